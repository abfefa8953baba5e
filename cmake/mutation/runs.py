"""Test suites, the mutants that each reaches, and the suites that detect a mutant."""

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

import rules

# A mutant hangs when its test takes TIMES its own time and MORE_SECONDS.
TIMES, MORE_SECONDS = 5, 20
PYTHON_SECONDS = 300  # the slowest test file of reports/ runs for 10
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
    failing: tuple = ()  # tests that fail without any mutant, since they count allocations, for example

    def words(self, folder):
        """Runs in `folder`, where it may write; {} is replaced by its name."""
        skipped = "-" + ":".join(self.failing) if self.failing else ""
        return [str(word).replace("{}", str(folder)) + (skipped if str(word).startswith("--gtest_filter") else "")
                for word in self.command]


def limited():
    os.setpgid(0, 0)
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(words, folder, limit=None, **environment):
    """Exit code, None after `limit` seconds, and output. All processes that it started end with it."""
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
    """Runs a suite without a mutant: what it reaches, how long it takes, which tests fail anyway. Names those as skipped."""
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
        return f"{suite.name} takes more than {limit:g} s and is skipped"
    suite.failing = tuple(sorted(set(re.findall(r"^\[  FAILED  \] (\S+?)(?:,| \()", output, re.MULTILINE))))
    if code != 0 and not suite.failing:
        suite.reached = set()
        return f"{suite.name} fails without a mutant and is skipped:\n{output[-2000:]}"
    return f"{', '.join(suite.failing)}: fails without a mutant and is skipped" if suite.failing else ""


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


def python_tests(reports, say):
    """The test files of reports/ that pass without a mutant: not the browser's, which needs more address space."""
    passing = []
    for test in sorted((reports / "tests").glob("test_*.py")):
        with tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as folder:
            code, output = run([sys.executable, "-B", test], folder, PYTHON_SECONDS)
        if code == 0:
            passing.append(test.name)
        else:
            say(f"{test.stem} fails without a mutant and is skipped:\n{output[-2000:]}")
    return passing


def python_killed_by(mutant, tests, reports):
    """The first of the test files that fails, the one of the mutated file's name first."""
    own = f"test_{Path(mutant.file).stem}.py"
    with tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as folder:
        copied = Path(folder, "reports")
        shutil.copytree(reports, copied)
        path = Path(folder, mutant.file)
        path.write_text(rules.mutated(path.read_text(), mutant.mutation))
        for test in sorted(tests, key=lambda name: name != own):
            code, output = run([sys.executable, "-B", f"tests/{test}", "--failfast"], copied, PYTHON_SECONDS)
            if code is None:
                return f"{test}: time-out"
            if code != 0:
                failed = re.search(r"^(?:FAIL|ERROR): (\w+)", output, re.MULTILINE)
                return f"{test}.{failed.group(1)}" if failed else f"{test}: code {code}"
    return ""
