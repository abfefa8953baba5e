#!/usr/bin/env python3
"""Draws the page of each scene that `slipstick report SCENE...` computed, and an index where there are several."""

import argparse
import sys
from pathlib import Path

import script

script.require("numpy", "matplotlib", "jinja2", "h5py")

import jinja2  # noqa: E402

import render  # noqa: E402
import results  # noqa: E402
import scene_figures  # noqa: E402
from method_figures import METHODS  # noqa: E402
from scene_figures import MOTIONS  # noqa: E402
from tables import Table  # noqa: E402
from whole_file import write_whole  # noqa: E402
from wording import (ANGLES, ENERGIES, LENGTHS, MOMENTS, STRESSES, percent, plain, quantity, sci, seconds,  # noqa: E402
                     typeset)  # noqa: E402


UNITS = {"m": LENGTHS, "Pa": STRESSES, "rad": ANGLES, "N m": MOMENTS, "J": ENERGIES}


def with_unit(row, key):
    if row[key] is None:
        return "–"
    return quantity(row[key], UNITS[row["unit"]], 6) if row["unit"] in UNITS else f"{plain(row[key])} {row['unit']}"


def numbers_table(page):
    inputs = page.get("uncertainty", {}).get("outputs")
    body = []
    for row in results.rows(page, "numbers"):
        known = "–" if row["error"] is None else sci(abs(row["error"])) if abs(row["error"]) < 1e-3 else percent(abs(row["error"]))
        body.append([row["words"], with_unit(row, "value"), with_unit(row, "reference"), known, typeset(row["basis"])])
        if inputs is not None:
            relative = inputs.get(row["key"], {}).get("relative")
            body[-1].insert(4, "–" if relative is None else percent(relative))
    head = ["number", "value on the finest mesh", "reference", "what the mesh leaves open", "how that is known"]
    if inputs is not None:
        head.insert(4, "what the inputs make of it")
    return Table(head, body)


def digits_table(page):
    body = [[row["words"], f"{found['digits']:.1f}", f"{found['low']:.1f} to {found['high']:.1f}"]
            for row in results.rows(page, "numbers")
            if (found := results.value(page, "digits.digits").get(row["key"])) and found["digits"] is not None]
    if not body:
        raise results.Unavailable("no number of the page was solved with another rounding")
    return Table(["number", "digits that survive", "95 % interval"], body)


def choices_table(page):
    body = []
    for row in results.rows(page, "cost.choices"):
        if row["cells"] is None:
            body.append([sci(row["wanted"]), "–", "–", "–", row["cells_reason"]])
            continue
        grids = f", the mean of {row['grids']} grids" if row.get("grids") else ""
        body.append([sci(row["wanted"]), "{} × {}".format(*row["cells"]) + grids, sci(row["tolerance"]),
                     "–" if row.get("seconds") is None else seconds(row["seconds"]), ""])
    return Table(["error wanted", "cells", "tolerance", "seconds, predicted", "remark"], body)


def program_table(page):
    """What the page's program says of its answer, beside what follows from its field."""
    answer = page["answer"]
    program, own = answer["program"], answer["program"]["own"]
    body = [["version", program["version"] or "–", ""],
            ["iterations", plain(own["iterations"]) if "iterations" in own else "–", ""],
            ["seconds", seconds(own["seconds"]) if "seconds" in own else "–", f"{seconds(program['wall_seconds'])} with its start"],
            ["twist", quantity(own["twist"], ANGLES, 6) if "twist" in own else "–", quantity(answer["twist_angle"], ANGLES, 6)],
            ["gap over energy", "–", "–" if answer["certificate"]["gap"] is None else sci(answer["certificate"]["gap"])]]
    if own.get("message"):
        body.append(["message", own["message"], ""])
    body += [[judged["quantity"], "", ("✓ " if judged["holds"] else "✗ ") + ("–" if judged["value"] is None else sci(judged["value"]))
              + ("" if judged["allowed"] is None else f" of {sci(judged['allowed'])} allowed")]
             for judged in (page.get("check") or {}).get("judged", [])]
    return Table(["", f"what {program['name']} says", "what follows from its field"], body)


def programs_table(page):
    body = []
    for row in results.rows(page, "programs"):
        body.append([row["name"], row["version"] or "–", f"{row['cells']}", row["status"].replace("_", " "),
                     "–" if row["error"] is None else sci(row["error"]), MOTIONS.get(row["number"], (row["number"].replace("_", " "),))[0],
                     "–" if row["seconds"] is None else seconds(row["seconds"]),
                     "–" if row["cpu_seconds"] is None else seconds(row["cpu_seconds"])])
    return Table(["program", "version", "cells", "status", "error", "of the", "s, as it says", "CPU s with its start"], body)


def tabulate(make, page):
    try:
        return {"table": make(page)}
    except results.Unavailable as reason:
        return {"unavailable": str(reason)}


def draw_all(page, data, folder):
    """The page's figures by name; those that the scene has nothing for are missing."""
    wanted = [("bodies", "The bodies", scene_figures.bodies), ("answer", "The answer", scene_figures.answer)]
    if len(page["answer"].get("steps") or []) > 1:
        wanted.append(("loop", "The history", scene_figures.loop))
    if "cost" in page:
        wanted.append(("cost", "Error against time", scene_figures.cost))
    if "programs" in page:
        wanted.append(("programs", "Other programs", scene_figures.programs))
    if "operators" in page:
        wanted.append(("operators", "Direct summation against convolution", scene_figures.operators))
    return {name: render.draw_entry(name, title, lambda: make(page, data), folder) for name, title, make in wanted}


def write_page(output, environment):
    """Writes output/index.html from output/data/, and returns what an index says of it."""
    data = output / "data"
    page = results.load(data / "report.json")
    folder = output / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    hard = render.map_hard_cases(page) if "hard" in page else None
    if "methods" in (hard or {}) and "program" not in page["answer"]:  # its one column is the scene's own
        method = page["answer"]["method"]
        hard["methods"] = [(hard["methods"][0][0], METHODS.get(method, (method,))[0])]
    html = environment.get_template("scene.html.j2").render(
        page=page, headline=page["headline"], figures=draw_all(page, data, folder),
        numbers_table=tabulate(numbers_table, page), choices=tabulate(choices_table, page) if "cost" in page else None,
        studies=render.show_studies(page, folder), digits=tabulate(digits_table, page) if "digits" in page else None, hard=hard,
        programs=tabulate(programs_table, page) if "programs" in page else None,
        program=tabulate(program_table, page) if "program" in page["answer"] else None,
        nulls=results.nulls({key: page[key] for key in ("answer",)}), data="data")
    write_whole(output / "index.html", html.encode())
    return page


def render_all(output, folders):
    environment = render.environment()
    pages = [(folder, write_page(folder, environment)) for folder in folders]
    if len(pages) > 1:
        html = environment.get_template("scenes.html.j2").render(
            pages=[(folder.relative_to(output), page) for folder, page in pages], plain=plain)
        write_whole(output / "index.html", html.encode())


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", type=Path, nargs="+", help="folders with data/report.json and data/answer.h5")
    parser.add_argument("--output", type=Path, required=True, help="folder of the index of several pages")
    arguments = parser.parse_args(words)
    return script.run(lambda: render_all(arguments.output.resolve(), [each.resolve() for each in arguments.folders]),
                      (results.InputError, results.Unavailable), arguments.output)


if __name__ == "__main__":
    sys.exit(main())
