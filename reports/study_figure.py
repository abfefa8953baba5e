#!/usr/bin/env python3
"""Draws the result of `slipstick study`: errors with their orders, error budgets, and errors by tolerance."""

import argparse
import sys
import textwrap
from collections import Counter
from pathlib import Path

import script

script.require("numpy", "matplotlib")

import numpy as np  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import NullLocator  # noqa: E402

import style  # noqa: E402
import study_result  # noqa: E402
from figure_entry import FigureEntry  # noqa: E402
from results import InputError, Unavailable, load, nearest, text  # noqa: E402
from study_result import PARTS, numbers, quantity_words  # noqa: E402
from wording import LENGTHS, sci, unit_for  # noqa: E402

HEAD = 0.2  # inches around the message of a single figure; a line of it takes LINE
LINE = 0.2
IN_A_SENTENCE = {"floor": "at a floor", "too_few": "of too few meshes"}
PART_COLOURS = dict(zip(PARTS, (style.BLACK, style.SKY, style.PURPLE, style.GREY)))


def order_words(order):
    """1.02 (0.96 to 1.09) asymptotic"""
    verdict = order["verdict"].replace("_", " ")
    if order["value"] is None:
        return f"no order: {verdict}"
    return f"{order['value']:.2f} ({order['low']:.2f} to {order['high']:.2f}) {verdict}".replace("-", "−")


def used_meshes(size, order):
    """The meshes of a fit; its sizes are means over the grids that converged."""
    used = np.zeros(size.size, bool)
    for one in order["sizes"]:
        used[nearest(np.log(size), np.log(one))] = True
    return used


def has_exact_answer(series, quantity):
    return all(one.order(quantity).get("basis") != "extrapolated" for one in series)


def draw_errors(axis, series, quantity):
    """|error| against cell size; meshes that the fit leaves out are pale."""
    handles = []
    for one in series:
        size, mean = numbers(one.meshes, "h"), one.mean(quantity)
        spread, order = np.nan_to_num(numbers(one.meshes, quantity, "spread")), one.order(quantity)
        used, given = used_meshes(size, order), np.isfinite(mean)
        look = dict(one.look, linestyle="")
        low = np.where(spread < mean, spread, (1 - 1e-9) * mean)  # a bar that would reach zero leaves the axes
        for where, alpha in ((used & given, 1.0), (~used & given, 0.3)):
            if where.any():
                bars = [list(low[where]), list(spread[where])]  # an array of one mesh would be taken for a number
                axis.errorbar(size[where], mean[where], yerr=bars, elinewidth=0.7, alpha=alpha, **look)
        if order["constant"] is not None and order["verdict"] != "oscillatory":
            ends = np.array([size[used].min(), size[used].max()])
            axis.plot(ends, abs(order["constant"]) * ends ** order["value"], color=look["color"], linewidth=0.9,
                      linestyle="--" if look.get("markerfacecolor") == "none" else "-")
        handles.append(Line2D([], [], label=order_words(order), **look))
    reference = "" if has_exact_answer(series, quantity) else ", from the extrapolated value"
    axis.set(xscale="log", yscale="log", title=quantity_words(quantity) + reference)
    axis.invert_xaxis()
    return handles


def range_of_errors(series, quantity):
    means = np.concatenate([one.mean(quantity) for one in series])
    if not (means > 0).any():
        raise Unavailable(f"“{quantity}” has no errors to show")
    return means[means > 0].min(), np.nanmax(means)


def expected_guides(axis, series, quantity, top):
    """Above all points: a line of each order that theory gives, from the coarsest mesh on."""
    size = numbers(series[0].meshes, "h")
    ends = np.array([size.max(), size.min()])
    for order in sorted({one.order(quantity)["expected"] for one in series} - {None}):
        error = top * (ends / ends[0]) ** order
        axis.plot(ends, error, ":", color=style.GREY, linewidth=1.0, zorder=1)
        axis.annotate(f"expected: {order:g}", (ends[0], error[0]), xytext=(8, -2), textcoords="offset points",
                      fontsize=7, color=style.GREY, va="bottom")


def size_ticks(axis, series):
    """Cell sizes as numbers of cells across."""
    meshes = {study_result.across(mesh): mesh["h"] for one in series for mesh in one.meshes}
    shown = {cells: size for cells, size in meshes.items() if cells & (cells - 1) == 0} or meshes
    axis.xaxis.set_minor_locator(NullLocator())
    axis.set_xticks(list(shown.values()), [str(cells) for cells in shown])


