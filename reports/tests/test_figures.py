"""Figures of the page one by one: what they say in numbers, and that they are honest about what is missing."""

import unittest

import numpy as np
from made_report import FRICTION, PEAK, Folder, small_paper, write_data, write_fields

import exact_figures
import figures
import hard_cases
import method_figures
import peers_figure
import results
import scene_figures
from wording import sci


def history(*moments, force=1e-16):
    """A page with the steps of a torsion whose forces are rounding errors."""
    steps = [{"twist_angle": m + m**3, "moment": m, "displacement": [0.0, 1e-22 * k], "force": [force * k, 0.0]}
             for k, m in enumerate(moments)]
    return {"answer": {"steps": steps, "contact_radius": 1e-3, "moment_limit": 1.0, "friction_force": 100.0,
                       "history": {"dissipated": 1e-6}}}


class SceneFigures(unittest.TestCase):
    def test_rounding_is_no_panel_of_a_history(self):
        self.assertEqual(len(scene_figures.loop(history(0.2, 0.5, 0.1), None).figure.axes), 1)

    def test_a_step_for_each_reversal_shows_no_loop(self):
        few = scene_figures.loop(history(0.8, -0.8, 0.8), None)
        self.assertEqual(few.figure.axes[0].lines[0].get_linestyle(), ":")
        self.assertNotIn("What lies within a closed loop is the energy", few.details)
        turns = [0.2, 0.4, 0.6, 0.8, 0.4, 0.0, -0.4, -0.8, -0.4, 0.0, 0.4, 0.8]
        many = scene_figures.loop(history(*turns), None)
        self.assertEqual(many.figure.axes[0].lines[0].get_linestyle(), "-")
        self.assertIn("What lies within a closed loop is the energy", many.details)

    def test_the_time_is_that_of_an_error_that_is_known(self):
        """Tighter tolerances gain nothing below what is known of the reference; the quickest such solve is named."""
        points = [{"method": "coulomb", "cells": 8, "tolerance": t, "seconds": s, "error": 4e-3 + e}
                  for t, s, e in ((1e-3, 0.1, 1e-2), (1e-6, 0.2, 3e-5), (1e-9, 0.5, 3e-10))]
        entry = scene_figures.cost({"cost": {"number": "twist_angle", "reference_uncertainty": 4e-3, "points": points}}, None)
        self.assertIn(f"An error of {sci(4e-3)} in the twist takes 0.2 s", entry.message)


