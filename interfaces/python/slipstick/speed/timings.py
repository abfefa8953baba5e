"""Files of times: of any program that uses Google Benchmark (--benchmark_format=json), of its versions 1.5 to 1.9, of
pytest-benchmark (--benchmark-json) and of hyperfine (--export-json)."""
from __future__ import annotations

import json
import math
import re
import statistics
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from ..errors import InputError

ALLOWED = ("what Google Benchmark (--benchmark_format=json), pytest-benchmark (--benchmark-json) or hyperfine (--export-json) "
           "writes")
MAX_REPETITIONS = 30  # of a benchmark of pytest-benchmark or hyperfine; successive ones are put together
MAX_LEVELS = 200  # of nested brackets, as in all JSON that the program reads
MAX_SHOWN = 200  # characters of a wrong value
SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
KINDS = {str: "a string", bool: "true or false", int: "a whole number", float: "a number", dict: "an object"}
NOT_COUNTERS = {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads", "iterations",
                "real_time", "cpu_time"}


@dataclass
class Benchmark:
    """One benchmark of a file: its repetitions in their order; none in files of aggregates only."""
    name: str  # with its arguments, without the aggregate; the second of a name has " #2"
    threads: int = 1  # that Google Benchmark ran it in
    real: list[float] = field(default_factory=list)  # seconds of one iteration by the clock
    cpu: list[float] = field(default_factory=list)  # of the processor
    counters: dict[str, float] = field(default_factory=dict)  # of the last repetition; only finite values
    error: str = ""  # why it failed, or which time is none
    skipped: str = ""  # why it left itself out, which is no failure

    def has_times(self) -> bool:
        """Whether it has times that can be judged: repetitions, each of a valid time."""
        return bool(self.real) and all(is_valid_time(time) for time in self.real)


@dataclass
class Timings:
    """The benchmarks of a file in its order, and where, when and how they were run. Empty texts, zeros: the file gives none."""
    file: str
    benchmarks: list[Benchmark]
    host_name: str = ""
    cpus: int = 0
    mhz: float = 0.0
    caches: str = "[]"  # as JSON
    load_average: float = 0.0  # over the minute before the program began
    library_build_type: str = ""  # of Google Benchmark itself; Debian's says debug always
    build_type: str = ""  # of the benchmarks: custom context "build_type"
    session: str = ""  # custom context: files of one session were run in interleaved pairs on one machine
    names_machine: bool = True  # False: files of this program cannot say where they were made


def are_paired(base: Timings, now: Timings) -> bool:
    """Whether both files are of one session."""
    return bool(base.session) and base.session == now.session


def is_valid_time(seconds: float) -> bool:
    """Finite and above zero."""
    return 0.0 < seconds < math.inf


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def parse_json(text: str, source: str) -> dict[str, Any]:
    """The JSON that a program of Google Benchmark wrote, infinities and NaN, which it writes as they are, as null. Raises
    InputError with the source for any other text."""
    def finite(number: str) -> float:
        if math.isinf(float(number)):
            raise ValueError(f"{number[:MAX_SHOWN]} is too large")
        return float(number)

    def levels(tree: Any) -> int:
        parts = tree.values() if isinstance(tree, dict) else tree if isinstance(tree, list) else None
        return 0 if parts is None else 1 + max(map(levels, parts), default=0)

    words = re.compile(r'"(?:[^"\\]|\\.)*"?|-?[A-Za-z]+', re.DOTALL)
    plain = words.sub(lambda word: word[0] if word[0][0] == '"' or word[0] in ("true", "false", "e", "E") else "null", text)
    try:
        tree = json.loads(plain, parse_float=finite, parse_int=lambda word: int(word) if len(word) < 19 else finite(word))
        too_deep = levels(tree) > MAX_LEVELS
    except RecursionError:
        too_deep = True
    except ValueError as error:
        raise InputError(f"{source}: is not JSON ({error}); allowed: {ALLOWED}") from error
    if too_deep:
        raise InputError(f"{source}: brackets in brackets, more than {MAX_LEVELS} deep; allowed: {ALLOWED}")
    if not isinstance(tree, dict):
        raise InputError(f"{source}: has no context and benchmarks; allowed: {ALLOWED}")
    return tree


