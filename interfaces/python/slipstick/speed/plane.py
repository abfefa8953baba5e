"""The speed-error plane of `slipstick bench`: the design of its solves, and the judgement of their times and errors.

A point of the plane is a choice of method, operator, model, pressure, mesh and tolerance with the seconds of a solve and the
errors that it buys (docs/schema/plane.schema.json).
"""
from __future__ import annotations

import math
from typing import Any, Tuple

from ..errors import InputError

QUANTITIES = {"twist": "twist", "traction_l1": "traction, mean (L1)", "traction_l2": "traction, root mean square (L2)",
              "stick_radius": "stick radius"}
CHOICES = {"method": "solver.method", "operator": "solver.operator", "model": "solver.model", "pressure": "contact.pressure"}
DEFAULT = {"method": "coulomb", "operator": "dcfft", "model": "auto", "pressure": "solved"}
MAIN_RATIO = 0.9  # of moment and limit moment, at which every choice is tried
# Tolerances at which choices other than method and mesh are tried: where the mesh's error is reached for the twist, and the
# program's default.
ONE_AT_A_TIME = (1e-4, 1e-8)
WANTED = (1e-2, 1e-3, 1e-4, 1e-5)  # errors of the rows of the table of times
ITERATION_PART = 0.1  # of the mesh's error that the iteration may change
Point = dict[str, Any]


# ---------------------------------------------------------------- design

def choices(moment_ratio: float, quick: bool) -> list[Point]:
    """The choices tried at one load: mesh and tolerance in all combinations for each method, and around the default each other
    choice on several meshes (at one moment ratio, or the design would take an hour). No choice twice."""
    design: list[Point] = []

    def add(meshes: tuple[int, ...], tolerances: tuple[float, ...], **words: str) -> None:
        for cells in meshes:
            for tolerance in tolerances:
                choice = {**DEFAULT, **words, "cells": cells, "tolerance": tolerance}
                if choice not in design:
                    design.append(choice)

    if quick:
        add((16, 32, 64, 128, 256), (1e-2, 1e-4, 1e-6, 1e-8))
    else:
        add((16, 24, 32, 48, 64, 96, 128, 192), (1e-2, 1e-3, 1e-4, 1e-6, 1e-8))
        add((256,), (1e-3, 1e-4, 1e-6, 1e-8))
        add((512,), (1e-4, 1e-6))
        add((1024,), (1e-6,))
    if moment_ratio != MAIN_RATIO:
        add((32, 64, 128), (1e-3, 1e-4, 1e-5, 1e-6), method="paper")
        return design
    if not quick:
        add((16, 24, 32, 48, 64, 96, 128), (1e-5, 1e-10))
        add((512,), (1e-3, 1e-8))
    if quick:
        add((16, 32, 64, 128), (1e-2, 1e-4, 1e-6), method="paper")
    else:
        add((16, 32, 64, 128), (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8), method="paper")
        add((256,), (1e-3, 1e-4, 1e-5, 1e-6), method="paper")
        add((512,), (1e-4,), method="paper")
    for words in ({"model": "full"}, {"pressure": "hertz"}, {"pressure": "hertz_averaged"}):
        add((32, 64, 128) if quick else (16, 32, 64, 128, 256), ONE_AT_A_TIME, **words)
        if not quick:
            add((512,), (1e-6,), **words)
    # Direct and dense summation cost the fourth power of the cells along a side: beyond these a solve takes seconds, or
    # gigabytes.
    add((16, 32) if quick else (16, 32, 64), ONE_AT_A_TIME, operator="direct", model="full")
    add((16,) if quick else (16, 32), ONE_AT_A_TIME, operator="dense", model="full")
    return design


def design(quick: bool) -> list[dict[str, Any]]:
    """The loads, as parts of the limit moment at which the paper's sphere is solved, with their choices: each with its
    overrides of the scene on one thread, the number of grids, whose edges lie differently in the cells (four, and fewer where
    one takes seconds), its name as a file and for a person."""
    loads = []
    for ratio in (MAIN_RATIO,) if quick else (0.5, MAIN_RATIO, 0.99):
        runs = []
        for choice in choices(ratio, quick):
            cells, tolerance, words = choice["cells"], choice["tolerance"], [choice[key] for key in CHOICES]
            runs.append({
                "choice": choice, "grids": 4 if cells <= 256 else 3 if cells <= 512 else 2,
                "file": f"plane-{ratio}-{'-'.join(words)}-{cells}-{tolerance}",
                "label": f"M/M_lim {ratio}: {' '.join(words)}, {cells} cells, tolerance {tolerance}",
                "overrides": [f"grid.cells=[{cells}, {cells}]", f"solver.tolerance={tolerance}", "solver.threads=1",
                              *(f'{key}="{word}"' for key, word in zip(CHOICES.values(), words)),
                              f"load.moment_ratio={ratio}"]})
        loads.append({"name": f"paper-{ratio}", "moment_ratio": ratio, "runs": runs})
    return loads


