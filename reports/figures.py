"""The questions of a page and the figures that answer them, and the figures of the paper's validation: each a function that
takes its results and the folder of their data and returns a FigureEntry.

Errors against the exact solution come with the data; here they are only drawn.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.colors import Normalize

import exact_figures
import hard_cases
import literature_figure
import maps
import method_figures
import peers_figure
import scene_figures
import studies
import style
from cells import Cells
from figure_entry import LIMIT, LIMIT_WORDS, LOAD_LABEL, TWIST_LABEL, FigureEntry
from results import column, nearest, number, rows, text, value
from wording import percent, plain, sci


def shear_components(report, data_dir):
    profile = _highest_load(report)
    fields, traction = _fields(report, profile, data_dir)
    computed = [traction("q1"), traction("q2")]
    errors = [np.abs(q - traction(name)) for q, name in zip(computed, ("q1_exact", "q2_exact"))]
    stick_ratio = number(profile, "stick_ratio")
    limit = np.nanmax(np.abs(computed))

    figure, axes = style.panels(2, 2, 6.6, sharex=True, sharey=True)
    for i in (0, 1):
        top = maps.draw(axes[0, i], fields, computed[i], style.DIVERGING, Normalize(-limit, limit), stick_ratio)
        bottom = maps.draw(axes[1, i], fields, errors[i], style.ERRORS, maps.error_scale(errors), stick_ratio)
        axes[0, i].set_title(f"$q_{i + 1}$ computed")
        axes[1, i].set_title(f"$q_{i + 1}$: |computed − exact|")
    maps.label(axes)
    figure.colorbar(top, ax=axes[0, :], label="$q_i/(\\mu p_0)$", pad=0.02)
    figure.colorbar(bottom, ax=axes[1, :], label="error over $\\mu p_0$", extend="min", pad=0.02)
    load, largest, turned = _load(profile), np.nanmax(errors), np.nanmax(np.abs(computed[1] + computed[0].T))
    return FigureEntry(
        f"Each shear component is within {sci(largest)} μp₀ of the exact one in every cell.",
        f"The circle is the exact edge of the stick area, a<sub>s</sub>/a = {stick_ratio:.4f}. The colours of the "
        "errors are logarithmic. The paper observes that one component is the other turned by 90°. The paper divides by p₀ alone; to compare, multiply by the friction coefficient "
        f"μ&nbsp;=&nbsp;{plain(number(profile, 'result.friction'))}.",
        f"Four maps over the contact circle at {load} of the limiting moment: the computed components q1 and q2, each "
        "antisymmetric about one axis, and below them the absolute error of each.", figure,
        [(LIMIT_WORDS, load), ("largest error, μp₀", sci(largest)), ("median error, μp₀", sci(np.nanmedian(errors))),
         ("one component against the other turned, μp₀", sci(turned))], [text(profile, "fields")])


def traction_norm(report, data_dir):
    profile = _highest_load(report)
    fields, traction = _fields(report, profile, data_dir)
    computed = np.hypot(traction("q1"), traction("q2"))
    error = np.abs(computed - np.hypot(traction("q1_exact"), traction("q2_exact")))
    stick_ratio = number(profile, "stick_ratio")

    figure, axes = style.panels(1, 2, 3.0, sharex=True, sharey=True, squeeze=False)
    left = maps.draw(axes[0, 0], fields, computed, style.SEQUENTIAL, Normalize(0, np.nanmax(computed)), stick_ratio)
    right = maps.draw(axes[0, 1], fields, error, style.ERRORS, maps.error_scale(error), stick_ratio)
    axes[0, 0].set_title("norm of the traction, computed")
    axes[0, 1].set_title("|computed − exact|")
    maps.label(axes)
    figure.colorbar(left, ax=axes[0, 0], label="$|q|/(\\mu p_0)$", shrink=0.85)
    figure.colorbar(right, ax=axes[0, 1], label="error over $\\mu p_0$", extend="min", shrink=0.85)
    load, worst = _load(profile), np.unravel_index(np.nanargmax(error), error.shape)
    place = np.hypot(*(fields.extent[[2, 0]] + (np.array(worst) + 0.5) * fields.size[::-1]))
    return FigureEntry(
        f"The traction is furthest off, by {sci(error[worst])} μp₀, in a cell at r/a = {place:.3f}.",
        f"Inside the circle r = a<sub>s</sub> = {stick_ratio:.4f} a the surfaces stick, "
        "outside it they slip and |q| = μp.",
        f"Two maps over the contact circle at {load} of the limiting moment: a ring of high traction around the stick "
        "area, and the absolute error of the norm.", figure,
        [(LIMIT_WORDS, load), ("largest error, μp₀", sci(error[worst])), ("median error, μp₀", sci(np.nanmedian(error)))],
        [text(profile, "fields")])


def radial_profiles(report, data_dir):
    profiles = rows(report, "profiles")
    figure, axes = style.with_error_panel(len(profiles))
    medians = []
    for (top, bottom), profile in zip(axes.T, profiles):
        exact, cells = rows(profile, "exact"), rows(profile, "computed")
        radius, stick_ratio = column(cells, "radius"), number(profile, "stick_ratio")
        error = np.abs(column(cells, "error"))
        inside = [row for row in exact if number(row, "radius") <= stick_ratio]
        top.plot(column(inside, "radius"), column(inside, "printed"), "--", color=style.VERMILION, linewidth=0.9,
                 label="Eq. (1) as printed")
        top.plot(column(exact, "radius"), column(exact, "value"), color=style.BLACK, linewidth=0.9, label="exact",
                 zorder=3)
        top.plot(radius, column(cells, "value"), ".", color=style.SKY, markersize=6, rasterized=True,
                 label="computed, one point a cell")
        bottom.plot(radius, error, ".", color=style.SKY, markersize=3, rasterized=True)
        for axis in (top, bottom):
            axis.axvline(stick_ratio, color=style.GREY, linewidth=0.8, linestyle=":")
        top.set_title(f"$M/M_\\mathrm{{lim}}$ = {_load(profile)}, $a_s/a$ = {stick_ratio:.4f}")
        bottom.set_xlabel("radius $r/a$")
        medians.append((f"median error at {LIMIT}{_load(profile)}, μp₀", sci(np.nanmedian(error))))
    axes[0, 0].set(ylabel="traction $q/(\\mu p_0)$", xlim=(0, 1), ylim=(0, None))
    axes[1, 0].set_ylabel("|error| over $\\mu p_0$")
    style.whole_decades(axes[1, 0])
    style.legend_on_top(figure, axes[0, 0].get_legend_handles_labels()[0], 3)
    factor = max(_printed_over_exact(profile) for profile in profiles)
    return FigureEntry(
        f"The computed tractions lie on the exact curve; where it sticks, Eq. (1) as printed is {factor:.4f} times too "
        "large.",
        "π/2 = 1.5708: the printed branch lacks the factor 2/π and so jumps at the stick edge (dotted line), where the "
        "traction is continuous. The exact curve meets that edge with a vertical tangent, which no grid of cells can "
        "follow.",
        "Traction against radius at two loads: computed points on the exact curve, and the printed Eq. (1) as a dashed "
        "curve well above it in the stick area; below, the absolute error of each cell on a log scale.", figure,
        medians, [text(profile, "fields") for profile in profiles])


def stick_radius(report, data_dir):
    curve = rows(report, "curve")
    figure, axes = style.with_error_panel()
    top, bottom = axes[:, 0]
    top.plot(column(curve, "moment_ratio"), column(curve, "stick_ratio"), color=style.BLACK, label="exact")
    numbers = []
    for table, label, look in _by_method(report):
        load, error = column(table, "moment_ratio"), np.abs(column(table, "stick_radius_error"))
        top.plot(load, column(table, "stick_ratio"), linestyle="", label=f"computed, {label}", **look)
        bottom.plot(load, error, linestyle="", **look)
        numbers += [(f"largest error, {label}", sci(np.nanmax(error))), (f"median error, {label}", sci(np.nanmedian(error)))]
    top.set(ylabel="stick radius $a_s/a$", xlim=(0, 1), ylim=(0, 1.03))
    bottom.set(ylabel="|computed/exact − 1|", xlabel=LOAD_LABEL)
    style.whole_decades(bottom)
    style.legend_on_top(figure, top.get_legend_handles_labels()[0], 3)
    return FigureEntry(
        f"The computed stick radius is on the exact curve, off by at most {numbers[0][1]}.",
        f"{_cells(report)} The error is relative to the stick radius itself, which vanishes at the right end.",
        "Stick radius against moment: computed points on the exact falling curve, and their relative error below.",
        figure, numbers)


def twist(report, data_dir):
    curve = rows(report, "curve")
    load, formula_error = column(curve, "moment_ratio"), np.abs(column(curve, "equation_7_error"))
    figure, axes = style.with_error_panel(height=5.8)
    top, bottom = axes[:, 0]
    top.plot(load, column(curve, "twist"), color=style.BLACK, label="exact, Eqs. (4) and (5)")
    top.plot(load, column(curve, "equation_7"), "--", color=style.VERMILION, label="Eq. (7)")
    bottom.plot(load, formula_error, "--", color=style.VERMILION)
    loads = column(rows(report, "loading"), "moment_ratio")
    high = loads[nearest(loads, 0.9)]
    numbers = []
    for table, label, look in _by_method(report):
        computed_load, error = column(table, "moment_ratio"), np.abs(column(table, "twist_error"))
        top.plot(computed_load, column(table, "twist"), linestyle="", label=f"computed, {label}", zorder=3, **look)
        bottom.plot(computed_load, error, linestyle="", **look)
        numbers.append((f"computed, {label}", sci(error[nearest(computed_load, high)])))
    top.set(ylabel=TWIST_LABEL, xlim=(0, 1),
            ylim=(0, 1.1 * max(np.nanmax(column(table, "twist")) for table, *_ in _by_method(report))))
    bottom.set(ylabel="|value/exact − 1|", xlabel=LOAD_LABEL)
    bottom.set_ylim(bottom=_floor(report), top=1)
    style.whole_decades(bottom)
    style.legend_on_top(figure, top.get_legend_handles_labels()[0], 2)
    return FigureEntry(
        f"At {LIMIT}{plain(high)} Eq. (7), with which the paper compares, is off by "
        f"{percent(formula_error[nearest(load, high)])}; the error of the computed twist is {numbers[0][1]}.",
        "Eq. (7) is an approximation for small moments, printed as an equality. The “few percent” that the paper "
        f"puts down to discretisation are Eq. (7) itself. {_cells(report)}",
        "Twist against moment: computed points on the exact curve, with Eq. (7) falling below it at high moments; in "
        "the error panel Eq. (7) lies orders of magnitude above the computed points.", figure,
        [(f"error at {LIMIT}{plain(high)}: Eq. (7)", sci(formula_error[nearest(load, high)])), *numbers])


def convergence(report, data_dir):
    quantities = [("twist_error", "twist"), ("traction_error.l1", "traction, L1"),
                  ("stick_radius_error", "stick radius")]
    runs = studies.read(report)
    figure, axes = style.panels(1, 3, 3.7, sharex=True)
    for axis, (path, title) in zip(axes, quantities):
        axis.set(xscale="log", yscale="log", title=title, xlabel="cells across the grid")
        for study in runs:
            axis.plot(study.cells, np.abs(column(study.table, path)), **study.look)
        style.whole_decades(axis)
        studies.slope_triangles(axis)
        studies.cell_ticks(axis, runs)
    axes[0].set_ylabel("relative error")
    style.legend_on_top(figure, studies.handles(runs), 3)
    finest = [(study, study.table[-1]) for study in runs if study.pressure == "solved"] or [
        (study, study.table[-1]) for study in runs]
    numbers = [(f"{title}, {LIMIT}{study.load}", _sci_at(row, path)) for study, row in finest for path, title in quantities]
    study, row = finest[-1]
    return FigureEntry(
        f"At {study.cells[-1]:.0f} cells a side and {LIMIT}{study.load} the twist is off by {_sci_at(row, 'twist_error')}, "
        f"the traction by {_sci_at(row, 'traction_error.l1')}.",
        "Grey triangles fall as the cell size (order 1) and as its square (order 2). Norms are relative to that of the "
        "exact solution. The twist answers to the contact as a whole and so can converge faster than the traction "
        "in its cells.",
        "Three log-log panels of relative error against cells for twist, traction and stick radius, one line for each "
        "pressure and load, with triangles of slope one and two.", figure,
        [(f"error left with the {study.name}: {words}", found) for words, found in numbers])


def equation_5_digits(report, data_dir):
    table = rows(report, "equation_5_digits")
    complement, error = column(table, "stick_complement"), np.abs(column(table, "relative_error"))
    figure, axis = style.panels(1, 1, 3.6)
    shown = np.where(error > 0, error, np.nan)  # right to the last bit: nothing to show on a log scale
    axis.loglog(complement, shown, ".-", color=style.BLUE, linewidth=0.8, label="Eq. (5), double precision")
    axis.axhline(np.finfo(float).eps, color=style.GREY, linestyle=":", label="rounding of one number, 2.2×10⁻¹⁶")
    axis.invert_xaxis()
    axis.set(xlabel="$1 - a_s/a$   (towards full stick →)", ylabel="relative error of the moment")
    style.legend_on_top(figure, axis.get_legend_handles_labels()[0], 2)
    samples = [nearest(np.log(complement), np.log(wanted)) for wanted in (1e-2, 1e-4, 1e-6)]
    return FigureEntry(
        "Eq. (5) is right, but its terms cancel: it loses its digits as the stick radius nears the contact radius.",
        "Its terms stay of the size of the limiting moment while their sum, the moment, goes to zero. The exact "
        "solution used on this page is written as an integral of a positive function and keeps its digits.",
        "Relative error of Eq. (5) against one minus the stick ratio on log-log axes, rising steadily to the right.",
        figure, [(f"error at 1&nbsp;−&nbsp;a<sub>s</sub>/a&nbsp;=&nbsp;{sci(complement[i])}", sci(error[i])) for i in samples])


@dataclass
class Figure:
    """A figure of a page; one that has no `part`, "" all of it, has no such figure. draw(page, folder of its data)."""
    name: str
    title: str
    draw: Callable
    part: str = ""


@dataclass
class Section:
    """A question, and the figures that answer it; a page has it where it has one of them, or the part."""
    name: str
    question: str
    figures: list
    part: str = ""


def _paper(name, title, draw):
    """A figure of the paper's validation."""
    return Figure(name, title, lambda page, folder: draw(page["paper"], folder), "paper")


