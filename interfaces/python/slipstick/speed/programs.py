"""Programs of Google Benchmark, run one benchmark at a time: a survey of one, or two builds or methods in interleaved pairs."""
from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from hashlib import sha256
from pathlib import Path
from typing import Any, Iterable, Iterator, List, Optional, Tuple

from ..errors import InputError
from . import compare, timings

# A name, under which two benchmarks are compared, and program and benchmark of either side, the base first; None: none.
Pair = Tuple[str, List[Optional[Tuple[str, str]]]]
PAIR_SECONDS = 0.05  # least timed duration of a run


def shown(parts: Iterable[tuple[str, Any]], total: int) -> Iterator[Any]:
    """The parts, each labelled, with their progress on standard error: on a terminal one line, rewritten; elsewhere a line
    every ten seconds."""
    start = said = time.monotonic()
    terminal = sys.stderr.isatty()
    for done, (label, part) in enumerate(parts, 1):
        yield part
        now, last = time.monotonic(), done == total
        if terminal or last or now - said >= 10.0:
            said = now
            printable = "".join(c if c.isprintable() else "?" for c in label)
            print(f"{chr(13) + chr(27) + '[K' if terminal else ''}[{done}/{total}] {printable}, about "
                  f"{(now - start) / done * (total - done):.0f} s left", end="" if terminal and not last else "\n",
                  file=sys.stderr, flush=True)


def exactly(name: str) -> str:
    """The --benchmark_filter (POSIX extended) that runs exactly this benchmark."""
    return "^(" + re.sub(r"[.\[\]{}()*+?|^$\\]", r"\\\g<0>", name) + ")$"


def list_benchmarks(program: str, pattern: str) -> list[str]:
    """The benchmarks whose names fit a regular expression (empty: the program's default), in the program's order."""
    if not os.path.isfile(program):
        raise InputError(f"{program}: there is no such program; allowed: one of Google Benchmark")
    words = [os.path.abspath(program), "--benchmark_list_tests", *([f"--benchmark_filter={pattern}"] if pattern else [])]
    try:
        end = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, check=False)
        names = end.stdout.decode(errors="replace").splitlines() if end.returncode == 0 else []
    except OSError:
        names = []
    if not names:
        raise InputError(f"{program}: lists no benchmark that fits \"{pattern}\"")
    return names


