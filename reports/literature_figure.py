"""Published numbers against the numbers of this program."""

import re

import numpy as np

import style
from figure_entry import FigureEntry
from results import Unavailable, rows, value
from tables import Table
from wording import sci

UNDECIDED = "cannot be compared at its digits"
LOOKS = {"agrees": {"color": style.GREEN, "marker": "o"}, "differs": {"color": style.VERMILION, "marker": "D"},
         UNDECIDED: {"color": style.GREY, "marker": "o", "markerfacecolor": "none"}, "✗ wrong": {"color": style.BLACK, "marker": "X"}}
SHOWN = (1e-3, 1e4)  # half units of the last digit; what lies beyond is drawn there


def outcome(row):
    word = row["published"]["comparison"]
    return UNDECIDED if word == "undecided" else word or "✗ wrong"


def author(row):
    """Author and year: "Hertz (1882)" of "Hertz (1882), J. reine angew. Math. 92", else the text before the comma."""
    return re.match(r"[^(:]*\(\d{4}\)|[^,:]*", row["published"]["source"])[0].strip()


def literature(report, data_dir):
    compared = [row for row in rows(report, "literature.gates") if "deviation" in value(row, "published")]
    if not compared:
        raise Unavailable("no published number was compared")
    sources = list(dict.fromkeys(map(author, compared)))
    figure, axis = style.panels(1, 1, 1.2 + 0.24 * len(sources))
    for name, look in LOOKS.items():
        drawn = [row for row in compared if outcome(row) == name]
        if drawn:
            axis.plot(np.clip([abs(row["published"]["deviation"]) for row in drawn], *SHOWN),
                      [sources.index(author(row)) for row in drawn], linestyle="", alpha=0.8, markersize=5, label=name, **look)
    axis.axvline(1, color=style.BLACK, linewidth=0.8)
    axis.set(xscale="log", xlim=(0.6 * SHOWN[0], 1.7 * SHOWN[1]), yticks=range(len(sources)), yticklabels=sources,
             xlabel="|ours − published| over half a unit of the last printed digit")
    axis.invert_yaxis()
    style.legend_on_top(figure, axis.get_legend_handles_labels()[0], 2)
    every = rows(report, "literature.gates")
    counts = {name: sum(outcome(row) == name for row in every) for name in ("agrees", "differs", UNDECIDED, "not compared", "✗ wrong")}
    wrong = f"; {counts['✗ wrong']} are wrong" if counts["✗ wrong"] else ""
    return FigureEntry(
        f"{counts['agrees']} of {len(every)} published numbers agree within their printed digits, {counts['differs']} differ for a "
        f"known reason, {counts[UNDECIDED]} cannot be compared at their digits, {counts['not compared']} not at all{wrong}.",
        "The line is half a unit of a number's last printed digit. A number agrees if its deviation is smaller than the sum of three "
        "parts: this half unit, the effect of the rounding of the printed argument, and our own error. Points somewhat right of the "
        "line can therefore agree. If our own error is larger than the other two parts, the number cannot be compared at its digits. "
        "Points beyond the axis are drawn at its ends.",
        "Deviations from published numbers, over half a unit of their last digit, on a log scale, a row for each source.",
        figure, [(f"sources: {len({author(row) for row in every})}; numbers", str(len(every))),
                 *((f"numbers: {name}", str(count)) for name, count in counts.items() if count)])


def table(report):
    body = []
    for row in rows(report, "literature.gates"):
        published = row["published"]
        ours = "–" if published.get("ours") is None else f"{published['ours']:.6g}"
        error = "–" if published.get("own_error") is None else sci(published["own_error_half_units"])
        seen = "" if published["seen"] == "the publication itself" else f" Seen in: {published['seen']}."
        body.append([published["source"] + "." + seen, row["id"], published["text"], ours, error, outcome(row),
                     published["differs"] or published["undecided"] or published["not_compared"] or row["why"]])
    return Table(["source", "number", "printed", "ours", "our error, half units of the last digit", "outcome", "why"], body)
