"""The tables of every page, and the rows of an index of pages."""

import itertools

from markupsafe import Markup, escape

import results
from scene_figures import MOTIONS
from tables import Table
from wording import ANGLES, ENERGIES, LENGTHS, MOMENTS, STRESSES, law, percent, plain, quantity, sci, seconds, typeset

UNITS = {"m": LENGTHS, "Pa": STRESSES, "rad": ANGLES, "N m": MOMENTS, "J": ENERGIES}


def _part(error):
    """A relative error; – where it is not known."""
    return "–" if error is None else "0" if error == 0 else sci(abs(error)) if abs(error) < 1e-3 else percent(abs(error))


def _error(row):
    """How far a number may be off."""
    return _part(row["error"])


def error_with_parts(row):
    return _error(row) + (f" (mesh {_part(row['mesh'])}, steps {_part(row['path'])})" if row["path"] and row["mesh"] is not None else "")


def judged_number(page):
    """The row of the number that the page is judged by."""
    number = page.get("cost", {}).get("number")
    known = [row for row in page["numbers"] if row["error"] is not None]
    return next((row for row in known if row["key"] == number), known[0] if known else None)


def sums(answer):
    """The gap, the seconds and the applications of a solve; of a history the worst gap and the sums."""
    if history := answer.get("history"):
        return history["worst_gap"], history["seconds"], history["operator_applications"]
    return answer["certificate"]["gap"], answer["seconds"]["total"], answer["operator_applications"]


def remembered(page):
    """The headline numbers, each with its name, and the object to which they refer."""
    answer, judged = page["answer"], judged_number(page)
    gap, time, _ = sums(answer)
    shown = [row for row in page["numbers"] if row is judged or (row["key"] == "stick_radius" and row["error"] is not None)]
    tiles = [(_error(row), f"{'error' if row['basis'] == 'exact' else 'estimated error (mesh, steps)'} of the {row['words']}")
             for row in shown]
    if gap is not None:
        tiles.append((sci(gap), f"gap in {law(answer)}, over the energy"))
    tiles.append((f"{seconds(time)}\N{NO-BREAK SPACE}s", "time of the solve"))
    load = Markup(", M/M<sub>lim</sub>&nbsp;=&nbsp;{}").format(plain(answer["moment_ratio"])) if answer.get("moment_ratio") else ""
    return tiles, Markup("{} cells{}").format("×".join(map(str, answer["cells"])), load)


def first_sentence(text):
    """The first sentence of the comment that opens a scene file."""
    lines = itertools.takewhile(lambda line: line.startswith("#"), text.splitlines())
    return " ".join(line[1:].strip() for line in lines).split(". ")[0].rstrip(".")


def index(pages):
    """A row for each page, (folder, page): what it shows, its judged number, its work."""
    body = []
    for folder, page in pages:
        answer, judged = page["answer"], judged_number(page)
        gap, time, applications = sums(answer)
        picture = Markup('<a href="{0}/index.html"><img src="{0}/figures/answer.svg" width="260" loading="lazy" alt="slip and stick, '
                         'tractions, pressure of {1}"></a>').format(folder, page["scene"]["name"])
        checks = page["headline"]["counts"]["checks"]
        verdict, worst = page["headline"]["verdict"], "fails" if "fails" in checks.values() else "open"
        said = Markup("; ").join(Markup("{}: {}").format(what, typeset(line)) for what, line in page["headline"]["lines"]
                                 if checks[what] == worst)
        body.append([Markup('<a href="{}/index.html">{}</a>').format(folder, page["scene"]["name"]), picture,
                     first_sentence(page["scene"]["text"]),
                     "✓ good" if verdict == "good" else Markup("{}: {}").format({"open": "○ open", "bad": "✗ bad"}[verdict], said),
                     *(("–", "–", "–") if judged is None else (judged["words"], with_unit(judged, "value"), error_with_parts(judged))),
                     "–" if gap is None else sci(gap), "–" if "program" in answer else f"{applications:.0f}",  # another program counts its own
                     str(len(answer.get("steps") or [0])), "×".join(map(str, answer["cells"])), seconds(time)])
    return Table(["scene", "the contact", "what it shows", "verdict", "judged by", "value", "error, or its estimate",
                  "gap / energy", "applica&shy;tions", "steps", "cells", "time, s"], body)