def known_from(series, quantity):
    """The uncertainty of the extrapolated value: nothing is known of smaller errors. Zero of an exact answer."""
    return 0.0 if has_exact_answer(series, quantity) else np.nanmax(
        [0.0, *(np.abs(found) for one in series for found in numbers(one.budget(quantity), "reference"))])


def errors_panel(axis, series, quantity):
    low, high = range_of_errors(series, quantity)
    handles = draw_errors(axis, series, quantity)
    expected_guides(axis, series, quantity, 4.0 * high)
    size_ticks(axis, series)
    legend = min(0.02 + 0.055 * len(handles), 0.45)  # of the height, below all points
    decades = np.log10(16.0 * high / low)
    axis.set_ylim(low / 2 * 10 ** (-legend / (1 - legend) * decades), 8.0 * high)
    known = known_from(series, quantity)
    if known > axis.get_ylim()[0]:
        axis.axhspan(axis.get_ylim()[0], known, color=style.GREY, alpha=0.2, linewidth=0)
    axis.legend(handles=handles, loc="lower left", fontsize=6.8, handlelength=1.2, handletextpad=0.3,
                labelspacing=0.25, borderaxespad=0.3, frameon=True, framealpha=0.85, edgecolor="none")


def draw_budget(axis, series, quantity):
    """Parts of the error on each mesh, side by side on a log scale; a part that is zero has no bar."""
    table = series.budget(quantity)
    where = np.arange(len(table))
    width = 0.8 / len(PARTS)
    for k, part in enumerate(PARTS):
        size = np.abs(numbers(table, part))
        axis.bar(where + (k - 1.5) * width, np.where(size > 0, size, np.nan), width, color=PART_COLOURS[part],
                 label=part)
    axis.set(yscale="log", ylabel="part of the error", xlabel="cells across the grid",
             title=f"parts of the error of the {quantity_words(quantity)}\n({style.verbatim(series.label)})")
    axis.set_xticks(where, [str(study_result.across(row)) for row in table])
    axis.grid(False, axis="x")
    low, high = axis.get_ylim()
    axis.set_ylim(10 ** np.floor(np.log10(low) - 0.3), high * 30)
    axis.legend(ncol=len(PARTS), loc="upper right", handlelength=1.0, columnspacing=1.5)


def tolerance_line(axis, series, found, **changes):
    axis.plot(numbers(series.tolerances, "requested"), np.abs(found), **(series.look | changes))


def draw_achieved(axis, series):
    """The certificate's gap against the requested tolerance; grey: equality."""
    requested = np.concatenate([numbers(one.tolerances, "requested") for one in series])
    ends = np.array([requested.min(), requested.max()])
    axis.plot(ends, ends, ":", color=style.GREY)
    for one in series:
        tolerance_line(axis, one, numbers(one.tolerances, "certificate.gap"))
        change = numbers(one.tolerances, "change")
        if not np.allclose(change, numbers(one.tolerances, "certificate.gap"), rtol=1e-6, equal_nan=True):
            tolerance_line(axis, one, change, linestyle="--", marker="", linewidth=0.9)
    axis.set(xscale="log", yscale="log", title="gap / energy reached")
    axis.invert_xaxis()


def draw_tolerance_errors(axis, series, quantity):
    """Errors and their part by stopping there; only that part for a value without an exact answer."""
    is_error = has_exact_answer(series, quantity)
    dashed = dict(linestyle="--", marker="", linewidth=0.9) if is_error else {}
    for one in series:
        if is_error:
            tolerance_line(axis, one, numbers(one.tolerances, quantity))
        tolerance_line(axis, one, numbers(one.tolerances, "iteration", quantity), **dashed)
    words = quantity_words(quantity)
    axis.set(xscale="log", yscale="log", title=f"error: {words}" if is_error else f"{words}, from the tightest run")
    axis.invert_xaxis()
    axis.yaxis.set_minor_locator(NullLocator())


def moved_by_tolerance(series, quantities):
    """The quantities with a known error, or with an effect of the tolerance."""
    def shown(quantity):
        rows = [numbers(one.tolerances, quantity) if has_exact_answer(series, quantity) else
                numbers(one.tolerances, "iteration", quantity) for one in series]
        return any((np.abs(found) > 0).any() for found in rows)
    return [each for each in quantities if shown(each[1])]


def look_handles(series):
    colours, markers = study_result.told_by(series)
    black = {"color": style.BLACK} if colours else {}
    return [Line2D([], [], color=colour, label=style.verbatim(words)) for words, colour in colours] + [
        Line2D([], [], label=style.verbatim(words), linestyle="", **(look | black)) for words, look in markers]


