#!/usr/bin/env python3
"""board.py BUILD DOCS [--publish]: one page and one JSON of all programs that `make peers` ran, BUILD/board.md and BUILD/board.json, from
BUILD/loops.json (simulators by cases), BUILD/on_meshes.json, BUILD/fields.json (fields by scenes), BUILD/stresses.json and
BUILD/peers.txt (what was left out). An earlier BUILD/board.json, or else DOCS/board.json, shows what changed. With --publish the page and the JSON go to DOCS, and the
table of the guide is written anew."""

import argparse
import json
import math
import re
import time
from pathlib import Path

GREEN, AMBER = 0.01, 0.05  # relative errors of fields, as in the cases
SHORT = {"green": "G", "amber": "A", "red": "R", "none": "–"}
MARKS = re.compile(r"(?<=<!-- board.py writes this table -->\n\n).*?(?=\n<!-- end of the table -->)", re.S)
HEAD = """# The board: programs and friction

The programs of `make peers` measured this page on {measured} ({machine}): simulators by the cases of
[Test your simulator](guides/test-your-simulator.md#the-cases), and contact solvers and finite-element programs by scenes.
[board.json](board.json) has every number, verdict, named cause and explanation. G: green, A: amber, R: red, –: no answer, for the
reason below. {changes}

"""


def read(file):
    return json.loads(file.read_text()) if file.exists() else {}


def color(error):
    return "green" if error <= GREEN else "amber" if error <= AMBER else "red"  # NaN is red


def of_pages(pages):
    """A row for each program and scene: the answer on the finest mesh. Its error is that of the mesh if slipstick's is as large there."""
    for page in pages:
        own = {each["cells"]: each for each in page["programs"] if each["name"] == "slipstick"}
        for name in dict.fromkeys(each["name"] for each in page["programs"]):
            last = [each for each in page["programs"] if each["name"] == name][-1]
            row = {"kind": "field", "on": page["scene"]["name"], "program": name, "version": last["version"].split(" ")[-1],
                   "variant": f"{last['cells']} cells", "cpu_seconds": last["cpu_seconds"], "measure": last["number"],
                   "number": last["error"], "cause": None, "why": last["message"].split(": ", 1)[-1], "shown": ""}
            if last["error"] is None:
                yield {**row, "verdict": "none" if last["status"] == "refused" else "red", "cause": last["status"]}
                continue
            same = own[last["cells"]]
            is_mesh = same["number"] == last["number"] and abs(last["error"] / same["error"] - 1) < 0.01
            found = color(last["error"])
            cause, why = (None, "") if found == "green" else ("mesh", "slipstick's own error on this mesh is as large") if is_mesh else (
                "unknown", "slipstick's own error on this mesh is another one")
            yield {**row, "verdict": found, "shown": f"{100 * last['error']:.2g} %", "cause": cause, "why": why}


def of_meshes(board):
    for each in board:
        both = [one for one in board if (one["program"], one["faces"]) == (each["program"], each["faces"]) and one["cpu_seconds"]]
        check, error = each["check"], next((one["value"] for one in each["check"]["judged"] if one["quantity"] == "tractions"), None)
        yield {"kind": "mesh", "on": f"paper, {each['moment_ratio']}", "program": each["program"].split(" ")[0],
               "version": each["program"].split(" ", 1)[-1], "variant": f"{each['faces']} faces",
               "cpu_seconds": each["cpu_seconds"] and each["cpu_seconds"] / len(both),
               "verdict": {"good": "green", "bad": "red"}.get(check["verdict"], "none"), "measure": "tractions", "number": error,
               "shown": "" if error is None else f"{100 * abs(error):.2g} %", "cause": check.get("cause"), "why": check["why"]}


def of_stresses(board):
    """The error of the worst component, over the largest von Mises stress. The mesh is its cause if slipstick's error is as large."""
    for each in board:
        error = max(each["errors"].values(), key=lambda value: value if value == value else math.inf)
        own = next(one for one in board if one["program"] == "slipstick" and all(one[key] == each[key] for key in ("cells", "moment_ratio")))
        found, is_mesh = color(error), abs(error / max(own["errors"].values()) - 1) < 0.05
        yield {"kind": "stress", "on": f"paper, {each['moment_ratio']}", "program": each["program"], "version": each["version"],
               "variant": f"{each['cells']} cells", "cpu_seconds": each["cpu_seconds"], "verdict": found, "measure": "stresses",
               "number": error, "shown": f"{100 * error:.2g} %", "cause": None if found == "green" else "mesh" if is_mesh else "unknown",
               "why": each["why"]}


def key(row):
    return row["kind"], row["on"], row["program"], row["variant"]


def changes(rows, before):
    """Verdicts that differ from those of an earlier run."""
    old = {key(row): row["verdict"] for row in before.get("rows", [])}
    found = [{"kind": row["kind"], "on": row["on"], "program": row["program"], "variant": row["variant"], "before": old[key(row)],
              "now": row["verdict"]} for row in rows if old.get(key(row), row["verdict"]) != row["verdict"]]
    return {"since": before.get("measured"), "new": sum(key(row) not in old for row in rows) if old else 0, "verdicts": found}


