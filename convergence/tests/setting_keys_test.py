"""setting_keys_test.py PROGRAM: the readers of scenes, studies, gates and hard cases agree with their tables of keys, which
`slipstick reference` has: they read each key, refuse other values with the table's words, and take a key with the shapes that
the table names."""

import json
import re
from pathlib import Path

from program_run import ProgramTest

SHAPES = {"sphere": "radius = 1", "ellipsoid": "radius_1 = 1\nradius_2 = 2", "cone": "slope = 0.1",
          "power": "exponent = 4\ncoefficient = 1", "flat_punch": "radius = 1", "rounded_punch": "flat_radius = 1\ncorner_radius = 1",
          "height_map": 'file = "heights.csv"\nspacing = [1, 1]',
          "roughness": "seed = 1\nhurst = 0.8\nrms_slope = 0.1\nlongest = 1\nshortest = 0.1"}
LAWS = {"contact.shear_strength": "capped", "contact.friction_exponent": "power"}  # of friction, that have the key
COATING = "thickness = 1\nyoung_modulus = 1\npoisson_ratio = 0.3\n"
LAYER = '[layer]\nkind = "winkler"\nnormal_compliance = 1\ntangential_compliance = 1\n'
STUDY = """
name = "all"
scene = "scene.toml"
set = { "load.moment_ratio" = 0.5 }
cells = [16, 32]
shifts = 2
tolerances = [1e-2, 1e-4]
quantities = ["twist"]
[[vary]]
key = "contact.friction"
values = [0.1, 0.2]
"""
GATES = """
made_by = "make it"
[[gate]]
id = "a"
status = "report_only"
scene = "scene.toml"
set = { "load.moment_ratio" = 0.5 }
quantity = "twist"
above = 0
below = 1
platform_spread = 1e-9
basis = "theory"
reason = "all keys"
[[group]]
study = "study.toml"
[[group.gate]]
id = "b"
quantity = "verdict"
equals = "asymptotic"
basis = "theory"
[[gate]]
id = "c"
result = "result.json"
quantity = "number"
of = "other.json"
within = 1e-3
basis = "theory"
[[gate]]
id = "d"
scene = "scene.toml"
quantity = "number"
published = "1.10"
published_in = "Somebody"
seen_in = "somewhere"
argument_error = 1e-3
own_error = 1e-3
times = 2
inverse = true
differs = "a misprint"
basis = "theory"
[[gate]]
id = "e"
quantity = "number"
published = "1"
published_in = "Somebody"
not_compared = "no such scene"
[[gate]]
id = "f"
scene = "scene.toml"
quantity = "number"
published = "1"
published_in = "Somebody"
undecided = "a coarse study"
"""
CASES = """[[family]]
name = "all"
why = "every key"
scene = "scene.toml"
set = { "load.moment_ratio" = 0.5 }
[[family.vary]]
key = "contact.friction"
values = [0.1, 0.2]
"""


def wrong_for(key):
    """A value that the type has not, and the end of the message about it."""
    words = key["allowed"]
    return {"number": ('"no"', "a number, " + words.split(",")[0]), "[a, b], two numbers": ("1", f"[a, b], two numbers, each {words}"),
            "one of some words": ('"no such word"', "allowed: " + words), "text": ("1", "a string"),
            "path, relative to this file": ("1", "a string"), "true or false": ("1", "true, false"),
            "tables": ("1", f"tables, each headed [[{key['name']}]]")}[key["type"]]


def scene_with(shape, body, several):
    """The shape is that of `body`, alone or the second of two tables; above [lower] there is then a sphere."""
    own = f'shape = "{shape}"\n{SHAPES[shape]}\n'
    sphere = 'shape = "sphere"\nradius = 1\n'
    if several:
        own = f"[[{body}.shape]]\n{sphere}[[{body}.shape]]\n{own}"
    shapes = {"upper": sphere, body: own}
    text = "".join(f"[{name}]\nyoung_modulus = 1\npoisson_ratio = 0.3\n{shapes.get(name, '')}" for name in ("upper", "lower"))
    return (text + '[contact]\nfriction = 0.1\npressure = "file"\npressure_file = "p.csv"\n[load]\nnormal = 1\n[[step]]\n[grid]\n'
            "cells = [8, 8]\n" + ("" if shape == "height_map" else "extent = [1, 1]\n"))


class SettingKeys(ProgramTest):
    def setUp(self):
        super().setUp()
        self.run_program("reference", "--json", "keys.json")
        self.keys = json.loads(Path("keys.json").read_text())["keys"]

    def complaint(self, key, shape):
        """About a wrong value for a key of a scene."""
        name = key["name"]
        body = "lower" if name.startswith("lower.") else "upper"
        of_table = name[5:].startswith(".shape.")
        text = scene_with(shape, body, of_table or name == "upper.combine") + (LAYER if name.startswith("layer.") else "")
        for table in ("upper.layer", "lower.layer"):
            text += f"[{table}]\n{COATING}" if name.startswith(table + ".") else ""
        if of_table:
            name = f"{body}.shape[1].{name[12:]}"
        law = ("--set", "contact.friction_law=" + LAWS[name]) if name in LAWS else ()
        name = re.sub(r"^step\.", "step[0].", name)
        return self.run_program("solve", self.write("scene.toml", text), *law, "--set", f"{name}={wrong_for(key)[0]}", code=2)

    def test_a_scene_refuses_what_the_table_does_not_allow(self):
        for key in self.keys["scene"]:
            self.assertIn(wrong_for(key)[1], self.complaint(key, (key["shapes"] or ["sphere"])[0]), key["name"])

    def test_keys_belong_to_the_shapes_that_the_table_names(self):
        for key in self.keys["scene"]:
            if not key["shapes"] or ".shape." in key["name"]:
                continue
            for shape in SHAPES:
                said = self.complaint(key, shape)
                self.assertEqual("unknown key" not in said, shape in key["shapes"], (key["name"], shape, said))

    def test_each_key_is_in_the_table_once(self):
        for name, keys in self.keys.items():
            names = [key["name"] for key in keys]
            self.assertEqual(len(names), len(set(names)), name)

    def test_studies_gates_and_hard_cases_read_every_key(self):
        """The scene that they name is missing, which is found after all keys were read."""
        for command, name, text, *options in (("study", "study", STUDY), ("gate", "gate", GATES), ("hard", "hard", CASES, "--once")):
            for key in self.keys[name]:
                last = key["name"].split(".")[-1]
                self.assertIn(f"[[{key['name']}]]" if key["type"] == "tables" else f"\n{last} = ", text, key["name"])
            said = self.run_program(command, self.write(f"all_{name}.toml", text), *options, "--output", "runs", code=(0, 2))
            self.assertNotIn("unknown key", said)
            self.assertIn("refused" if name == "hard" else "cannot be read", said)
