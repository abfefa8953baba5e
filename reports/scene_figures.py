"""Figures of a scene's page: the bodies, the answer, the loop of a history, what an error costs."""

import numpy as np
from markupsafe import escape

import solve_figure
import style
from cells import Cells
from figure_entry import FigureEntry
from method_figures import METHODS, OTHER
from results import Unavailable, column, groups, number, rows, text, value
from wording import ENERGIES, LENGTHS, percent, plain, quantity, sci, seconds, unit_for

# Numbers that a motion is measured by: words, and their axis.
MOTIONS = {"twist_angle": ("twist", "rad"), "displacement": ("displacement", "m"), "moment": ("moment", "N m"),
           "force": ("force", "N"), "approach": ("approach", "m")}


def _numbers(values):
    return np.array([np.nan if each is None else each for each in values], float)


def bodies(page, folder):
    """The gap before any load, along both axes of the grid through its centre and over the grid."""
    gap = value(page, "scene.gap")
    lines = [("x1", "along_1", "along $x_1$", dict(color=style.BLUE)),
             ("x2", "along_2", "along $x_2$", dict(color=style.VERMILION, linestyle="--"))]
    found = [(_numbers(gap[x]), _numbers(gap[y]), words, look) for x, y, words, look in lines]
    over = np.stack([_numbers(row) for row in gap["map"]])
    if not np.isfinite(over).any():
        raise Unavailable("no point of the grid can be touched")
    length, length_unit = unit_for(max(np.max(np.abs(x)) for x, *_ in found), LENGTHS)
    highest = np.nanmax(np.abs(over))
    height, height_unit = unit_for(highest, LENGTHS) if highest > 0 else (length, length_unit)
    figure, (axis, plane) = style.panels(1, 2, 3.0)
    for x, y, words, look in found:
        axis.plot(x / length_unit, y / height_unit, label=words, **look)
    axis.axhline(0, color=style.GREY, linewidth=4, alpha=0.5)
    axis.set(xlabel=f"position, {length}", ylabel=f"gap, {height}")
    axis.legend()
    image = plane.imshow(over.T / height_unit, origin="lower", cmap=style.SEQUENTIAL,
                         extent=[end / length_unit for x, *_ in found for end in (x[0], x[-1])])
    plane.set(xlabel=f"$x_1$, {length}", ylabel=f"$x_2$, {length}")
    plane.grid(False)
    figure.colorbar(image, ax=plane, label=f"gap, {height}")
    message = "The gap between the bodies before any load"
    if not highest > 0:
        message += " is zero wherever they can touch"
    elif height_unit < length_unit:
        message += f"; its unit is {plain(float(f'{length_unit / height_unit:.2g}'))} times smaller than that along the plane"
    return FigureEntry(f"{message}.", "Left, along the two axes of the grid, through its centre; the lower body is grey. Right, over the grid. "
                       "Nothing is drawn where the bodies cannot touch.", "Two lines, the gap along both axes, and a map of the gap.",
                       figure)


def answer(page, folder):
    """Slip and stick with directions, tractions, pressure on the finest mesh."""
    result = value(page, "answer")
    fields = text(page, "fields")
    solved = solve_figure.Solved(result, Cells(folder / fields, value(result, "cell_size")))
    details = solve_figure.details(solved).replace("\\$", "$").replace("\N{NO-BREAK SPACE}", " ")
    return FigureEntry(f"{escape(solve_figure.message(solved))}.", escape(details),
                       "Three maps of the contact: slip and stick, tangential traction, pressure.",
                       solve_figure.draw(solved, titled=False), sources=[fields])


def _along(steps, key):
    """A number step by step; of pairs the part along the longest of them."""
    found = [step.get(key) for step in steps]
    if not any(isinstance(each, list) for each in found):
        return _numbers(found)
    pairs = np.array([each or (np.nan, np.nan) for each in found], float)
    longest = pairs[np.nanargmax(np.hypot(*pairs.T))]
    return pairs @ (longest / (np.hypot(*longest) or 1.0))


ROUNDING = 1e-9  # loads and motions below this part of their scale are rounding errors
FEWEST_ON_A_BRANCH = 4  # points from one reversal to the next that show how it is curved


