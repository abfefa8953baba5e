"""Figures of the exact solutions: one function for each figure, as in figures.py."""

import numpy as np
from markupsafe import escape
from matplotlib.ticker import LogLocator

import style
from figure_entry import LIMIT, LOAD_LABEL, TWIST_LABEL, FigureEntry
from results import Unavailable, column, nearest, number, rows, text, value
from wording import percent, plain, rounded_down, sci

LAWS = {"equation_7": ("Eq. (7)", dict(color=style.VERMILION, linestyle="--")),
        "small_moments": ("small moments", dict(color=style.PURPLE, linestyle="-.")),
        "no_slip": ("no slip", dict(color=style.BLUE, linestyle="--")),
        "dem": ("discrete elements (DEM)", dict(color=style.SKY, linewidth=4, zorder=1.5))}
FRICTIONS = {"coulomb": ("Coulomb", style.BLACK), "tresca": ("strength", style.VERMILION), "capped": ("capped", style.BLUE),
             "power": ("square root", style.GREEN)}
BODIES = {"hertz": ("sphere", style.BLACK), "cone": ("cone", style.VERMILION),
          "flat_punch": ("flat punch", style.BLUE)}


def approximations(report, data_dir):
    table = rows(report, "approximations")
    load, exact = column(table, "moment_ratio"), column(table, "twist")
    limit = number(table[-1], "moment") / number(table[-1], "moment_ratio")
    dem_load, dem_error = column(table, "dem_moment.moment") / limit, column(table, "dem_moment.error")
    cap, worst = np.nanmax(dem_load), int(np.nanargmax(np.abs(dem_error)))

    figure, (left, right) = style.panels(1, 2, 4.0)
    figure.get_layout_engine().set(wspace=0.06)
    left.plot(exact, load, color=style.BLACK, label="exact", zorder=3)
    numbers = []
    for key, (label, look) in LAWS.items():
        error = np.abs(column(table, f"{key}.error"))
        if key == "dem":
            left.plot(exact, dem_load, **look, label=label)
        else:
            left.plot(column(table, f"{key}.twist"), load, **look, label=label)
        right.semilogy(load, np.where(error > 0, error, np.nan), **look)
        bounds = [_load_within(load, error, bound) for bound in (0.01, 0.1)]
        right.plot(bounds, (0.01, 0.1), "o", color=look["color"], markeredgecolor=style.BLACK, markersize=4, zorder=4,
                   clip_on=False)
        numbers.append((f"{label}: within 1&nbsp;% (10&nbsp;%) up to", "{} ({})".format(*map(rounded_down, bounds))))
    left.axhline(1, color=style.GREY, linestyle=":", zorder=1)
    left.annotate(f"DEM cap, {percent(cap - 1)} above all\nthat the sphere can carry", (0.98, cap), xytext=(0, 6),
                  xycoords=left.get_yaxis_transform(), textcoords="offset points", ha="right", va="bottom")
    left.set(xlabel=TWIST_LABEL, ylabel=LOAD_LABEL, xlim=(0, exact[nearest(load, 0.99)]), ylim=(0, cap + 0.2))
    for bound in (0.01, 0.1):
        right.axhline(bound, color=style.GREY, linestyle=":", zorder=1)
        right.annotate(percent(bound), (1, bound), xycoords=right.get_yaxis_transform(), xytext=(4, 0),
                       textcoords="offset points", va="center")
    right.set(xlabel=LOAD_LABEL, ylabel="error of the twist, |law/exact − 1|", xlim=(0, 1), ylim=(1e-4, 1))
    style.legend_on_top(figure, left.get_legend_handles_labels()[0], 3)
    return FigureEntry(
        f"No simple law holds next to the limit, and discrete element codes carry {percent(cap - 1)} more than the sphere can.",
        "<em>Eq. (7)</em> is the paper’s. <em>Small moments</em>: the exact law to second order, "
        "(3/16)&nbsp;M&nbsp;+&nbsp;(9/64)&nbsp;M² with M in μWa. <em>No slip</em>: the contact is bonded and the twist "
        "grows in proportion, (3/16)&nbsp;M (Reissner and Sagoci, 1944). <em>DEM</em>: codes that follow many grains, "
        "the discrete element method, give each contact a spring and let it spin freely beyond (2/3)&nbsp;μWa, as if "
        "the pressure were uniform (e.g. Marshall, 2009); codes differ in the spring, here it is that of no slip, so "
        "the two lines coincide up to the cap. The error of the DEM moment is taken at the exact twist. Dots: where an "
        "error reaches 1&nbsp;% and 10&nbsp;%.",
        "Left, moment against twist: the exact curve bends towards the limiting moment, three laws reach it at finite "
        "twists, and that of discrete element codes goes straight up to a cap above it. Right, the error of the twist "
        "by each law against moment, on a log scale.", figure,
        [*numbers, (f"moment of the DEM law off at {LIMIT}{load[worst]:.2g}, by over",
                    f"{rounded_down(100 * abs(dem_error[worst]))}&nbsp;%")])


