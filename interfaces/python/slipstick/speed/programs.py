"""Programs of Google Benchmark, run one benchmark at a time: a survey of one, or two builds or methods in interleaved pairs."""
from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..errors import InputError
from . import compare, timings


@dataclass(frozen=True)
class RunLength:
    """How long one run of a benchmark lasts."""
    seconds: float = 0.05  # least timed duration
    repetitions: int = 1


@dataclass(frozen=True)
class Pair:
    """Benchmarks of the base program and the compared one, run in immediate succession. No name: there is none to run."""
    name: str  # under which they are compared
    sides: tuple[tuple[str, str], tuple[str, str]]  # program and benchmark


class Progress:
    """Progress on standard error: on a terminal one line, rewritten; elsewhere a line every ten seconds."""

    def __init__(self, total: int) -> None:
        self._total, self._done, self._start = total, 0, time.monotonic()
        self._said = self._start

    def finished(self, label: str) -> None:
        self._done += 1
        now, terminal, last = time.monotonic(), sys.stderr.isatty(), self._done == self._total
        if not terminal and not last and now - self._said < 10.0:
            return
        self._said = now
        left = (now - self._start) / self._done * (self._total - self._done)
        shown = "".join(c if c.isprintable() else "?" for c in label)
        print(f"{chr(13) + chr(27) + '[K' if terminal else ''}[{self._done}/{self._total}] {shown}, about {left:.0f} s left",
              end="" if terminal and not last else "\n", file=sys.stderr, flush=True)


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


def run_benchmark(program: str, name: str, length: RunLength, starter: list[str]) -> dict[str, Any]:
    """Runs one benchmark in a process of its own; its output, in Google Benchmark's JSON. starter: words that start a program
    so that it does not outlive this one."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "timings.json"
        words = [os.path.abspath(program), f"--benchmark_filter={exactly(name)}", f"--benchmark_out={out}",
                 "--benchmark_out_format=json", f"--benchmark_min_time={length.seconds:g}",
                 f"--benchmark_repetitions={length.repetitions}"]
        end = subprocess.run([*starter, *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             check=False)
        if end.returncode != 0:
            how = f"ended with code {end.returncode}" if end.returncode > 0 else f"was killed by signal {-end.returncode}"
            raise InputError(f"{program}: benchmark {name} {how}")
        return timings.parse_json(out.read_text(errors="replace"), f"{program}: benchmark {name}")


def survey(program: str, pattern: str, length: RunLength, folder: Path, starter: list[str]) -> dict[str, Any]:
    """Runs benchmarks one after the other; one file of all. Finished ones are kept in the folder and not run again for the same
    program and length; an interrupt loses the one being run."""
    folder.mkdir(parents=True, exist_ok=True)
    names = list_benchmarks(program, pattern)
    progress, status = Progress(len(names)), os.stat(program)
    file: dict[str, Any] = {}
    for name in names:
        key = [os.path.abspath(program), status.st_size, status.st_mtime_ns, name, length.seconds, length.repetitions]
        readable = re.sub("[^A-Za-z0-9]", "-", name)[:80]
        kept = folder / f"{readable}-{sha256(name.encode()).hexdigest()[:16]}.json"
        try:
            found = json.loads(kept.read_text())
            run = found["result"] if found["key"] == key else None
        except (OSError, ValueError, TypeError, KeyError):
            run = None
        if run is None:
            run = run_benchmark(program, name, length, starter)
            draft = kept.with_suffix(f".part-{os.getpid()}")
            draft.write_text(json.dumps({"key": key, "result": run}, indent=1))
            draft.replace(kept)
        file = file or {"context": run["context"], "benchmarks": []}
        file["benchmarks"] += run["benchmarks"]
        progress.finished(name)
    return file


def two_builds(base: str, now: str, pattern: str) -> list[Pair]:
    """Every benchmark that fits in either program, by its name; a benchmark of one program only has no partner."""
    of_base, of_now = list_benchmarks(base, pattern), list_benchmarks(now, pattern)
    return [Pair(name, ((base, name if name in of_base else ""), (now, name if name in of_now else "")))
            for name in dict.fromkeys(of_base + of_now)]


def two_methods(program: str, base: str, now: str) -> list[Pair]:
    """Two benchmarks of one program, compared under both names."""
    for name in (base, now):
        list_benchmarks(program, exactly(name))
    return [Pair(f"{now} over {base}", ((program, base), (program, now)))]


def run_session(pairs: list[Pair], rounds: int, starter: list[str]) -> list[dict[str, Any]]:
    """The base's file and the new one, a repetition a round, both with the same "session" in their context. Runs all pairs,
    `rounds` times, every other time in the reverse order (AB, BA, AB...), so that other load of the machine affects both."""
    progress = Progress(len(pairs) * rounds)
    files: list[dict[str, Any]] = [{"context": {}, "benchmarks": []}, {"context": {}, "benchmarks": []}]
    for i in range(rounds):
        for pair in pairs:
            for side in ((0, 1) if i % 2 == 0 else (1, 0)):
                if not pair.sides[side][1]:
                    continue
                run = run_benchmark(*pair.sides[side], RunLength(), starter)
                files[side]["context"] = files[side]["context"] or run["context"]
                files[side]["benchmarks"] += [
                    {**row, "name": pair.name, "run_name": pair.name, "repetitions": rounds, "repetition_index": i}
                    for row in run["benchmarks"] if row.get("run_type", "iteration") == "iteration"]
            progress.finished(pair.name)
    session = f"{time.time_ns() // 1000000}-{os.getpid()}"
    for file in files:
        file["context"]["session"] = session
    return files


def compare_pairs(pairs: list[Pair], rounds: int, rules: compare.Rules, names: tuple[str, str],
                  starter: list[str]) -> dict[str, Any]:
    """Runs a session, and a second one with twice the rounds for the benchmarks that look slower: a verdict counts if both
    agree. The answer holds the first session's files."""
    def compared(files: list[dict[str, Any]]) -> compare.Comparison:
        return compare.compare(timings.from_json(files[0], "base"), timings.from_json(files[1], "new"), rules)

    files = run_session(pairs, rounds, starter)
    found, second = compared(files), None
    doubtful = {benchmark.name for benchmark in found.benchmarks if benchmark.finding in compare.SECOND_RUN}
    if doubtful:
        second = compared(run_session([pair for pair in pairs if pair.name in doubtful], 2 * rounds, starter))
        found = compare.confirm(found, second)
    return {**compare.report(*names, rules, found, second), "files": files}


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """A survey, or a comparison of two builds or two methods."""
    program = request["program"]
    starter = [request["starter"], "--tied-to", str(os.getpid()), "start"] if request["starter"] else []
    if request["what"] == "survey":
        from . import growth  # needs SciPy

        length = RunLength(request["seconds"], request["repetitions"])
        file = survey(program, request["filter"], length, Path(request["folder"]), starter)
        laws = growth.scaling(timings.from_json(file, "timings.json"))
        return {"result": file, "scaling": laws, "text": growth.crossovers_text(laws)}
    if request["what"] == "builds":
        pairs, names = two_builds(request["base"], program, request["filter"]), (request["base"], program)
    else:
        pairs, names = two_methods(program, request["base"], request["now"]), (request["base"], request["now"])
    return compare_pairs(pairs, request["rounds"], compare.Rules(effect=request["effect"]), names, starter)
