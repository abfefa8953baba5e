"""report_words_test.py PROGRAM: errors that a page is asked for, and the scenes whose errors are against exact answers."""

from program_run import SCENES, ProgramTest

# By theory; others know the normal contact at most.
EXACT = ("paper", "paper-0.1", "paper-0.5", "paper-0.99", "off_centre", "cone", "flat_punch", "rounded_punch", "mindlin", "goodman",
         "spence", "spence_sphere", "fretting_force", "fretting_torsion", "growing_load", "torsion_loop", "coated_sphere",
         "rubber_lens", "capped_friction")


class Words(ProgramTest):
    def test_wanted_error_is_a_quantity_and_a_number_below_one(self):
        for word in ("twist", "twist=", "twist=0", "twist=1", "twist=-1e-3", "twist=nan", "twist=1e-3x"):
            self.run_program("report", str(SCENES / "paper.toml"), "--want", word, code=2, says=("--want", word))

    def test_scenes_have_the_exact_answers_that_theory_has(self):
        for scene in SCENES.glob("*.toml"):
            with self.subTest(scene.stem):
                said = self.run_program("solve", str(scene), "--quiet", "--set", "solver.model=exact", "--set", "grid.cells=[16,16]",
                                        code=0 if scene.stem in EXACT else 2)
                self.assertEqual("solver.model" in said or "grid.cells" in said, scene.stem not in EXACT, said)
