"""program_accuracy_test.py PROGRAM: errors reached by `slipstick solve --accuracy` and predictions of --plan."""

import itertools
import json
from pathlib import Path

from program_run import SCENES, ProgramTest

GRIDS = 3  # shifted grids; a number is their mean


def command(scene, words):
    return ["solve", str(SCENES / f"{scene}.toml"), *words.split()]


class Solve(ProgramTest):
    def solved(self, scene, words):
        return self.result(*command(scene, words))

    def text(self, scene, words, **expected):
        return self.run_program(*command(scene, words), **expected)


class Accuracy(Solve):
    def test_is_reached_on_grids_of_the_papers_scene(self):
        for wanted, ratio in itertools.product((1e-2, 1e-3, 1e-4), (0.5, 0.9)):
            result = self.solved("paper", f"--model auto --accuracy {wanted} --set load.moment_ratio={ratio}")
            accuracy = result["accuracy"]
            self.assertLessEqual(abs(result["twist_error"]), wanted)
            self.assertEqual((accuracy["reached"], accuracy["how"], accuracy["wanted"]),
                             (abs(result["twist_error"]), "exact", wanted))
            self.assertLessEqual(len(accuracy["attempts"]), 2)  # the data for choosing a mesh are of such loads
            self.assertEqual(accuracy["attempts"][-1]["cells"], result["cells"])

    def test_shifted_grids_reach_five_digits_of_the_papers_twist_on_small_grids(self):
        for ratio in (0.5, 0.9):
            result = self.solved("paper", f"--model auto --accuracy 1e-5 --set load.moment_ratio={ratio}")
            self.assertLessEqual(abs(result["twist_error"]), 1e-5)
            self.assertLessEqual(result["cells"][0], 200)
            self.assertEqual(result["cell_traction"], "smooth")
            self.assertEqual(len(result["accuracy"]["attempts"][0]["grids"]), GRIDS)
            self.assertLessEqual(result["accuracy"]["uncertainty"], 1e-5)
        self.text("ellipse", "--accuracy 1e-3", says=["uncertainty", f"scatter of {GRIDS} grids"])

    def test_of_tractions_and_stick_radius_is_reached(self):
        traction = self.solved("paper", "--model auto --accuracy 1e-2 --accuracy-of traction")
        self.assertLessEqual(traction["traction_error"]["l2"], 1e-2)
        stick = self.solved("paper", "--model auto --accuracy 1e-2 --accuracy-of stick_radius")
        self.assertLessEqual(abs(stick["stick_radius_error"]), 1e-2)
        self.assertEqual(stick["accuracy"]["quantity"], "stick_radius")

    def test_of_an_imposed_twist_is_that_of_the_moment(self):
        result = self.solved("paper", "--model auto --accuracy 1e-3 --set load.twist=2e-3")
        self.assertEqual(result["accuracy"]["quantity"], "moment")
        self.assertEqual(result["accuracy"]["reached"], abs(result["moment_error"]))
        self.assertLessEqual(result["accuracy"]["reached"], 1e-3)

    def test_of_a_history_is_that_of_its_last_step(self):
        result = self.solved("fretting_torsion", "--model auto --accuracy 1e-2")
        self.assertEqual(result["accuracy"]["reached"], abs(result["steps"][-1]["twist_error"]))

    def test_needs_no_grid_where_there_is_an_exact_answer(self):
        result = self.solved("paper", "--accuracy 1e-9")
        self.assertEqual(result["method"], "exact")
        self.assertLessEqual(result["accuracy"]["reached"], 1e-9)
        # The user may choose a grid.
        self.assertEqual(self.solved("paper", "--accuracy 1e-2 --set solver.model=full")["method"], "coulomb")

    def test_is_estimated_on_an_ellipse(self):
        # No exact twist is known: the estimate covers the difference to three times the cells and parts of steps.
        for wanted in ("1e-2", "1e-3"):
            result = self.solved("ellipse", f"--accuracy {wanted}")
            accuracy = result["accuracy"]
            cells = ",".join(str(3 * n) for n in result["cells"])
            fine = self.solved("ellipse", f"--set grid.cells=[{cells}] --set solver.substeps={3 * accuracy['substeps']}")
            self.assertEqual(accuracy["how"], "estimated")
            self.assertLessEqual(accuracy["reached"], float(wanted))
            self.assertLessEqual(abs(result["twist_angle"] / fine["twist_angle"] - 1), accuracy["reached"])

    def test_that_cannot_be_asked_for_is_refused(self):
        for scene, words, *says in (
                *(("paper", f"--accuracy {error}", "above 0 and below 1") for error in ("0", "-1e-3", "nan", "2", "inf")),
                ("paper", "--accuracy 1e-16"), ("paper", "--accuracy 1e-9 --model auto", "allowed on a grid"),
                ("paper", "--accuracy 1e-3 --set grid.cells=[64,64]", "--set grid.cells=[64,64]"),
                ("paper", "--accuracy 1e-3 --set solver.tolerance=1e-6", "--set solver.tolerance=1e-6"),
                ("paper", "--accuracy 1e-3 --model auto --set solver.method=paper", "solver.method"),
                ("paper", "--accuracy 1e-3 --accuracy-of moment", "moment"),
                ("mindlin", "--accuracy 1e-3 --model auto", "no torsion"),
                ("honed_surface", "--accuracy 1e-3", "the grid is that of upper.file"),
                # A contact of millimetres in a square metre: no mesh of reasonable size resolves it.
                *(("turned_ellipse", f"{words} --set grid.extent=[1,1]", 'grid.extent = ["1 m", "1 m"]',
                   "less than one of [64, 64] cells")
                  for words in ("--accuracy 0.1", "--accuracy 0.1 --plan", "--set grid.cells=[64,64]")),
                # The size of a contact of several shapes is known only after a solve.
                ("patches", "--accuracy 0.1 --set grid.extent=[1,1]", 'grid.extent = ["1 m", "1 m"]',
                 "too few to choose a mesh by")):
            self.text(scene, words, code=2, says=says)

    def test_says_what_it_replaces(self):
        self.text("paper", "--accuracy 1e-2 --model auto", says=["replaced", "grid.cells = [128, 128]", "attempt"])


