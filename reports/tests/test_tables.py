"""The page's tables: each number under its own head, from rows in which no two numbers are alike."""

import sys
import unittest
from pathlib import Path

REPORTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPORTS))

import speed_tables  # noqa: E402
import tables  # noqa: E402


def beside_heads(table, row=0):
    """The cells under each head, in order."""
    assert len(table.head) == len(table.body[row]), table.head
    return list(zip(table.head, map(str, table.body[row])))


SOLVE = {
    "pressure": "hertz", "moment_ratio": 0.5, "cells": [64, 32], "method": "coulomb", "twist_error": 1.1e-3,
    "stick_radius_error": -1.2e-3, "traction_error": {"l1": 1.3e-3, "l2": 1.4e-3, "max": 1.5e-3},
    "certificate": {"gap": 1.6e-9, "moment": 1.7e-9}, "iterations": 18, "operator_applications": 19.5,
    "stick_ratio": 0.21, "twist": 0.22, "exact": {"stick_ratio": 0.23, "twist": 0.24},
    "seconds": {"setup": 0.25, "pressure": 0.26, "traction": 0.27, "total": 0.78}}


class OfSolves(unittest.TestCase):
    def test_meshes(self):
        self.assertEqual(beside_heads(tables.table({"mesh": [SOLVE]}, "mesh", tables.MESH)), [
            ("pressure", "hertz"), ("M/M<sub>lim</sub>", "0.5"), ("cells", "64×32"), ("twist error", "1.1×10⁻³"),
            ("stick radius error", "−1.2×10⁻³"), ("traction error L1", "1.3×10⁻³"), ("traction error L2", "1.4×10⁻³"),
            ("gap / energy", "1.6×10⁻⁹"), ("iter&shy;ations", "18"), ("operator applica&shy;tions", "19.5"),
            ("pressure, s", "0.26"), ("traction, s", "0.27"), ("total, s", "0.78")])

    def test_loads(self):
        self.assertEqual(beside_heads(tables.table({"loading": [SOLVE]}, "loading", tables.LOADING)), [
            ("M/M<sub>lim</sub>", "0.5"), ("method", "coulomb"), ("a<sub>s</sub>/a computed", "0.21"),
            ("a<sub>s</sub>/a exact", "0.23"), ("error", "−1.2×10⁻³"), ("twist computed", "0.22"),
            ("twist exact", "0.24"), ("error", "1.1×10⁻³"), ("gap / energy", "1.6×10⁻⁹"), ("iter&shy;ations", "18"),
            ("operator applica&shy;tions", "19.5"), ("time, s", "0.78")])

    def test_approximations(self):
        row = {"moment_ratio": 0.5, "moment": 0.29, "twist": 0.31,
               **{law: {"twist": 9.0, "error": error} for law, error in
                  (("equation_7", -0.11), ("small_moments", -0.12), ("no_slip", -0.13), ("dem", -0.14))},
               "dem_moment": {"moment": 9.0, "error": 0.15}}
        self.assertEqual(beside_heads(tables.table({"rows": [row]}, "rows", tables.APPROXIMATIONS)), [
            ("M/M<sub>lim</sub>", "0.5"), ("exact twist", "0.31"), ("twist by Eq.&nbsp;(7)", "−11\u00a0%"),
            ("twist, small moments", "−12\u00a0%"), ("twist, no slip", "−13\u00a0%"), ("twist, DEM", "−14\u00a0%"),
            ("DEM moment at the exact twist", "+15\u00a0%")])


ORDER = {"value": 1.11, "low": 0.98, "high": 1.24, "constant": 9.0, "verdict": "too_few", "why": "for the reason",
         "expected": 1.5, "expected_why": "by theory"}
BUDGET = {"quantity": "twist_error", "observed": 1.1e-3, "discretisation": 1.2e-3, "trend": 1.3e-3,
          "staircase": -1.4e-4, "iteration": -1.5e-5, "rounding": 1.6e-13, "reference": 1.7e-15}


