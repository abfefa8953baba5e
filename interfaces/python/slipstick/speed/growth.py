"""How times grow with the cells along a side, and where one way to compute overtakes another."""
from __future__ import annotations

import math
import re
import statistics
from typing import Any, NamedTuple

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
# The slow one and the quick one of many cells.
RACES = (("application/dense", "application/dcfft"), ("application/direct", "application/dcfft"),
         ("application/direct_2_threads", "application/dcfft_2_threads"), ("setup/dense", "setup/dcfft"))


class LogTime(NamedTuple):
    """The logarithm of a time, its standard error (NaN: one repetition) and the degrees of freedom that this rests on."""
    value: float
    error: float
    freedom: int

    def half(self) -> float:
        """Of the 95 % interval."""
        return self.error * float(stdtrit(self.freedom, UPPER_QUANTILE)) if self.freedom else math.nan


def log_time(seconds: list[float]) -> LogTime | None:
    """The median of repetitions: Student's interval of their logarithms, widened as a median is less certain than a mean (the
    median of many normal deviates has sqrt(pi/2) of their mean's standard error). Repetitions without a positive number are
    ignored; None: no repetition has one."""
    logs = [math.log(time) for time in seconds if is_valid_time(time)]
    if not logs:
        return None
    error = math.sqrt(0.5 * math.pi / len(logs)) * statistics.stdev(logs) if len(logs) > 1 else math.nan
    return LogTime(statistics.median(logs), error, len(logs) - 1)


def typical(seconds: list[float]) -> tuple[float, float, float]:
    """The median of repetitions with its 95 % interval; NaN: fewer than two repetitions."""
    time = log_time(seconds) or LogTime(math.nan, math.nan, 0)
    return math.exp(time.value), math.exp(time.value - time.half()), math.exp(time.value + time.half())


def _log_times(family: Family) -> dict[float, LogTime]:
    """Of the sizes that have a time, smallest first."""
    times = ((cells, log_time(family[cells])) for cells in sorted(family))
    return {cells: time for cells, time in times if time is not None and cells > 0.0}


def fit_power_law(family: Family) -> dict[str, Any]:
    """constant cells^exponent with the exponent's 95 % interval (Student's, from the residuals), by least squares of logarithms
    over the asymptotic part: from an eighth of the largest size up, three doublings, at least three sizes. Below, what each
    call costs whatever its size takes a part of the time. `why_not`: why no law was fitted."""
    law = {**dict.fromkeys(("exponent", "low", "high", "constant"), math.nan), "cells": [], "why_not": ""}
    times = _log_times(family)
    if len(times) < MIN_SIZES:
        return {**law, "why_not": f"{len(times)} sizes have a time, {MIN_SIZES} are needed"}
    least = max(times) / ASYMPTOTIC_SPAN
    cells = [size for size in times if size >= least]
    if len(cells) < MIN_SIZES:
        return {**law, "why_not": f"{len(cells)} sizes from {least:g} cells up, {MIN_SIZES} are needed"}
    (slope, start), covariance = numpy.polyfit(numpy.log(cells), [times[size].value for size in cells], 1, cov=True)
    half = float(stdtrit(len(cells) - 2, UPPER_QUANTILE)) * math.sqrt(covariance[0, 0])
    return {**law, "exponent": float(slope), "low": slope - half, "high": slope + half, "constant": math.exp(start),
            "cells": cells}


def _crossing(log_cells: list[float], log_ratios: list[float]) -> float:
    """Where the logarithm of slow over quick becomes positive for good; infinite outside the sizes."""
    if not log_ratios[-1] > 0.0:
        return math.inf
    i = len(log_ratios) - 1
    while i > 0 and log_ratios[i - 1] > 0.0:
        i -= 1
    if i == 0:
        return -math.inf
    part = -log_ratios[i - 1] / (log_ratios[i] - log_ratios[i - 1])
    return math.exp(log_cells[i - 1] + part * (log_cells[i] - log_cells[i - 1]))