def _rows(tree: dict[str, Any], key: str, source: str) -> list[_Object]:
    for i, values in enumerate(tree[key]):
        if not isinstance(values, dict):
            raise InputError(f"{source}: {key}[{i}] is no object")
    return [_Object(values, f"{source}: {key}[{i}]") for i, values in enumerate(tree[key])]


class _Object:
    """The values of one object of a file, which stands at `place`."""

    def __init__(self, values: dict[str, Any], place: str) -> None:
        self.values, self._place = values, place

    def refuse(self, key: str, allowed: str) -> InputError:
        shown = json.dumps(self.values[key])[:MAX_SHOWN] if key in self.values else "nothing"
        return InputError(f"{self._place}.{key} = {shown}: allowed: {allowed}")

    def get(self, key: str, otherwise: Any) -> Any:
        """The value of a key, of the same type as `otherwise`, which stands for a missing one; NaN for null as a number."""
        value = self.values.get(key, otherwise)
        if value is None and isinstance(otherwise, float):
            return math.nan
        if not (is_number(value) if isinstance(otherwise, float) else type(value) is type(otherwise)):
            raise self.refuse(key, KINDS[type(otherwise)])
        return value


def _add_repetition(benchmark: Benchmark, row: _Object) -> None:
    if row.get("error_occurred", False):
        benchmark.error = row.get("error_message", "") or "it says that an error occurred"
        return
    if row.get("skipped", False):
        benchmark.skipped = row.get("skip_message", "") or "it says that it was skipped"
        return
    unit = row.get("time_unit", "ns")
    if unit not in SECONDS:
        raise row.refuse("time_unit", ", ".join(SECONDS))
    if "real_time" not in row.values:
        raise row.refuse("real_time", "a number")
    benchmark.real.append(SECONDS[unit] * row.get("real_time", math.nan))
    benchmark.cpu.append(SECONDS[unit] * row.get("cpu_time", math.nan))
    benchmark.counters = {key: float(value) for key, value in row.values.items()
                          if key not in NOT_COUNTERS and is_number(value)}
    benchmark.threads = row.get("threads", 1)
    if not is_valid_time(benchmark.real[-1]) and not benchmark.error:
        benchmark.error = f"the time of repetition {len(benchmark.real)} is {benchmark.real[-1]:g}, which is none"


class _Benchmarks:
    """The benchmarks of a file by their keys, in its order; two of one name are of two families."""

    def __init__(self) -> None:
        self._found: dict[Any, Benchmark] = {}
        self._number: Counter[str] = Counter()

    def get(self, name: str, key: Any) -> Benchmark:
        """The benchmark of a key, a new one of this name if the key is new."""
        if key not in self._found:
            self._number[name] += 1
            self._found[key] = Benchmark(name if self._number[name] == 1 else f"{name} #{self._number[name]}")
        return self._found[key]

    def all(self, source: str) -> list[Benchmark]:
        if not self._found:
            raise InputError(f"{source}: holds no benchmark")
        return list(self._found.values())