def study():
    return {"series": {"one": {
        "set": {"load.normal": 700.0, "contact.friction": 0.3}, "order": {"twist_error": ORDER},
        "meshes": [{"cells": [16, 16]}, {"cells": [32, 16]}],
        "budget": [dict(BUDGET, cells=[16, 16]), dict(BUDGET, cells=[32, 16], observed=1.8e-3)]}}}


class OfStudies(unittest.TestCase):
    def test_orders(self):
        self.assertEqual(beside_heads(tables.study_orders(study())), [
            ("quantity", "twist"), ("normal", "700.0"), ("friction", "0.3"), ("order", "1.11"),
            ("95 % interval", "0.98 to 1.24"), ("ex&shy;pected", "1.5"), ("verdict", "too few"),
            ("why", "for the reason")])
        self.assertEqual(tables.study_expectations(study()), [("twist", "1.5", "by theory")])

    def test_budget(self):
        label, table = tables.study_budget(study())
        self.assertEqual(label, "load.normal = 700.0, contact.friction = 0.3")
        self.assertEqual(beside_heads(table), [
            ("error of the", "twist"), ("cells", "16²"), ("error", "1.1×10⁻³"), ("discreti&shy;sation", "1.2×10⁻³"),
            ("of which trend", "1.3×10⁻³"), ("of which staircase", "−1.4×10⁻⁴"), ("iteration", "−1.5×10⁻⁵"),
            ("rounding ±", "1.6×10⁻¹³"), ("reference ±", "1.7×10⁻¹⁵")])
        self.assertEqual([row[1:3] for row in table.body], [["16²", "1.1×10⁻³"], ["32×16", "1.8×10⁻³"]])


def timed_point(cells, **choice):
    return {"method": "paper", "operator": "dcfft", "model": "auto", "pressure": "solved",
            "cells": cells, "tolerance": 1e-4} | choice


PLANE = {
    "scenes": [{
        "name": "made", "moment_ratio": 0.3, "points": [timed_point(16), timed_point(32)],
        "exact": {"seconds": {"median": 5e-6, "low": 4e-6, "high": 6e-6}, "error": 7e-14, "cells": 128},
        "time_to": [{"quantity": "traction_l2", "method": "paper", "error": error, "point": place, "seconds": seconds}
                    for error, place, seconds in ((1e-2, 0, 0.011), (1e-3, 1, 0.012), (1e-4, None, None))]}]}

LAW = {"name": "application/direct", "rows": [],
       "power_law": {"exponent": 3.9, "low": 3.8, "high": 4.1, "constant": 1e-3, "theory": "N^2 log N", "expected": 2.3,
                     "cells": [8, 16, 32]}}
CROSSOVER = {"slow": "application/direct", "quick": "application/dcfft", "cells": 12.0, "low": 11.0, "high": 13.0,
             "remark": "beyond what was measured"}


class OfTimes(unittest.TestCase):
    def test_times_to_errors(self):
        table = speed_tables.times_to_errors(PLANE)
        self.assertEqual(beside_heads(table), [
            ("M/M<sub>lim</sub>", "0.3"), ("error of", "tractions, root mean square"), ("method", "paper"),
            ("to 10⁻²", "11\u00a0ms: 16² cells, tolerance 10⁻⁴"), ("to 10⁻³", "12\u00a0ms: 32² cells, tolerance 10⁻⁴"), ("to 10⁻⁴", "–")])
        self.assertEqual(table.body[1], ["0.3", "all", "exact, no grid", "0.005 ms", "0.005 ms", "0.005 ms"])

    def test_laws(self):
        self.assertEqual(beside_heads(speed_tables.laws({"families": [LAW]})), [
            ("what", "application/direct"), ("exponent", "3.90"), ("95 % interval", "3.80 to 4.10"),
            ("by theory", "2.30"), ("", "N² log N")])

    def test_crossovers(self):
        table = speed_tables.crossovers({"crossovers": [CROSSOVER]})
        self.assertEqual(beside_heads(table), [
            ("is quicker than", "application/dcfft"), ("", "application/direct"), ("from cells a side", "12"),
            ("95 % interval", "11 to 13"), ("remark", "beyond what was measured")])
