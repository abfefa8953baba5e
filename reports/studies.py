"""Mesh studies: the runs of each pressure at each load, and how they look in every figure."""

from dataclasses import dataclass

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter, ScalarFormatter

import style
from results import Unavailable, groups, number, rows
from wording import plain

PRESSURES = {"solved": ("pressure solved on the same grid", style.BLUE),
             "hertz": ("Hertz pressure at cell centres", style.VERMILION),
             "hertz_averaged": ("Hertz pressure averaged over cells", style.GREEN)}
LOAD_STYLES = [("o", "-"), ("s", "--"), ("^", ":")]


@dataclass
class Study:
    """The runs of one pressure at one load, coarse to fine."""
    pressure: str
    load: str
    table: list
    cells: np.ndarray
    look: dict

    @property
    def name(self):
        return PRESSURES[self.pressure][0]


def read(report):
    table = [dict(row, load=plain(number(row, "moment_ratio"))) for row in rows(report, "mesh")]
    loads = list(groups(table, "load"))
    studies = []
    for (pressure, load), runs in groups(table, "pressure", "load").items():
        if pressure not in PRESSURES:
            raise Unavailable(f"unknown pressure “{pressure}”")
        runs = sorted(runs, key=_across)
        marker, line = LOAD_STYLES[loads.index((load,)) % len(LOAD_STYLES)]
        studies.append(Study(pressure, load, runs, np.array([_across(row) for row in runs], float),
                             dict(marker=marker, linestyle=line, color=PRESSURES[pressure][1])))
    return studies


def _across(row):
    return rows(row, "cells")[0]


def handles(studies):
    pressures = [Line2D([], [], color=PRESSURES[name][1], label=PRESSURES[name][0])
                 for name in dict.fromkeys(study.pressure for study in studies)]
    looks = {study.load: study.look for study in studies}
    loads = [Line2D([], [], color=style.BLACK, marker=look["marker"], linestyle=look["linestyle"],
                    label=f"$M/M_\\mathrm{{lim}}$ = {load}") for load, look in looks.items()]
    return pressures + loads


def slope_triangles(axis):
    """Triangles of order 1 and 2 in the upper right corner, which falling errors leave free: from one apex down to twice
    the cells, each with its order."""
    (left, right), (bottom, top) = axis.get_xlim(), axis.get_ylim()
    end = right / 1.35
    apex = top / 1.6
    for order in (1, 2):
        foot = apex * 2.0**-order
        axis.add_line(Line2D([end / 2, end, end, end / 2], [apex, foot, apex, apex], color=style.GREY, linewidth=0.8, zorder=1,
                             linestyle="-" if order == 1 else (0, (4, 2))))
        axis.annotate(str(order), (end, foot), xytext=(2, 0), textcoords="offset points", va="bottom", fontsize=7.5,
                      color=style.GREY)
    axis.set(xlim=(left, right), ylim=(bottom, top))


def cell_ticks(axis, studies):
    cell_ticks_at(axis, np.concatenate([study.cells for study in studies]))


def cell_ticks_at(axis, cells):
    axis.set_xticks(sorted(set(cells)))
    axis.xaxis.set_major_formatter(ScalarFormatter())
    axis.xaxis.set_minor_formatter(NullFormatter())

