"""A small made-up data set that a page is drawn from, and pages drawn from it for tests."""

import io
import json
import sys
import tempfile
import unittest
import warnings
from contextlib import redirect_stderr
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG

REPORTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPORTS))

import render  # noqa: E402
import style  # noqa: E402

RADIUS, PEAK, FRICTION = 2.0, 3.0, 0.5


def solve_result(load, cells, pressure="solved", method="paper"):
    error = 1.0 / cells**2
    return {
        "method": method, "pressure": pressure, "moment_ratio": load, "cells": [cells, cells], "friction": FRICTION,
        "stick_ratio": 1 - load, "twist": load, "twist_error": error, "stick_radius_error": -error,
        "traction_error": {"l1": error, "l2": 2 * error, "max": 3 * error},
        "exact": {"stick_ratio": 1 - load, "twist": load},
        "iterations": 7, "operator_applications": 14, "certificate": {"gap": 1e-5 * (1 + load)},
        "slip_direction": {"mean": 2.4 if method == "paper" else 1e-7},
        "seconds": {"setup": 0.1, "pressure": 0.2, "traction": 0.3, "total": 1e-4 * cells**2},
    }


def profile(load):
    points = [{"radius": r, "value": 1 + r, "printed": 2 * (1 + r)} for r in (0.0, 0.25, 0.5, 0.75, 1.0)]
    cells = [{"radius": r, "value": 1.01 + r, "exact": 1 + r, "error": 0.01} for r in (0.2, 0.6, 0.9)]
    return {"moment_ratio": load, "stick_ratio": 0.5, "exact": points, "computed": cells,
            "fields": f"fields-{load}.h5", "result": solve_result(load, 4)}


def approximation(load):
    """Errors that grow with the load, so that 1 % and 10 % are reached at known ones."""
    def law(error):
        return {"twist": load * (1 + error), "error": error}
    return {"moment_ratio": load, "moment": 0.5 * load, "twist": load, "equation_7": law(-0.2 * load),
            "small_moments": law(-0.25 * load), "no_slip": law(-0.5 * load), "dem": law(-0.5 * load),
            "dem_moment": {"moment": min(load, 0.6), "error": min(load, 0.6) / (0.5 * load) - 1 if load else 0.0}}


def body(profile, limit, full_stick):
    loads = (0.0, 0.5, 0.9, 0.999)
    return {"profile": profile, "moment_limit": limit, "full_stick": full_stick,
            "rows": [{"moment_ratio": x, "moment": limit * x, "stick_ratio": 1 - x, "twist": x} for x in loads]}


def hard():
    def beside(**found):
        return {"methods": {"paper": found}}

    def row(case, verdict, **more):
        return {"family": "moment", "case": case, "verdict": verdict} | more

    return {
        "families": {"moment": {"why": "next to <nothing>"}},
        "rows": [
            row("0.1", "certified", operator_applications=10, **beside(verdict="agrees", operator_applications=30)),
            row("0.2", "certified", operator_applications=12,
                **beside(verdict="other_direction", reason="turned by 3 degrees", operator_applications=31)),
            row("0.3", "certified", operator_applications=14,
                **beside(verdict="other_answer", reason="it differs by 0.4", difference=0.4, operator_applications=32)),
            row("0.4", "certified", operator_applications=15, **beside(verdict="not_converged", reason="every cell slips")),
            row("2.0", "refused", reason="beyond \"the\" limit", **beside(verdict="refused", reason="beyond it")),
        ],
    }


def peer(program, verdict, over):
    """A field of another program; `over`: its errors over what is allowed."""
    judged = [{"quantity": name, "value": -over * allowed if name == "twist" else over * allowed, "allowed": allowed,
               "holds": over <= 1 or name == "moment_error"} for name, allowed in (("moment_error", 1e-3), ("twist", 1e-2))]
    return {"program": program, "file": "x.csv", "expected": verdict, "verdict": verdict, "why": f"it <is> {verdict}",
            "cells": [8, 8], "twist_error": -0.01 * over, "moment_error": 1e-3, "traction_error": {"l2": 0.5},
            "certificate": {"gap": 1e-5}, "slip_direction": {"mean": 1.5}, "judged": judged}


