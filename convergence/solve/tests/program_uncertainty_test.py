"""program_uncertainty_test.py PROGRAM: `slipstick solve --uncertain` against power laws and against random draws of this test."""

import math
import random
from statistics import NormalDist

import numpy as np

from program_run import SCENES, SHORT_SCENE, ProgramTest

DRAWS = 100_000  # of this test; the program makes 16384 exact ones, or 1024
ELLIPSE = (SHORT_SCENE.replace('"sphere"\nradius = 0.018', '"ellipsoid"\nradius_1 = 0.03\nradius_2 = 0.012')
           .replace("moment_ratio = 0.5", "moment = 0.02").replace("[32, 32]", "[64, 32]"))


class Uncertain(ProgramTest):
    def solve(self, scene, words, *more):
        return self.result("solve", scene, *more, "--uncertain", *words.split())

    def found(self, scene, words, *more):
        return self.solve(scene, words, *more)["uncertainty"]

    def text_and_found(self, scene, words, *more):
        text, result = self.text_and_result("solve", scene, *more, "--uncertain", *words.split())
        return text, result["uncertainty"]


class Derivatives(Uncertain):
    def holds_laws(self, found, words, laws, within):
        relative = [float(word.split("=")[1][:-1]) / 100 for word in words.split()]
        for name, exponents in laws.items():
            output = found["outputs"][name]
            for part, exponent in zip(output["parts"], exponents):
                self.assertAlmostEqual(part["exponent"], exponent, delta=within, msg=f"{name}, {part['key']}")
            standard = math.hypot(*(a * b for a, b in zip(exponents, [*relative, relative[-1]])))  # two bodies
            self.assertAlmostEqual(output["relative"], standard, delta=within)
            value = abs(output["value"])
            self.assertAlmostEqual(output["standard"], output["relative"] * value, delta=1e-12 * value)

    def test_follow_the_power_laws_of_hertz(self):
        # At a given moment ratio the twist is mu W / (G a^2), the limit mu W a, and a^3 = W R / E* times constants.
        third, sixth = 1 / 3, 1 / 6
        words = "friction=5% load.normal=3% radius=1% young_modulus=2%"
        length, moment = (0, third, third, -sixth, -sixth), (1, 4 * third, third, -sixth, -sixth)
        laws = {"contact_radius": length, "stick_radius": length, "moment": moment, "moment_limit": moment,
                "peak_pressure": (0, third, -2 * third, third, third),
                "approach": (0, 2 * third, -third, -third, -third),
                "twist_angle": (1, third, -2 * third, -sixth, -sixth),
                "dissipated": (2, 5 * third, -third, -third, -third)}
        for more in (["--model", "exact"], ["--set", "grid.cells=[48,48]"]):
            found = self.found(SCENES / "paper.toml", words, *more)
            self.holds_laws(found, words, laws, 1e-9)
            self.assertNotIn("draws", found)
        self.assertLess(found["outputs"]["twist_angle"]["numerical"], found["outputs"]["twist_angle"]["relative"] / 3)
        self.assertIn("refinement", found["sentence"])

    def test_follow_those_of_an_ellipse_on_a_grid(self):
        words = "friction=5% load.normal=3%"
        found = self.found(SCENES / "ellipse.toml", words)
        laws = {"twist_angle": (1, 1 / 3), "moment": (1, 4 / 3), "contact_radius": (0, 1 / 3)}
        self.holds_laws(found, words, laws, 1e-3)
        self.assertNotIn("draws", found)

    def test_of_one_body_alone(self):
        found = self.found(SCENES / "paper.toml", "upper.young_modulus=2%", "--model", "exact")
        self.assertEqual(len(found["inputs"]), 1)
        self.assertAlmostEqual(found["outputs"]["contact_radius"]["relative"], 0.02 / 6, delta=1e-9)

    def test_of_inputs_that_are_better_known_than_the_mesh_allows(self):
        found = self.found(SCENES / "paper.toml", "friction=0.001%", "--set", "grid.cells=[16,16]")
        twist = found["outputs"]["twist_angle"]
        self.assertLess(twist["relative"], twist["numerical"] / 3)
        self.assertIn("better inputs", found["sentence"])

    def test_of_forces_are_of_displacements_and_of_no_moment(self):
        for more in ([], ["--model", "exact"]):
            for force, there in (([60, 0], {0}), ([30, -40], {0, 1})):
                # Mindlin's displacement is 1 - (1 - F/(mu W))^(2/3) times mu times a constant.
                words = ["--set", f"load.force={force}", "--set", "grid.cells=[48,48]", *more]
                text, found = self.text_and_found(SCENES / "mindlin.toml", "friction=1%", *words)
                outputs, left = found["outputs"], 1 - math.hypot(*force) / 100
                self.assertEqual({i for i in (0, 1) if f"displacement[{i}]" in outputs}, there)
                exponent = 1 - 2 / 3 * (1 - left) / (left ** (1 / 3) - left)
                for i in there:
                    self.assertAlmostEqual(outputs[f"displacement[{i}]"]["parts"][0]["exponent"], exponent, delta=1e-3)
                self.assertFalse({"twist_angle", "moment", "moment_limit"} & set(outputs))
                for said in (found["sentence"], text):
                    self.assertIn("displacement along x1", said)

    def test_bad_inputs_are_refused(self):
        for word in ("fricton=5%", "shape=5%", "friction=5", "friction=-5%", "friction=five%", "friction",
                     "friction=0%", "friction=100%", "friction=nan%", "=5%", "cells=5%", "friction=5% contact.friction=2%"):
            self.run_program("solve", SCENES / "paper.toml", "--model", "exact", "--uncertain", *word.split(), code=2,
                             says=["--uncertain", "allowed"])


