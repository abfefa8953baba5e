"""Base of the tests of `slipstick check`: fields as other programs write them, made from solves, and the verdicts on them."""

import functools
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

PROGRAM = Path(sys.argv[1]).resolve()
CHECK = Path(__file__).resolve().parents[1]
SCENES = CHECK.parent / "scenes"
TEMPORARY = tempfile.TemporaryDirectory()  # goes with the program
FOLDER = Path(TEMPORARY.name)
MPA = [1, 1, 1e-6, 1e-6, 1e-6]  # factors of the columns
LAWS = {"Tresca's law": ('contact.friction_law="tresca"', "contact.shear_strength=1e8"),
        "the capped law": ('contact.friction_law="capped"', "contact.shear_strength=1e8"),
        "the power law": ('contact.friction_law="power"', "contact.friction=2000", "contact.friction_exponent=0.5")}
LAYERS = (("lower.layer={thickness=1e-4,young_modulus=420e9,poisson_ratio=0.25}", "contact.coupling=none"),
          ("upper.layer={thickness=3e-4,young_modulus=20e9,poisson_ratio=0.4}", "contact.coupling=none"),
          ('layer={kind="winkler",normal_compliance=3e-16,tangential_compliance=5e-15}', "grid.extent=[1.3e-3,1.3e-3]"))


def ratio(number):
    return f"load.moment_ratio={number}"


def also(scene, *settings):
    """The words of a scene with more of its keys set."""
    return scene + tuple(word for setting in settings for word in ("--set", setting))


def example(name, cells=32, *settings):
    """The words of a scene of convergence/scenes/ with `cells` cells along x1."""
    return also((SCENES / f"{name}.toml",), f"grid.cells=[{cells},{cells // 2 if name == 'ellipse' else cells}]", *settings)


def run(*words):
    """The result as JSON, and the output as its `text`; the message where the program refuses."""
    ran = subprocess.run([PROGRAM, *map(str, words), "--json", FOLDER / "result.json"], capture_output=True, text=True)
    return ran.stderr if ran.returncode > 1 else json.loads((FOLDER / "result.json").read_text()) | {"text": ran.stdout}


@functools.lru_cache(maxsize=None)
def solve(scene):
    """Rows x1, x2 (m), pressure, q1, q2 (Pa) of a solution's contact cells, read-only; and its result."""
    result = run("solve", *scene, "--fields", FOLDER / "solved.csv")
    rows = np.loadtxt(FOLDER / "solved.csv", delimiter=",", skiprows=1, usecols=range(5))
    rows.flags.writeable = False
    return rows, result


def solved(scene):
    return solve(scene)[0]


def sampled(scene):
    """The exact field at the cells' centres."""
    return solved(also(scene, "solver.model=exact"))


def exactly(scene):
    """The exact result."""
    return solve(also(scene, "solver.model=exact"))[1]


def means(rows, size, count):
    """Means over square cells of a size (m), each of `count` of the rows' cells or of fewer at the edge."""
    places, cells = np.unique(np.floor(rows[:, :2] / size), axis=0, return_inverse=True)
    return np.column_stack([(places + 0.5) * size, *(np.bincount(cells.ravel(), column) / count for column in rows[:, 2:].T)])


def sizes(rows):
    """|q| (Pa)."""
    return np.hypot(rows[:, 3], rows[:, 4])


def scaled(rows, factor):
    """Tractions times a factor or one for each row."""
    return np.column_stack([rows[:, :3], rows[:, 3:] * np.reshape(factor, (-1, 1))])


def check(scene, field, *options, twist=None, digits=17):
    """The verdict on rows (digits: of all columns or of each) or on a file; a message where it is refused."""
    options += () if twist is None else ("--twist", repr(float(twist)))
    if not isinstance(field, Path):
        formats = [f"%.{n - 1}e" for n in np.broadcast_to(digits, 5)]
        np.savetxt(FOLDER / "field.csv", field, formats, ",", header="x1,x2,pressure,q1,q2", comments="")
        field = FOLDER / "field.csv"
    return run("check", *scene, field, *options)


def judged(result, quantity):
    """The judgement of a quantity; one that is not judged holds."""
    return next((item for item in result["judged"] if item["quantity"] == quantity), {"holds": True})


class CheckTest(unittest.TestCase):
    maxDiff = None

    def assert_near(self, found, right, within):
        """within: relative."""
        self.assertLessEqual(abs(found - right), within * abs(right), (found, right))

    def good(self, scene, field, *options, **keys):
        result = check(scene, field, *options, **keys)
        self.assertEqual(result["verdict"], "good", result["why"])
        return result

    def bad(self, scene, field, *options, breaks=(), says=".", cause="", found=None, **keys):
        """A bad field. breaks: quantities that do not hold; says: an expression in the reason; cause: a part of the likely cause
        with {} in place of its number, which is `found` in two digits; None: no cause is named."""
        result = check(scene, field, *options, **keys)
        self.assertEqual(result["verdict"], "bad", result["why"])
        for quantity in breaks:
            self.assertFalse(judged(result, quantity)["holds"], (quantity, result["why"]))
        self.assertRegex(result["why"], says)
        if cause is None:
            self.assertNotIn("likely cause", result["why"])
        elif cause:
            expression = "likely cause: .*" + re.escape(cause).replace(r"\{\}", r"([-+.\de]*\d)")
            self.assertRegex(result["details"], expression)
            if found is not None:
                self.assert_near(float(re.search(expression, result["details"])[1]), found, 5e-3)
        return result

    def assert_off(self, result, quantity, error):
        """A quantity does not hold, by a signed relative error in two digits."""
        item = judged(result, quantity)
        self.assertFalse(item["holds"], result["why"])
        self.assert_near(item["value"], abs(error), 0.05)
        self.assertRegex(result["why"], f"too {'low' if error < 0 else 'high'}")