def published(name, comparison, text, value, ours, own=1e-9, **why):
    found = {"text": text, "value": value, "half_unit": 0.005, "source": f"Some{name} (1900), Title: Table 1",
             "seen": "a later text", "argument_error": 0.0, "comparison": comparison,
             **{key: why.get(key, "") for key in ("differs", "undecided", "not_compared")}}
    if ours is not None:
        found |= {"ours": ours, "own_error": own, "own_error_half_units": own / 0.005, "deviation": (ours - value) / 0.005}
    outcome = {"agrees": "passed", "differs": "failed as expected"}.get(comparison, "reported")
    return {"id": name, "outcome": outcome, "why": "", "published": found}


def small_paper():
    """A made validation of the paper."""
    loads = (0.2, 0.5, 0.9)
    return {
        "contact": {"radius": RADIUS, "peak_pressure": PEAK},
        "loading_cells": 4,
        "curve": [{"moment_ratio": x, "stick_ratio": 1 - x, "stick_complement": x, "twist": x, "equation_7": 0.9 * x,
                   "equation_7_error": -0.1} for x in loads],
        "profiles": [profile(0.5), profile(0.9)],
        "loading": [solve_result(load, 4) for load in loads],
        "mesh": [solve_result(load, cells, pressure) for pressure in ("solved", "hertz") for load in (0.5, 0.9)
                 for cells in (4, 8, 16)],
        "methods": [solve_result(loads[-1], cells, method=method) for method in ("coulomb", "paper")
                    for cells in (4, 8)],
        "ellipse": [solve_result(loads[-1], cells, method=method) for method in ("coulomb", "paper")
                    for cells in (4, 8)],
        "equation_5_digits": [{"stick_complement": 10.0**-i, "relative_error": 10.0**(2 * i - 16)} for i in range(7)],
        "approximations": [approximation(x) for x in (0.0, *loads)],
        "approximation_table": [approximation(x) for x in loads],
        "bodies": [body("hertz", 0.6, 0.0), body("cone", 0.5, 0.0), body("flat_punch", 0.8, 0.85)],
        "loop": {"turning_points": [0.8, -0.8, 0.8],
                 "rows": [{"moment_ratio": x, "moment": 0.6 * x, "twist": twist, "dissipated": 0.1} for x, twist in
                          ((0.0, 0.0), (0.8, 0.4), (0.0, 0.1), (-0.8, -0.4), (0.0, -0.1), (0.8, 0.4))]},
        "cycle_energy": [{"moment_ratio": x, "energy": x**3 / (1 - x), "small_amplitude": x**3}
                         for x in (0.05, 0.1, 0.2, 0.5)],
        "first_yield": {"poisson": 0.3, "curves": [{"friction": 0.5, "rows": [
            {"moment_ratio": x, "von_mises": 0.62 + max(0, x - 0.5), "radius": x, "depth": 0.48 if x < 0.6 else 0.0} for x in loads]}],
            "maps": [{"friction": 0.5, "moment_ratio": x, "spacing": 0.5, "von_mises": [[0.1, 0.2, 0.1], [0.6, 0.3, 0.1], [0.5, 0.2, 0.1]],
                      "shear": [[0.1, 0.1, 0.1], [0.3, 0.2, 0.1], [0.2, 0.1, 0.1]]} for x in (0.0, 0.9)],
            "solved": {"cells": [8, 8], "planes": [{"plane": plane, "von_mises": [[0.6, 0.3, 0.1], [0.5, 0.3, 0.1]],
                                                    "shear": [[0.3, 0.2, 0.1], [0.2, 0.2, 0.1]]} for plane in ("x1-x3", "x2-x3")],
                       "errors": [{"cells": [cells, cells], "stress_error": {"l1": 0.1, "l2": 0.1, "max": 1 / cells**2}}
                                  for cells in (4, 8)]}},
        "hard": hard(),
        "cycle": {"cells": [4, 4], "rows": [{"moment_ratio": x, "twist": 1.01 * twist, "exact": twist, "dissipated": 0.1}
                                            for x, twist in ((0.8, 0.4), (0.0, 0.1), (-0.8, -0.4))]},
        "beyond": [{"name": name, "profile": [{"radius": x, "value": 0.9 * x, "exact": x} for x in (0.8, 0.1, 0.5)],
                    "rows": [{"cells": [cells, cells], "twist_error": -0.1 / cells**2, "moment_limit_error": 0.5 / cells}
                             for cells in (4, 8)]} for name in ("coulomb", "tresca")],
        "peers": [peer("ONE", "good", 0.1), peer("TWO", "bad", 30.0)],
        "gates": {"gates": [{"id": "a-gate", "outcome": "passed", "quantity": "twist_error", "value": 1e-5, "factor": 0.5,
                             "reason": "it <matters>"}]},
        "literature": {"gates": [published("agreed", "agrees", "1.10", 1.1, 1.1002),
                                 published("other", "differs", "2.0", 2.0, 2.2, differs="it <differs>"),
                                 published("coarse", "undecided", "2.0", 2.0, 2.01, own=0.5, undecided="a staircase"),
                                 published("left", "not compared", "3", 3.0, None, not_compared="not here")]},
        "errata": [{"equation": "(0)", "printed": "a < b", "holds": "a > b", "shown": "by example"}],
    }