ANSWER = Figure("answer", "The answer", scene_figures.answer)
LEADS = [_paper("twist", "Twist and load (the paper’s Fig. 5)", twist), ANSWER]  # the first that a page has stands beside its verdict
SECTIONS = [
    Section("right", "Is the paper right?", [
        _paper("shear-components", "The two shear components (the paper’s Fig. 1)", shear_components),
        _paper("traction-norm", "The norm of the shear tractions (the paper’s Fig. 2)", traction_norm),
        _paper("radial-profiles", "Radial profiles (the paper’s Fig. 3)", radial_profiles),
        _paper("stick-radius", "Stick radius and load (the paper’s Fig. 4)", stick_radius),
        _paper("equation-5", "Where Eq. (5) loses its digits", equation_5_digits),
        _paper("methods", "The paper’s method and others", method_figures.methods),
        _paper("gap", "Gap in Coulomb’s law when the iteration stops", method_figures.certificate),
    ]),
    Section("what", "What is it?", [
        Figure("bodies", "The bodies", scene_figures.bodies),
    ]),
    Section("result", "What is the answer?", [
        ANSWER,
        Figure("loop", "The history", scene_figures.loop, "answer.steps"),
    ], "answer"),
    Section("errors", "How fast do errors fall?", [
        _paper("convergence", "Convergence with the mesh, by the pressure", convergence),
    ], "answer"),
    Section("costs", "What does an error cost?", [
        Figure("cost", "Error against time", scene_figures.cost, "cost"),
        Figure("operators", "Direct summation against convolution", scene_figures.operators, "operators"),
    ]),
    Section("hard", "Where does it break?", [
        _paper("hard-cases", "Hard scenes by each method", hard_cases.methods),
    ], "hard"),
    Section("others", "What do other programs say?", [
        Figure("programs", "Other programs", scene_figures.programs, "programs"),
        _paper("known-fields", "Fields of other programs, judged", peers_figure.peers),
    ]),
    Section("literature", "What does the literature say?", [
        Figure("published", "Published numbers", lambda page, folder: literature_figure.literature(page["paper"], folder),
               "paper.literature"),
    ]),
    Section("beyond", "What lies beyond the paper?", [
        _paper("friction-laws", "Other laws of friction", exact_figures.friction_laws),
        _paper("bodies-and-cycles", "Other bodies, and cycles", exact_figures.bodies_and_cycles),
        _paper("first-yield", "Where does it yield?", exact_figures.first_yield),
        _paper("solved-stresses", "Stresses of a solve below the surface", exact_figures.solved_stresses),
        _paper("cycle", "A cycle, computed step by step", exact_figures.computed_cycle),
        _paper("approximations", "Which approximation may be used", exact_figures.approximations),
    ]),
]
FIGURES = [LEADS[0], *(figure for section in SECTIONS for figure in section.figures)]


