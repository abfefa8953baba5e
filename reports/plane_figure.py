"""The speed-error plane that `slipstick bench` measured: what each choice costs, and the error that it buys."""

import numpy as np
from markupsafe import escape
from matplotlib.lines import Line2D

import style
from figure_entry import LIMIT, FigureEntry
from method_figures import METHODS
from results import Unavailable, number, rows, text, value
from wording import plain, sci, seconds

# (quantity, title of its panel)
PANELS = (("twist", "twist"), ("traction_l2", "tractions, root mean square"), ("stick_radius", "stick radius"))
DEFAULT = {"method": "coulomb", "operator": "dcfft", "model": "auto", "pressure": "solved"}
# The first of these keys that differs from its default: key, words, look.
KINDS = [("operator", "direct or dense operator", dict(color=style.GREY, marker="x")),
         ("model", "full model", dict(color=style.GREEN, marker="s", markersize=7, markerfacecolor="none")),
         ("pressure", "Hertz’s pressure", dict(color=style.VERMILION, marker="v"))]
ENVELOPE = dict(color=style.BLACK, linewidth=1.0, alpha=0.8, zorder=1)


def kind(point):
    """Words and look of a point."""
    if point["method"] != DEFAULT["method"]:
        return METHODS[point["method"]]
    for key, words, look in KINDS:
        if point[key] != DEFAULT[key]:
            return words, look
    return METHODS[DEFAULT["method"]]


def timed(scene):
    """The points that have a time: the others are wrong."""
    found = [point for point in rows(scene, "points") if point["seconds"] is not None]
    if not found:
        raise Unavailable(f"“{text(scene, 'name')}” has no point that was timed")
    return found


def draw_panel(axis, scene, quantity, title):
    """|error| against seconds; returns the handles of its lines."""
    handles = {}
    for point in timed(scene):
        error = value(point, f"error.{quantity}")
        if not error:
            continue
        words, look = kind(point)
        axis.plot(number(point, "seconds.median"), error, **look | dict(linestyle="", markersize=look.get(
            "markersize", 4.0) * 0.85, alpha=0.75))
        handles.setdefault(words, Line2D([], [], label=words, **look | dict(linestyle="")))
    front = [scene["points"][place] for place in value(scene, f"envelope.{quantity}")]
    axis.step([number(point, "seconds.median") for point in front],
              [number(point, f"error.{quantity}") for point in front], where="post", **ENVELOPE)
    name_meshes(axis, front, quantity)
    axis.set(xscale="log", yscale="log", title=title)
    show_exact(axis, scene)
    return handles


def name_meshes(axis, front, quantity):
    """The first point of each mesh on the envelope, by its cells."""
    seen = set()
    for point in front:
        if point["cells"] in seen:
            continue
        seen.add(point["cells"])
        axis.annotate(f"{point['cells']}²", (number(point, "seconds.median"), number(point, f"error.{quantity}")),
                      xytext=(-3, -3), textcoords="offset points", fontsize=6.5, ha="right", va="top",
                      path_effects=style.HALO)


def show_exact(axis, scene):
    """The exact answer lies far below the axes: an arrow at its time."""
    if value(scene, "exact") is None:
        return
    low, high = axis.get_ylim()
    low = 10 ** (np.log10(low) - 0.12 * np.log10(high / low))
    axis.set_ylim(low, high)
    at = number(scene, "exact.seconds.median")
    axis.set_xlim(left=min(axis.get_xlim()[0], 0.7 * at))
    axis.annotate("", (at, low), xytext=(0, 16), textcoords="offset points",
                  arrowprops=dict(arrowstyle="-|>", color=style.BLACK, linewidth=1.2))
    axis.annotate(f"exact: {sci(number(scene, 'exact.error'))}", (at, low), xytext=(5, 4), textcoords="offset points",
                  fontsize=6.5, path_effects=style.HALO)


def draw(scene):
    """The figure of one scene of the plane, a FigureEntry."""
    figure, axes = style.panels(1, len(PANELS), 3.9, sharex=True)
    handles = {}
    for axis, (quantity, title) in zip(axes, PANELS):
        handles |= draw_panel(axis, scene, quantity, title)
    axes[0].set_ylabel("relative error")
    figure.supxlabel("time of a whole solve, s (one thread)", fontsize=9)
    last = Line2D([], [], label="envelope: nothing is quicker and as good", **ENVELOPE)
    style.legend_on_top(figure, [*handles.values(), last], 2)
    return FigureEntry(
        message(scene), details(scene),
        "Three log-log panels of error against time, a marker a choice, the envelope as a staircase.", figure)


def message(scene):
    """The least time to a few errors of the twist, and the choices that reach it."""
    found = [row for row in rows(scene, "time_to")
             if row["quantity"] == "twist" and row["method"] == "any" and row["point"] is not None]
    if not found:
        raise Unavailable(f"“{text(scene, 'name')}” reaches none of the requested errors")
    parts = [f"{power_of_ten(row['error'])} takes {milliseconds(number(row, 'seconds'))} "
             f"({escape(short(scene['points'][row['point']]))})" for row in found]
    return f"At {LIMIT}{plain(number(scene, 'moment_ratio'))} a twist right to {'; '.join(parts)}."


def details(scene):
    points = timed(scene)
    wrong = len(rows(scene, "points")) - len(points)
    left_out = f" Not timed, since their results are wrong: {wrong}." if wrong else ""
    return (f"{len(points)} choices of method, operator, model, pressure, mesh and tolerance; a point each: the "
            "median time, and the root mean square of the errors on several grids of the mesh, which lie differently under "
            "the contact. Numbers at the envelope are cells of the grid. The exact answer is stick radius, twist and "
            f"tractions in the cells of one mesh.{left_out}")


def power_of_ten(error):
    return sci(error).replace("1.0×", "")


def milliseconds(time):
    return f"{seconds(1e3 * time)} ms" if time < 1 else f"{seconds(time)} s"


def short(point, method=True):
    """The settings that differ from the default, and the mesh."""
    words = [point["method"].replace("_", " ") if point["method"] != "coulomb" else "Newton"] if method else []
    words += [point[key].replace("_", " ") for key in ("operator", "model", "pressure")
              if point[key] != DEFAULT[key]]
    return ", ".join([*words, f"{point['cells']}² cells", f"tolerance {power_of_ten(point['tolerance'])}"])