class OneFigure(Folder):
    def setUp(self):
        super().setUp()
        self.report = small_paper()
        write_data(self.folder, {"paper": self.report})
        self.folder /= "data"

    def assert_unavailable(self, draw, words):
        with self.assertRaisesRegex(results.Unavailable, words):
            draw(self.report, self.folder)

    def test_missing_key(self):
        del self.report["loading"][2]["twist_error"]
        self.assert_unavailable(figures.twist, "twist_error.*missing")

    def test_only_nulls(self):
        for row in self.report["loading"]:
            row.update(certificate=None, certificate_reason="not asked for")
        self.assert_unavailable(method_figures.certificate, "certificate.gap.*null in every row: not asked for")

    def test_null_where_the_message_quotes_it(self):
        self.report["loading"][2].update(twist_error=None, twist_error_reason="no exact answer")
        self.assertIn("the computed twist is not available", figures.twist(self.report, self.folder).message)

    def test_field_with_nan(self):
        write_fields(self.folder / "fields-0.9.h5", q1_shift=np.nan)
        self.assert_unavailable(figures.shear_components, "fields-0.9.h5: “q1”.*not numbers")

    def test_field_file_missing_or_damaged(self):
        (self.folder / "fields-0.9.h5").unlink()
        self.assert_unavailable(figures.traction_norm, "fields-0.9.h5 cannot be read")
        (self.folder / "fields-0.9.h5").write_text("no HDF5")
        self.assert_unavailable(figures.traction_norm, "fields-0.9.h5 cannot be read")

    def test_twist_errors_stand_above_the_floor_of_their_panel(self):
        for row, error in zip(self.report["loading"], (0.0, 1e-9, None)):
            row.update(twist_error=error, twist_error_reason="no exact answer")
        self.assertAlmostEqual(1e9 * figures.twist(self.report, self.folder).figure.axes[1].get_ylim()[0], 0.3)

    def assert_meshes_are_named(self, figure, cells):
        for axis in figure.axes:
            self.assertEqual([label.get_text() for label in axis.get_xticklabels()], cells)
            self.assertEqual(axis.get_xlabel(), "cells across the grid")

    def test_methods_are_drawn_against_the_cells(self):
        figure = method_figures.methods(self.report, self.folder).figure
        self.assert_meshes_are_named(figure, ["4", "8"])
        for axis, found in zip(figure.axes, (14, 0.3, 1e-7)):
            drawn = {line.get_label(): line for line in axis.lines}
            self.assertEqual(set(drawn), {"Newton’s method for Coulomb’s law", "the paper’s method"})
            line = drawn["Newton’s method for Coulomb’s law"]
            self.assertEqual((list(line.get_xdata()), list(line.get_ydata())), ([4, 8], [found, found]))

    def test_convergence_speaks_of_the_pressure_solved_where_there_is_one(self):
        entry = figures.convergence(self.report, self.folder)
        self.assert_meshes_are_named(entry.figure, ["4", "8", "16"])
        self.assertEqual([axis.get_ylabel() for axis in entry.figure.axes], ["relative error", "", ""])
        self.assertEqual([text.get_text() for text in entry.figure.legends[0].get_texts()], [
            "pressure solved on the same grid", "Hertz pressure at cell centres", "$M/M_\\mathrm{lim}$ = 0.5",
            "$M/M_\\mathrm{lim}$ = 0.9"])
        for axis in entry.figure.axes:
            triangles = [line for line in axis.lines if len(line.get_xdata()) == 4]
            self.assertEqual([note.get_text() for note in axis.texts], ["1", "2"])
            for order, line in zip((1, 2), triangles):
                (x0, x1), (y0, y1) = line.get_xdata()[:2], line.get_ydata()[:2]
                self.assertAlmostEqual(np.log(y0 / y1) / np.log(x1 / x0), order)
                self.assertTrue(axis.get_ylim()[0] < y1 and y0 < axis.get_ylim()[1] and x1 < axis.get_xlim()[1])
        self.assertEqual(entry.message, "At 16 cells a side and M/M<sub>lim</sub>&nbsp;=&nbsp;0.9 the twist is off by "
                         "3.9×10⁻³, the traction by 3.9×10⁻³.")
        self.assertEqual(len(entry.numbers), 6)
        self.assertIn("pressure solved on the same grid", entry.numbers[0][0])
        self.report["mesh"] = [row for row in self.report["mesh"] if row["pressure"] == "hertz"]
        self.assertIn("Hertz pressure at cell centres", figures.convergence(self.report, self.folder).numbers[0][0])

    def test_missing_cycles(self):
        for key in ("loop", "cycle_energy"):
            self.report = small_paper()
            del self.report[key]
            self.assert_unavailable(exact_figures.bodies_and_cycles, f"{key}.*missing")

    def test_how_far_each_law_holds(self):
        numbers = [number for _, number in exact_figures.approximations(self.report, self.folder).numbers]
        self.assertEqual(numbers[:3], ["0.050 (0.50)", "0.040 (0.40)", "0.020 (0.20)"])
        self.assertEqual(numbers[-1], "100&nbsp;%")

    def test_hard_scenes_in_numbers(self):
        entry = hard_cases.methods(small_paper(), self.folder)
        self.assertEqual(entry.message, "Newton’s method for Coulomb’s law certifies 4 of 5 hard scenes and refuses 1 with a "
                         "reason; 0 do not converge or are wrong.")
        self.assertEqual([number for words, number in entry.numbers if "paper" in words], ["1"] * 5)
        bars = [[bar.get_width() for bar in entry.figure.axes[0].patches[5 * i:5 * i + 5]] for i in (0, 1)]
        self.assertEqual(bars, [[4, 1, 0, 0, 0], [1, 1, 1, 1, 1]])

    def test_law_that_holds_everywhere(self):
        for row in self.report["approximations"]:
            row["equation_7"]["error"] = 0.001 * row["moment_ratio"]
        self.assertEqual(exact_figures.approximations(self.report, self.folder).numbers[0][1], "0.90 (0.90)")

    def test_laws_that_are_beyond_a_bound_at_once_or_come_back(self):
        for row, equation_7, no_slip in zip(self.report["approximations"], (0.02, 0.03, 0.04, 0.05),
                                            (0.0, 0.008, 0.012, 0.009)):
            row["equation_7"]["error"], row["no_slip"]["error"] = equation_7, no_slip
        numbers = [number for _, number in exact_figures.approximations(self.report, self.folder).numbers]
        self.assertEqual(numbers[0], "0 (0.90)")
        self.assertEqual(numbers[2], "0.35 (0.90)")  # 0.2 + 0.3 (10 - 8)/(12 - 8)

    def test_each_law_is_drawn_by_its_own_twists(self):
        left, right = exact_figures.approximations(self.report, self.folder).figure.axes
        loads = [row["moment_ratio"] for row in self.report["approximations"]]
        drawn = {line.get_label(): line for line in left.lines}
        for key, label in (("equation_7", "Eq. (7)"), ("small_moments", "small moments"), ("no_slip", "no slip")):
            self.assertEqual(list(drawn[label].get_xdata()), [row[key]["twist"] for row in self.report["approximations"]])
            self.assertEqual(list(drawn[label].get_ydata()), loads)
        self.assertEqual(list(drawn["exact"].get_xdata()), loads)
        errors = [line.get_ydata() for line in right.lines if len(line.get_xdata()) == len(loads)]
        np.testing.assert_allclose(errors[0], [np.nan, *(0.2 * load for load in loads[1:])])  # no zero on a log scale
        self.assertEqual(right.get_yscale(), "log")

    def test_friction_laws_in_numbers(self):
        entry = exact_figures.friction_laws(self.report, self.folder)
        self.assertEqual([label for label, _ in entry.numbers],
                         ["Coulomb: twist, limit moment off at 8 cells", "strength: twist, limit moment off at 8 cells"])
        self.assertEqual(entry.numbers[0][1], f"{sci(0.1 / 64)}, {sci(0.5 / 8)}")

    def test_bodies_and_cycles_in_numbers(self):
        entry = exact_figures.bodies_and_cycles(self.report, self.folder)
        self.assertIn("keeps 25\u00a0% of its twist", entry.message)
        numbers = dict(entry.numbers)
        self.assertEqual(numbers["limit moment, sphere"], "0.600&nbsp;μWa")
        self.assertEqual(numbers["flat punch: sticks everywhere up to"], "0.850&nbsp;M<sub>lim</sub>")
        self.assertEqual(list(numbers.values())[-2:], ["0.10&nbsp;M<sub>lim</sub>", "2"])

    def test_computed_cycle_in_numbers(self):
        entry = exact_figures.computed_cycle(self.report, self.folder)
        self.assertEqual(entry.numbers[0][1], "1.0×10⁻²")  # of the largest twist, 0.4
        exact, computed = entry.figure.axes[0].lines
        self.assertEqual(computed.get_xdata().tolist(), [0.8, 0.0, -0.8])
        self.assertTrue(np.allclose(entry.figure.axes[1].lines[0].get_ydata(), [0.01, 0.0025, 0.01]))

    def test_known_fields_stand_on_their_side_of_the_line(self):
        entry = peers_figure.peers(self.report, self.folder)
        self.assertEqual(entry.message, "TWO carries the right moment, yet its twist, tractions and slip directions are wrong.")
        one, two = entry.figure.axes[0].lines[:2]
        self.assertTrue(np.allclose(one.get_xdata(), 0.1) and np.allclose(two.get_xdata(), 30.0))
        self.assertLess(two.get_xdata().max(), entry.figure.axes[0].get_xlim()[1])

    def test_error_map_is_the_difference_from_exact(self):
        entry = figures.shear_components(self.report, self.folder)
        error = entry.figure.axes[2].images[0].get_array()
        self.assertAlmostEqual(float(error.max()), 0.02 / (FRICTION * PEAK), places=12)