def grid(rows, numbers=True):
    """Programs by cases or scenes."""
    places = list(dict.fromkeys(row["on"] for row in rows))
    lines = ["| program | " + " | ".join(f"`{place}`" for place in places) + " | CPU s |", "|---" * (len(places) + 2) + "|"]
    for name in dict.fromkeys((row["program"], row["variant"]) for row in rows):
        mine = {row["on"]: row for row in rows if (row["program"], row["variant"]) == name}
        version = next((row["version"] for row in mine.values() if row["version"]), "")
        cells = [f"{SHORT[row['verdict']]} {row['shown'] if numbers else row['cause'] or ''}".strip() if row else "–"
                 for row in map(mine.get, places)]
        known = [row["cpu_seconds"] for row in mine.values() if row["cpu_seconds"] is not None]
        spent = f"{math.fsum(known):.2g}" if known else "–"
        lines.append(f"| {f'{name[0]} {version}'.strip()}, {name[1]} | " + " | ".join(cells) + f" | {spent} |")
    return "\n".join(lines) + "\n"


def page(result):
    kinds = {kind: [row for row in result["rows"] if row["kind"] == kind] for kind in ("case", "field", "mesh", "stress")}
    changed = result["changes"]
    said = "There is no earlier run." if not changed["since"] else (
        f"Since {changed['since']}, {len(changed['verdicts'])} verdicts changed and {changed['new']} rows are new.")
    text = HEAD.format(**{**result, "changes": said})
    missed = max((row["missed"] for row in kinds["case"]), default=0.0)
    for kind, title, about in (
            ("case", "Simulators by cases", "With the number that decides; the same table with causes is in the "
             "[guide](guides/test-your-simulator.md#programs-by-cases). LAMMPS and Yade impose motions; where a case imposes loads, a "
             f"servo does, and misses them by at most {missed:.0e} of their limits."),
            ("field", "Contact solvers by scenes", f"The error of the twist (of the approach, for programs that find only pressure) on the "
             f"finest mesh; green up to {100 * GREEN:g} %, amber up to {100 * AMBER:g} %."),
            ("mesh", "Finite-element programs on meshes of their own", "The error of the tractions at two moments over the limit; `check` "
             "gives the verdict."),
            ("stress", "Stresses below the surface", "The largest error of a component over the largest von Mises stress, at depths of 0.05 "
             f"to 2 contact radii and two moments over the limit; green up to {100 * GREEN:g} %, amber up to {100 * AMBER:g} %.")):
        if kinds[kind]:
            text += f"## {title}\n\n{about}\n\n{grid(kinds[kind])}\n"
    text += "## Not green, and why\n\n| program | case or scene | verdict | cause | explanation |\n|---|---|---|---|---|\n"
    for row in result["rows"]:
        if row["verdict"] != "green":
            why = row["why"].removeprefix(f"{row['on']}: ").replace("|", "/").split(" (the moment is")[0]
            text += (f"| {row['program']}, {row['variant'].split(':')[0]} | `{row['on']}` | {row['verdict']} | {row['cause'] or ''} | "
                     f"{why} |\n")
    if changed["verdicts"]:
        text += "\n## Changed verdicts\n\n" + "".join(
            f"- {each['program']}, {each['variant']}, `{each['on']}`: {each['now']}, before {each['before']}.\n"
            for each in changed["verdicts"])
    if result["left_out"]:
        text += "\n## Left out\n\n" + "".join(f"- {line}\n" for line in result["left_out"])
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path)
    parser.add_argument("docs", type=Path)
    parser.add_argument("--publish", action="store_true")
    words = parser.parse_args()
    loops, meshes, fields, stresses = (read(words.build / f"{name}.json") for name in ("loops", "on_meshes", "fields", "stresses"))
    rows = [*loops.get("rows", []), *of_pages(fields.get("pages", [])), *of_meshes(meshes.get("board", [])),
            *of_stresses(stresses.get("board", []))]
    lines = (words.build / "peers.txt").read_text().splitlines()
    result = {"measured": time.strftime("%Y-%m-%d"), "machine": next((line.split(": ")[-1] for line in lines if "model name" in line), ""),
              "left_out": [line.removeprefix("LEFT OUT: ") for line in lines if line.startswith("LEFT OUT: ")],
              "changes": changes(rows, read(words.build / "board.json") or read(words.docs / "board.json")), "rows": rows}
    text = page(result)
    for folder in [words.build, *([words.docs] if words.publish else [])]:
        (folder / "board.json").write_text(json.dumps(result, indent=0, ensure_ascii=False) + "\n")
        (folder / "board.md").write_text(text)
    if words.publish:
        guide = words.docs / "guides/test-your-simulator.md"
        table = grid([row for row in rows if row["kind"] == "case"], numbers=False)
        guide.write_text(MARKS.sub(lambda _: table, guide.read_text()))


if __name__ == "__main__":
    main()