def number(key, words, unit, found, error, basis="exact"):
    parts = {"mesh": None, "path": None} if basis == "exact" else {"mesh": error, "path": None if error is None else 0.0}
    return {"key": key, "words": words, "unit": unit, "value": found, "reference": found, "error": error, "uncertainty": 0.0,
            "basis": basis} | parts


def small_page():
    """A page with every part that one can have."""
    answer = solve_result(0.9, 16, method="coulomb") | {
        "name": "made up", "status": "converged", "cell_size": [1.0, 1.0], "normal_load": 3.0, "moment": 2e-6, "twist_angle": 1.25e-3,
        "force": None, "force_reason": "not asked for",
        "steps": [{"name": "step", "twist_angle": x, "moment": x / (1 + x), "exact": {"twist_angle": x, "moment": x}} for x in (0.1, 0.2, 0.1)],
        "history": {"worst_gap": 2e-9, "operator_applications": 20.4, "seconds": 0.125, "dissipated": 1e-6},
        "program": {"name": "mine", "version": "1.0", "own": {"twist_angle": 1.2e-3, "message": "so & so"}, "wall_seconds": 0.5}}
    points = [{"method": method, "cells": n, "tolerance": 1e-6, "status": "converged", "seconds": 1e-4 * n**2, "error": 1 / n**2}
              for method in ("coulomb", "paper") for n in (8, 16)]
    asked = [{"wanted": 1e-2, "cells": [16, 8], "tolerance": 1e-3, "grids": 4, "seconds": 0.01},
             {"wanted": 1e-3, "cells": None, "cells_reason": "too <fine>", "tolerance": 1e-3}]
    others = [{"name": name, "version": "1", "cells": n, "status": "converged", "message": "", "seconds": 1e-3 * n, "cpu_seconds": 1.0,
               "number": "twist_angle", "error": 1 / n} for name in ("slipstick", "mine") for n in (8, 16)]
    alone = hard()
    for row in alone["rows"]:
        del row["methods"]
    return {
        "provenance": {"version": "0.0.0", "commit": "none", "cpu": "made <up>", "threads": 1},
        "scene": {"name": "made up", "text": "# So &\n# so. More.\nname = \"made up\"", "summary": [["Indenter", "sphere, radius 18 mm"]],
                  "gap": {"x1": [-1.0, 0.0, 1.0], "along_1": [1e-3, 0.0, None], "x2": [-1.0, 1.0], "along_2": [1e-3, 1e-3],
                          "map": [[1e-3, 2e-3], [0.0, 1e-3], [1e-3, None]]}},
        "answer": answer, "fields": "answer.h5",
        "numbers": [number("twist_angle", "twist", "rad", 1.25e-3, 3e-3), number("moment", "moment", "N m", 2e-6, None, "no mesh"),
                    number("stick_radius", "stick radius", "m", 4e-4, -2e-2, "order 2"), number("stick_ratio", "stick ratio", "", 0.5, 0.01),
                    number("contact_radius", "contact radius", "m", 1.5e-3, 2e-4)],
        "uncertainty": {"sentence": "the inputs leave 5 % open", "outputs": {"twist_angle": {"relative": 0.05}}},
        "studies": [],
        "cost": {"number": "twist_angle", "reference_uncertainty": 1e-5, "points": points, "choices": asked},
        "operators": {"rows": [{"operator": kind, "cells": n, "seconds": 1e-6 * n**power, "low": None, "low_reason": "one repetition",
                                "high": None, "high_reason": "one repetition"}
                               for kind, power in (("direct", 4), ("dcfft", 3)) for n in (8, 16, 32)],
                      "cells": 12.0, "low": 11.0, "high": 13.0, "remark": ""},
        "programs": others,
        "hard": alone,
        "digits": {"samples": 6, "digits": {"twist_angle": {"digits": 12.3, "low": 11.9, "high": 12.7}}},
        "headline": {"verdict": "good", "commit": "none", "lines": [["Gates", "1 of 1 pass"], ["Hard", "a < b"]], "numbers": {},
                     "counts": {"checks": {"Gates": "holds", "Hard": "holds"}},
                     "since": "0123456789abcdef", "changes": ["hard certified: 2 before, 1 now"]},
        "paper": small_paper(),
    }


