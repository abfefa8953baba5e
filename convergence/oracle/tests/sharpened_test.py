"""sharpened_test.py PROGRAM: fields whose square-root edges are read off are nearer to the exact ones, whatever the contact's
law and load; they keep to the friction's bound; edges that are no root on these cells are left as they are."""

import json
import subprocess

import numpy as np
from program_run import PROGRAM, SCENES, ProgramTest


def solve(scene, *settings, fields=None):
    words = [PROGRAM, "solve", SCENES / f"{scene}.toml", "--json", "-"]
    for setting in settings:
        words += ["--set", setting]
    return json.loads(subprocess.run(words + (["--fields", fields] if fields else []), capture_output=True, check=True).stdout)


def errors(scene, *settings):
    """Errors of tractions at cell centres, root mean square: as they are solved, and sharpened."""
    error = solve(scene, *settings)["traction_error"]
    return error["l2"], error["sharpened"]["l2"]


class Sharpened(ProgramTest):
    def test_is_nearer_under_every_load_and_law(self):
        for case in (("paper-0.5", "grid.cells=[256,256]"), ("paper", "grid.cells=[256,256]"), ("rounded_punch",), ("mindlin",),
                     ("rubber_lens",), ("growing_load",), ("fretting_torsion",), ("coated_sphere", "grid.cells=[256,256]"),
                     ("paper", "grid.cells=[200,200]", "upper.at=[3e-5,1e-5]", "grid.extent=[1.3e-3,1.3e-3]")):
            raw, sharp = errors(*case)
            self.assertLess(sharp, 0.5 * raw, case)

    def test_is_no_worse_where_an_edge_is_no_root_on_these_cells(self):
        def sphere(*more, radius=0.018, young=210e9):
            return ("paper", f"upper.radius={radius}", f"upper.young_modulus={young}", *more)

        tresca = ('contact.friction_law="tresca"', "contact.shear_strength=5e7")
        for case in (sphere(*tresca, "grid.cells=[24,24]", "load.moment_ratio=0.94"),  # a stick area of few cells
                     sphere("grid.cells=[48,48]", "load.moment_ratio=0.1"),  # a ring of 2 cells
                     ("coated_sphere", "lower.layer.young_modulus=40e9", "lower.layer.thickness=6e-5", "grid.cells=[40,40]"),
                     ("coated_sphere", "lower.layer.thickness=5e-5", "grid.cells=[64,64]", "load.moment_ratio=0.3"),
                     ("cone", "grid.cells=[64,64]", "load.moment_ratio=0.91"),  # a tip in the stick area
                     ("rounded_punch", "upper.flat_radius=6e-4", "grid.cells=[40,40]", "load.moment_ratio=0.2")):
            error = solve(*case)["traction_error"]
            self.assertLess(error["sharpened"]["l2"], 1.03 * error["l2"], case)
            self.assertIn("kept", error["sharpened"], case)

    def test_falls_faster_than_the_first_order(self):
        for traction in ("constant", "smooth"):
            means = []
            for cells in (96, 384):
                means.append(np.mean([errors("paper", f"load.moment_ratio={ratio}", f"solver.cell_traction={traction}",
                                             f"grid.cells=[{cells + more},{cells + more}]")[1]
                                      for ratio in (0.5, 0.7, 0.9) for more in (0, 2, 4)]))
            self.assertGreater(means[0] / means[1], 4.5, traction)  # 4 is the first order

    def test_leaves_a_punch_as_it_is(self):
        raw, sharp = errors("flat_punch", "load.moment_ratio=0.7")
        self.assertAlmostEqual(sharp / raw, 1.0, places=12)

    def test_keeps_to_the_bound_and_to_the_direction(self):
        for scene, bound in (("paper", lambda p: 0.1 * p), ("capped_friction", lambda p: np.minimum(0.1 * p, 1e8)),
                             ("rubber_lens", lambda p: np.where(p > 0, 0.3e6, 0.0))):
            solve(scene, fields="fields.csv")
            rows = np.genfromtxt("fields.csv", delimiter=",", names=True)
            sharp = np.hypot(rows["q1_sharpened"], rows["q2_sharpened"])
            largest = sharp.max()
            self.assertLessEqual((sharp - bound(rows["pressure_sharpened"])).max(), 1e-9 * largest, scene)
            across = rows["q1_sharpened"] * rows["q2"] - rows["q2_sharpened"] * rows["q1"]
            self.assertLessEqual(np.abs(across).max(), 1e-9 * largest**2, scene)
            self.assertGreaterEqual((rows["q1_sharpened"] * rows["q1"] + rows["q2_sharpened"] * rows["q2"]).min(), 0.0)