def has(page, part):
    """Whether a page has what stands at a dotted path; a list of one thing says no more than the thing itself."""
    for key in filter(None, part.split(".")):
        page = page.get(key) if isinstance(page, dict) else None
    return len(page) > 1 if isinstance(page, list) else page is not None


def _load(profile):
    return plain(number(profile, "moment_ratio"))


def _sci_at(row, path):
    found = value(row, path)
    return "not available" if found is None else sci(abs(found))


def _cells(report):
    return f"{number(report, 'loading_cells'):.0f} cells a side, pressure solved on the same grid."


def _floor(report):
    errors = np.abs(np.concatenate([column(table, "twist_error") for table, *_ in _by_method(report)]))
    return 0.3 * np.min(errors[errors > 0], initial=1e-6)


def _by_method(report):
    return method_figures.by_method(rows(report, "loading"))


def _printed_over_exact(profile):
    exact = [row for row in rows(profile, "exact") if number(row, "value") > 0]
    return np.nanmax(column(exact, "printed") / column(exact, "value"))


def _highest_load(report):
    return max(rows(report, "profiles"), key=lambda profile: number(profile, "moment_ratio"))


def _fields(report, profile, data_dir):
    """The cells of a profile over the contact radius, and a traction's grid over mu p0 by its name."""
    fields = Cells(data_dir / text(profile, "fields"), unit=number(report, "contact.radius"))
    scale = number(profile, "result.friction") * number(report, "contact.peak_pressure")
    return fields, lambda name: fields.grid(fields.columns[name]) / scale
