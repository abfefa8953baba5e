"""The stick ratio against the load, computed: a figure of the page in its smallest form."""

import style
from figure_entry import LOAD_LABEL, FigureEntry
from results import column, rows


def stick_ratio(page, folder):
    loading = rows(page, "paper.loading")
    loads, ratios = column(loading, "moment_ratio"), column(loading, "stick_ratio")
    figure, axes = style.panels(1, 1, 3.0)
    axes.plot(loads, ratios, "o-", color=style.BLUE)
    axes.set_xlabel(LOAD_LABEL)
    axes.set_ylabel("stick ratio $a_s/a$")
    return FigureEntry(f"The stick area shrinks to {ratios[-1]:.2g} of the contact's radius.",
                       f"{len(loads)} solves.",
                       "A falling curve: the stick ratio against the moment over its limit.", figure)
