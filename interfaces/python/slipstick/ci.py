"""Runs of `slipstick gate` for a CI: a history over commits with a figure, a badge, and files for two trackers of benchmarks."""
from __future__ import annotations

import io
import json
import math
import os
import statistics
import subprocess
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from .errors import InputError
from .speed import timings

COMMIT_VARIABLES = ("GITHUB_SHA", "CI_COMMIT_SHA")  # GitHub, GitLab
KEPT = ("id", "quantity", "value", "below", "above", "equals", "factor", "outcome")
WRONG = ("failed", "passed unexpectedly")
MOST_PANELS = 24


def _git(*words: str) -> str:
    try:
        return subprocess.run(("git", *words), capture_output=True, text=True, check=True, timeout=60).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return ""


def _commit() -> dict[str, Any]:
    """The commit of the working folder, as git has it, else as the CI server says."""
    commit = _git("rev-parse", "HEAD")
    if commit:
        return {"commit": commit, "modified": bool(_git("status", "--porcelain", "--untracked-files=no"))}
    for variable in COMMIT_VARIABLES:
        if os.environ.get(variable):
            return {"commit": os.environ[variable], "modified": False}
    return {"commit": None, "commit_reason": f"no git repository here, and none of {', '.join(COMMIT_VARIABLES)} is set"}


def _times(file: str) -> list[dict[str, Any]]:
    """The benchmarks of a file with times: medians and extremes."""
    read = timings.parse(Path(file).read_text(encoding="utf-8", errors="replace"), file)
    return [{"name": each.name, "seconds": statistics.median(each.real), "least": min(each.real), "most": max(each.real),
             "repetitions": len(each.real)} for each in read.benchmarks if each.has_times()]


def run_of(result: dict[str, Any], times: str) -> dict[str, Any]:
    """A run as a line of a history has it. result: of `gate --json`. times: file of benchmarks; empty: none."""
    gates = [{key: row[key] for key in KEPT if row.get(key) is not None} for row in result["gates"]]
    return {**_commit(), "date": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"), "exit_code": result["exit_code"],
            "gates": gates, "times": _times(times) if times else []}


def read_history(file: str) -> list[dict[str, Any]]:
    """The runs of a history in their order; none where there is no such file."""
    path = Path(file)
    runs = []
    for i, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines() if path.exists() else (), 1):
        try:
            run = json.loads(line)
        except ValueError:
            run = None
        if not (isinstance(run, dict) and isinstance(run.get("gates"), list) and isinstance(run.get("times"), list)):
            raise InputError(f"{file}:{i}: is no run; allowed: what gate --history writes, a JSON object a line")
        runs.append(run)
    return runs


def badge(run: dict[str, Any]) -> dict[str, Any]:
    """For the endpoint of shields.io."""
    outcomes = [gate["outcome"] for gate in run["gates"]]
    wrong, refused = sum(each in WRONG for each in outcomes), outcomes.count("refused")
    message = f"{len(outcomes)} gates"
    if wrong or refused:
        message = f"{wrong or refused} of {message} {'failed' if wrong else 'not judged'}"
    return {"schemaVersion": 1, "label": "slipstick", "message": message,
            "color": "red" if wrong else "yellow" if refused or not outcomes else "brightgreen"}


def benchmark_action(run: dict[str, Any]) -> list[dict[str, Any]]:
    """customSmallerIsBetter of github-action-benchmark: of each gate how far its number is from the middle of its bound, where 1
    is at the bound; and times."""
    rows = [{"name": gate["id"], "unit": "times the bound", "value": gate["factor"], "extra": f"{gate['quantity']} = {gate['value']}"}
            for gate in run["gates"] if "factor" in gate and "equals" not in gate]
    return rows + [{"name": each["name"], "unit": "s", "value": each["seconds"], "range": f"{each['least']:.3g} to {each['most']:.3g}"}
                   for each in run["times"]]


def bencher(run: dict[str, Any]) -> dict[str, Any]:
    """Bencher Metric Format: the numbers of gates and their distances from the bounds; times as its latency, in nanoseconds."""
    metrics: dict[str, Any] = {gate["id"]: {"value": {"value": gate["value"]}, "times-the-bound": {"value": gate["factor"]}}
                               for gate in run["gates"] if "factor" in gate and "equals" not in gate}
    for each in run["times"]:
        metrics[each["name"]] = {"latency": {"value": 1e9 * each["seconds"], "lower_value": 1e9 * each["least"],
                                             "upper_value": 1e9 * each["most"]}}
    return metrics


