"""The result of `slipstick study`: its series, their looks in figures, and their main quantities."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

import style
from method_figures import METHODS
from results import Unavailable, rows, value
from studies import PRESSURES

PRESSURE, METHOD, PROGRAM = "contact.pressure", "solver.method", "solver.program"
COLOURS = [style.BLUE, style.VERMILION, style.GREEN, style.PURPLE, style.SKY, style.BLACK]
# Larger and hollow where points of another series lie on the same spots.
MARKERS = [dict(marker="o"), dict(marker="s", markersize=7.5, markerfacecolor="none"), dict(marker="^"),
           dict(marker="D", markersize=7, markerfacecolor="none"), dict(marker="v"), dict(marker="P")]
KNOWN_COLOURS = {PRESSURE: {name: colour for name, (_, colour) in PRESSURES.items()},
                 METHOD: {name: look["color"] for name, (_, look) in METHODS.items()}}
WORDS = {PRESSURE: {name: words for name, (words, _) in PRESSURES.items()},
         METHOD: {name: words for name, (words, _) in METHODS.items()}}

# A series takes the first that it has: the error against the exact answer, or the value.
MAIN = [("twist", ("twist_error", "twist_angle")), ("traction, L2", ("traction_error.l2",)),
        ("stick radius", ("stick_radius_error", "stick_radius")),
        ("contact radius", ("contact_radius_error", "contact_radius"))]
PARTS = ("discretisation", "iteration", "reference", "rounding")


@dataclass
class Series:
    """One combination of the varied values."""
    name: str
    varied: dict
    content: dict
    look: dict  # colour and marker

    @property
    def meshes(self):
        return rows(self.content, "meshes")

    def order(self, quantity):
        """The fit of a quantity; its name may have dots."""
        found = value(self.content, "order")
        if quantity not in found:
            raise Unavailable(f"series “{self.name}” has no order of “{quantity}”")
        return found[quantity]

    def budget(self, quantity):
        return [row for row in value(self.content, "budget") if row["quantity"] == quantity]

    def mean(self, quantity):
        """Errors on the meshes, without their signs."""
        return np.abs(numbers(self.meshes, quantity, "mean"))

    @property
    def tolerances(self):
        """On the finest mesh."""
        finest = self.meshes[-1]["cells"]
        return [row for row in self.content.get("tolerances", []) if row.get("cells", finest) == finest]

    @property
    def label(self):
        return ", ".join(word(key, chosen) for key, chosen in self.varied.items()) or self.name


def word(key, chosen):
    """A varied value as people say it; numbers with their key."""
    if key in WORDS:
        return WORDS[key].get(chosen, str(chosen))
    if key == PROGRAM:
        return Path(chosen).stem if chosen else "slipstick’s own solver"
    return f"{key} = {chosen}"


def _choices(series, keys):
    return list(dict.fromkeys(tuple(str(one["set"].get(key)) for key in keys) for one in series))


def _keys_of_looks(series):
    """The key for colours and the keys for markers; a single key is used for both."""
    keys = list(next(iter(series))["set"])
    coloured = PRESSURE if PRESSURE in keys else next(iter(keys), None)
    return coloured, [key for key in keys if key != coloured] or [coloured]


def read(study):
    """All series, in the study's order."""
    found = value(study, "series")
    if not found:
        raise Unavailable("the study has no series")
    coloured, marked = _keys_of_looks(found.values())
    colours, markers = _choices(found.values(), [coloured]), _choices(found.values(), marked)
    result = []
    for name, content in found.items():
        chosen = content["set"]
        colour = KNOWN_COLOURS.get(coloured, {}).get(
            chosen.get(coloured), COLOURS[colours.index((str(chosen.get(coloured)),)) % len(COLOURS)])
        marker = MARKERS[markers.index(tuple(str(chosen.get(key)) for key in marked)) % len(MARKERS)]
        result.append(Series(name, chosen, content, dict(marker, color=colour)))
    return result


def told_by(series):
    """The legends of colours and markers: two lists of (words, look), one of them for a single varied key, none
    without varied keys."""
    coloured, marked = _keys_of_looks([one.content for one in series])
    if coloured is None:
        return [], []
    markers = {tuple(one.varied[key] for key in marked): one.look for one in series}
    told = [(", ".join(map(word, marked, chosen)), look) for chosen, look in markers.items()]
    if marked == [coloured]:
        return [], told
    colours = {one.varied[coloured]: one.look["color"] for one in series}
    return [(word(coloured, chosen), colour) for chosen, colour in colours.items()], told


def has_meshes(series):
    """Whether there is more than one mesh."""
    return any(len(one.meshes) > 1 for one in series)


def main_quantities(series):
    """Up to four (words, path) that the first series has; none that is right on each mesh, as an imposed twist is."""
    orders = [path for path in value(series[0].content, "order")
              if not has_meshes(series) or not all((one.mean(path) == 0).all() for one in series)]
    found = [(words, path) for words, paths in MAIN for path in [next((p for p in paths if p in orders), None)] if path]
    return found or [(quantity_words(path), path) for path in orders[:4]]


def quantity_words(path):
    for words, paths in MAIN:
        if path in paths:
            return words
    return path.replace("_error", "").replace("_", " ").replace(".l", ", L").replace(".", ", ")


def numbers(table, path, inner=None):
    """One number of each row, NaN where it is null or missing; a path is one key, dots and all."""
    def one(row):
        found = row.get(path)
        if inner is not None and isinstance(found, dict):
            found = found.get(inner)
        return np.nan if found is None else float(found)
    return np.array([one(row) for row in table])


def budget_series(series, quantity):
    """The first series whose error has all its parts on some mesh."""
    for one in series:
        if any(all(row[part] is not None for part in PARTS) for row in one.budget(quantity)):
            return one
    return series[0]


def across(mesh):
    return max(value(mesh, "cells"))
