#!/usr/bin/env python3
"""Draws what `slipstick solve` computed: slip and stick, tractions, pressure, and of a history its loop, in one figure."""

import argparse
import sys
import textwrap
from pathlib import Path

import script

script.require("numpy", "matplotlib")

import numpy as np  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402
from matplotlib.colors import Normalize  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

import style  # noqa: E402
from cells import Cells  # noqa: E402
from results import InputError, Unavailable, load, number, reason, text, value  # noqa: E402
from wording import ANGLES, FORCES, LENGTHS, MOMENTS, STRESSES, law, percent, plain, quantity, sci, unit_for  # noqa: E402

WIDE = 1.7  # width over height of the contact, from which on its panels stand one above the other
SIDES = (0.35, 6.0)  # least and largest width over height of a panel; white space makes up for the rest
LONGEST_ARROW = 0.055  # of the longer side of the contact's bounding rectangle
MIN_ARROW = 0.05  # shorter vectors, of the longest, get no arrow
MAX_SEGMENTS = 2000  # an outline of more becomes a fine image, so that files stay small
ROUNDING = 1e-9  # loads and motions below this part of their scale are rounding errors
MOST_MARKED = 60  # steps of a loop that get dots
LOOP_HEIGHT = 3.0  # inches, of a loop below the other panels
STEP = "{step}"  # in a file's name stands for the number of a step, from 1
HEAD = 0.34  # inches for the message; a line of details takes DETAIL
DETAIL = 0.19


