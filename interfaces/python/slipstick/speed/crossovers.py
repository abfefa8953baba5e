"""The cells along a side from which on one way to compute overtakes another."""
from __future__ import annotations

import math
from typing import Any

from .growth import Family, log_time, put, quantile, typical

# The slow one and the quick one of many cells.
RACES = (("application/dense", "application/dcfft"), ("application/direct", "application/dcfft"),
         ("application/direct_2_threads", "application/dcfft_2_threads"), ("setup/dense", "setup/dcfft"))
OUTSIDE = "outside the measured sizes"


def _crossing(log_cells: list[float], log_ratios: list[float]) -> float:
    """Where the logarithm of slow over quick becomes positive for good; infinite outside the sizes."""
    last = max((i for i, ratio in enumerate(log_ratios) if not ratio > 0.0), default=-1)  # at which the quick one is not quicker
    if last == len(log_ratios) - 1:
        return math.inf
    if last < 0:
        return -math.inf
    before, after = log_ratios[last], log_ratios[last + 1]
    return math.exp(log_cells[last] + before / (before - after) * (log_cells[last + 1] - log_cells[last]))


def find_crossover(slow: Family, quick: Family) -> dict[str, Any]:
    """`cells` from which on the quick family stays the quicker one, over the sizes that both have, and its 95 % interval; between
    two sizes the ratio of times is a power of the cells. The interval is that between the crossings of the ratios' 95 % limits
    at each size. NaN: unknown, or none within the sizes; infinite: an end outside the sizes. `remark`: why something of this is
    missing, else empty."""
    log_cells, ratios, halves = [], [], []
    for cells in sorted(slow):
        one, other = log_time(slow[cells]), log_time(quick.get(cells, []))
        if cells > 0.0 and one and other:
            log_cells.append(math.log(cells))
            ratios.append(one[0] - other[0])
            halves.append(quantile(min(one[2], other[2])) * math.hypot(one[1], other[1]))
    found = {"cells": math.nan, "low": math.nan, "high": math.nan, "remark": "no size has a time in both"}
    if not ratios:
        return found
    found.update(cells=_crossing(log_cells, ratios), remark="")
    if math.isinf(found["cells"]):
        later = found["cells"] > 0.0
        found.update(cells=math.nan, remark=f"not within the measured sizes: {'not yet' if later else 'already'} at "
                     f"{math.exp(log_cells[-1 if later else 0]):g} cells")
    if any(map(math.isnan, halves)):
        found["remark"] = found["remark"] or "the uncertainty of one repetition is unknown"
        return found
    found["low"] = _crossing(log_cells, [ratio + half for ratio, half in zip(ratios, halves)])
    found["high"] = _crossing(log_cells, [ratio - half for ratio, half in zip(ratios, halves)])
    return found


def crossovers(families: dict[str, Family]) -> list[dict[str, Any]]:
    """The sizes from which dcfft is quicker than the other operators."""
    rows = []
    for slow, quick in RACES:
        if slow in families and quick in families:
            found = find_crossover(families[slow], families[quick])
            row: dict[str, Any] = {"slow": slow, "quick": quick}
            put(row, "cells", found["cells"], found["remark"])
            for key in ("low", "high"):
                put(row, key, found[key], found["remark"] if math.isnan(found[key]) else OUTSIDE)
            rows.append({**row, "remark": found["remark"]})
    return rows


def crossovers_text(rows: list[dict[str, Any]]) -> str:
    """The crossovers for a person."""
    def shown(value: float | None) -> str:
        return "-" if value is None else f"{value:.3g}"

    return "".join(f"{row['quick']} is quicker than {row['slow']} from {shown(row['cells'])} cells a side on "
                   f"[{shown(row['low'])}, {shown(row['high'])}]{'' if row['cells'] else ': ' + row['remark']}\n" for row in rows)


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """Whole solves of a scene by each operator, and where the quick one overtakes the slow one. families: of each operator the
    pairs of cells and seconds; null: a solve has no time."""
    families = {kind: {cells: [math.nan if one is None else one for one in seconds] for cells, seconds in family}
                for kind, family in request["families"].items()}
    rows = []
    for kind, family in families.items():
        for cells, seconds in family.items():
            row: dict[str, Any] = {"operator": kind, "cells": cells}
            for key, value, none in zip(("seconds", "low", "high"), typical(seconds),
                                        ("it did not solve", "one repetition", "one repetition")):
                put(row, key, value, none)
            rows.append(row)
    found = find_crossover(families[request["slow"]], families[request["quick"]])
    result: dict[str, Any] = {"rows": rows, "remark": found["remark"]}
    for key in ("cells", "low", "high"):
        put(result, key, found[key], found["remark"] or OUTSIDE)
    return {"result": result}
