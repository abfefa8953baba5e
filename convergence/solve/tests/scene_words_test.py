"""scene_words_test.py PROGRAM: units, points of a step, shapes of both bodies, and reasons to doubt a scene."""

import csv
import json
import math
import re
from pathlib import Path

from program_run import SHORT_SCENE, ProgramTest

ROUGH = 'shape = "roughness"\nseed = 3\nhurst = 0.8\nlongest = 4e-4\nshortest = 1e-4\nrms_slope = 0.01\n'
GRID = "[grid]\ncells = [32, 32]\n"
MILLIMETRES = 'units = "mm"\n' + SHORT_SCENE.replace("0.018", "18").replace("210e9", "210e3") + "extent = [1.1, 1.1]\n"
TEXTS = (SHORT_SCENE.replace("0.018", '"18 mm"').replace("210e9", '"210 GPa"').replace("= 1000", '= "1 kN"')
         + 'extent = ["1.1 mm", "1100 um"]\n')
UNLOADED = SHORT_SCENE.replace("moment_ratio = 0.5\n", "")


class Words(ProgramTest):
    def solved(self, text, *options, **expected):
        self.write("scene.toml", text)
        Path("r.json").unlink(missing_ok=True)
        self.said = self.run_program("solve", "scene.toml", "--json", "r.json", *options, **expected)
        return json.loads(Path("r.json").read_text())


class UnitsTest(Words):
    NUMBERS = ("contact_radius", "peak_pressure", "moment", "twist_angle", "stick_radius", "normal_load")

    def test_millimetres_and_texts_are_the_same_scene_in_si_units(self):
        """To the last digit, since a unit is a power of ten of the decimal number."""
        metres = self.solved(SHORT_SCENE + "extent = [1.1e-3, 1.1e-3]\n")
        for text in (MILLIMETRES, TEXTS):
            other = self.solved(text)
            for key in self.NUMBERS:
                self.assertEqual(other[key], metres[key], key)

    def test_texts_for_people_have_the_units_of_the_file(self):
        result = self.solved(MILLIMETRES)
        for words in (f"contact radius   {1e3 * result['contact_radius']:.6g} mm",
                      f"peak pressure    {1e-6 * result['peak_pressure']:.6g} MPa",
                      f"moment           {1e3 * result['moment']:.6g} N mm"):
            self.assertIn(words, self.said)
        rough = ROUGH.replace("4e-4", "0.4").replace("1e-4", '"100 um"')
        self.solved(MILLIMETRES.replace("[lower]\n", "[lower]\n" + rough).replace("[1.1, 1.1]", "[1.2, 1.2]"))
        self.assertIn(" mm^2 (", self.said)
        self.solved(TEXTS)
        self.assertIn(f"peak pressure    {1e-9 * result['peak_pressure']:.6g} GPa", self.said)
        self.assertIn("normal load      1 kN", self.said)

    def test_a_degree_is_a_180th_of_pi(self):
        result = self.solved(UNLOADED, "--set", "load.twist=0.05 deg")
        self.assertAlmostEqual(result["twist_angle"], 0.05 * math.pi / 180, delta=1e-15)
        self.assertIn("twist            0.05 deg", self.said)

    def test_percents_are_hundredths(self):
        half = self.solved(SHORT_SCENE, "--set", "load.moment_ratio=50 %")
        for key in self.NUMBERS:
            self.assertEqual(half[key], self.solved(SHORT_SCENE)[key], key)

    def test_an_extent_that_a_message_names_can_be_typed(self):
        """In a scene in mm, whose numbers without a unit are in mm."""
        small = MILLIMETRES.replace("[1.1, 1.1]", "[0.5, 0.5]")
        self.write("scene.toml", small)
        said = self.run_program("solve", "scene.toml", code=2, says="grid.extent")
        allowed = re.search(r'about (\["[^"]* mm", "[^"]* mm"\])', said).group(1)
        larger = [1.1 * float(each.split()[0]) for each in json.loads(allowed)]
        self.solved(small.replace("[0.5, 0.5]", str(larger)))

    def test_units_of_powers_and_of_the_power_law_of_friction_follow(self):
        """A gap of c r^3, c in m^-2, and a friction k p^0.5, k in Pa^0.5."""
        power = {"m": 3e4, "mm": 3e-2}
        k = {"m": 3e3, "mm": 3.0}
        found = {}
        for units, text in (("m", SHORT_SCENE), ("mm", MILLIMETRES.replace("extent = [1.1, 1.1]\n", ""))):
            radius = "radius = 0.018" if units == "m" else "radius = 18"
            text = (text.replace('"sphere"', '"power"').replace(radius, f"exponent = 3\ncoefficient = {power[units]}")
                    .replace("friction = 0.1", f'friction = {k[units]}\nfriction_law = "power"\nfriction_exponent = 0.5'))
            found[units] = self.solved(text)
        for key in self.NUMBERS:
            self.assertAlmostEqual(found["mm"][key] / found["m"][key], 1.0, delta=1e-9, msg=key)

    def test_an_uncertain_number_keeps_its_unit(self):
        result = self.solved(TEXTS, "--uncertain", "radius=1%")
        self.assertEqual(result["uncertainty"]["inputs"][0]["value"], 18.0)

    def test_a_unit_of_another_kind_is_refused_with_those_of_this_kind(self):
        for key, value in (("load.normal", "1 kg"), ("upper.radius", "1 N"), ("upper.radius", "mm"),
                           ("upper.radius", "1 2 mm"), ("contact.friction", "1 mm")):
            words = () if key == "contact.friction" else ("with a unit, ", "kN" if key == "load.normal" else "cm, mm")
            self.write("scene.toml", SHORT_SCENE)
            self.run_program("solve", "scene.toml", "--set", f"{key}={value}", code=2, says=(key, "a number", *words))