def from_google_benchmark(tree: dict[str, Any], source: str) -> Timings:
    """Puts the rows of a file together to benchmarks, in their order. A row without a type is a repetition; rows of complexity
    fits are of a family, not of a benchmark. Raises InputError, with the key, for wrong values and without benchmarks."""
    found = _Benchmarks()
    for row in _rows(tree, "benchmarks", source):
        if row.get("aggregate_name", "") in ("BigO", "RMS"):
            continue
        name = row.get("run_name" if "run_name" in row.values else "name", "")
        if not name:
            raise row.refuse("name", "the name of a benchmark")
        benchmark = found.get(name, (name, row.get("family_index", 0), row.get("per_family_instance_index", 0)))
        if row.get("run_type", "") != "aggregate":
            _add_repetition(benchmark, row)
    benchmarks = found.all(source)
    context = _Object(tree["context"], f"{source}: context")
    load = tree["context"].get("load_avg", [])
    if not isinstance(load, list) or (load and not is_number(load[0])):
        raise context.refuse("load_avg", "a list of numbers")
    texts = {key: context.get(key, "") for key in ("host_name", "library_build_type", "build_type", "session")}
    return Timings(source, benchmarks, cpus=context.get("num_cpus", 0), mhz=context.get("mhz_per_cpu", 0.0),
                   caches=json.dumps(tree["context"].get("caches", []), separators=(",", ":")),
                   load_average=load[0] if load else 0.0, **texts)


def _add_seconds(benchmark: Benchmark, row: _Object, key: str) -> None:
    """Times of successive repetitions, in seconds. Many are put together in MAX_REPETITIONS groups of neighbours, each with its
    median: neighbours share what disturbs them."""
    times = row.values.get(key, [])
    if not isinstance(times, list) or not all(is_number(time) for time in times):
        raise row.refuse(key, "a list of numbers")
    wrong = next((i for i, time in enumerate(times, 1) if not is_valid_time(time)), None)
    if wrong:
        benchmark.error = f"the time of repetition {wrong} is {times[wrong - 1]:g}, which is none"
    groups = min(len(times), MAX_REPETITIONS)
    ends = [len(times) * i // groups for i in range(groups + 1)] if groups else []
    benchmark.real += [float(statistics.median(times[begin:end])) for begin, end in zip(ends, ends[1:])]
    benchmark.cpu += groups * [math.nan]


def from_pytest_benchmark(tree: dict[str, Any], source: str) -> Timings:
    """Each benchmark has its rounds in stats.data, which only --benchmark-json and --benchmark-save-data write."""
    found = _Benchmarks()
    for i, row in enumerate(_rows(tree, "benchmarks", source)):
        name = row.get("fullname" if "fullname" in row.values else "name", "")
        if not name or not isinstance(row.values.get("stats"), dict):
            raise row.refuse("stats" if name else "name", "an object" if name else "the name of a benchmark")
        _add_seconds(found.get(name, i), _Object(row.values["stats"], f"{source}: benchmarks[{i}].stats"), "data")
    machine = _Object(tree["machine_info"], f"{source}: machine_info")
    cpu = _Object(machine.get("cpu", {}), f"{source}: machine_info.cpu")
    return Timings(source, found.all(source), host_name=machine.get("node", ""), cpus=cpu.get("count", 0),
                   caches=json.dumps([cpu.values.get(key) for key in ("brand_raw", "l2_cache_size", "l3_cache_size")]))


def from_hyperfine(tree: dict[str, Any], source: str) -> Timings:
    """Each command has its times. The file does not name the machine."""
    found = _Benchmarks()
    for i, row in enumerate(_rows(tree, "results", source)):
        name = row.get("command", "")
        if not name:
            raise row.refuse("command", "the command that was timed")
        _add_seconds(found.get(name, i), row, "times")
    return Timings(source, found.all(source), names_machine=False)


def from_json(tree: dict[str, Any], source: str) -> Timings:
    """The timings of a file of any of the three programs."""
    benchmarks = isinstance(tree.get("benchmarks"), list)
    if benchmarks and isinstance(tree.get("context"), dict):
        return from_google_benchmark(tree, source)
    if benchmarks and isinstance(tree.get("machine_info"), dict):
        return from_pytest_benchmark(tree, source)
    results = tree.get("results")
    if isinstance(results, list) and results and all(isinstance(each, dict) and "times" in each for each in results):
        return from_hyperfine(tree, source)
    raise InputError(f"{source}: has no context and benchmarks; allowed: {ALLOWED}")


def parse(text: str, source: str) -> Timings:
    """The timings of a text; messages call it `source`."""
    return from_json(parse_json(text, source), source)
