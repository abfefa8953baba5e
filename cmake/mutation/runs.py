"""Test suites, what each reaches, and which of them see a mutant."""

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

# A mutant hangs when its test takes so many times the test's own time, and so many seconds more.
TIMES, MORE_SECONDS = 5, 20
BYTES = 8 << 30  # of address space
PROGRAMS = {"analytic": ("analytic/analytic_tests", "analytic/certified/certified_tests"),
            "solver": ("solver/solver_tests", "solver/operators_tests"),
            "convergence": ("convergence/convergence_tests",), "bench": ("bench/bench_tests", "bench/work_counts_tests")}


@dataclass
class Suite:
    name: str
    command: list
    reached: set = field(default_factory=set)  # numbers of mutants
    seconds: float = 0.0
    failing: tuple = ()  # tests that fail without any mutant: they count allocations and the like

    def words(self, folder):
        """In `folder`, where it may write; {} stands for it."""
        left_out = "-" + ":".join(self.failing) if self.failing else ""
        return [str(word).replace("{}", str(folder)) + (left_out if str(word).startswith("--gtest_filter") else "")
                for word in self.command]


def limited():
    os.setpgid(0, 0)
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(words, folder, limit=None, **environment):
    """Exit code, None after `limit` seconds, and output. What it has started ends with it."""
    with tempfile.TemporaryFile("w+", errors="replace") as output:
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=output, stderr=output, cwd=folder,
                                   env=os.environ | {"TMPDIR": str(folder)} | environment, preexec_fn=limited)
        try:
            code = process.wait(limit)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
        output.seek(0)
        return code, output.read()


def google_suites(build, folder):
    """Each GoogleTest suite of a folder's test programs."""
    for program in PROGRAMS[folder]:
        path = build / program
        if not path.is_file():
            continue
        listing = subprocess.run([path, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
        for name in re.findall(r"^(\S+)\.", listing, re.MULTILINE):
            yield Suite(name, [path, "--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter={name}.*"])


def gates(source, build):
    words = [build / "slipstick", "gate", source / "convergence/gates/quick.toml", "--results", "{}", "--output", "{}"]
    return Suite("the gates", words)


def measure(suite, mutants, limit=None):
    """Runs a suite without a mutant: what it reaches, how long it takes, what fails anyway. Says what is left out."""
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        reached = Path(folder, "reached")
        reached.write_bytes(bytes(mutants + 1))
        words = [word for word in suite.words(folder) if word != "--gtest_fail_fast"]
        start = time.monotonic()
        code, output = run(words, folder, limit, SLIPSTICK_REACHED=str(reached))
        suite.seconds = time.monotonic() - start
        suite.reached = {number for number, byte in enumerate(reached.read_bytes()) if byte}
    if code is None:
        suite.reached = set()
        return f"{suite.name} takes more than {limit:g} s and is left out"
    suite.failing = tuple(sorted(set(re.findall(r"^\[  FAILED  \] (\S+?)(?:,| \()", output, re.MULTILINE))))
    if code != 0 and not suite.failing:
        suite.reached = set()
        return f"{suite.name} fails without a mutant and is left out:\n{output[-2000:]}"
    return f"{', '.join(suite.failing)}: fails without a mutant and is left out" if suite.failing else ""


def verdict(suite, number):
    """How a suite sees a mutant; empty: not at all."""
    with tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as folder:
        code, output = run(suite.words(folder), folder, TIMES * suite.seconds + MORE_SECONDS, SLIPSTICK_MUTANT=str(number))
    if code is None:
        return f"{suite.name}: time-out"
    if code == 0:
        return ""
    failed = re.search(r"^\[  FAILED  \] (\S+?)(?:,| \(|$)", output, re.MULTILINE)
    return failed.group(1) if failed else f"{suite.name}: code {code}"


def killed_by(mutant, suites):
    """The first suite, the quickest first, that fails; None: no suite reaches the mutant."""
    reaching = sorted((suite for suite in suites if mutant.number in suite.reached), key=lambda suite: suite.seconds)
    for suite in reaching:
        if found := verdict(suite, mutant.number):
            return found
    return "" if reaching else None


# ---- Python: the mutated file lies in a copy of the folder.

TRACED = """
import json, os, runpy, sys
folder, result, test, name = sys.argv[1:]
lines = set()
def line(frame, event, argument):
    lines.add((frame.f_code.co_filename, frame.f_lineno))
    return line
def call(frame, event, argument):
    return line(frame, event, argument) if frame.f_code.co_filename.startswith(folder) else None
sys.settrace(call)
sys.argv = [test, name]
sys.path.insert(0, os.path.dirname(test))
try:
    runpy.run_path(test, run_name="__main__")
finally:
    sys.settrace(None)
    json.dump(sorted(lines), open(result, "w"))
"""


CLASSES = """
import importlib, sys, unittest
sys.path.insert(0, "tests")
for found in vars(importlib.import_module(sys.argv[1])).values():
    if isinstance(found, type) and issubclass(found, unittest.TestCase) and found.__module__ == sys.argv[1]:
        if unittest.defaultTestLoader.getTestCaseNames(found):
            print(found.__name__)
"""


def python_suites(reports):
    """Each class of tests."""
    for test in sorted((reports / "tests").glob("test_*.py")):
        listing = subprocess.run([sys.executable, "-B", "-c", CLASSES, test.stem], cwd=reports, capture_output=True,
                                 text=True, check=True).stdout
        for name in listing.split():
            yield Suite(f"{test.stem}.{name}", [sys.executable, "-B", Path("tests", test.name), "--failfast", name])


def measure_python(suite, reports, mutants, limit=None):
    test, name = reports / suite.command[2], suite.command[4]
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        result = Path(folder, "lines.json")
        start = time.monotonic()
        code, output = run([sys.executable, "-B", "-c", TRACED, str(reports), str(result), str(test), name], folder, limit)
        suite.seconds = time.monotonic() - start
        lines = {tuple(each) for each in json.loads(result.read_text())} if result.is_file() else set()
    if code is None:
        return f"{suite.name} takes more than {limit:g} s and is left out"
    if code != 0:
        return f"{suite.name} fails without a mutant and is left out:\n{output[-2000:]}"
    suite.reached = {each.number for each in mutants
                     if any((str(reports.parent / each.file), line) in lines for line in each.lines)}
    return ""


def python_killed_by(mutant, suites, reports):
    reaching = sorted((suite for suite in suites if mutant.number in suite.reached), key=lambda suite: suite.seconds)
    if not reaching:
        return None
    with tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as folder:
        copied = Path(folder, "reports")
        shutil.copytree(reports, copied)
        path = copied.parent / mutant.file
        text, change = path.read_text(), mutant.mutation
        path.write_text(text[:change.start] + change.shown + text[change.end:])
        for suite in reaching:
            code, output = run([str(word) for word in suite.command], copied, TIMES * suite.seconds + MORE_SECONDS)
            if code is None:
                return f"{suite.name}: time-out"
            if code != 0:
                failed = re.search(r"^(?:FAIL|ERROR): (\w+)", output, re.MULTILINE)
                return f"{suite.name}.{failed.group(1)}" if failed else f"{suite.name}: code {code}"
    return ""
