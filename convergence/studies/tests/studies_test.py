"""studies_test.py PROGRAM: orders, budgets and limits that `slipstick study` finds on small meshes, and its refusals."""

import math
import signal
import subprocess
from pathlib import Path

from program_run import PROGRAM, SCENES, SOURCE, ProgramTest

FOOTING = SOURCE / "convergence/literature/scenes/footing.toml"


class Studies(ProgramTest):
    def study(self, text, scene="paper", code=0):
        """The series of a study by name, and its text."""
        self.write("study.toml", f"scene = '{SCENES / f'{scene}.toml'}'\n{text}\n")
        text, result = self.text_and_result("study", "study.toml", "--output", "points", code=code)
        return result["series"], text

    def test_budget_has_the_error_by_rounding(self):
        """Directed rounding changes a result by less than 1e-10. Rounded downward, Hertz's pressure on 96 cells is its mirror image
        to rounding, and half a turn, which is both mirrors, nearly to twice as much: one test decides for the quadrant and for the
        limit load."""
        series = self.study("cells = [24, 32]\nquantities = ['twist_error']")[0]["paper"]
        part = series["budget"][0]
        self.assertTrue(0 < part["rounding"] < 1e-10, part)
        self.assertAlmostEqual(part["observed"], series["rows"][0]["twist_error"], delta=1e-16)
        self.assertAlmostEqual(part["discretisation"] + part["iteration"], part["observed"], delta=1e-16)
        series = self.study("cells = [64, 96]\nset = {'contact.pressure' = 'hertz', 'load.moment_ratio' = 0.5}")[0]["paper"]
        self.assertEqual(series["failed_runs"]["count"], 0)
        self.assertEqual([row["status"] for row in series["rows"]], ["converged"] * 2)

    def test_results_are_found_where_sigchld_is_ignored(self):
        self.write("study.toml", f"scene = '{SCENES / 'paper.toml'}'\ncells = [12, 16]\n")
        ran = subprocess.run([PROGRAM, "study", "study.toml", "--output", "points"], capture_output=True, text=True,
                             preexec_fn=lambda: signal.signal(signal.SIGCHLD, signal.SIG_IGN))
        self.assertEqual(ran.returncode, 0, ran.stderr)

    def test_order_of_the_contact_radius(self):
        """It follows from the pressure's second moments: second order. Each grid of a mesh lies differently."""
        series = self.study("cells = [12, 16, 24, 32, 48, 64]\nshifts = 3\nquantities = ['contact_radius_error']")[0]["paper"]
        order = series["order"]["contact_radius_error"]
        self.assertAlmostEqual(order["value"], 2, delta=0.3)
        self.assertLessEqual(order["low"], 2)
        self.assertEqual((len(series["rows"]), len({row["h"] for row in series["rows"]})), (18, 18))

    def test_order_of_the_stresses(self):
        """Deeper than a cell the edges are smoothed: second order, with the torsion of a history too."""
        quantities = "quantities = ['stress_error.l2', 'stress_error.max']"
        for scene, more in (("paper", "shifts = 3"), ("torsion_loop", ""), ("paper", "set = {'contact.friction' = 0.5}")):
            series = next(iter(self.study(f"cells = [24, 32, 48, 64]\n{quantities}\n{more}", scene)[0].values()))
            for path in ("stress_error.l2", "stress_error.max"):
                order = series["order"][path]
                self.assertEqual(order["expected"], 2)
                self.assertAlmostEqual(order["value"], 2, delta=0.4)
        series = self.study(f"cells = [16, 24]\n{quantities}", "ellipse")[0]["ellipse"]  # whose exact stresses are not known
        self.assertIsNone(series["order"]["stress_error.max"]["value"])

    def test_tolerance_is_tightened_where_stopping_shows(self):
        series, text = self.study("cells = [12, 16, 24]\nset = {'solver.tolerance' = 1e-2}")
        loose = series["paper"]
        self.assertGreater(loose["tightened"], 0)
        self.assertLess(loose["tolerance"], 1e-2)
        self.assertIn("tightened", text)
        for part in loose["budget"]:
            if part["quantity"] == "twist_error":
                self.assertLessEqual(abs(part["iteration"]), 0.1 * abs(part["discretisation"]))
        self.assertEqual(self.study("cells = [12, 16, 24]")[0]["paper"]["tightened"], 0)

    def test_limit_is_extrapolated_without_an_exact_answer(self):
        series = self.study("cells = [16, 24, 32, 48, 64]\nquantities = ['moment_limit']", "ellipse")[0]["ellipse"]
        self.assertEqual((series["basis"], series["order"]["moment_limit"]["basis"]), ("extrapolated", "extrapolated"))
        solved = self.result("solve", str(SCENES / "ellipse.toml"), "--set", "grid.cells=[32,16]")
        exact, limit = solved["moment_limit"] / (1 + solved["moment_limit_error"]), series["extrapolated"]["moment_limit"]
        self.assertLessEqual(abs(limit["value"] - exact), limit["uncertainty"])
        self.assertLessEqual(limit["uncertainty"], 1e-2 * exact)

    def test_edges_between_cells_are_extrapolated_with_their_powers(self):
        """A square plate's capacitance over 4 pi eps0 is 0.366788: by Galerkin's method on rectangles graded towards the edges, which
        is a lower bound, 0.3667869 from 96 x 96 of them, and 0.36678802 as they shrink."""
        series = self.study("cells = [16, 24, 32, 48, 64, 96]\nquantities = ['approach']", FOOTING.with_suffix(""))[0]["footing"]
        approach = series["extrapolated"]["approach"]
        part = approach["uncertainty"] / approach["value"]
        self.assertAlmostEqual(0.05305164769729845 / approach["value"] / 0.366788, 1, delta=part + 1e-7)  # (1 - nu)/(4 pi)
        self.assertLessEqual(part, 3e-6)
        self.assertIn("h^1.59", approach["method"])

    def test_values_without_an_exact_answer_are_extrapolated(self):
        """The exact answer of an ellipse covers its normal contact only."""
        series = self.study("cells = [16, 24, 32]", "ellipse")[0]["ellipse"]
        self.assertEqual(series["basis"], "exact")
        for path in ("moment_error", "moment_limit_error", "contact_radius_error", "peak_pressure_error", "pressure_error.l1",
                     "pressure_error.l2"):
            self.assertEqual(series["order"][path]["basis"], "exact")
            self.assertNotIn(path, series["extrapolated"])
        for path in ("twist_angle", "stick_radius", "dissipated"):
            self.assertEqual(series["order"][path]["basis"], "extrapolated")
            self.assertTrue(math.isfinite(series["extrapolated"][path]["value"]))
        for path in ("twist_error", "traction_error.l1", "moment_limit", "contact_radius"):
            self.assertNotIn(path, series["order"])

    def test_every_combination_is_a_series(self):
        series, _ = self.study("cells = [12, 16]\n[[vary]]\nkey = 'contact.pressure'\nvalues = ['solved', 'hertz']\n"
                               "[[vary]]\nkey = 'load.moment_ratio'\nvalues = [0.5, 0.9]")
        self.assertEqual({*series}, {"solved-0.5", "solved-0.9", "hertz-0.5", "hertz-0.9"})
        for each in series.values():
            self.assertEqual((len(each["rows"]), each["order"]["twist_error"]["verdict"]), (2, "too_few"))
        self.assertEqual(series["hertz-0.5"]["set"], {"contact.pressure": "hertz", "load.moment_ratio": 0.5})

    def test_a_series_that_cannot_be_solved_does_not_spoil_the_others(self):
        series, _ = self.study("cells = [12, 16, 24]\nquantities = ['twist_error']\nset = {'load.moment_ratio' = 0.5}\n"
                               "[[vary]]\nkey = 'solver.max_iterations'\nvalues = [1, 5000]", code=(0, 1))
        verdicts = [series[name]["order"]["twist_error"]["verdict"] for name in ("1", "5000")]
        self.assertEqual(verdicts[0], "too_few")
        self.assertNotEqual(verdicts[1], "too_few")

    def test_tolerances(self):
        """The reached one is not larger than the requested one, and the error by stopping falls with it. Without an exact answer a
        row has the value under its own name, and its relative distance from the tightest run."""
        rows = self.study("cells = [24]\ntolerances = [1e-6, 1e-1, 1e-3]")[0]["paper"]["tolerances"]
        self.assertEqual([row["requested"] for row in rows], [1e-1, 1e-3, 1e-6])
        for row in rows:
            self.assertLessEqual(row["certificate.gap"], row["requested"])
        self.assertGreater(abs(rows[0]["iteration"]["twist_error"]), abs(rows[2]["iteration"]["twist_error"]))
        series, text = self.study("cells = [16]\ntolerances = [1e-1, 1e-6]", "ellipse")
        row = series["ellipse"]["tolerances"][0]
        self.assertGreater(row["twist_angle"], 1e-4)  # rad
        self.assertTrue(1e-7 < abs(row["iteration"]["twist_angle"]) < 0.1)  # in rad it would be a thousand times smaller
        self.assertNotIn("twist error", text)

    def test_quantities_of_the_scene(self):
        """Some contacts have an exact ratio only, and a height map fixes the grid. Each error has an expected order with a reason, not
        a higher one where the pressure is singular at the edge, and none on a rough surface."""
        orders = {scene: self.study("cells = [12, 16]", scene)[0][scene]["order"] for scene in ("paper", "flat_punch", "rough_sphere")}
        for path, order in orders["paper"].items():
            self.assertTrue(order["expected"] > 0 and order["expected_why"], path)
            singular = orders["flat_punch"].get(path, order)["expected"]
            self.assertLessEqual(singular or 0, order["expected"], path)
        self.assertEqual({order["expected"] for order in orders["rough_sphere"].values()}, {None})
        self.assertIn("stick_ratio_error", self.study("cells = [12, 16]", "spence")[0]["spence"]["order"])
        self.assertNotIn("stick_ratio_error", self.study("cells = [12, 16]")[0]["paper"]["order"])
        rows = self.study("tolerances = [1e-2, 1e-4]", "honed_surface")[0]["honed_surface"]["tolerances"]
        self.assertEqual(len(rows), 2)
        self.write("study.toml", f"scene = '{SCENES / 'honed_surface.toml'}'\ncells = [12, 16]\n")
        self.run_program("study", "study.toml", code=2)

    def test_bad_studies_say_what_is_allowed(self):
        billions = "".join(f"[[vary]]\nkey = 'k{i}'\nvalues = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n" for i in range(9))
        for text, *says in (("", "[[vary]]"), (billions, "1e+09", "10000"), ("cell = [16, 32]", "cells"),
                            ("cells = [16, 16]", "twice"), ("cells = [16, 0]", "whole number"), ("cells = 16", "list"),
                            ("cells = [16, 32]\nshifts = 0", "shifts = 0"), ("tolerances = [1e-3, -1.0]", "positive"),
                            ("[[vary]]\nkey = 'grid.cells'\nvalues = [1]", "vary[0].key"),
                            ("cells = [12, 16]\nquantities = ['twist_eror']", "twist_eror")):
            Path("study.toml").write_text(f"scene = '{SCENES / 'paper.toml'}'\n{text}\n")
            self.run_program("study", "study.toml", code=2, says=says)