def bodies_and_cycles(report, data_dir):
    figure, axes = style.panels(1, 3, 4.1)
    limits = _draw_bodies(axes[0], rows(report, "bodies"))
    peak, residual = _draw_loop(axes[1], value(report, "loop"))
    within, far, ratio = _draw_cycle_energy(axes[2], rows(report, "cycle_energy"))
    style.legend_on_top(figure, [handle for axis in axes for handle in axis.get_legend_handles_labels()[0]], 3)
    return FigureEntry(
        f"Each body slips as a whole at a moment of its own; a sphere twisted to {LIMIT}{plain(peak)} keeps "
        f"{percent(residual)} of its twist.",
        "All of it is exact, under a constant W. After a reversal the twist follows the curve of first loading "
        "enlarged twice (Masing’s rule); where the inner loop closes, the contact has forgotten it and goes on along "
        "the outer one. For small amplitudes the energy lost grows with the cube of the moment (Deresiewicz, 1954).",
        "Three panels. Twist against moment for sphere, cone and flat punch, each growing without bound at its own "
        "limiting moment. A hysteresis loop of the sphere with a smaller loop in it. Energy lost in a cycle against "
        "amplitude on log-log axes, rising above the dashed cube law at large amplitudes.", figure,
        [*limits, ("cube law of the energy lost: within 10&nbsp;% up to", f"{rounded_down(within)}&nbsp;M<sub>lim</sub>"),
         (f"energy lost over that law at {far:.2g}&nbsp;M<sub>lim</sub>", f"{ratio:.2g}")])


def computed_cycle(report, data_dir):
    """Computed points on the exact loop, and their distance from it over the largest twist."""
    loop, table = rows(value(report, "loop"), "rows"), rows(value(report, "cycle"), "rows")
    figure, (left, right) = style.panels(1, 2, 3.8, width_ratios=[3, 2])
    left.plot(column(loop, "moment_ratio"), column(loop, "twist"), color=style.BLACK, label="exact, by Masing’s rule")
    load, twist, exact = (column(table, key) for key in ("moment_ratio", "twist", "exact"))
    left.plot(load, twist, "s", color=style.GREEN, label="computed, one point a step", zorder=3)
    left.set(xlabel=LOAD_LABEL, ylabel=TWIST_LABEL, xlim=(-1, 1))
    error = np.abs(twist - exact) / np.abs(exact).max()
    right.semilogy(np.arange(1, len(error) + 1), np.where(error > 0, error, np.nan), "s", color=style.GREEN)
    right.set(xlabel="step", ylabel="|computed − exact| over the largest twist")
    style.whole_decades(right)
    style.legend_on_top(figure, left.get_legend_handles_labels()[0], 2)
    across = rows(value(report, "cycle"), "cells")[0]
    return FigureEntry(
        f"The computed loop is the exact one to {sci(error.max())} of its largest twist, inner loop and all.",
        f"{across} cells a side, {len(error)} steps, pressure solved on the same grid. Each branch is the curve of first "
        "loading enlarged twice; where the inner loop closes, the contact goes on along the outer one.",
        "Left, twist against moment: a hysteresis loop with a smaller one in it, computed points on the exact curve. Right, "
        "their distance from it, step by step, on a log scale.", figure,
        [("largest distance, over the largest twist", sci(error.max())), ("steps", str(len(error))),
         ("energy lost in the last step, J", sci(number(table[-1], "dissipated")))])


