"""Tables of times and errors that `slipstick bench` measured."""

from plane_figure import milliseconds, power_of_ten, short
from results import Unavailable, groups, rows, value
from tables import Table
from scaling_figure import IN_WORDS
from wording import plain

QUANTITIES = {"twist": "twist", "traction_l2": "tractions, root mean square", "stick_radius": "stick radius"}


def times_to_errors(plane):
    """A row for each load, quantity and method: the least time to each error, with its mesh and tolerance."""
    errors = sorted({row["error"] for scene in rows(plane, "scenes") for row in rows(scene, "time_to")}, reverse=True)
    body = []
    for scene in rows(plane, "scenes"):
        load = plain(value(scene, "moment_ratio"))
        for (quantity, method), found in groups(rows(scene, "time_to"), "quantity", "method").items():
            if quantity not in QUANTITIES or method in ("any", "exact"):
                continue
            by_error = {row["error"]: row for row in found}
            body.append([load, QUANTITIES[quantity], method.replace("_", " "),
                         *(_time(by_error.get(error), scene) for error in errors)])
        if value(scene, "exact") is not None:
            time = milliseconds(value(scene, "exact.seconds.median"))
            body.append([load, "all", "exact, no grid", *[time] * len(errors)])
    return Table(["M/M<sub>lim</sub>", "error of", "method", *(f"to {power_of_ten(error)}" for error in errors)], body)


def _time(row, scene):
    if row is None or row["point"] is None:
        return "–"
    point = scene["points"][row["point"]]
    return f"{milliseconds(row['seconds'])}: {short(point, method=False)}".replace(" ms", "\N{NO-BREAK SPACE}ms")


def laws(scaling):
    """The fitted growth of each family, and the growth by theory."""
    body = []
    for found in rows(scaling, "families"):
        law = found["power_law"]
        if law["exponent"] is None:
            continue
        expected = "–" if law["expected"] is None else f"{law['expected']:.2f}"
        body.append([found["name"].replace("_", " "), f"{law['exponent']:.2f}", _interval(law, "{:.2f}".format),
                     expected, IN_WORDS.get(law["theory"], "–")])
    if not body:
        raise Unavailable("nothing was measured at three sizes or more")
    return Table(["what", "exponent", "95 % interval", "by theory", ""], body)


def _interval(found, write):
    return "–" if found["low"] is None or found["high"] is None else f"{write(found['low'])} to {write(found['high'])}"


def crossovers(scaling):
    body = []
    for row in rows(scaling, "crossovers"):
        cells = "–" if row["cells"] is None else f"{row['cells']:.3g}"
        body.append([row["quick"].replace("_", " "), row["slow"].replace("_", " "), cells,
                     _interval(row, "{:.3g}".format), row["remark"]])
    return Table(["is quicker than", "", "from cells a side", "95 % interval", "remark"], body)
