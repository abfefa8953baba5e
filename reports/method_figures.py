"""Figures that compare the methods for the slip-stick problem."""

import numpy as np

import style
from figure_entry import LIMIT, LOAD_LABEL, FigureEntry
from results import column, groups, number, rows
from studies import cell_ticks_at
from wording import plain, sci, seconds

METHODS = {"coulomb": ("Newton’s method for Coulomb’s law", dict(color=style.GREEN, marker="s")),
           # Larger and hollow: on a circle its points lie on the other’s.
           "paper": ("the paper’s method", dict(color=style.BLUE, marker="o", markersize=7.5, markerfacecolor="none"))}
OTHER = dict(color=style.BLACK, marker="v")


def by_method(table):
    """Rows as (rows, label, look of the marker and line), one entry a method."""
    return [(found, *METHODS.get(method, (method, OTHER))) for (method,), found in groups(table, "method").items()]


def methods(report, data_dir):
    figure, axes = style.panels(1, 3, 3.7)
    spheres, ellipses = rows(report, "methods"), rows(report, "ellipse")
    panels = [(spheres, "operator_applications", "work on the sphere", "applications of the operator"),
              (spheres, "seconds.traction", "time on the sphere", "time of the traction solve, s"),
              (ellipses, "slip_direction.mean", "error on an ellipse", "slip not opposed to traction, degrees")]
    for axis, (table, path, title, label) in zip(axes, panels):
        axis.set(xscale="log", yscale="log", title=title, ylabel=label, xlabel="cells across the grid")
        for found, name, look in by_method(table):
            axis.plot(_across(found), column(found, path), "-", label=name, **look)
        cell_ticks_at(axis, _across(table))
        style.whole_decades(axis)
    style.legend_on_top(figure, axes[0].get_legend_handles_labels()[0], 3)
    work = [(f"sphere, {name}", f"{number(found[-1], 'operator_applications'):.0f} applications, "
             f"{seconds(number(found[-1], 'seconds.traction'))} s, gap {sci(number(found[-1], 'certificate.gap'))}")
            for found, name, *_ in by_method(spheres)]
    turned = {name: _degrees(np.nanmax(column(found, "slip_direction.mean"))) for found, name, *_ in by_method(ellipses)}
    worst = max(by_method(ellipses), key=lambda each: np.nanmax(column(each[0], "slip_direction.mean")))[1]
    return FigureEntry(
        f"On an ellipse {worst} leaves slip misaligned with traction by up to {turned[worst]}, at every mesh.",
        f"The sphere is at {LIMIT}{plain(number(spheres[0], 'moment_ratio'))}, {_across(spheres)[-1]:.0f} cells a side. "
        "All work of Newton’s method is counted, that on coarser grids by its share of the cells; its applications hardly "
        "grow with the mesh. The paper’s method keeps the direction that a cell’s traction had when it began to slip, so no "
        "mesh reduces its error on an ellipse. Newton’s method stops on the certificate at gap / energy = 10⁻⁸, the paper’s "
        "on Eq. (26).",
        "Three log-log panels against cells across the grid, one line a method: applications of the operator, time, and on "
        "an ellipse the mean angle between slip and the reverse of traction.", figure,
        [*work, *((f"ellipse, slip direction, {name}", angle) for name, angle in turned.items())])


def certificate(report, data_dir):
    figure, axis = style.panels(1, 1, 3.4)
    numbers = []
    for table, label, look in by_method(rows(report, "loading")):
        gap = column(table, "certificate.gap")
        axis.semilogy(column(table, "moment_ratio"), gap, "-", linewidth=0.8, label=f"circle, {label}", **look)
        numbers.append((f"circle, {label}", f"{sci(np.nanmin(gap))} to {sci(np.nanmax(gap))}"))
    for table, label, look in by_method(rows(report, "ellipse")):
        axis.semilogy(column(table, "moment_ratio"), column(table, "certificate.gap"),
                      **look | dict(linestyle="", markersize=9, markerfacecolor="none", label=f"ellipse, {label}"))
        gap = column(table, "certificate.gap")
        numbers.append((f"ellipse, {label}", f"{sci(np.nanmin(gap))} to {sci(np.nanmax(gap))}"))
    axis.set(xlabel=LOAD_LABEL, ylabel="gap / energy", xlim=(0, 1))
    style.whole_decades(axis)
    style.legend_on_top(figure, axis.get_legend_handles_labels()[0], 2)
    return FigureEntry(
        f"When the iteration stops the gap in Coulomb’s law is {numbers[0][1]} of the energy by Newton’s method; on an "
        f"ellipse it is {numbers[-1][1]} by {label}.",
        "The gap adds up, over all cells, how far traction and slip are from Coulomb’s law; it is zero only where the "
        "law holds in every cell, it bounds the error in energy, and it needs no exact solution. The paper’s test, "
        f"Eq. (26), asks only whether the tractions still change. {number(report, 'loading_cells'):.0f} cells a side on the "
        "circle, pressure solved on the same grid.",
        "Certificate gap over energy against moment on a log scale, one line a method.", figure, numbers)


def _degrees(angle):
    return f"{angle:.2g}°" if angle >= 0.01 else f"{sci(angle)} of a degree"


def _across(table):
    return np.array([rows(row, "cells")[0] for row in table], float)