class Draws(Uncertain):
    def test_of_a_sphere_are_those_made_here(self, seed=20261, scenes=1):
        # mu W / (G a^2) times the exact curve at constant pressure, a function of M / (mu W^(4/3)).
        curve = self.result("exact", "--history", "0.999999999", "--points", "5000")["curve"]
        ratios, twists = (np.array([p[name] for p in curve]) for name in ("moment_ratio", "twist"))
        chance = random.Random(seed)
        for _ in range(scenes):
            moment, normal = chance.uniform(0.4, 0.97), chance.uniform(500, 3000)
            parts = {"friction": chance.uniform(0.05, 0.25), "load.normal": chance.uniform(0.02, 0.15)}
            text = SHORT_SCENE.replace("1000", str(normal))
            limit = self.result("solve", self.write("scene.toml", text), "--model", "exact")["moment_limit"]
            scene = self.write("scene.toml", text.replace("moment_ratio = 0.5", f"moment = {moment * limit}"))
            words = " ".join(f"{key}={100 * part}%" for key, part in parts.items())
            result = self.solve(scene, words, "--model", "exact")
            drawn = []
            for _ in range(DRAWS):
                friction, load = (1 + part * chance.gauss(0, 1) for part in parts.values())
                ratio = moment / (friction * load ** (4 / 3)) if friction > 0 else 1
                if ratio < ratios[-1]:
                    drawn.append(friction * load ** (1 / 3) * np.interp(ratio, ratios, twists))
            scale = result["twist_angle"] / np.interp(moment, ratios, twists)
            self.holds(result["uncertainty"], [scale * twist for twist in sorted(drawn)])

    def holds(self, found, drawn):
        draws, output, answered = found["draws"], found["outputs"]["twist_angle"], len(drawn) / DRAWS
        sampling = math.sqrt(answered * (1 - answered) / DRAWS) + math.sqrt(answered * (1 - answered) / draws["number"])
        self.assertLessEqual(abs(1 - draws["sliding"] - draws["failed"] - answered), 3 * sampling)
        for word, below in (("5 %", 0.05), ("50 %", 0.5), ("95 %", 0.95)):
            self.assertAlmostEqual(output["quantiles"][word] / drawn[int(below * len(drawn))], 1, delta=0.02)

    def test_of_an_ellipse_are_those_of_its_solves(self):
        # The twist decreases with the friction: its quantiles are the twists at the quantiles of the friction.
        scene = self.write("ellipse.toml", ELLIPSE)
        normal, spread = NormalDist(), 0.15
        result = self.solve(scene, f"friction={100 * spread}%")
        slides = normal.cdf((1 / result["limit"]["factor"] - 1) / spread)
        self.assertAlmostEqual(result["uncertainty"]["draws"]["sliding"], slides, delta=2 / 1024)
        for word, below in (("5 %", 0.05), ("50 %", 0.5), ("95 %", 0.95)):
            friction = 0.1 * (1 + spread * normal.inv_cdf(slides + (1 - below) * (1 - slides)))
            twist = self.result("solve", scene, "--set", f"contact.friction={friction}")["twist_angle"]
            found = result["uncertainty"]["outputs"]["twist_angle"]["quantiles"][word]
            self.assertAlmostEqual(found / twist, 1, delta=0.02)

    def test_at_the_limit_are_no_percentage(self):
        # On a grid; the draws are exact, and the steps of the derivatives stay below the limit. It slides where the ratio is 1.
        text, found = self.text_and_found(SCENES / "paper.toml", "moment_ratio=5%", "--set", "load.moment_ratio=0.9999", "--set",
                                          "grid.cells=[48,48]")
        part = NormalDist().cdf((0.9999 - 1) / (0.9999 * 0.05))
        self.assertTrue(found["draws"]["exact"])
        self.assertAlmostEqual(found["draws"]["sliding"], part, delta=2 / found["draws"]["number"])
        self.assertIn(f"{100 * part:.1f} % of the draws slide altogether", text)
        self.assertRegex(text, "uncertain +twist [0-9.]+ to [0-9.]+, median")
        self.assertNotIn("makes", text.split("matters")[1])
        self.assertAlmostEqual(found["outputs"]["moment"]["relative"], 0.05, delta=1e-9)

    def test_without_an_answer_for_another_reason_are_told_apart(self):
        normal = NormalDist()
        draws = self.found(SCENES / "mindlin.toml", "friction=50%", "--model", "exact")["draws"]  # F = 0.6 mu W
        self.assertAlmostEqual(draws["failed"], normal.cdf(-2), delta=2 / 16384)
        self.assertAlmostEqual(draws["sliding"], normal.cdf(-0.8) - normal.cdf(-2), delta=4 / 16384)
        self.assertIn("contact.friction = -", draws["failed_reason"])
