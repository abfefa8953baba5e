"""Growth of times with the cells, and crossings of two operators, as `slipstick bench` measures them."""

import numpy as np
from matplotlib.lines import Line2D

import style
from figure_entry import FigureEntry
from results import Unavailable, column, rows, value
from studies import cell_ticks_at
from wording import plain

CIRCLE, HOLLOW = dict(marker="o"), dict(marker="o", markerfacecolor="none")
# Families of one application: words, look; the hollow ones run on two threads.
APPLICATIONS = {"application/dense": ("dense matrix", dict(color=style.VERMILION, marker="s")),
                "application/direct": ("direct summation", dict(color=style.BLUE, **CIRCLE)),
                "application/direct_2_threads": ("the same, 2 threads", dict(color=style.BLUE, **HOLLOW)),
                "application/dcfft": ("convolution (DC-FFT)", dict(color=style.GREEN, **CIRCLE)),
                "application/dcfft_2_threads": ("the same, 2 threads", dict(color=style.GREEN, **HOLLOW)),
                "application/dcfft_quarter": ("a quadrant, by symmetry", dict(color=style.PURPLE, marker="^")),
                "application/dcfft_quarter_with_diagonal": ("and about the diagonal", dict(color=style.BLACK, marker="v"))}
SETUPS = {"setup/dense": "application/dense", "setup/direct": "application/direct", "setup/dcfft": "application/dcfft"}
BARE = ("four_bare_transforms", "four bare transforms (FFTW)", dict(color=style.GREY, linestyle=":"))
IN_WORDS = {"N^4": "N⁴", "N^2": "N²", "N^2 log N": "N² log N"}


def family(scaling, name):
    for found in rows(scaling, "families"):
        if found["name"] == name:
            return found
    raise Unavailable(f"“{name}” was not measured")


def has(scaling, name):
    return any(found["name"] == name for found in rows(scaling, "families"))


def times(found):
    """Cells and median seconds of the sizes that have a time."""
    table = [row for row in rows(found, "rows") if row["seconds"] is not None]
    if not table:
        raise Unavailable(f"“{found['name']}” has no time")
    return column(table, "cells"), column(table, "seconds")


def draw_family(axis, scaling, name, words, look, fitted=True):
    found = family(scaling, name)
    cells, seconds = times(found)
    axis.plot(cells, seconds, **dict(linestyle="", markersize=4) | look)
    law = value(found, "power_law")
    if fitted and law["exponent"] is not None:
        ends = np.array([law["cells"][0], law["cells"][-1]])
        axis.plot(ends, law["constant"] * ends**law["exponent"], color=look["color"], linewidth=0.8, alpha=0.7)
    return Line2D([], [], label=words, **dict(linestyle="") | look)


def size_axis(axis, most):
    axis.set(xscale="log", yscale="log")
    cell_ticks_at(axis, 2.0 ** np.arange(2, np.log2(most) + 0.5))


def growth(scaling):
    """One application against the cells, each form with its law, and where the lines cross."""
    figure, axis = style.panels(1, 1, 4.4)
    size_axis(axis, 1024)
    handles = [draw_family(axis, scaling, name, words, look)
               for name, (words, look) in APPLICATIONS.items() if has(scaling, name)]
    if has(scaling, BARE[0]):
        cells, seconds = times(family(scaling, BARE[0]))
        axis.plot(cells, seconds, **BARE[2])
        handles.append(Line2D([], [], label=BARE[1], **BARE[2]))
    low, high = axis.get_ylim()
    for crossing in value(scaling, "crossovers"):
        if crossing["slow"] in APPLICATIONS and crossing["cells"] is not None:
            mark_crossing(axis, crossing)
    axis.set_ylim(low, high)
    axis.set(xlabel="cells N along a side", ylabel="time of one application, s")
    style.legend_on_top(figure, handles, 3)
    return FigureEntry(
        crossing_message(scaling), growth_details(scaling),
        "Log-log lines of time against cells, one a form of the operator, with vertical bands where they cross.",
        figure)