def with_unit(row, key):
    if row[key] is None:
        return "–"
    return quantity(row[key], UNITS[row["unit"]], 6) if row["unit"] in UNITS else f"{plain(row[key])} {row['unit']}"


def numbers(page):
    inputs = page.get("uncertainty", {}).get("outputs")
    body = []
    for row in results.rows(page, "numbers"):
        body.append([row["words"], with_unit(row, "value"), with_unit(row, "reference"), _error(row),
                     _part(row["mesh"]), _part(row["path"]), typeset(row["basis"])])
        if inputs is not None:
            relative = inputs.get(row["key"], {}).get("relative")
            body[-1].insert(6, "–" if relative is None else percent(relative))
    head = ["number", "value on the finest mesh", "reference", "error, or how far it may be off", "of which the mesh",
            "of which the length of the steps", "how that is known"]
    if inputs is not None:
        head.insert(6, "what the inputs make of it")
    return Table(head, body)


def digits(page):
    body = [[row["words"], f"{found['digits']:.1f}", f"{found['low']:.1f} to {found['high']:.1f}"]
            for row in results.rows(page, "numbers")
            if (found := results.value(page, "digits.digits").get(row["key"])) and found["digits"] is not None]
    if not body:
        raise results.Unavailable("no number of the page was solved with another rounding")
    return Table(["number", "digits that survive", "95 % interval"], body)


def choices(page):
    body = []
    for row in results.rows(page, "cost.choices"):
        if row["cells"] is None:
            body.append([sci(row["wanted"]), "–", "–", "–", row["cells_reason"]])
            continue
        grids = f", the mean of {row['grids']} grids" if row.get("grids") else ""
        body.append([sci(row["wanted"]), "{} × {}".format(*row["cells"]) + grids, sci(row["tolerance"]),
                     "–" if row.get("seconds") is None else seconds(row["seconds"]), row.get("remark", "")])
    return Table(["error wanted", "cells", "tolerance", "seconds, predicted", "remark"], body)


def program(page):
    """The numbers that the page's program states, and the numbers that follow from its field."""
    answer = page["answer"]
    program, own = answer["program"], answer["program"]["own"]
    body = [["version", program["version"] or "–", ""],
            ["iterations", plain(own["iterations"]) if "iterations" in own else "–", ""],
            ["seconds", seconds(own["seconds"]) if "seconds" in own else "–", f"{seconds(program['wall_seconds'])} with its start"],
            ["twist", quantity(own["twist_angle"], ANGLES, 6) if "twist_angle" in own else "–", quantity(answer["twist_angle"], ANGLES, 6)],
            ["gap over energy", "–", "–" if answer["certificate"]["gap"] is None else sci(answer["certificate"]["gap"])]]
    if own.get("message"):
        body.append(["message", own["message"], ""])
    body += [[judged["quantity"], "", ("✓ " if judged["holds"] else "✗ ") + ("–" if judged["value"] is None else sci(judged["value"]))
              + ("" if judged["allowed"] is None else f" of {sci(judged['allowed'])} allowed")]
             for judged in (page.get("check") or {}).get("judged", [])]
    return Table(["", f"what {escape(program['name'])} says", "what follows from its field"], body)


def programs(page):
    body = []
    for row in results.rows(page, "programs"):
        body.append([row["name"], row["version"] or "–", f"{row['cells']}", row["status"].replace("_", " "),
                     "–" if row["error"] is None else sci(row["error"]), MOTIONS.get(row["number"], (row["number"].replace("_", " "),))[0],
                     "–" if row["seconds"] is None else seconds(row["seconds"]),
                     "–" if row["cpu_seconds"] is None else seconds(row["cpu_seconds"])])
    return Table(["program", "version", "cells", "status", "error", "of the", "s, as it says", "CPU s with its start"], body)