# ---------------------------------------------------------------- judgement

Way = Tuple[float, float]  # to an answer: seconds and error; a NaN is worse than any number


def _is_number(way: Way) -> bool:
    return all(map(math.isfinite, way))


def pareto_front(ways: list[Way]) -> list[int]:
    """Indices of the ways that no other way beats, quickest first. A way beats another if it is at least as quick and as good,
    and better in one of the two; of equal ways none beats another."""
    known = list(filter(_is_number, ways))
    front = [i for i, way in enumerate(ways) if _is_number(way) and not any(
        seconds <= way[0] and error <= way[1] and (seconds, error) != way for seconds, error in known)]
    return sorted(front, key=lambda i: ways[i][0])


def quickest_to(ways: list[Way], error: float) -> int | None:
    """The quickest way with at most this error; None if no way is as good."""
    good = [i for i, way in enumerate(ways) if _is_number(way) and way[1] <= error]
    return min(good, key=lambda i: ways[i][0], default=None)


def _ways_to(points: list[Point], quantity: str, method: str) -> list[Way]:
    """The points as ways to one quantity, place by place; not a number where not timed, or of another method."""
    return [(point["seconds"]["median"] if point["seconds"] and method in ("any", point["method"]) else math.nan,
             math.nan if point["error"][quantity] is None else point["error"][quantity]) for point in points]


def _time_to(points: list[Point], quantity: str, method: str, error: float) -> dict[str, Any]:
    ways = _ways_to(points, quantity, method)
    row: dict[str, Any] = {"quantity": quantity, "error": error, "method": method}
    place = quickest_to(ways, error)
    if place is not None:
        return {**row, "point": place, "seconds": ways[place][0]}
    best = min(pareto_front(ways), key=lambda i: ways[i][1], default=None)
    why = "no timed point" if best is None else f"the best is {ways[best][1]:.2g}, on {{0}} x {{0}} cells".format(
        points[best]["cells"])
    return {**row, "seconds": None, "seconds_reason": why, "point": None, "reason": why}


def put_medians(plane: dict[str, Any]) -> None:
    """Replaces repeated times by their median, its 95 % interval and their number."""
    from .growth import typical  # needs SciPy

    for scene in plane["scenes"]:
        for timed in (*scene["points"], scene["exact"]):
            if timed["seconds"] is not None:
                median, low, high = typical(timed["seconds"])
                timed["seconds"] = {"median": median, "low": low, "high": high, "repetitions": len(timed["seconds"])}


def judge(plane: dict[str, Any]) -> None:
    """Puts envelopes and times to errors of the measured points into the result."""
    plane["not_timed"] = []
    for scene in plane["scenes"]:
        points = scene["points"]
        methods = ("any", *sorted({point["method"] for point in points}))
        quantities = [quantity["name"] for quantity in plane["quantities"]]
        scene["envelope"] = {name: pareto_front(_ways_to(points, name, "any")) for name in quantities}
        scene["time_to"] = []
        for name in quantities:
            for error in WANTED:
                scene["time_to"] += [_time_to(points, name, method, error) for method in methods]
                scene["time_to"].append({"quantity": name, "error": error, "method": "exact", "point": None,
                                         "reason": "no grid", "seconds": scene["exact"]["seconds"]["median"]})
        plane["not_timed"] += [
            {"scene": scene["name"], "choice": {key: point[key] for key in (*CHOICES, "tolerance", "cells")},
             "reason": point["not_timed"]} for point in points if "not_timed" in point]


def times_text(plane: dict[str, Any]) -> str:
    """The least times to errors, for a person."""
    def shown(seconds: float | None) -> str:
        return "-" if seconds is None else f"{seconds:.3g} s"

    text = "the least time to an error\n"
    for scene in plane["scenes"]:
        for quantity in plane["quantities"]:
            text += f"  {scene['name']:<12} {quantity['label']:<32}" + "".join(
                f"  {row['error']:.0e} {shown(row['seconds']):>8}" for row in scene["time_to"]
                if (row["quantity"], row["method"]) == (quantity["name"], "any")) + "\n"
        text += f"  {scene['name']:<12} {'exact, no grid':<32}  all   {shown(scene['exact']['seconds']['median']):>8}\n"
    return text


# ---------------------------------------------------------------- data of solve --accuracy

Loads = list[dict[float, Point]]  # the points of one mesh at each load, by tolerance