def run_benchmark(program: str, name: str, starter: list[str], seconds: float, repetitions: int = 1) -> dict[str, Any]:
    """Runs one benchmark in a process of its own; its output, in Google Benchmark's JSON. starter: words that start a program
    so that it does not outlive this one."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "timings.json"
        words = [*starter, os.path.abspath(program), f"--benchmark_filter={exactly(name)}", f"--benchmark_out={out}",
                 "--benchmark_out_format=json", f"--benchmark_min_time={seconds:g}", f"--benchmark_repetitions={repetitions}"]
        end = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        if end.returncode != 0:
            how = f"ended with code {end.returncode}" if end.returncode > 0 else f"was killed by signal {-end.returncode}"
            raise InputError(f"{program}: benchmark {name} {how}")
        return timings.parse_json(out.read_text(errors="replace"), f"{program}: benchmark {name}")


def survey(program: str, pattern: str, folder: Path, starter: list[str], seconds: float, repetitions: int) -> dict[str, Any]:
    """Runs benchmarks one after the other; one file of all. Finished ones are kept in the folder and not run again for the same
    program and length; an interrupt loses the one being run."""
    folder.mkdir(parents=True, exist_ok=True)
    names = list_benchmarks(program, pattern)
    status = os.stat(program)
    file: dict[str, Any] = {}
    for name in shown(zip(names, names), len(names)):
        key = [os.path.abspath(program), status.st_size, status.st_mtime_ns, name, seconds, repetitions]
        readable = re.sub("[^A-Za-z0-9]", "-", name)[:80]
        kept = folder / f"{readable}-{sha256(name.encode()).hexdigest()[:16]}.json"
        try:
            found = json.loads(kept.read_text())
            run = found["result"] if found["key"] == key else None
        except (OSError, ValueError, TypeError, KeyError):
            run = None
        if run is None:
            run = run_benchmark(program, name, starter, seconds, repetitions)
            draft = kept.with_suffix(f".part-{os.getpid()}")
            draft.write_text(json.dumps({"key": key, "result": run}, indent=1))
            draft.replace(kept)
        file = file or {"context": run["context"], "benchmarks": []}
        file["benchmarks"] += run["benchmarks"]
    return file


def two_builds(base: str, now: str, pattern: str) -> list[Pair]:
    """Every benchmark that fits in either program, by its name; a benchmark of one program only has no partner."""
    known = {program: list_benchmarks(program, pattern) for program in (base, now)}
    return [(name, [(program, name) if name in known[program] else None for program in (base, now)])
            for name in dict.fromkeys(known[base] + known[now])]


def two_methods(program: str, base: str, now: str) -> list[Pair]:
    """Two benchmarks of one program, compared under both names."""
    for name in (base, now):
        list_benchmarks(program, exactly(name))
    return [(f"{now} over {base}", [(program, base), (program, now)])]


def run_session(pairs: list[Pair], rounds: int, starter: list[str]) -> list[dict[str, Any]]:
    """The base's file and the new one, a repetition a round, both with the same "session" in their context. Runs all pairs,
    `rounds` times, every other time in the reverse order (AB, BA, AB...), so that other load of the machine affects both."""
    files: list[dict[str, Any]] = [{"context": {}, "benchmarks": []}, {"context": {}, "benchmarks": []}]
    parts = ((pair[0], (i, *pair)) for i in range(rounds) for pair in pairs)
    for i, name, sides in shown(parts, len(pairs) * rounds):
        for side, file in list(zip(sides, files))[::1 if i % 2 == 0 else -1]:
            if side is not None:
                run = run_benchmark(*side, starter, PAIR_SECONDS)
                file["context"] = file["context"] or run["context"]
                file["benchmarks"] += [{**row, "name": name, "run_name": name, "repetitions": rounds, "repetition_index": i}
                                       for row in run["benchmarks"] if row.get("run_type", "iteration") == "iteration"]
    session = f"{time.time_ns() // 1000000}-{os.getpid()}"
    return [{**file, "context": {**file["context"], "session": session}} for file in files]


def compare_pairs(pairs: list[Pair], rounds: int, rules: compare.Rules, base: str, now: str,
                  starter: list[str]) -> dict[str, Any]:
    """Runs a session, and a second one with twice the rounds for the benchmarks that look slower: a verdict counts if both
    agree. The answer holds the first session's files."""
    def compared(files: list[dict[str, Any]]) -> compare.Comparison:
        return compare.compare(timings.from_json(files[0], "base"), timings.from_json(files[1], "new"), rules)

    files = run_session(pairs, rounds, starter)
    found, second = compared(files), None
    doubtful = {benchmark.name for benchmark in found.benchmarks if benchmark.finding in compare.SECOND_RUN}
    if doubtful:
        second = compared(run_session([pair for pair in pairs if pair[0] in doubtful], 2 * rounds, starter))
        found = compare.confirm(found, second)
    return {**compare.report(base, now, rules, found, second), "files": files}


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """A survey, or a comparison of two builds or two methods."""
    program, what = request["program"], request["what"]
    starter = [request["starter"], "--tied-to", str(os.getpid()), "start"] if request["starter"] else []
    if what == "survey":
        from . import crossovers, growth  # need SciPy

        file = survey(program, request["filter"], Path(request["folder"]), starter, request["seconds"], request["repetitions"])
        read = timings.from_json(file, "timings.json")
        crossings = crossovers.crossovers({name: growth.seconds_of(own) for name, own in growth.families(read).items()})
        return {"result": file, "scaling": {"families": growth.scaling(read), "crossovers": crossings},
                "text": crossovers.crossovers_text(crossings)}
    base, now = request["base"], program if what == "builds" else request["now"]
    pairs = two_builds(base, now, request["filter"]) if what == "builds" else two_methods(program, base, now)
    return compare_pairs(pairs, request["rounds"], compare.Rules(effect=request["effect"]), base, now, starter)