def find_crossover(slow: Family, quick: Family) -> dict[str, Any]:
    """The cells from which on the quick family stays the quicker one, over the sizes that both have; between two of them the
    ratio of times is a power of the cells. `low`, `high`: between the crossings of the ratios' 95 % limits at each size;
    infinite: outside the sizes too, NaN: unknown. `remark`: why something of this is missing."""
    one, other = _log_times(slow), _log_times(quick)
    both = [cells for cells in one if cells in other]
    found = {"cells": math.nan, "low": math.nan, "high": math.nan, "remark": ""}
    if not both:
        return {**found, "remark": "no size has a time in both"}
    log_cells = [math.log(cells) for cells in both]
    ratios = [one[cells].value - other[cells].value for cells in both]
    found["cells"] = _crossing(log_cells, ratios)
    if math.isinf(found["cells"]):
        where = f"not yet at {both[-1]:g}" if found["cells"] > 0.0 else f"already at {both[0]:g}"
        found.update(cells=math.nan, remark=f"not within the measured sizes: {where} cells")
    halves = [LogTime(0.0, math.hypot(one[cells].error, other[cells].error),
                      min(one[cells].freedom, other[cells].freedom)).half() for cells in both]
    if any(map(math.isnan, halves)):
        found["remark"] = found["remark"] or "the uncertainty of one repetition is unknown"
        return found
    found["low"] = _crossing(log_cells, [ratio + half for ratio, half in zip(ratios, halves)])
    found["high"] = _crossing(log_cells, [ratio - half for ratio, half in zip(ratios, halves)])
    return found


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


def crossover_row(found: dict[str, Any]) -> dict[str, Any]:
    row: dict[str, Any] = {}
    put(row, "cells", found["cells"], found["remark"])
    for key in ("low", "high"):
        put(row, key, found[key], found["remark"] if math.isnan(found[key]) else "outside the measured sizes")
    return {**row, "remark": found["remark"]}


def scaling(timings: Timings) -> dict[str, Any]:
    """Results of the benchmarks whose names have "cells:N" (the rest of the name is the family): rows, power laws, measured and
    theoretical growth, and the size from which dcfft is quicker than the other operators."""
    members: dict[str, dict[float, Benchmark]] = {}
    for benchmark in timings.benchmarks:
        place = family_and_cells(benchmark.name)
        if place is not None:
            members.setdefault(place[0], {})[place[1]] = benchmark
    families = {name: {cells: [] if own[cells].error else own[cells].real for cells in sorted(own)}
                for name, own in members.items()}
    rows = [{"name": name, "rows": [_row(cells, members[name][cells], seconds) for cells, seconds in family.items()],
             "power_law": _power_law(name, family)} for name, family in families.items()]
    races = [{"slow": slow, "quick": quick, **crossover_row(find_crossover(families[slow], families[quick]))}
             for slow, quick in RACES if slow in families and quick in families]
    return {"families": rows, "crossovers": races}


def crossovers_text(result: dict[str, Any]) -> str:
    """The crossovers for a person."""
    def shown(value: float | None) -> str:
        return "-" if value is None else f"{value:.3g}"

    return "".join(f"{row['quick']} is quicker than {row['slow']} from {shown(row['cells'])} cells a side on "
                   f"[{shown(row['low'])}, {shown(row['high'])}]{'' if row['cells'] is not None else ': ' + row['remark']}\n"
                   for row in result["crossovers"])


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """The typical seconds of direct sums and of convolution on several meshes, and where these take the same time. The families
    are lists of cells and seconds; null: a solve failed."""
    families = {kind: {cells: [math.nan if one is None else one for one in seconds] for cells, seconds in family}
                for kind, family in request["families"].items()}
    rows = []
    for kind, family in families.items():
        for cells, seconds in family.items():
            time, low, high = typical(seconds)
            row: dict[str, Any] = {"kind": kind, "cells": cells}
            put(row, "seconds", time, "it did not solve")
            put(row, "low", low, "one repetition")
            put(row, "high", high, "one repetition")
            rows.append(row)
    return {"result": {"rows": rows, **crossover_row(find_crossover(families["direct"], families["dcfft"]))}}