def _scale(answer, steps, key):
    """The scale of a load or a motion; all motions have one scale, as displacements."""
    radius = answer.get("contact_radius") or 0.0
    turned, moved = (np.max(np.abs(_along(steps, motion)), initial=0.0) for motion in ("twist_angle", "displacement"))
    scales = {"moment": answer.get("moment_limit"), "force": answer.get("friction_force"),
              "twist_angle": max(turned, moved / radius) if radius else turned, "displacement": max(moved, turned * radius)}
    return scales.get(key) or np.max(np.abs(_along(steps, key)), initial=0.0)


def _varies(answer, steps, key):
    values = _along(steps, key)
    return np.isfinite(values).all() and np.ptp(values) > ROUNDING * _scale(answer, steps, key)


def _shows_branches(load):
    """Whether each stretch between two reversals of a load, the first one from zero, has points enough."""
    change = np.diff(load)
    ends = np.flatnonzero(np.sign(change[1:]) != np.sign(change[:-1])) + 1
    return np.min(np.diff(np.concatenate([[0], ends, [load.size - 1]]))) >= FEWEST_ON_A_BRANCH


def loop(page, folder):
    """Loads against motions, step by step."""
    answer, steps = value(page, "answer"), rows(page, "answer.steps")
    pairs = [pair for pair in (("twist_angle", "moment"), ("displacement", "force"), ("approach", "normal_load"))
             if all(_varies(answer, steps, key) for key in pair)]
    if not pairs:
        raise Unavailable("no load and no motion changes from step to step")
    figure, axes = style.panels(1, len(pairs), 3.2, squeeze=False)
    words = {**MOTIONS, "normal_load": ("normal load", "N")}
    curved = all(_shows_branches(np.insert(_along(steps, load), 0, 0.0)) for _, load in pairs)
    for axis, (motion, load) in zip(axes[0], pairs):
        axis.plot(*(np.insert(_along(steps, key), 0, 0.0) for key in (motion, load)), "-o" if curved else ":o", color=style.BLUE,
                  markersize=3, label="computed")
        exact = [step.get("exact") or {} for step in steps]
        if all(each.get(motion) is not None and each.get(load) is not None for each in exact):
            axis.plot(_along(exact, motion), _along(exact, load), "x", color=style.BLACK, markersize=5, label="exact")
        axis.set(xlabel=", ".join(words[motion]), ylabel=", ".join(words[load]))
        axis.ticklabel_format(scilimits=(-3, 3))
        axis.legend()
    lost = number(page, "answer.history.dissipated")
    return FigureEntry(f"The history in {len(steps)} steps; friction takes {quantity(lost, ENERGIES)} in all.",
                       "A point for each step, from no load on. " + (
                           "What lies within a closed loop is the energy that it loses." if curved else
                           "Dotted lines only join the points in their order: the contact itself follows curves between them, which more "
                           "steps from one reversal to the next would show, and the energy lost is not what lies within the lines."),
                       "Loads against motions, step by step.", figure)


NEXT_TO_NOTHING = 0.9  # of an error: what is gained by less is not worth its time


def cost(page, folder):
    """Error against time of each method, mesh and tolerance."""
    points = [point for point in rows(page, "cost.points") if point["seconds"] is not None and point["error"]]
    points.sort(key=lambda each: each["seconds"])
    if not points:
        raise Unavailable("no solve has an error that is known")
    figure, axis = style.panels(1, 1, 3.6)
    for (method,), found in groups(points, "method").items():
        words, look = METHODS.get(method, (method, OTHER))
        axis.plot(column(found, "seconds"), column(found, "error"), label=style.verbatim(words), **look | dict(linestyle=""))
    best, finest = [], np.inf
    for point in points:
        if point["error"] < NEXT_TO_NOTHING * finest:
            finest = point["error"]
            best.append(point)
    axis.step([point["seconds"] for point in best], [point["error"] for point in best], where="post", color=style.BLACK,
              linewidth=1.0, alpha=0.8)
    floor = page["cost"]["reference_uncertainty"]
    words = MOTIONS.get(text(page, "cost.number"), (text(page, "cost.number"), ""))[0]
    axis.set(xscale="log", yscale="log", xlabel="time of a whole solve, s (one thread)", ylabel=f"relative error of the {words}")
    style.whole_decades(axis)
    if floor:
        axis.set_ylim(min(axis.get_ylim()[0], floor / 3))
        axis.axhspan(axis.get_ylim()[0], floor, color=style.GREY, alpha=0.2)
    style.legend_on_top(figure, axis.get_legend_handles_labels()[0], 2)
    last = best[-1]
    message = (f"An error of {sci(last['error'])} in the {words} takes {seconds(last['seconds'])} s: "
               f"{escape(METHODS.get(last['method'], (last['method'],))[0])}, {last['cells']} cells along the longer side, tolerance "
               f"{sci(last['tolerance'])}.")
    known = "against the exact answer" if not floor else (
        f"at most the distance from the value that the meshes tend to, plus {percent(floor)} by which that value may be off itself (the "
        "length of the steps included). Nothing is known below, where it is grey")
    return FigureEntry(message, f"A point for each method, mesh and tolerance; the line joins those that no other beats. The error is "
                       f"{known}. Solves that did not converge or were refused have no point.",
                       "Log-log points of error against time.", figure)