def mark_crossing(axis, crossing):
    colour = APPLICATIONS[crossing["slow"]][1]["color"]
    if crossing["low"] is not None and crossing["high"] is not None:
        axis.axvspan(crossing["low"], crossing["high"], color=colour, alpha=0.15, linewidth=0)
    hollow = crossing["slow"].endswith("threads")
    axis.axvline(crossing["cells"], color=colour, linewidth=0.8, linestyle="--" if hollow else "-", zorder=0)


def interval(found, low="low", high="high", write=plain):
    """ (8.8 to 9.6); empty where there is none."""
    if found[low] is None or found[high] is None:
        return ""
    return f" ({write(found[low])} to {write(found[high])})"


def _three(number):
    return f"{number:.3g}"


def crossing_message(scaling):
    sentences = []
    for crossing in value(scaling, "crossovers"):
        if crossing["slow"] not in APPLICATIONS:
            continue
        words = APPLICATIONS[crossing["slow"]][0]
        if crossing["slow"].endswith("2_threads"):
            words = "direct summation on two threads"
        if crossing["cells"] is None:
            sentences.append(f"{words}: {crossing['remark']}")
        else:
            sentences.append(f"a {words} from {_three(crossing['cells'])}{interval(crossing, write=_three)} cells a side on"
                             if words.startswith("dense") else
                             f"{words} from {_three(crossing['cells'])}{interval(crossing, write=_three)} on")
    if not sentences:
        raise Unavailable("no two operators were measured at the same sizes")
    return f"Convolution overtakes {', '.join(sentences)}."


def growth_details(scaling):
    laws = []
    for name in ("application/dense", "application/direct", "application/dcfft"):
        if not has(scaling, name):
            continue
        found = family(scaling, name)
        law = value(found, "power_law")
        if law["exponent"] is not None:
            laws.append(f"{APPLICATIONS[name][0]} N<sup>{law['exponent']:.2f}</sup>{interval(law, write='{:.2f}'.format)}")
    return (f"Points are medians, lines powers fitted to the largest sizes: {'; '.join(laws)}. Theory says N⁴ for sums over "
            f"all pairs of cells, N² log N for convolution. Bands are 95 % intervals of where two lines cross, from the "
            "repetitions’ scatter. Each form is checked against another before it is timed.")


def setting_up(scaling):
    """The cost of the setup in applications."""
    figure, axes = style.panels(1, 2, 3.2)
    handles, sentences = [], []
    for name, of in SETUPS.items():
        if not has(scaling, name):
            continue
        words, look = APPLICATIONS[of]
        handles.append(draw_family(axes[0], scaling, name, words, look, fitted=False))
        cells, seconds = times(family(scaling, name))
        other_cells, other = times(family(scaling, of))
        both, here, there = np.intersect1d(cells, other_cells, return_indices=True)
        ratio = seconds[here] / other[there]
        axes[1].plot(both, ratio, "-", color=look["color"], marker=look["marker"])
        sentences.append(f"{ratio[-1]:.2g} by {words}, {both[-1]:.0f}² cells")
    if not handles:
        raise Unavailable("no set-up was measured")
    for axis in axes:
        size_axis(axis, 1024)
        axis.set_xlabel("cells N along a side")
    axes[0].set(ylabel="time to set up, s")
    axes[1].set(ylabel="set-up over one application")
    style.legend_on_top(figure, handles, 3)
    return FigureEntry(
        f"The cost of setting up, in applications: {'; '.join(sentences)}.",
        "Influence coefficients, their transforms and FFTW’s plans for convolution; the matrix for the dense "
        "operator; tables of coefficients for direct summation. Done once for each grid.",
        "Two log-log panels against cells: time to set up, and that time over one application.", figure)


FIGURES = [("One application of the operator", growth), ("Setting up", setting_up)]
