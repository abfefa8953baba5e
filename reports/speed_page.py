#!/usr/bin/env python3
"""Draws the figures and writes the page of times and errors that `slipstick bench` measured."""

import argparse
import sys
from pathlib import Path

import script

script.require("numpy", "matplotlib", "jinja2")

import plane_figure  # noqa: E402
import results  # noqa: E402
import scaling_figure  # noqa: E402
import speed_tables  # noqa: E402
from render import draw_entry, environment, tabulate  # noqa: E402
from whole_file import write_whole  # noqa: E402
from wording import plain  # noqa: E402

NAME = "figure-{}"


def draw_all(scaling, plane, folder):
    """Every figure of the page, drawn or with the reason why not."""
    drawings = [(title, lambda draw=draw: draw(scaling)) for title, draw in scaling_figure.FIGURES if scaling]
    for scene in results.rows(plane, "scenes"):
        title = f"Speed against error at M/M_lim = {plain(results.number(scene, 'moment_ratio'))}"
        drawings.append((title, lambda scene=scene: plane_figure.draw(scene)))
    return [draw_entry(NAME.format(k), title, draw, folder) for k, (title, draw) in enumerate(drawings, 1)]


def render(data, output):
    """Writes output/index.html and output/figures/ from data/plane.json and, if it is there, data/scaling.json."""
    plane = results.load(data / "plane.json")
    scaling = results.load(data / "scaling.json") if (data / "scaling.json").exists() else None
    folder = output / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    page = environment().get_template("speed.html.j2").render(
        figures=draw_all(scaling, plane, folder),
        times=tabulate(speed_tables.times_to_errors, plane),
        laws=scaling and tabulate(speed_tables.laws, scaling),
        crossovers=scaling and tabulate(speed_tables.crossovers, scaling),
        not_timed=plane.get("not_timed", []),
        provenance=plane.get("provenance", {}))
    write_whole(output / "index.html", page.encode())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path, help="folder with scaling.json and plane.json")
    parser.add_argument("--output", type=Path, required=True, help="folder for index.html and figures/")
    arguments = parser.parse_args()
    return script.run(lambda: render(arguments.data.resolve(), arguments.output.resolve()), results.InputError,
                      arguments.output)


if __name__ == "__main__":
    sys.exit(main())
