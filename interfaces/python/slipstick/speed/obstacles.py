"""Reasons not to judge times: different machines, debug builds, load, one file twice."""
from __future__ import annotations

import statistics
from dataclasses import dataclass
from pathlib import PurePath

from .timings import Benchmark, Timings, are_paired


@dataclass(frozen=True)
class Rules:
    """The rules by which a benchmark is called slower or quicker."""
    effect: float = 0.10  # smallest change of the time that counts
    level: float = 0.01  # of significance, over all benchmarks of a comparison together (Holm 1979)
    same_machine: bool = False  # the caller vouches for that
    debug_library: bool = False  # Google Benchmark may say that it was built without NDEBUG, as Debian's does

    def __post_init__(self) -> None:
        if not (self.effect > 0.0 and 0.0 < self.level < 1.0):
            raise ValueError("an effect is above 0, a level between 0 and 1")


CLOCK_TOLERANCE = 0.05  # a clock that is measured, not read, comes out a few percent different each time
# The part of the processors that other programs may keep busy when a run begins. A run in one thread finds a free processor
# then; it still shares caches, memory and the heat that limits the clock.
FOREIGN_LOAD = 0.5
# Time by the clock over the processor's: a quiet machine stays within a few percent of 1, three programs on two processors make
# it 1.5. A benchmark that waits for nine tenths of its time does so by its nature: a machine that is as busy as that shows in
# its load average.
WAITING, WAITING_BY_NATURE = 1.25, 10.0
# A wait that a change put into the program is in some benchmarks, one for a loaded machine is in most. Fewer benchmarks than
# this decide nothing.
MIN_CONCLUSIVE = 3


def _machine_differences(base: Timings, now: Timings) -> list[str]:
    pairs = [("host_name", base.host_name, now.host_name), ("num_cpus", base.cpus, now.cpus)]
    if not abs(now.mhz - base.mhz) <= CLOCK_TOLERANCE * base.mhz:
        pairs.append(("mhz_per_cpu", f"{base.mhz:g}", f"{now.mhz:g}"))
    return [f"{key} {one} and {other}" for key, one, other in [*pairs, ("caches", base.caches, now.caches)] if one != other]


def _debug_build(file: Timings, rules: Rules) -> str:
    if file.build_type.lower() == "debug":
        return "a debug build (build_type)"
    if file.build_type or rules.debug_library or file.library_build_type != "debug":
        return ""
    return ("a debug build, by library_build_type (if only Google Benchmark's library is one, as Debian's says of itself: "
            "--debug-library, or a custom context build_type=release)")


def _load(file: Timings) -> str:
    own = max(1, *(benchmark.threads for benchmark in file.benchmarks))  # what the run itself uses, and one just before it
    if file.cpus == 0 or file.load_average - own <= FOREIGN_LOAD * file.cpus:
        return ""
    return (f"the machine was loaded when it began (load average {file.load_average:.2f} on {file.cpus} processors; "
            f"the program explains {own}); run it again when the others are done")


def _waiting_factor(benchmark: Benchmark) -> float:
    """The median of clock over processor time; 1 where the processor time includes other work."""
    brings_own_time = "/manual_time" in benchmark.name or "/process_time" in benchmark.name
    if not benchmark.has_times() or benchmark.threads != 1 or brings_own_time:
        return 1.0
    return statistics.median(real / cpu if cpu > 0.0 else 1.0 for real, cpu in zip(benchmark.real, benchmark.cpu))


def _waiting(file: Timings) -> str:
    """Whether most benchmarks wait."""
    count = len(file.benchmarks)
    waiting = sum(WAITING <= _waiting_factor(benchmark) < WAITING_BY_NATURE for benchmark in file.benchmarks)
    if count < MIN_CONCLUSIVE or 2 * waiting <= count:
        return ""
    return (f"the machine was loaded: {waiting} of {count} benchmarks took {WAITING} times as long as the processor worked for "
            "them, or longer (if that is their nature: MeasureProcessCPUTime or UseManualTime)")


def find_obstacles(base: Timings, now: Timings, rules: Rules) -> list[str]:
    """Reasons not to judge the times of two files: different machines, debug builds, load, one file twice. Load is
    a reason in independent runs only: it slows both sides of a pair alike."""
    found = []
    paired = are_paired(base, now)
    differences = _machine_differences(base, now)
    if not (base.names_machine and now.names_machine) and not rules.same_machine:
        found.append("a file of hyperfine does not say on which machine it was made (if it is one machine: --same-machine)")
    elif differences and not rules.same_machine and not paired:
        found.append(f"the machines differ: {'; '.join(differences)} (if it is one machine: --same-machine)")
    for file in (base, now):
        reasons = (_debug_build(file, rules), _load(file), "" if paired else _waiting(file))
        found += [f"{PurePath(file.file).name}: {reason}" for reason in reasons if reason]
    times, others = ([time for benchmark in file.benchmarks for time in benchmark.real] for file in (base, now))
    if times and times == others:
        found.append("both files hold the very same times: one run is compared with itself")
    return found