def programs(page, folder):
    """Error against time of this program and of others."""
    known = [row for row in rows(page, "programs") if row["seconds"] is not None and row["error"] is not None]
    if not known:
        raise Unavailable("no program has an answer whose error is known")
    figure, axis = style.panels(1, 1, 3.4)
    looks = [dict(color=color, marker=marker) for color, marker in
             zip((style.GREEN, style.BLUE, style.VERMILION, style.PURPLE, style.BLACK), "so^vD")]
    for ((name, number), found), look in zip(groups(known, "name", "number").items(), looks * 4):
        axis.plot(column(found, "seconds"), column(found, "error"), "-", label=f"{style.verbatim(name)}, {_number_words(number)}", **look)
    axis.set(xscale="log", yscale="log", xlabel="time of the solve, s", ylabel="relative error")
    style.whole_decades(axis)
    style.legend_on_top(figure, axis.get_legend_handles_labels()[0], 2)
    finest = {name: found[-1] for (name,), found in groups(known, "name").items()}
    own = finest.pop("slipstick", None)
    others = ", ".join(f"{escape(name)} {seconds(row['seconds'])} s ({sci(row['error'])})" for name, row in finest.items())
    message = f"On the finest mesh, seconds and error: {others}" + (
        f"; slipstick {seconds(own['seconds'])} s ({sci(own['error'])}, of {_number_words(own['number'])})." if own else ".")
    return FigureEntry(message, "A point for each mesh. Programs that find the pressure alone do less than those that find tractions "
                       "too. The time is that of the solve as the program says it, without its start, where it says so.",
                       "Log-log lines of error against time, one a program.", figure)


def _number_words(number):
    return MOTIONS.get(number, (number.replace("_", " "),))[0]


def operators(page, folder):
    """Whole solves of the scene by direct sums and by convolution."""
    table = [row for row in rows(page, "operators.rows") if row["seconds"] is not None]
    if not table:
        raise Unavailable(value(page, "operators")["remark"] or "no solve on a small mesh was timed")
    figure, axis = style.panels(1, 1, 3.2)
    looks = {"direct": ("direct summation", dict(color=style.VERMILION, marker="o")),
             "dcfft": ("convolution (DC-FFT)", dict(color=style.BLUE, marker="s"))}
    for (kind,), found in groups(table, "operator").items():
        words, look = looks[kind]
        axis.plot(column(found, "cells"), column(found, "seconds"), "-", label=words, **look)
    crossing = value(page, "operators")
    if crossing["cells"] is not None:
        if crossing["low"] is not None and crossing["high"] is not None:
            axis.axvspan(crossing["low"], crossing["high"], color=style.GREY, alpha=0.25)
        axis.axvline(crossing["cells"], color=style.BLACK, linewidth=0.8)
    axis.set(xscale="log", yscale="log", xlabel="cells along the longer side", ylabel="time of a whole solve, s")
    axis.set_xticks(sorted(set(column(table, "cells"))), [f"{n:g}" for n in sorted(set(column(table, "cells")))])
    axis.minorticks_off()
    style.legend_on_top(figure, axis.get_legend_handles_labels()[0], 2)
    if crossing["cells"] is None:
        message = f"Convolution against direct summation: {escape(crossing['remark'])}."
    else:
        interval = "" if crossing["low"] is None or crossing["high"] is None else (
            f" ({crossing['low']:.3g} to {crossing['high']:.3g})")
        message = f"Convolution overtakes direct summation from {crossing['cells']:.3g}{interval} cells a side on."
    return FigureEntry(message, "Whole solves of this scene to the same numbers, medians of repetitions. The band is the 95 % interval "
                       "of where the lines cross, from the repetitions’ scatter.",
                       "Two log-log lines of time against cells.", figure)