def write_fields(path, q1_shift=0.02):
    """The twelve cells of a 4 x 4 grid that lie in the unit circle."""
    centre = RADIUS * np.array([-0.75, -0.25, 0.25, 0.75])
    x1, x2 = (x.ravel() for x in np.meshgrid(centre, centre))
    inside = np.hypot(x1, x2) < RADIUS
    x1, x2 = x1[inside], x2[inside]
    with h5py.File(path, "w") as file:
        for name, values in {"x1": x1, "x2": x2, "q1": -x2 + q1_shift, "q2": x1, "q1_exact": -x2,
                             "q2_exact": x1}.items():
            file[name] = values


def write_answer(path):
    """Two cells that stick and one that slips."""
    with h5py.File(path, "w") as file:
        for name, values in {"x1": [0.0, 1.0, 2.0], "x2": [0.0, 0.0, 0.0], "stick": [1.0, 1.0, 0.0], "pressure": [2.0, 3.0, 1.0],
                             "q1": [1.0, 1.0, 0.5], "q2": [0.0, 0.5, 0.5], "slip1": [1e-9, 0.0, 3.0], "slip2": [0.0, 0.0, 4.0]}.items():
            file[name] = values


def write_data(page_folder, page):
    """Puts a page's results where they are drawn from."""
    folder = page_folder / "data"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "report.json").write_text(json.dumps(page))
    for entry in page.get("paper", {}).get("profiles", []):
        write_fields(folder / entry["fields"])
    write_answer(folder / "answer.h5")


def run_render(*folders, output=None, save=style.save):
    """Draws the page of each folder, and an index of several in `output`: exit code and output; `save` writes the figures.
    A warning is an error, except for announced changes of matplotlib."""
    with redirect_stderr(io.StringIO()) as errors, patch.object(style, "save", save), warnings.catch_warnings():
        for kind in (UserWarning, RuntimeWarning, DeprecationWarning):
            warnings.simplefilter("error", kind)
        warnings.filterwarnings("ignore", category=DeprecationWarning, module="matplotlib")
        exit_code = render.main([*map(str, folders), "--output", str(output or folders[0])])
    return exit_code, errors.getvalue()


def save_quickly(figure, stem):
    """Draws it once, as SVG, not laid out and without minor ticks: a quarter of the work."""
    figure.set_layout_engine("none")
    for axis in figure.axes:
        axis.minorticks_off()
    FigureCanvasSVG(figure).print_svg(stem.with_suffix(".svg"))
    return stem.with_suffix(".svg").read_text(encoding="utf-8")


def save_nothing(figure, stem):
    """For tests of the page's text."""


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
