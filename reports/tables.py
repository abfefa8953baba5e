"""The page's tables: which number stands in which column, and how it is written."""

from dataclasses import dataclass

from markupsafe import Markup

from results import Unavailable, rows, value
from wording import ANGLES, ENERGIES, LENGTHS, MOMENTS, plain, quantity, sci, seconds, signed_percent


@dataclass
class Table:
    head: list
    body: list


def _text(written):
    return str(written)


def _cells(cells):
    across, along = cells
    return f"{across}²" if across == along else f"{across}×{along}"


MESH = [
    ("pressure", "pressure", _text),
    ("M/M<sub>lim</sub>", "moment_ratio", plain),
    ("cells", "cells", _cells),
    ("twist error", "twist_error", sci),
    ("stick radius error", "stick_radius_error", sci),
    ("traction error L1", "traction_error.l1", sci),
    ("traction error L2", "traction_error.l2", sci),
    ("gap / energy", "certificate.gap", sci),
    ("iter&shy;ations", "iterations", _text),
    ("operator applica&shy;tions", "operator_applications", _text),
    ("pressure, s", "seconds.pressure", seconds),
    ("traction, s", "seconds.traction", seconds),
    ("total, s", "seconds.total", seconds),
]

LOADING = [
    ("M/M<sub>lim</sub>", "moment_ratio", plain),
    ("method", "method", _text),
    ("a<sub>s</sub>/a computed", "stick_ratio", plain),
    ("a<sub>s</sub>/a exact", "exact.stick_ratio", plain),
    ("error", "stick_radius_error", sci),
    ("twist computed", "twist", plain),
    ("twist exact", "exact.twist", plain),
    ("error", "twist_error", sci),
    ("gap / energy", "certificate.gap", sci),
    ("iter&shy;ations", "iterations", _text),
    ("operator applica&shy;tions", "operator_applications", _text),
    ("time, s", "seconds.total", seconds),
]

APPROXIMATIONS = [
    ("M/M<sub>lim</sub>", "moment_ratio", plain),
    ("exact twist", "twist", plain),
    ("twist by Eq.&nbsp;(7)", "equation_7.error", signed_percent),
    ("twist, small moments", "small_moments.error", signed_percent),
    ("twist, no slip", "no_slip.error", signed_percent),
    ("twist, DEM", "dem.error", signed_percent),
    ("DEM moment at the exact twist", "dem_moment.error", signed_percent),
]

UNITS = {"rad": ANGLES, "m": LENGTHS, "N m": MOMENTS, "J": ENERGIES}

GALLERY_HEAD = ["scene", "what it shows", "judged by", "computed", "reference", "error", "gap / energy",
                "applica&shy;tions", "steps", "cells along", "time, s"]


def gallery(report, link):
    """A row for each scene; link(stem) is the address of its file, or None."""
    return Table(GALLERY_HEAD, [_gallery_row(row, link(value(row, "scene"))) for row in rows(report, "gallery")])


def _gallery_row(row, address):
    def in_units(number):
        written = quantity(number, UNITS[row["unit"]], 6) if row["unit"] else plain(number)
        return written.replace(" ", "\N{NO-BREAK SPACE}")

    title = Markup('<a href="{}">{}</a>').format(address, row["title"]) if address else row["title"]
    reference = "–" if value(row, "reference") is None else f"{in_units(row['reference'])} {row['basis']}"
    error = _cell(row, "error", sci) if value(row, "error") is not None else _cell(
        row, "uncertainty", lambda number: "±" + sci(number))
    return [title, row["shows"], row["quantity"], _cell(row, "value", in_units), reference, error,
            _cell(row, "gap", sci), _cell(row, "operator_applications", "{:.0f}".format), _text(row["steps"]),
            _cell(row, "cells", max), _cell(row, "seconds", seconds)]


def table(report, name, columns):
    """A list of results as text; a number that is null or missing is a dash."""
    return Table([head for head, _, _ in columns],
                 [[_cell(row, path, write) for _, path, write in columns] for row in rows(report, name)])


def _cell(row, path, write):
    try:
        found = value(row, path)
    except Unavailable:
        found = None
    return "–" if found is None else write(found)
