"""The page's tables: which number stands in which column, and how it is written."""

from dataclasses import dataclass

import study_result
from results import Unavailable, rows, value
from wording import plain, sci, seconds, signed_percent, typeset


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
    ("operator applica&shy;tions", "operator_applications", "{:.3g}".format),
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
    ("operator applica&shy;tions", "operator_applications", "{:.3g}".format),
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

GATES = [
    ("gate", "id", _text),
    ("outcome", "outcome", _text),
    ("quantity", "quantity", _text),
    ("value", "value", lambda found: sci(found) if isinstance(found, float) else str(found)),
    ("part of its bound", "factor", lambda part: f"{100 * part:.0f}\N{NO-BREAK SPACE}%"),
    ("why it matters", "reason", _text),
]

PEERS = [
    ("program", "program", _text),
    ("verdict", "verdict", _text),
    ("cells", "cells", _cells),
    ("moment error", "moment_error", sci),
    ("twist error", "twist_error", sci),
    ("traction error L2", "traction_error.l2", sci),
    ("slip direction, degrees", "slip_direction.mean", sci),
    ("gap / energy", "certificate.gap", sci),
    ("why", "why", typeset),
]


def _short(key):
    return key.rsplit(".", 1)[-1].replace("_", " ")


def _or_dash(found, write):
    return "–" if found is None else write(found)


def _two_digits(number):
    return f"{number:.2f}".replace("-", "−")


def study_orders(study):
    """The fitted orders of the main quantities, one row a series; None where there is one mesh."""
    series = study_result.read(study)
    if not study_result.has_meshes(series):
        return None
    body = []
    for words, path in study_result.main_quantities(series):
        for one in series:
            order = one.order(path)
            fitted = ["–", "–"] if order["value"] is None else [
                _two_digits(order["value"]), f"{_two_digits(order['low'])} to {_two_digits(order['high'])}"]
            body.append([words if one is series[0] else "", *map(str, one.varied.values()), *fitted,
                         _or_dash(order["expected"], "{:g}".format), order["verdict"].replace("_", " "),
                         typeset(order["why"])])
    return Table(["quantity", *map(_short, series[0].varied), "order", "95 % interval", "ex&shy;pected", "verdict", "why"],
                 body)


def study_expectations(study):
    """The order by theory, and its reason: a row for each reason."""
    series = study_result.read(study)
    reasons = {}
    for words, path in study_result.main_quantities(series):
        for one in series:
            order = one.order(path)
            reasons.setdefault((_or_dash(order["expected"], "{:g}".format), order["expected_why"]), []).append(
                (words, *(str(one.varied[key]) for key in (study_result.PRESSURE,) if key in one.varied)))
    return [("; ".join(", ".join(names) for names in dict.fromkeys(found)), expected, typeset(why))
            for (expected, why), found in reasons.items()]


BUDGET = [
    ("error", "observed", sci),
    ("discreti&shy;sation", "discretisation", sci),
    ("of which trend", "trend", sci),
    ("of which staircase", "staircase", sci),
    ("iteration", "iteration", sci),
    ("rounding ±", "rounding", sci),
    ("reference ±", "reference", sci),
]


def _in_budget(series):
    """The main quantities whose errors are known: on one mesh only quantities with an exact answer."""
    found = study_result.main_quantities(series)
    if study_result.has_meshes(series):
        return found
    return [(words, path) for words, path in found if all(one.order(path).get("basis") == "exact" for one in series)]


def has_budget(study):
    return bool(_in_budget(study_result.read(study)))


def study_budget(study):
    """One series: its first main quantity on every mesh, the others on the finest; and the series’ name."""
    series = study_result.read(study)
    quantities = _in_budget(series)
    one = study_result.budget_series(series, quantities[0][1])
    body = []
    for words, path in quantities:
        shown = one.budget(path) if path == quantities[0][1] else one.budget(path)[-1:]
        body += [[words, _cells(row["cells"]), *(_cell(row, key, write) for _, key, write in BUDGET)] for row in shown]
    return one.label, _without_empty(Table(["error of the", "cells", *(head for head, _, _ in BUDGET)], body))


def _without_empty(table):
    """Without columns that have dashes only."""
    kept = [k for k in range(len(table.head)) if any(row[k] != "–" for row in table.body)]
    return Table([table.head[k] for k in kept], [[row[k] for k in kept] for row in table.body])


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