def friction_laws(report, data_dir):
    """Tractions along the radius under each law, computed and exact, and the errors of twists by mesh."""
    figure, (left, right) = style.panels(1, 2, 4.0)
    numbers = []
    for entry in rows(report, "beyond"):
        name, table = text(entry, "name"), rows(entry, "rows")
        label, colour = FRICTIONS.get(name, (name, style.PURPLE))
        points = sorted(rows(entry, "profile"), key=lambda point: number(point, "radius"))
        radius = column(points, "radius")
        left.plot(radius, column(points, "exact"), color=colour, label=style.verbatim(label))
        every = max(1, len(radius) // 30)
        left.plot(radius[::every], column(points, "value")[::every], "o", color=colour, markersize=4)
        cells = np.array([row["cells"][0] for row in table])
        right.loglog(cells, np.abs(column(table, "twist_error")), "o-", color=colour)
        right.loglog(cells, np.abs(column(table, "moment_limit_error")), "s:", color=colour, markersize=4)
        numbers.append((f"{escape(label)}: twist, limit moment off at {cells[-1]} cells",
                        "{}, {}".format(*(sci(abs(number(table[-1], key))) for key in ("twist_error", "moment_limit_error")))))
    left.plot([], [], "o", color=style.GREY, label="computed")
    right.plot([], [], "o-", color=style.GREY, label="twist")
    right.plot([], [], "s:", color=style.GREY, label="limit moment")
    left.set(xlabel="radius $r/a$", ylabel="traction over the bound’s reference", xlim=(0, 1), ylim=(0, None))
    right.set(xlabel="cells a side", ylabel="relative error")
    right.set_xticks(cells, [f"{count}" for count in cells])
    right.minorticks_off()
    style.legend_on_top(figure, [handle for axis in (left, right) for handle in axis.get_legend_handles_labels()[0]], 4)
    return FigureEntry(
        "Friction need not be μp: the exact solution and the solver take any bound of the traction.",
        "The paper’s sphere at 0.7 of each limit moment. <em>Coulomb</em>: μp. <em>Strength</em>: the same shear strength "
        "wherever the bodies touch (Tresca). <em>Capped</em>: μp, and no more than a strength. <em>Square root</em>: in "
        "proportion to √p. Tractions are over μp₀, the strength, μp₀, and the bound at the centre. A strength acts in all of each "
        "cell that the contact’s edge cuts, so its limit moment is of first order; the twist at a part of that limit is not.",
        "Left, tractions against radius under four laws, computed points on exact curves, which rise from zero on the axis to "
        "the stick radius and follow each law beyond. Right, errors of twist and limit moment against cells on log-log axes.",
        figure, numbers)


def first_yield(report, data_dir):
    """The normal load at first yield against moment and friction, and where the largest stress is."""
    data = value(report, "first_yield")
    figure, (left, *maps) = style.panels(1, 3, 3.4, width_ratios=[1.3, 1, 1])
    numbers = []
    for curve, colour in zip(rows(data, "curves"), (style.BLACK, style.BLUE, style.GREEN, style.PURPLE, style.VERMILION)):
        table, friction = rows(curve, "rows"), number(curve, "friction")
        load, stress, depth = (column(table, key) for key in ("moment_ratio", "von_mises", "depth"))
        smallest = stress[np.argmax(depth)]  # below the axis, where torsion adds nothing
        share, surface = (smallest / stress) ** 3, depth < 1e-3
        left.plot(load, share, color=colour, label=f"μ = {friction:g}")
        left.plot(load[surface], share[surface], "o", color=colour, markersize=4)
        first = f"from {LIMIT}{load[surface][0]:.3f} on" if surface.any() else "at no moment drawn"
        numbers.append((f"μ = {friction:g}: first yield at the surface", first))
    left.plot([], [], "o", color=style.GREY, markersize=4, label="at the surface")
    left.set(xlabel=LOAD_LABEL, ylabel="normal load at first yield,\nover that without torsion", xlim=(0, 1), ylim=(0, 1.05))
    drawn = [np.array(entry["von_mises"]) for entry in rows(data, "maps")]
    levels = np.arange(0, max(stress.max() for stress in drawn) + 0.1, 0.1)
    for axis, entry, stress in zip(maps, rows(data, "maps"), drawn):
        radius, depth = (number(entry, "spacing") * np.arange(count) for count in stress.shape[::-1])
        filled = axis.contourf(radius, depth, stress, levels, cmap="viridis")
        row, at = np.unravel_index(stress.argmax(), stress.shape)
        axis.plot(radius[at], depth[row], "*", color=style.VERMILION, markersize=13, markeredgecolor="white", clip_on=False)
        moment = number(entry, "moment_ratio")
        axis.set_title("without torsion" if moment == 0 else f"$M/M_\\mathrm{{lim}}$ = {moment:g}, μ = {number(entry, 'friction'):g}")
        axis.set(xlabel="radius $r/a$", aspect="equal", ylim=(1, 0), ylabel="depth $z/a$" if axis is maps[0] else "")
    figure.colorbar(filled, ax=maps, label="von Mises stress / $p_0$", shrink=0.8, ticks=levels[::2], format="%.1f")
    style.legend_on_top(figure, left.get_legend_handles_labels()[0], 6)
    return FigureEntry(
        "Torsion moves the place of first yield from below the axis to the surface, where the friction is above about 0.3.",
        f"Exact, under a sphere, with Poisson’s ratio {number(data, 'poisson'):g}. Without torsion a sphere yields first below the axis "
        "(Huber, 1904), where torsion adds no stress. The tractions of the slip ring add most at its inner edge, at the surface. The "
        "normal load at first yield grows with the cube of the yield stress over the largest von Mises stress. Stars: the largest stress.",
        "Left, the normal load at first yield against moment for five frictions: each curve is flat at one, then falls from the moment "
        "at which the place jumps to the surface. Right, two maps of von Mises’ stress by radius and depth: without torsion the largest "
        "is below the axis, at half the contact radius, with torsion it is at the surface.", figure, numbers)


MEASURES = {"von_mises": "von Mises stress", "shear": "largest shear"}


def solved_stresses(report, data_dir):
    """Stresses of a solve and exact ones on the two sides of the axis, and the error of all components by mesh."""
    data = value(report, "first_yield")
    exact, solved = rows(data, "maps")[-1], value(data, "solved")
    figure, axes = style.panels(3, 2, 6.4, height_ratios=[1, 1, 1.25])
    spacing, numbers = number(exact, "spacing"), []
    for measure, line in zip(MEASURES, axes):
        right = np.array(exact[measure])[1:]  # from one spacing below the surface on, as in the solve
        levels = np.linspace(0, np.ceil(right.max() * 20) / 20, 16)
        off, values = 0.0, {}
        for axis, plane in zip(line, rows(solved, "planes")):
            left, name = np.array(plane[measure]), text(plane, "plane")
            radius, depth = spacing * np.arange(right.shape[1]), spacing * np.arange(1, right.shape[0] + 1)
            for side, stress in ((-1, left), (1, right)):
                filled = axis.contourf(side * radius, depth, stress, levels, cmap="viridis")
                row, at = np.unravel_index(stress.argmax(), stress.shape)
                axis.plot(side * radius[at], depth[row], "*", color=style.VERMILION, markersize=12, markeredgecolor="white")
                values[side] = f"{stress[row, at]:.4f}&nbsp;p₀ at {radius[at]:.2f}a, {depth[row]:.2f}a deep"
            axis.axvline(0, color="white", linewidth=1.5)
            for x, words in ((-0.95, "solved"), (0.95, "exact")):
                axis.text(x, 0.93, words, color="white", ha="center", va="bottom", weight="bold")
            axis.set(title=f"plane $x_{name[1]}$–$x_3$", xlabel=f"$x_{name[1]}/a$", aspect="equal",
                     ylim=(1, 0), ylabel="depth $x_3/a$" if axis is line[0] else "")
            off = max(off, np.abs(left - right).max())
        figure.colorbar(filled, ax=list(line), label=f"{MEASURES[measure]} / $p_0$", ticks=levels[::5], format="%.2f")
        numbers += [(f"{MEASURES[measure]}, solved", values[-1]), (f"{MEASURES[measure]}, exact at the same points", values[1]),
                    (f"{MEASURES[measure]}: largest difference", f"{sci(off)}&nbsp;p₀")]
    for axis in axes[2]:
        axis.remove()
    errors = figure.add_subplot(axes[2, 0].get_gridspec()[2, :])
    table = rows(solved, "errors")
    cells, error = np.array([value(row, "cells")[0] for row in table]), column(table, "stress_error.max")
    errors.loglog(cells, error, "o-", color=style.BLUE, label="largest error of six components")
    errors.loglog(cells, error[-1] * (cells[-1] / cells)**2, "--", color=style.GREY, label="order 2")
    errors.set(xlabel="cells across the grid", ylabel="error / largest stress", title="0.4$a$ below the surface")
    errors.set_xticks(cells, [f"{count:g}" for count in cells])
    errors.minorticks_off()
    style.whole_decades(errors)
    errors.legend()
    numbers.insert(0, ("order of the error at 0.4a, by the two finest meshes",
                       f"{np.log(error[-2] / error[-1]) / np.log(cells[-1] / cells[-2]):.2f}"))
    across = value(solved, "cells")[0]
    return FigureEntry(
        f"A solve on {across:g} × {across:g} cells finds the stresses below the surface, and the place of the largest there.",
        f"The paper’s sphere at {LIMIT}{number(exact, 'moment_ratio'):g} with μ = {number(exact, 'friction'):g}, down from {spacing:g}a, "
        "about one cell. Closed influence coefficients of a cell give the stresses of the solve (Love, 1929; Cerruti). Stars: the largest "
        "stress in each half. The largest shear is half of Tresca’s stress. At a fixed depth of more than a cell the error is of order two; "
        "on the surface, where the largest of all is, the jumps between cells dominate.",
        "Four maps of stress by position and depth, von Mises’ stress above and the largest shear below, in two planes. The left half of "
        "each is solved, the right half exact, and both look alike: the stars stand at the same place under the slip ring. Below, "
        "errors at a depth of 0.4a fall with the cells along a line of order two, on log-log axes.", figure, numbers)


def _draw_bodies(axis, bodies):
    """Twist and load of each body; returns the limiting moments, as numbers of a FigureEntry."""
    limits, ends = [], []
    for body in bodies:
        name, table = text(body, "profile"), rows(body, "rows")
        label, colour = BODIES.get(name, (name, style.PURPLE))
        limit, full_stick = number(body, "moment_limit"), number(body, "full_stick")
        moment, twist = column(table, "moment"), column(table, "twist")
        axis.plot(moment, twist, color=colour, label=style.verbatim(label))
        axis.axvline(limit, color=colour, linestyle=":", linewidth=1)
        limits.append((f"limit moment, {escape(label)}", f"{limit:.3f}&nbsp;μWa"))
        if full_stick > 0:
            axis.plot(full_stick * limit, np.interp(full_stick * limit, moment, twist), "o", color=colour, zorder=3)
            limits.append((f"{escape(label)}: sticks everywhere up to", f"{full_stick:.3f}&nbsp;M<sub>lim</sub>"))
        ends.append(twist[-1])
    axis.plot([], [], ":", color=style.GREY, label="limiting moment")
    axis.plot([], [], "o", color=style.GREY, label="end of full stick")
    axis.set(title="three bodies", xlabel="moment $M/(\\mu Wa)$", ylabel=TWIST_LABEL, xlim=(0, None),
             ylim=(0, min(ends)))
    return limits


def _draw_loop(axis, loop):
    """Twist and load along a history; returns its first turning point and the twist that remains without load."""
    table = rows(loop, "rows")
    load, twist = column(table, "moment_ratio"), column(table, "twist")
    turns = np.flatnonzero(np.diff(np.sign(np.diff(load)))) + 1
    axis.plot(load, twist, color=style.BLACK)
    axis.plot(load[turns], twist[turns], "D", color=style.PURPLE, label="turning point", zorder=3)
    axis.set(title="up and down (sphere)", xlabel=LOAD_LABEL, ylabel=TWIST_LABEL, xlim=(-1, 1))
    if turns.size < 2:
        raise Unavailable("“loop” does not turn back twice")
    back = slice(turns[1], turns[0] - 1, -1)  # from the first turning point to the second, by rising moment
    return load[turns[0]], np.interp(0, load[back], twist[back]) / twist[turns[0]]


def _draw_cycle_energy(axis, table):
    """Energy lost and amplitude; returns how far the cube law holds to 10 %, and a large amplitude and its excess."""
    load, energy, cube = (column(table, name) for name in ("moment_ratio", "energy", "small_amplitude"))
    axis.loglog(load, energy, color=style.BLACK)
    axis.loglog(load, cube, "--", color=style.GREEN, label="cube law, small amplitudes")
    axis.xaxis.set_major_locator(LogLocator(numticks=9))
    axis.set(title="a cycle’s loss (sphere)", xlabel="amplitude $M/M_\\mathrm{lim}$",
             ylabel="energy $Ga/(\\mu W)^2$ per cycle")
    high = nearest(load, 0.9)
    return _load_within(load, np.abs(cube / energy - 1), 0.1), load[high], energy[high] / cube[high]


def _load_within(load, error, bound):
    """Up to which load the error, zero at first, stays within a bound."""
    beyond = np.flatnonzero(error > bound)
    if beyond.size == 0:
        return load[-1]
    upto = slice(max(beyond[0] - 1, 0), beyond[0] + 1)
    return np.interp(bound, error[upto], load[upto])