class PointsTest(Words):
    LOOP = "[[step]]\nmoment_ratio = 0.8\npoints = 4\n[[step]]\nname = 'back'\nmoment_ratio = -0.8\npoints = 8\n"

    def test_are_steps_at_equal_parts_of_the_load(self):
        """Written out as steps, a history gives the same bits."""
        result = self.solved(UNLOADED + self.LOOP, "--loop", "loop.csv")
        ratios = [0.2, 0.4, 0.6000000000000001, 0.8, *(0.8 - 0.2 * i for i in range(1, 8)), -0.8]
        self.assertEqual([step["name"] for step in result["steps"]][:5], ["1 1/4", "1 2/4", "1 3/4", "1 4/4", "back 1/8"])
        for step, ratio in zip(result["steps"], ratios, strict=True):
            self.assertAlmostEqual(step["moment_ratio"], ratio, delta=1e-12)
        out = "".join(f"[[step]]\nmoment_ratio = {step['moment_ratio']}\n" for step in result["steps"])
        written = self.solved(UNLOADED + out)
        self.assertAlmostEqual(written["twist_angle"], result["twist_angle"], delta=1e-9 * abs(result["twist_angle"]))
        with open("loop.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["moment"]) for row in rows], [step["moment"] for step in result["steps"]])
        self.assertEqual([float(row["rotation"]) for row in rows], [step["twist_angle"] for step in result["steps"]])

    def test_a_later_cycle_begins_at_the_end_of_the_last(self):
        result = self.solved("cycles = 2\n" + UNLOADED + self.LOOP)
        second = [step["moment_ratio"] for step in result["steps"][12:17]]
        for found, ratio in zip(second, (-0.4, 0.0, 0.4, 0.8, 0.6)):
            self.assertAlmostEqual(found, ratio, delta=1e-12)
        self.assertEqual([step["cycle"] for step in result["steps"]], [1] * 12 + [2] * 12)

    def test_normal_load_force_and_motion_are_divided_too(self):
        result = self.solved(UNLOADED + "[[step]]\nforce = [10, 0]\n[[step]]\nnormal = 2000\nforce = [30, 20]\npoints = 2\n"
                             "[[step]]\nforce = [0, 0]\n[[step]]\ndisplacement = [0.0, 2e-8]\npoints = 2\n")
        half = result["steps"][1]
        self.assertAlmostEqual(half["normal_load"], 1500.0, delta=1e-6)
        self.assertAlmostEqual(half["force"][0], 20.0, delta=1e-9)
        self.assertAlmostEqual(half["force"][1], 10.0, delta=1e-9)
        self.assertAlmostEqual(result["steps"][4]["displacement"][1], 1e-8, delta=1e-20)

    def test_loads_of_two_kinds_have_nothing_between_them(self):
        self.write("scene.toml", UNLOADED + "[[step]]\nmoment_ratio = 0.5\n[[step]]\ntwist = 1e-4\npoints = 2\n")
        self.run_program("solve", "scene.toml", code=2, says=("step[1].points", "loads of one kind"))
        self.run_program("solve", "scene.toml", "--set", "step[1].points=0", code=2, says=("step[1].points", "from 1"))

    def test_each_point_has_a_figure(self):
        self.solved(UNLOADED + self.LOOP.replace("points = 8", "points = 2"), "--set", "grid.cells=[16,16]", "--figure", "slip-{step}.svg")
        self.assertEqual(len(list(Path().glob("slip-*.svg"))), 6)
        self.assertIn("moment against twist", Path("slip-3.svg").read_text())
        self.run_program("solve", "scene.toml", "--figure", "slip-{step}.svg", "--checkpoint", "c.h5", code=2,
                         says="with --checkpoint")
        self.run_program("solve", "scene.toml", "--loop", "loop.txt", code=2, says="allowed ending: .csv")


class ShapesTest(Words):
    def test_roughness_on_either_body_is_the_same_gap(self):
        sphere = 'shape = "sphere"\nradius = 0.018\n'
        extent = SHORT_SCENE.replace(GRID, GRID + "extent = [1.2e-3, 1.2e-3]\n")
        upper = extent.replace(sphere, "").replace("[contact]", f"[[upper.shape]]\n{sphere}[[upper.shape]]\n{ROUGH}[contact]")
        below = extent.replace("[lower]\n", "[lower]\n" + ROUGH)
        tables = extent.replace("[contact]", f"[[lower.shape]]\n{ROUGH}[contact]")
        expected = self.solved(upper)
        for text in (below, tables):
            result = self.solved(text)
            for key in ("contact_cells", "peak_pressure", "moment", "twist_angle"):
                self.assertEqual(result[key], expected[key], key)
        self.assertNotEqual(expected["peak_pressure"], self.solved(extent)["peak_pressure"])

    def test_the_nearest_of_several_shapes_faces_a_plane(self):
        pair = 'combine = "nearest"\nshape = [{shape = "sphere", radius = 0.018}, {shape = "sphere", radius = 0.01}]\n'
        text = SHORT_SCENE.replace('shape = "sphere"\nradius = 0.018\n', pair).replace("[lower]\n", "[lower]\n" + ROUGH)
        self.write("scene.toml", text)
        self.run_program("solve", "scene.toml", code=2, says=("lower.shape", "nearest"))


class KeysTest(Words):
    def test_the_last_override_holds_and_a_wrong_value_below_it_is_none(self):
        result = self.solved(SHORT_SCENE)
        self.assertEqual(result["name"], "scene")  # the file's
        result = self.solved(SHORT_SCENE.replace("friction = 0.1", 'friction = "x"'), *(word for each in (
            "load.normal=5", "contact.friction=0.2", "grid.cells=[8, 9]", "name=other", "load.normal=6", "contact.pressure=hertz",
            'solver.operator="dense"') for word in ("--set", each)))
        self.assertAlmostEqual(result["normal_load"], 6, delta=0.1)  # of Hertz's pressure at the centres of few cells
        for key, value in (("name", "other"), ("friction", 0.2), ("cells", [8, 9]), ("pressure", "hertz"),
                           ("operator", "dense")):
            self.assertEqual(result[key], value, key)

    def test_an_override_finds_a_step_by_its_place(self):
        """And a load replaces another; what is not there is not made."""
        steps = ("moment_ratio = 0.2", "moment_ratio = 0.3", "moment_ratio = 0.1\nforce = [1, 0]")
        text = UNLOADED + "".join(f"[[step]]\n{step}\n" for step in steps)
        settings = ("step[0].twist=1e-4", "step[2].moment_ratio=0.4", "step[2].force=[2, 0]")
        first, second, third = self.solved(text, *(word for each in settings for word in ("--set", each)))["steps"]
        self.assertAlmostEqual(first["twist_angle"], 1e-4, delta=1e-18)
        for step, ratio, force in ((second, 0.3, 0), (third, 0.4, 2)):
            self.assertAlmostEqual(step["moment_ratio"], ratio, delta=1e-12)
            self.assertAlmostEqual(step["force"][0], force, delta=1e-9)
        for path in ("step[3].force", "step[].force", "step[-1].force", "step[x].force", "grid.cells[0].force", "stage[0].force",
                     "step[2].part[0].force"):
            self.run_program("solve", "scene.toml", "--set", f"{path}=1", code=2,
                             says=(f"--set {path}", "is not a table of the scene file"))

    def test_a_number_has_digits_on_both_sides_of_its_point(self):
        self.write("scene.toml", SHORT_SCENE)
        for number in (".5", "-.5", "5.", "5.e-1"):
            for setting in (f"load.normal={number}", f"grid.extent=[1, {number}]"):
                self.run_program("solve", "scene.toml", "--set", setting, code=2, says="both sides")
        self.assertNotIn("both sides", self.run_program("solve", "scene.toml", "--set", "load.normal=five.", code=2))
        self.assertEqual(self.solved(SHORT_SCENE, "--set", "name=.5")["name"], ".5")

    def test_a_whole_number_that_no_double_holds_is_a_number_too(self):
        result = self.solved(SHORT_SCENE, "--model", "exact", "--set", "load.normal=9223372036854775807")
        self.assertEqual(result["normal_load"], 2.0**63)

    def test_a_rigid_body_has_no_modulus(self):
        """a^3 = 3 W R (1 - nu^2)/(4 E), of the elastic body. Both may be rigid below a layer."""
        steel = "young_modulus = 210e9\npoisson_ratio = 0.3\n"
        rigid = SHORT_SCENE.replace(steel, "rigid = true\n", 1)
        exact = (3 * 1000 * 0.018 * 0.91 / (4 * 210e9))**(1 / 3)
        found = self.solved(rigid, "--model", "exact", "--set", "contact.coupling=none")["contact_radius"]
        self.assertAlmostEqual(found / exact, 1, delta=1e-14)
        layer = f"[lower.layer]\nthickness = 1e-4\n{steel}"
        coated = rigid.replace(steel, "rigid = true\n") + "extent = [1.6e-3, 1.6e-3]\n" + layer
        layer_only = self.solved(coated)
        self.assertLess(layer_only["contact_radius"], exact)
        between = self.solved(coated + '[layer]\nkind = "winkler"\nnormal_compliance = 1e-14\ntangential_compliance = 1e-14\n')
        self.assertGreater(between["approach"], layer_only["approach"])

    def test_roughness_has_a_period_of_four_longest_waves(self):
        """And overrides find a shape by its place."""
        rough = ROUGH.replace("[lower]", "")
        text = SHORT_SCENE.replace("[contact]", f"[[lower.shape]]\n{rough}[contact]") + "extent = [1.2e-3, 1.2e-3]\n"
        usual, same, other = (self.solved(text, "--set", f"lower.shape[0].{key}")
                              for key in ("seed=3", "period=1.6e-3", "period=2e-3"))
        self.assertEqual(usual["twist_angle"], same["twist_angle"])
        self.assertNotEqual(usual["twist_angle"], other["twist_angle"])


class DoubtsTest(Words):
    def doubted(self, text, *words, options=()):
        result = self.solved(text, *options)
        self.assertEqual(result["status"], "converged")
        self.assertEqual(len(result["warnings"]), len(words), result["warnings"])
        for warning, parts in zip(result["warnings"], words):
            self.assertIn("slipstick: warning: " + warning, self.said)
            for part in parts:
                self.assertIn(part, warning)

    def test_a_plausible_scene_has_none(self):
        self.assertNotIn("warnings", self.solved(SHORT_SCENE.replace("[lower]", "yield_stress = 9e9\n[lower]")))
        self.assertNotIn("warning", self.said)

    def test_a_contact_wider_than_its_sphere(self):
        """Hertz: 50 um on 18 um, W = 4 E* a^3/(3 R); the peak pressure is (2/pi) E* a/R = 0.97 E."""
        radius = 18e-6
        load = 4 / 3 * 210e9 / 1.82 * (50e-6)**3 / radius
        text = SHORT_SCENE.replace("0.018", f"{radius}").replace("normal = 1000", f"normal = {load}")
        self.doubted(text, ("upper: the contact's radius", "2.78", "above 0.3"))

    def test_a_steep_cone_and_steep_roughness(self):
        cone = SHORT_SCENE.replace('"sphere"\nradius = 0.018', '"cone"\nslope = 0.5').replace("1000", "10")
        self.doubted(cone, ("upper: the slope, 0.5",))
        self.doubted(cone, ("upper: the slope, 0.5",), options=("--model", "exact"))
        rough = SHORT_SCENE.replace("[lower]\n", "[lower]\n" + ROUGH.replace("0.01", "0.4")).replace(
            GRID, GRID + "extent = [2.4e-3, 2.4e-3]\n")
        self.doubted(rough, ("lower.shortest", "1.33 cells", "fewer than 4"), ("lower: the slope, 0.4",))
        fine = rough.replace("0.4", "0.01")
        self.assertNotIn("warnings", self.solved(fine, "--set", "lower.shortest=300e-6", "--set", "lower.longest=8e-4"))

    def test_a_modulus_in_gigapascals(self):
        text = SHORT_SCENE.replace("210e9", "210")
        self.doubted(text, ("upper: the contact's radius",), ("exceeds upper.young_modulus", "210e9"),
                     ("exceeds lower.young_modulus",))

    def test_a_pressure_above_the_yield_stress_of_one_body(self):
        """Hertz: p0 = 3 W/(2 pi a^2) = 1.996 GPa."""
        self.doubted(SHORT_SCENE.replace("[contact]", "yield_stress = \"1 GPa\"\n[contact]"),
                     ("2 times lower.yield_stress",), options=("--set", "upper.yield_stress=2e9", "--model", "exact"))

    def test_a_twist_in_degrees(self):
        self.doubted(UNLOADED, ("all slides", "load.twist is in rad"), options=("--set", "load.twist=1.0"))