def draw(study, head=0.0):
    """The figure of a study with `head` free inches above it, as a FigureEntry."""
    series = study_result.read(study)
    quantities = study_result.main_quantities(series)
    to_tolerances = [one for one in series if one.tolerances]
    moved = moved_by_tolerance(to_tolerances, quantities)
    sections = []
    if study_result.has_meshes(series):
        sections += [(_draw_error_section, 2.9 * -(-_error_panels(series, quantities) // 2)), (_draw_budget_section, 2.5)]
    if to_tolerances:
        sections.append((_draw_tolerance_section, 2.9 * -(-(1 + len(moved)) // 2)))
    if not sections:
        raise Unavailable("the study has one mesh and one tolerance: nothing to compare")
    handles = look_handles(series)
    top = 0.21 * -(-len(handles) // 2) + 0.06 + head
    height = sum(height for _, height in sections) + top
    figure = style.Figure(figsize=(style.WIDTH, height), layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - top / height))
    parts = np.atleast_1d(figure.subfigures(len(sections), 1, height_ratios=[height for _, height in sections]))
    for part, (draw_section, _) in zip(parts, sections):
        draw_section(part, *((to_tolerances, moved) if draw_section is _draw_tolerance_section else (series, quantities)))
    if handles:
        figure.legend(handles=handles, loc="upper center", ncol=2, handlelength=2.0, columnspacing=1.8,
                      borderaxespad=0.1, bbox_to_anchor=(0.5, 1 - head / height))
    return FigureEntry(
        failures(study) + message(series, quantities), details(series, quantities),
        "Log-log panels of errors against cell size with fitted orders, bars of the parts of an error, or "
        "errors against tolerances.", figure)


def _grid(part, count):
    columns = min(count, 2)
    axes = part.subplots(-(-count // columns), columns, squeeze=False).ravel()
    for spare in axes[count:]:
        spare.set_axis_off()
    return axes


def has_times(series):
    return all(np.isfinite(numbers(one.meshes, "seconds")).any() for one in series)


def seconds_panel(axis, series):
    """Seconds of one solve against cell size."""
    for one in series:
        axis.plot(numbers(one.meshes, "h"), numbers(one.meshes, "seconds"), **one.look)
    axis.set(xscale="log", yscale="log", title="seconds of one solve")
    axis.invert_xaxis()
    size_ticks(axis, series)


def _error_panels(series, quantities):
    """Their number."""
    return len(quantities) + has_times(series)


def _draw_error_section(part, series, quantities):
    axes = _grid(part, _error_panels(series, quantities))
    for axis, (_, path) in zip(axes, quantities):
        errors_panel(axis, series, path)
    if has_times(series):
        seconds_panel(axes[len(quantities)], series)
    part.supxlabel("cells across the grid", fontsize=9)
    part.supylabel("relative error", fontsize=9)


def _draw_budget_section(part, series, quantities):
    path = quantities[0][1]
    draw_budget(part.subplots(), study_result.budget_series(series, path), path)


def _draw_tolerance_section(part, series, quantities):
    axes = _grid(part, 1 + len(quantities))
    draw_achieved(axes[0], series)
    asked = Line2D([], [], linestyle=":", color=style.GREY, label="requested")
    test = Line2D([], [], linestyle="--", color=style.BLACK, linewidth=0.9, label="the method’s own stopping quantity")
    axes[0].legend(handles=[asked, test], loc="lower left", fontsize=7)
    for axis, (_, path) in zip(axes[1:], quantities):
        draw_tolerance_errors(axis, series, path)
        error = [("error", dict(linestyle="-")), ("part left by stopping there", dict(linestyle="--", linewidth=0.9))]
        difference = [("relative difference from the tightest run", dict(linestyle="-"))]
        shown = error if has_exact_answer(series, path) else difference
        axis.legend(handles=[Line2D([], [], color=style.BLACK, label=words, **look) for words, look in shown],
                    loc="lower left", fontsize=7)
    part.supxlabel("requested tolerance", fontsize=9)


def failures(study):
    """Before all else: which runs are missing from the figure."""
    runs = study.get("failed_runs", {"count": 0})
    if not runs["count"]:
        return ""
    first = runs["first"]
    return f"{runs['count']} of {runs['of']} runs failed; the first ({first['run']}): {first['message']}. "


def message(series, quantities):
    """The content of the figure in a sentence or two."""
    sentences = []
    if study_result.has_meshes(series):
        verdicts = Counter(one.order(path)["verdict"] for one in series for _, path in quantities)
        (first, most), *others = [(IN_A_SENTENCE.get(verdict, verdict), count) for verdict, count in
                                  verdicts.most_common()]
        counted = ", ".join([f"{most} {'is' if most == 1 else 'are'} {first}",
                             *(f"{count} {words}" for words, count in others)])
        sentences.append(f"{verdicts.total()} orders: {counted}.")
        sentences += dominance(study_result.budget_series(series, quantities[0][1]), *quantities[0])
    stalled = [one for one in series if one.tolerances and _best(one, "certificate.gap") > 10 * _best(one, "requested")]
    for one in stalled:
        sentences.append(f"With {one.label}, the law of friction holds to a gap of {sci(_best(one, 'certificate.gap'))} at best, "
                         f"though its own test reads {sci(_best(one, 'change'))}.")
    if not stalled and any(one.tolerances for one in series):
        sentences.append("Every requested tolerance is reached.")
    return " ".join(sentences)


def _best(series, path):
    return np.nanmin(np.abs(numbers(series.tolerances, path)))


def dominance(series, words, path):
    """By how much the mesh outweighs all else that makes an error; or what else is too large."""
    table = series.budget(path)
    size = {part: np.abs(numbers(table, part)) for part in PARTS}
    rest = np.nansum([size[part] for part in PARTS[1:]], axis=0)
    times = size[PARTS[0]] / np.where(rest > 0, rest, np.nan)
    if np.isnan(times).all():
        return []
    if np.nanmin(times) >= 10:
        return [f"The mesh error of the {words} is at least {sci(np.nanmin(times))} times all its other errors together."]
    worst = int(np.nanargmin(times))
    largest = max(PARTS[1:], key=lambda part: np.nan_to_num(size[part][worst]))
    return [f"On {np.count_nonzero(times < 10)} of {len(table)} meshes other parts of the error of the {words} are above a "
            f"tenth of the mesh’s, most of all the {largest}."]


def details(series, quantities):
    sentences = []
    if study_result.has_meshes(series):
        size = numbers(series[0].meshes, "h")
        name, unit = unit_for(size.max(), LENGTHS)
        grids = max(mesh["grids"] for mesh in series[0].meshes)
        bars = f" Points are means over {grids} grids that lie differently under the contact; bars are their spread." \
            if grids > 1 else ""
        sentences.append(f"Cells of {size.min() / unit:.3g} to {size.max() / unit:.3g} {name}.{bars} Lines are fitted over "
                         "the meshes that they span; pale points take no part. Orders have their 95 % interval.")
        if any(known_from(series, path) for _, path in quantities):
            sentences.append("Grey: below the uncertainty of the extrapolated value no error is known.")
    if any(one.tolerances for one in series):
        mesh = series[0].meshes[-1]
        sentences.append(f"Tolerances on a mesh of {study_result.across(mesh)} cells across.")
        exact = [has_exact_answer(series, path) for _, path in quantities]
        if any(exact):
            sentences.append("The part left by stopping there is the change of the error when the iteration continues.")
        if not all(exact):
            sentences.append("Where no exact answer exists, the relative difference from the tightest run is shown.")
        shown = moved_by_tolerance([one for one in series if one.tolerances], quantities)
        if same := [words for words, path in quantities if (words, path) not in shown]:
            sentences.append(f"The same at each tolerance: {', '.join(same)}.")
    return " ".join(sentences)


def standalone(study):
    """With its message and details above."""
    drawn = draw(study)
    bold = textwrap.wrap(style.verbatim(drawn.message), int(11.5 * style.WIDTH))
    plain = textwrap.wrap(style.verbatim(f"{text(study, 'name')}. {drawn.details}"), int(15 * style.WIDTH))
    head = HEAD + LINE * (len(bold) + len(plain))
    figure = draw(study, head).figure
    width, height = figure.get_size_inches()
    figure.text(0.1 / width, 1 - 0.08 / height, "\n".join(bold), weight="bold", size=10, va="top", linespacing=1.4)
    figure.text(0.1 / width, 1 - (0.12 + LINE * len(bold)) / height, "\n".join(plain), va="top", linespacing=1.4)
    return figure


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", type=Path, help="result of `slipstick study --json`")
    parser.add_argument("figure", type=Path, help="figure to write: " + ", ".join(style.FORMATS))
    arguments = parser.parse_args(words)
    return script.run(lambda: style.write(standalone(load(arguments.result)), arguments.figure), (InputError, Unavailable),
                      arguments.figure)


if __name__ == "__main__":
    sys.exit(main())
