"""How times grow with the cells along a side."""
from __future__ import annotations

import math
import re
import statistics
from typing import Any

import numpy
from scipy.special import stdtrit

from .timings import Benchmark, Timings, is_valid_time

UPPER_QUANTILE = 0.975  # the upper end of a 95 % interval
ASYMPTOTIC_SPAN = 8.0  # largest size over the smallest that a power law is fitted to
MIN_SIZES = 3  # that a law needs: two would fit any law
NO_THEORY = "no theory is known here"
Family = dict[float, list[float]]  # the seconds of one benchmark's repetitions by its cells

# Growth by theory. N: cells along a side. The logarithm is that of 2 N, the length that N is padded to.
GROWTHS = {"N^2": lambda n: n**2, "N^2 log N": lambda n: n**2 * math.log2(2 * n), "N^4": lambda n: n**4}
# By the beginning of a family's name.
THEORY = {"application/dense": "N^4", "application/direct": "N^4", "application/dcfft": "N^2 log N",
          "four_bare_transforms": "N^2 log N", "influence/": "N^2", "setup/dense": "N^4", "setup/direct": "N^2",
          "setup/dcfft": "N^2 log N", "normal/": "N^2 log N", "solve/coulomb": "N^2 log N"}


def log_time(seconds: list[float]) -> tuple[float, float, int] | None:
    """The median of the repetitions' logarithms, its standard error (NaN: one repetition) and the degrees of freedom that it
    rests on; None: no repetition is a positive number. The median of many normal deviates has sqrt(pi/2) of their mean's
    standard error."""
    logs = [math.log(time) for time in seconds if is_valid_time(time)]
    if not logs:
        return None
    error = math.sqrt(0.5 * math.pi / len(logs)) * statistics.stdev(logs) if len(logs) > 1 else math.nan
    return statistics.median(logs), error, len(logs) - 1


def quantile(freedom: int) -> float:
    """Student's, at the upper end of a 95 % interval; NaN without a degree of freedom."""
    return float(stdtrit(freedom, UPPER_QUANTILE)) if freedom > 0 else math.nan


def typical(seconds: list[float]) -> tuple[float, float, float]:
    """The median of repetitions with its 95 % interval: Student's, of their logarithms. Repetitions without a positive number are
    ignored; NaN: there are fewer than two."""
    time = log_time(seconds)
    if time is None:
        return math.nan, math.nan, math.nan
    median, half = time[0], time[1] * quantile(time[2])
    return math.exp(median), math.exp(median - half), math.exp(median + half)


def fit_power_law(family: Family) -> dict[str, Any]:
    """constant cells^exponent with the exponent's 95 % interval (Student's, from the residuals), by least squares of logarithms
    over the asymptotic part: from an eighth of the largest size up, three doublings, at least three sizes. Below, what each
    call costs whatever its size takes a part of the time. `why_not`: why no law was fitted."""
    law = {**dict.fromkeys(("exponent", "low", "high", "constant"), math.nan), "cells": [], "why_not": ""}
    medians = {cells: typical(family[cells])[0] for cells in sorted(family) if cells > 0.0}
    times = {cells: seconds for cells, seconds in medians.items() if not math.isnan(seconds)}
    if len(times) < MIN_SIZES:
        return {**law, "why_not": f"{len(times)} sizes have a time, {MIN_SIZES} are needed"}
    least = max(times) / ASYMPTOTIC_SPAN
    cells = [size for size in times if size >= least]
    if len(cells) < MIN_SIZES:
        return {**law, "why_not": f"{len(cells)} sizes from {least:g} cells up, {MIN_SIZES} are needed"}
    (slope, start), covariance = numpy.polyfit(numpy.log(cells), numpy.log([times[size] for size in cells]), 1, cov=True)
    half = quantile(len(cells) - 2) * math.sqrt(covariance[0, 0])
    return {**law, "exponent": float(slope), "low": slope - half, "high": slope + half, "constant": math.exp(start),
            "cells": cells}


# ---------------------------------------------------------------- results


def put(row: dict[str, Any], key: str, value: float, reason: str) -> None:
    """Sets a number, or null with its reason: JSON has no NaN and no infinity."""
    row[key] = value if math.isfinite(value) else None
    if row[key] is None:
        row[f"{key}_reason"] = reason


def family_and_cells(name: str) -> tuple[str, float] | None:
    """"a/cells:8/b" is the family "a/b" at 8 cells."""
    found = re.search("(?:^|/)cells:([^/]*)", name)
    if found is None or not re.fullmatch("[0-9]{1,9}", found[1]):
        return None
    family = name[:found.start()] + name[found.end():]
    return family[1:] if family.startswith("/") else family, float(found[1])


def _row(cells: float, benchmark: Benchmark, seconds: list[float]) -> dict[str, Any]:
    time, low, high = typical(seconds)
    none = benchmark.error or "no repetition has a time"
    row: dict[str, Any] = {"cells": cells}
    put(row, "seconds", time, none)
    put(row, "low", low, none if math.isnan(time) else "one repetition")
    put(row, "high", high, none if math.isnan(time) else "one repetition")
    row["repetitions"] = sum(is_valid_time(one) for one in seconds)
    error = benchmark.counters.get("error", benchmark.counters.get("twist_error", math.nan))
    put(row, "error", error, "the benchmark has no such counter")
    return {**row, "counters": dict(sorted(benchmark.counters.items()))}


def _power_law(name: str, family: Family) -> dict[str, Any]:
    """Adds the exponent of theory's growth between the same sizes."""
    law = fit_power_law(family)
    theory = next((growth for beginning, growth in THEORY.items() if name.startswith(beginning)), None)
    row: dict[str, Any] = {}
    for key in ("exponent", "low", "high", "constant"):
        put(row, key, law[key], law["why_not"])
    row["theory"] = theory
    expected = math.nan
    if theory is None:
        row["theory_reason"] = NO_THEORY
    elif law["cells"]:
        least, most = law["cells"][0], law["cells"][-1]
        expected = math.log(GROWTHS[theory](most) / GROWTHS[theory](least)) / math.log(most / least)
    put(row, "expected", expected, law["why_not"] if theory else NO_THEORY)
    return {**row, "cells": law["cells"]}


def families(timings: Timings) -> dict[str, dict[float, Benchmark]]:
    """The benchmarks whose names have "cells:N" (the rest of the name is the family), by family and cells."""
    members: dict[str, dict[float, Benchmark]] = {}
    for benchmark in timings.benchmarks:
        place = family_and_cells(benchmark.name)
        if place is not None:
            members.setdefault(place[0], {})[place[1]] = benchmark
    return {name: dict(sorted(own.items())) for name, own in members.items()}


def seconds_of(members: dict[float, Benchmark]) -> Family:
    return {cells: [] if benchmark.error else benchmark.real for cells, benchmark in members.items()}


def scaling(timings: Timings) -> list[dict[str, Any]]:
    """The rows of each family, with its growth as measured and by theory."""
    return [{"name": name, "rows": [_row(cells, own[cells], seconds) for cells, seconds in seconds_of(own).items()],
             "power_law": _power_law(name, seconds_of(own))} for name, own in families(timings).items()]