class Plan(Solve):
    def test_predicts_what_a_solve_takes_and_stops(self):
        size = "--set grid.cells=[48,48]"
        found = self.solved("paper", f"{size} --plan")
        plan, result = found["plan"], self.solved("paper", size)
        self.assertNotIn("status", found)
        self.assertEqual(plan["cells"], result["cells"])
        self.assertLessEqual(plan["least_bytes"], result["predicted_bytes"])
        self.assertGreaterEqual(plan["bytes"], result["predicted_bytes"])
        self.assertGreater(plan["seconds"], 0)
        # Two tractions in each contact cell, over 8 by symmetry: two mirror axes and the diagonal.
        self.assertAlmostEqual(plan["unknowns"], result["contact_cells"] / 4, delta=10)

    def test_of_an_accuracy_is_that_of_the_first_attempt(self):
        words = "--model auto --accuracy 1e-2"
        plan, attempt = self.solved("paper", f"{words} --plan")["plan"], self.solved("paper", words)["accuracy"]["attempts"][0]
        for key in ("cells", "tolerance"):
            self.assertEqual(plan[key], attempt[key])

    def test_names_surfaces_outside_the_data_that_choose_its_mesh(self):
        words = "--model auto --accuracy 1e-2 --plan"
        self.assertNotIn("note", self.solved("paper", words)["plan"])
        self.assertIn("rough", self.solved("rough_sphere", words)["plan"]["note"])
        self.text("rough_sphere", words, says=["plan", "note"])

    def test_an_unknown_error_of_the_steps_is_never_reached(self):
        self.run_program(*command("dissimilar", "--accuracy 1e-1 --accuracy-of stick_radius --json unknown.json"), code=1)
        accuracy = json.loads(Path("unknown.json").read_text())["accuracy"]
        self.assertEqual((accuracy["reached"], accuracy["path"]), (None, None))
        self.assertIn("solver.substeps", accuracy["not_reached"])

    def test_holds_for_scenes_of_all_kinds(self):
        for scene in ("honed_surface", "unequal_patches", "fretting_force", "dissimilar"):
            self.assertGreater(self.solved(scene, "--plan")["plan"]["bytes"], 0, scene)
        self.assertIsNone(self.solved("paper", "--plan --model exact")["plan"]["cells"])
        self.assertIsNone(self.solved("paper", "--plan --set solver.method=paper")["plan"]["seconds"])