def _series(runs: list[dict[str, Any]]) -> list[tuple[str, list[float], dict[str, list[float]], list[bool]]]:
    """Title, values, bounds and failures of each panel over the runs; the gate nearest to its bound first, times last. A bound
    without `above` is one of the size."""
    def over_runs(of_run: list[dict[str, Any]], key: str) -> list[float]:
        return [float(row[key]) if isinstance(row.get(key), (int, float)) else math.nan for row in of_run]

    found = []
    known = {gate["id"]: gate for gate in runs[-1]["gates"] if isinstance(gate.get("value"), (int, float)) and "equals" not in gate}
    for name in sorted(known, key=lambda name: -known[name].get("factor", math.inf)):
        rows = [next((gate for gate in run["gates"] if gate["id"] == name), {}) for run in runs]
        values, below, above = (over_runs(rows, key) for key in ("value", "below", "above"))
        if all(map(math.isnan, above)):
            values = [abs(value) for value in values]
        failed = [row.get("outcome") in WRONG for row in rows]
        found.append((f"{name}\n{known[name]['quantity']}", values, {"below": below, "above": above}, failed))
    for name in (each["name"] for each in runs[-1]["times"]):
        rows = [next((each for each in run["times"] if each["name"] == name), {}) for run in runs]
        found.append((f"{name}\nseconds", over_runs(rows, "seconds"), {}, [False] * len(runs)))
    return found


def figure(runs: list[dict[str, Any]]) -> str:
    """The values over the runs with their bounds, as SVG."""
    import matplotlib
    matplotlib.use("svg")
    from matplotlib.figure import Figure

    matplotlib.rcParams.update({"svg.hashsalt": "slipstick", "font.size": 8})
    all_panels = _series(runs)
    panels = all_panels[:MOST_PANELS]
    columns = max(1, min(3, len(panels)))
    rows = max(1, math.ceil(len(panels) / columns))
    drawing = Figure(figsize=(3.6 * columns, 2.3 * rows + 0.4), layout="constrained")
    axes = drawing.subplots(rows, columns, squeeze=False).ravel()
    places = list(range(len(runs)))
    step = max(1, math.ceil(len(runs) / 6))
    for axis, (title, values, bounds, failed) in zip(axes, panels):
        axis.plot(places, values, ".-", color="#0072b2", linewidth=1)
        axis.plot([x for x in places if failed[x]], [values[x] for x in places if failed[x]], "o", color="#d55e00", label="failed")
        for numbers in bounds.values():
            axis.plot(places, numbers, "--", color="#666666", linewidth=1)
        axis.set_title(title.replace("$", r"\$"), loc="left", fontsize=8)
        axis.set_xticks(places[::step], [(runs[x].get("commit") or "?")[:7] for x in places[::step]], rotation=30, ha="right")
        axis.grid(alpha=0.3)
    for axis in axes[len(panels):]:
        axis.remove()
    note = f"; {len(all_panels) - len(panels)} further from their bounds are left out" if len(all_panels) > len(panels) else ""
    drawing.suptitle(f"{len(runs)} runs, to {runs[-1]['date'][:10]}; dashed: bounds{note}", x=0.01, ha="left")
    text = io.StringIO()
    drawing.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def answer(request: dict[str, Any]) -> dict[str, Any]:
    """The texts of the files of gate's options. request: files, by option; times; result, of gate."""
    files, run = request["files"], run_of(request["result"], request["times"])
    texts = {}
    if "--history" in files:
        runs = [*read_history(files["--history"]), run]
        texts["--history"] = json.dumps(run, allow_nan=False) + "\n"
        if "--figure" in files:
            texts["--figure"] = figure(runs)
    for option, export in (("--badge", badge), ("--bencher", bencher), ("--benchmark-action", benchmark_action)):
        if option in files:
            texts[option] = json.dumps(export(run), allow_nan=False, indent=2) + "\n"
    return {"result": {}, "texts": texts}
