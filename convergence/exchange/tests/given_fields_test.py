"""given_fields_test.py PROGRAM: pressure and tractions that another program found, described as an answer, and the scene that the
program receives."""

import json
import math
import sys
from pathlib import Path

from program_run import SHORT_SCENE, ProgramTest

CELLS = ("grid.cells=[24,20]", "grid.extent=[0.0014,0.0015]")  # no squares, with room for softer bodies
COPY = "import shutil, sys\nshutil.copy(sys.argv[1], 'scene.json')\nshutil.copy('given.csv', sys.argv[2])\n"


class GivenFields(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("sphere.toml", SHORT_SCENE)
        self.write("copy.py", COPY.replace("'scene", f"'{self.folder}/scene").replace("'given", f"'{self.folder}/given"))
        self.write("program.toml", f"name = 'copy'\ncommand = [{sys.executable!r}, 'copy.py', '{{scene}}', '{{field}}']\n")

    def solve(self, *settings, words=()):
        return self.result("solve", "sphere.toml", "--quiet", *(word for each in (*CELLS, *settings) for word in ("--set", each)),
                           *words, code=(0, 1))

    def described(self, *settings, factor=1):
        """The result of a solve, and that of a program which finds its pressure and `factor` times its tractions."""
        solved = self.solve(*settings, words=("--fields", "fields.csv"))
        rows = [line.split(",")[:5] for line in Path("fields.csv").read_text().splitlines()]
        self.write("given.csv", "".join(",".join(row[:3] + [row[k] if i == 0 else repr(factor * float(row[k])) for k in (3, 4)]) + "\n"
                                        for i, row in enumerate(rows)))
        return solved, self.solve(*settings, words=("--program", "program.toml"))

    def test_of_a_solve_are_that_solve(self):
        """Under the solve's own motion, and no other, its fields satisfy Coulomb's law."""
        for settings in ((), ("load.moment_ratio=0.7", "load.force=[40.0,20.0]"), ("load.twist=1e-3", "load.displacement=[1e-7,2e-7]"),
                         ("lower.young_modulus=70e9", "upper.poisson_ratio=0.2")):
            with self.subTest(settings):
                solved, found = self.described(*settings)
                moved = max(math.hypot(*solved["displacement"]), abs(solved["twist_angle"]) * solved["contact_radius"])
                for one, other in zip(found["displacement"], solved["displacement"]):
                    self.assertAlmostEqual(one, other, delta=1e-5 * moved)
                for key, within in (("twist_angle", 1e-5), ("approach", 1e-8), ("moment", 1e-12), ("moment_limit", 1e-9),
                                    ("elastic_energy", 1e-9), ("dissipated", 1e-4), ("contact_cells", 0)):
                    self.assertAlmostEqual(found[key], solved[key], delta=within * abs(solved[key]), msg=key)
                for key, most in (("gap", 1e-6), ("moment", 1e-7), ("force", 1e-7)):
                    self.assertLessEqual(found["certificate"][key], most)
                self.assertLessEqual(found["pressure_complementarity"], 1e-8)

    def test_that_are_too_small_miss_their_load(self):
        """The moment is less by the same part, and Coulomb's law holds in no motion."""
        _, found = self.described("load.moment_ratio=0.9", factor=0.9)
        self.assertAlmostEqual(found["certificate"]["moment"], 0.09, delta=1e-6)
        self.assertGreaterEqual(found["certificate"]["gap"], 1e-2)

    def test_constants_of_the_pair(self):
        """E*, G and nu of a pair, by hand. Surfaces of one material on unlike bases are moved by the pressure by different amounts."""
        self.described("lower.young_modulus=70e9", "lower.poisson_ratio=0.25")
        posed = json.loads(Path("scene.json").read_text())
        upper, lower = 210e9 / 2.6, 70e9 / 2.5
        shear = 1 / (1 / upper + 1 / lower)
        for key, right in (("shear_modulus", shear), ("contact_modulus", 1 / (0.91 / 210e9 + 0.9375 / 70e9)),
                           ("poisson_ratio", (0.3 / upper + 0.25 / lower) * shear), ("mismatch", 0.5 / lower - 0.4 / upper)):
            self.assertAlmostEqual(posed["combined"][key] / right, 1, delta=1e-10, msg=key)
        self.assertEqual((posed["coupling"], posed["pressure"]), ("pressure", None))
        for settings, coupling in (((), "none"), (("lower.young_modulus=70e9",
                                                   "lower.layer={thickness=1e-4,young_modulus=210e9,poisson_ratio=0.3}"), "pressure")):
            self.described(*settings)
            posed = json.loads(Path("scene.json").read_text())
            self.assertEqual((posed["combined"]["mismatch"], posed["coupling"]), (0, coupling))