def _timed_meshes(plane: dict[str, Any]) -> list[Loads]:
    """The default choices on the meshes that were solved at every load, by rising cells along a side."""
    meshes: dict[int, Loads] = {}
    for scene in plane["scenes"]:
        of_load: dict[int, dict[float, Point]] = {}
        for point in scene["points"]:
            if all(point[key] == word for key, word in DEFAULT.items()) and point["seconds"] is not None:
                of_load.setdefault(point["cells"], {})[point["tolerance"]] = point
        for cells, points in of_load.items():
            meshes.setdefault(cells, []).append(points)
    return [meshes[cells] for cells in sorted(meshes) if len(meshes[cells]) == len(plane["scenes"])]


def _loosest_tolerance(loads: Loads, tolerances: list[float], quantity: str, most_change: float) -> float:
    """The loosest tolerance at which, and below, the iteration changes no load's error by more than this: the root mean square
    over the grids."""
    loosest = 0.0
    for tolerance in sorted(tolerances):
        for points in loads:
            tight, loose = points[min(points)]["errors"][quantity], points[tolerance]["errors"][quantity]
            if not math.sqrt(sum((x - y) ** 2 for x, y in zip(loose, tight)) / len(loose)) <= most_change:
                return loosest
        loosest = tolerance
    return loosest


def accuracy_from_plane(plane: dict[str, Any]) -> list[dict[str, Any]]:
    """The meshes by which `solve --accuracy` chooses, of the points with the default choices: on each mesh the largest error
    over the loads, the loosest tolerance that changes no load's error by more than a tenth of it, and the work. Errors fall
    and tolerances tighten from mesh to finer mesh."""
    meshes = []
    for loads in _timed_meshes(plane):
        tolerances = sorted(set(loads[0]).intersection(*loads), reverse=True)  # at which all loads were solved
        if not tolerances:
            continue
        mesh: dict[str, Any] = {"cells_across": loads[0][min(loads[0])]["contact_cells"]}
        for name, quantity in (("twist", "twist"), ("traction", "traction_l2"), ("stick_radius", "stick_radius")):
            error = max(points[min(points)]["error"][quantity] for points in loads)
            mesh[name] = {"error": error,
                          "tolerance": _loosest_tolerance(loads, tolerances, quantity, ITERATION_PART * error)}
        mesh["tolerances"] = tolerances
        mesh["applications"] = [max(points[tolerance]["applications"] for points in loads) for tolerance in tolerances]
        mesh["work"] = [max(points[tolerance]["seconds"]["median"] for points in loads) / plane["application_seconds"]
                        for tolerance in tolerances]
        meshes.append(mesh)
    if len(meshes) < 2:
        raise InputError("the plane holds too few meshes to pick by")
    for name in ("twist", "traction", "stick_radius"):
        for coarse, fine in reversed(list(zip(meshes, meshes[1:]))):
            coarse[name]["error"] = max(coarse[name]["error"], fine[name]["error"])
        for coarse, fine in zip(meshes, meshes[1:]):
            fine[name]["tolerance"] = min(coarse[name]["tolerance"], fine[name]["tolerance"])
    return meshes


def accuracy_toml(meshes: list[dict[str, Any]], origin: str) -> str:
    """The text of a file like convergence/solve/accuracy.toml; `origin` becomes a comment on machine and date."""
    text = f"""\
# Errors of smooth contacts in torsion and work of their solves, by which `slipstick solve --accuracy` chooses a mesh.
# {origin}
# cells_across: the contact's diameter over a cell's side. error: relative, the largest over the loads and over
# finer meshes. tolerance: the loosest that changes it by at most a tenth. applications, work: at each of the
# tolerances, the most over the loads. Unit of work: the seconds of one application on 64 x 64 cells.
version = 1
"""
    for mesh in meshes:
        text += f"\n[[mesh]]\ncells_across = {mesh['cells_across']:.5g}\n"
        for name in ("twist", "traction", "stick_radius"):
            text += f"{name} = {{ error = {mesh[name]['error']:.3g}, tolerance = {mesh[name]['tolerance']:g} }}\n"
        for name in ("tolerances", "applications", "work"):
            text += f"{name} = [{', '.join(f'{value:.4g}' for value in mesh[name])}]\n"
    return text


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """The design, or the judgement of its measured points, or data for `solve --accuracy` of a judged plane."""
    if request["what"] == "design":
        return {"result": {"loads": design(request["quick"]), "quantities": [
            {"name": name, "label": label} for name, label in QUANTITIES.items()]}}
    plane = request["plane"]
    if request["what"] == "accuracy":
        return {"text": accuracy_toml(accuracy_from_plane(plane), request["origin"])}
    put_medians(plane)
    judge(plane)
    return {"result": plane, "text": times_text(plane)}
