"""Hard scenes: how each method ends on them, as a figure and as a map with a square for each scene."""

import numpy as np

import style
from figure_entry import FigureEntry
from method_figures import METHODS, OTHER
from results import rows, text, value

FIRST = "coulomb"
RIGHT = ("certified", "agrees")
# A verdict in words, its colour, and its mark on the map for those who see no colour.
VERDICTS = {
    "right": ("certified, or agrees with the certified answer", style.GREEN, ""),
    "refused": ("refused with a reason", "#d9d9d9", "–"),
    "not_converged": ("not converged, and says so", "#E69F00", "·"),
    "other_direction": ("slip does not oppose traction", "#EDA287", "/"),
    "wrong": ("another answer", style.VERMILION, "×"),
}


def _verdict(found):
    word = text(found, "verdict")
    if word in RIGHT:
        return "right"
    return "wrong" if word == "other_answer" else word


def by_method(table):
    """The answers of each method to the same scenes, the first method's first."""
    answers = {FIRST: table}
    for method in table[0].get("methods") or {}:
        answers[method] = [value(row, "methods")[method] for row in table]
    return answers


def _counts(answers):
    verdicts = [_verdict(found) for found in answers]
    return {verdict: verdicts.count(verdict) for verdict in VERDICTS}


def methods(report, data_dir):
    answers = by_method(rows(report, "hard.rows"))
    figure, (bars, profile) = style.panels(1, 2, 3.3, width_ratios=[3, 2])
    counts = {method: _counts(found) for method, found in answers.items()}
    for place, (method, found) in enumerate(counts.items()):
        left = 0
        for verdict, (_, colour, _) in VERDICTS.items():
            bars.barh(place, found[verdict], left=left, color=colour, height=0.62)
            if found[verdict] > 0.03 * len(answers[FIRST]):
                bars.text(left + 0.5 * found[verdict], place, found[verdict], ha="center", va="center", fontsize=8)
            left += found[verdict]
    bars.set(yticks=range(len(counts)), yticklabels=[_name(method).replace(" for ", "\nfor ") for method in counts],
             xlabel="scenes", xlim=(0, len(answers[FIRST])))
    bars.invert_yaxis()
    bars.grid(axis="y", visible=False)
    for method, found in answers.items():
        work = np.sort([float(value(row, "operator_applications")) for row in found if _verdict(row) == "right"])
        line, = profile.step(work, np.arange(1, len(work) + 1), where="post",
                             color=METHODS.get(method, ("", OTHER))[1]["color"])
        if len(work):
            profile.annotate(_name(method).split(" for ")[0], (work[-1], len(work)), xytext=(0, 3), ha="right",
                             textcoords="offset points", color=line.get_color(), fontsize=8,
                             path_effects=style.HALO)
    profile.set(xscale="log", xlabel="applications of the operator", ylabel="scenes solved right within as many",
                ylim=(0, 1.1 * len(answers[FIRST])))
    handles = [bars.barh(0, 0, color=colour, label=words) for words, colour, _ in VERDICTS.values()]
    style.legend_on_top(figure, handles, 2)
    message, details, alt, numbers = _texts(counts, len(answers[FIRST]))
    return FigureEntry(message, details, alt, figure, numbers)


def _texts(counts, total):
    """Message, details, alternative text and numbers."""
    first = counts[FIRST]
    numbers = [(f"{_name(method)}: {words}", str(found[verdict])) for method, found in counts.items()
               for verdict, (words, _, _) in VERDICTS.items() if found[verdict]]
    message = (f"{_name(FIRST)} certifies {first['right']} of {total} hard scenes and refuses {first['refused']} with a "
               f"reason; {first['not_converged'] + first['wrong']} do not converge or are wrong.")
    details = (
        "The scenes: loads next to nothing and next to the limit, ugly "
        "contacts, extreme materials, odd grids. An answer agrees within 1&nbsp;% of twist, moment and energy of the "
        "certified one on the same grid; slip does not oppose traction where its mean angle is above one degree and costs "
        "more than 10⁻⁶ of the energy. <a href=\"#map\">The map</a> shows each scene.")
    alt = (f"Bars of {total} scenes, one for each method, by how they end, and beside them the number of scenes solved "
           "right against applications of the operator.")
    return message, details, alt, numbers


def _name(method):
    return METHODS.get(method, (method, OTHER))[0]


def square_map(report):
    """For the page: the methods’ names, the legend, and for each family a list of squares for each method."""
    answers = by_method(rows(report, "hard.rows"))
    families = []
    for family, about in value(report, "hard.families").items():
        squares = {method: [_square(row, found) for row, found in zip(answers[FIRST], all_found)
                            if row["family"] == family] for method, all_found in answers.items()}
        families.append({"name": family.replace("_", " "), "why": text(about, "why"), "squares": squares})
    legend = [(verdict, words, mark) for verdict, (words, _, mark) in VERDICTS.items()]
    return {"methods": [(method, _name(method)) for method in answers], "families": families, "legend": legend}


def _square(row, found):
    verdict = _verdict(found)
    about = [row["family"].replace("_", " "), row["case"], found["verdict"].replace("_", " ")]
    if found.get("reason"):
        about.append(found["reason"])
    for words, path, look in (("applications", "operator_applications", "{:.3g}"), ("s", "seconds.total", "{:.2g}"),
                              ("error", "error", "{:.1e}"), ("of the certified answer away", "difference", "{:.1e}")):
        if found.get(path) is not None:
            about.append(f"{look.format(found[path])} {words}")
    return {"verdict": verdict, "mark": VERDICTS[verdict][2], "about": "; ".join(about)}