def round_down(number):
    """1, 2 or 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(number))
    return max(digit for digit in (1, 2, 5) if digit <= number / power * (1 + 1e-9)) * power


class Solved:
    """A result, its contact cells, the part of the plane in the panels, and its loop. Of a history `step` is shown (from 1;
    None: the last one)."""

    def __init__(self, result, cells, step=None):
        steps = result.get("steps") or []
        self.step = step or len(steps)
        self.loop = Loop(steps) if len(steps) > 1 else None
        self.result = {**result, **steps[self.step - 1], "name": result["name"]} if steps else result
        self.cells = cells
        columns = cells.columns
        self.sticks = columns["stick"] != 0
        self.pressure = columns["pressure"]
        self.traction = np.stack([columns["q1"], columns["q2"]])
        self.slip = None  # an exact solution has none
        if "slip1" in columns:
            self.slip = np.stack([columns["slip1"], columns["slip2"]]) * ~self.sticks

        low, high = cells.extent[[0, 2]], cells.extent[[1, 3]]
        self.length_name, self.length = unit_for(max(high - low), LENGTHS)
        half = 0.5 * (high - low) + 0.04 * max(high - low)
        half = np.maximum(half, half[::-1] * (SIDES[0], 1 / SIDES[1]))
        self.view = np.stack([0.5 * (low + high) - half, 0.5 * (low + high) + half]) / self.length
        aspect = half[0] / half[1]
        self.stacked = aspect > WIDE
        self.panel_height = 5.6 / aspect if self.stacked else min(3.25 / aspect, 6.5)

    def image(self, axis, values, colours, largest=None):
        """Colours from zero to the largest value."""
        norm = Normalize(0, np.nanmax(values) if largest is None else largest)
        return axis.imshow(self.cells.grid(values), origin="lower", extent=self.cells.extent / self.length,
                           cmap=colours, norm=norm, interpolation="nearest")

    def arrows(self, axis, vectors, where, scale, **options):
        """Thinned arrows; one of length `scale` is as long as a metre of the plane."""
        chosen = self.cells.thinned(where)
        return axis.quiver(*self.cells.positions[:, chosen] / self.length, *vectors[:, chosen], angles="xy",
                           scale_units="xy", scale=scale * self.length, pivot="mid", width=0.0045, **options)


class Loop:
    """Moment against twist at the ends of the steps, or, where nothing turns, force against displacement along the
    direction of the largest force."""

    def __init__(self, steps):
        moment, twist = (np.array([step.get(key) or 0.0 for step in steps]) for key in ("moment", "twist_angle"))
        limit = max(step.get("moment_limit") or 0.0 for step in steps)
        self.title = "moment against twist"
        self.names, self.units = ("twist", "moment"), (ANGLES, MOMENTS)
        self.points = np.stack([twist, moment])
        if np.abs(moment).max() > ROUNDING * limit:
            return
        force, displacement = (np.array([step.get(key) or (0.0, 0.0) for step in steps]) for key in
                               ("force", "displacement"))
        largest = force[np.hypot(*force.T).argmax()]
        along = largest / (np.hypot(*largest) or 1.0)
        self.title = "force against displacement"
        self.names, self.units = ("displacement", "force"), (LENGTHS, FORCES)
        self.points = np.stack([displacement @ along, force @ along])


def draw_loop(axis, solved):
    """The steps in their order; the one that the other panels show has a dot."""
    loop = solved.loop
    axis.set_title(loop.title, loc="left")
    scales = [unit_for(np.abs(numbers).max(), units) for numbers, units in zip(loop.points, loop.units)]
    x, y = (numbers / unit for numbers, (_, unit) in zip(loop.points, scales))
    axis.plot(x, y, color=style.BLACK, linewidth=1.0, marker="." if len(x) <= MOST_MARKED else None, markersize=4)
    axis.plot(x[solved.step - 1], y[solved.step - 1], "o", color=style.BLACK)
    axis.set(xlabel=f"{loop.names[0]}, {scales[0][0]}", ylabel=f"{loop.names[1]}, {scales[1][0]}")
    axis.set_box_aspect(1)


def say(axis, words):
    axis.text(0.5, 0.5, words, transform=axis.transAxes, ha="center", va="center", path_effects=style.HALO)


def draw_slip(axis, solved):
    """Blue where the surfaces stick; slip in colour and as arrows."""
    axis.set_title("slip; blue: sticks", loc="left")
    if solved.sticks.any():
        solved.image(axis, np.where(solved.sticks, 1.0, np.nan), style.STICK, 1.0)
    if solved.slip is None:
        say(axis, "the exact solution\nsays nothing of slip")
        return None
    size = np.hypot(*solved.slip)
    largest = size.max()
    if not largest > 0:
        say(axis, "all sticks" if solved.sticks.all() else "nothing slips")
        return None
    name, unit = unit_for(largest, LENGTHS)
    image = solved.image(axis, np.where(solved.sticks, np.nan, size / unit), style.SLIP, largest / unit)
    longest = LONGEST_ARROW * solved.cells.longer_side()
    arrows = solved.arrows(axis, solved.slip, size > MIN_ARROW * largest, largest / longest)
    key = round_down(largest)
    axis.quiverkey(arrows, 0.94, 1 + 0.12 / solved.panel_height, key, f"{plain(key / unit)} {name}", labelpos="W",
                   labelsep=0.06)
    return image, f"slip, {name}"


def draw_traction(axis, solved):
    """The norm in colour, directions as arrows of equal length."""
    axis.set_title("tangential traction |q| and its direction", loc="left")
    size = np.hypot(*solved.traction)
    largest = size.max()
    if not largest > 0:
        say(axis, "no tangential traction")
        return None
    name, unit = unit_for(largest, STRESSES)
    image = solved.image(axis, size / unit, style.SEQUENTIAL)
    where = size > MIN_ARROW * largest
    solved.arrows(axis, solved.traction / np.where(where, size, 1.0), where,
                  1 / (0.8 * solved.cells.spacing()), color="white",
                  edgecolor=style.BLACK, linewidth=0.3)
    return image, f"|q|, {name}"


def draw_pressure(axis, solved):
    axis.set_title("pressure", loc="left")
    name, unit = unit_for(solved.pressure.max(), STRESSES)
    return solved.image(axis, solved.pressure / unit, style.SEQUENTIAL), f"p, {name}"


def message(solved):
    """The content of the figure in one line."""
    warning = "NOT CONVERGED: " if text(solved.result, "status") != "converged" else ""
    if not np.any(solved.traction):
        return warning + ("No tangential traction" if number(solved.result, "friction") else "No friction")
    sticking = np.mean(solved.sticks)
    slip = 0.0 if solved.slip is None else np.hypot(*solved.slip).max()
    up_to = f" by up to {quantity(slip, LENGTHS)}" if slip else ""
    if sticking == 1:
        return warning + "All of the contact sticks"
    if sticking == 0:
        return warning + f"All of the contact slips{up_to}"
    return warning + f"{percent(sticking)} of the contact sticks, the rest slips{up_to}"


def loads(result):
    """Force, moment and twist, unless they are rounding errors."""
    parts = []
    friction = (result.get("friction") or 0) * number(result, "normal_load")
    force = result.get("force") or (0, 0)
    if np.hypot(*force) > ROUNDING * friction:
        parts.append("force ({:.4g}, {:.4g}) N".format(*np.where(np.abs(force) > ROUNDING * friction, force, 0)))
    ratio = result.get("moment_ratio")
    if value(result, "moment") is not None and (ratio is None or abs(ratio) > ROUNDING):
        moment = f"moment {plain(number(result, 'moment'))} N m"
        parts.append(moment if ratio is None else f"{moment} = {ratio:.4g} of the limit")
    twist = value(result, "twist_angle")
    if twist is not None and (result.get("twist") is None or abs(result["twist"]) > ROUNDING):
        parts.append(f"twist {quantity(number(result, 'twist_angle'), ANGLES)}")
    return parts


def details(solved):
    """Name, loads, twist and certificate."""
    result = solved.result
    parts = [style.verbatim(text(result, "name"))]
    if result.get("steps"):
        count, name = len(result["steps"]), result["steps"][solved.step - 1]["name"]
        parts.append(f"end of step {solved.step} of {count}" + ("" if name.isdigit() else f", “{style.verbatim(name)}”"))
    if value(result, "cells"):
        parts.append("{} × {} cells".format(*value(result, "cells")))
    parts.append(f"normal load {plain(number(result, 'normal_load'))} N")
    parts.extend(loads(result))
    if result.get("method") == "exact":
        parts.append("exact solution")
    elif value(result, "certificate.gap") is None:
        parts.append("no certificate: " + reason(result, "certificate.gap"))
    else:
        words = f"{law(result)} holds to gap/energy = {sci(number(result, 'certificate.gap'))}"
        parts.append(words[0].upper() + words[1:])
    return "  ·  ".join(part.replace(" ", "\N{NO-BREAK SPACE}") for part in parts)


def finish(axis, solved):
    segments = solved.cells.outline() / solved.length
    many = len(segments) > MAX_SEGMENTS
    axis.add_collection(LineCollection(segments, colors=style.BLACK, linewidths=0.2 if many else 0.6,
                                       capstyle="projecting", rasterized=many))
    axis.set(xlim=solved.view[:, 0], ylim=solved.view[:, 1], aspect="equal")
    axis.grid(False)


def draw(solved, titled=True):
    """The panels; `titled`: below what they show, in words."""
    stacked = solved.stacked
    panels = 4 if solved.loop else 3
    width = 7.2 if stacked else 11.0 / 3 * panels
    lines = textwrap.wrap(details(solved), int(14.5 * width)) if titled else []
    head = HEAD + DETAIL * len(lines) + 0.15 if titled else 0.15
    height = head + (panels * (solved.panel_height + 0.35) + 0.3 if stacked else solved.panel_height + 1.35)
    if stacked and solved.loop:
        height += LOOP_HEIGHT - solved.panel_height
    figure = Figure(figsize=(width, height), layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - head / height))
    if titled:
        figure.text(0.1 / width, 1 - 0.08 / height, message(solved), weight="bold", size=12, va="top")
        figure.text(0.1 / width, 1 - HEAD / height, "\n".join(lines), va="top", linespacing=1.4)
    heights = [solved.panel_height] * 3 + [LOOP_HEIGHT] * (panels - 3)
    grid = figure.add_gridspec(panels, 1, height_ratios=heights) if stacked else figure.add_gridspec(1, panels)
    first = figure.add_subplot(grid[0])
    axes = [first, *(figure.add_subplot(grid[i], sharex=first, sharey=first) for i in (1, 2))]
    for axis in axes:
        axis.label_outer()
    for axis, panel_of in zip(axes, (draw_slip, draw_traction, draw_pressure)):
        bar = panel_of(axis, solved)
        finish(axis, solved)
        if bar:
            figure.colorbar(bar[0], ax=axis, label=bar[1], location="right" if stacked else "bottom", pad=0.02)
    for axis in axes[-1:] if stacked else axes:
        axis.set_xlabel(f"$x_1$, {solved.length_name}")
    for axis in axes if stacked else axes[:1]:
        axis.set_ylabel(f"$x_2$, {solved.length_name}")
    if solved.loop:
        draw_loop(figure.add_subplot(grid[3]), solved)
    return figure


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path, help="result of `slipstick solve --json`")
    parser.add_argument("fields", type=Path, help="its contact cells, from `--fields` (HDF5 or CSV); with {step} of each step")
    parser.add_argument("--output", type=Path, required=True,
                        help="figure to write: " + ", ".join(style.FORMATS) + "; with {step} one for each step")
    arguments = parser.parse_args(words)

    def work():
        result = load(arguments.result)
        size = value(result, "cell_size")
        if STEP not in arguments.output.name:
            return style.write(draw(Solved(result, Cells(arguments.fields, size))), arguments.output)
        for step in range(1, max(len(result.get("steps") or []), 1) + 1):
            fields, output = (Path(str(file).replace(STEP, str(step))) for file in (arguments.fields, arguments.output))
            style.write(draw(Solved(result, Cells(fields, size), step)), output)
        return None

    return script.run(work, (InputError, Unavailable), arguments.output)


if __name__ == "__main__":
    sys.exit(main())
