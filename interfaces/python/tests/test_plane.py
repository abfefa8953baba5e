"""slipstick.speed.plane: the design, the judgement of made points, and the data of `solve --accuracy`."""
import math
import re
import unittest
from pathlib import Path

from slipstick.errors import InputError
from slipstick.speed import plane
from slipstick.speed.plane import pareto_front, quickest_to

ACCURACY = Path(__file__).resolve().parents[3] / "convergence/solve/accuracy.toml"


class DesignTest(unittest.TestCase):
    def test_holds_no_choice_twice(self):
        for quick in (False, True):
            for load in plane.design(quick):
                runs = load["runs"]
                self.assertGreater(len(runs), 20)
                for key in ("file", "label", "overrides"):
                    self.assertEqual(len({str(run[key]) for run in runs}), len(runs))

    def test_tries_each_choice_somewhere(self):
        words = {run["choice"][key] for load in plane.design(False) for run in load["runs"] for key in plane.CHOICES}
        self.assertLessEqual({"coulomb", "paper", "dcfft", "direct", "dense", "auto", "full", "solved", "hertz",
                              "hertz_averaged"}, words)


class EnvelopeTest(unittest.TestCase):
    def test_holds_the_ways_that_none_beats(self):
        for ways, front in (
                ([(3.0, 0.1), (1.0, 0.5), (2.0, 0.5), (4.0, 0.2)], [1, 0]), ([(1.0, 1.0)], [0]), ([], []),
                ([(1.0, 0.5), (1.0, 0.5)], [0, 1]),  # both of a tie
                ([(2.0, 0.5), (1.0, 0.5), (1.0, 0.6)], [1]),
                ([(1.0, math.nan), (math.nan, 0.1), (2.0, 0.5), (0.1, math.inf)], [2])):
            self.assertEqual(pareto_front(ways), front)

    def test_finds_the_quickest_of_those_as_good(self):
        ways = [(3.0, 1e-3), (2.0, 1e-2), (1.0, 1e-1), (0.1, math.nan)]
        self.assertEqual([quickest_to(ways, error) for error in (1e-2, 5e-3, 1.0, 1e-4)], [1, 0, 2, None])


def point(method, cells, error, low, median, high):
    """A made point whose times have an interval."""
    return {**plane.DEFAULT, "method": method, "cells": cells, "tolerance": 1e-8, "error": {"twist": error},
            "seconds": {"median": median, "low": low, "high": high, "repetitions": 5}}


def judged(*points):
    scene = {"name": "made", "points": list(points), "exact": {"seconds": {"low": 0.3, "median": 0.4, "high": 0.7}}}
    made = {"quantities": [{"name": "twist", "label": "twist"}], "scenes": [scene]}
    plane.judge(made)
    return made, {(row["error"], row["method"]): row for row in made["scenes"][0]["time_to"]}


class JudgementTest(unittest.TestCase):
    def test_makes_repeated_times_a_median_with_its_interval(self):
        points = [{"seconds": [1.0, 4.0]}, {"seconds": None}]
        plane.put_medians({"scenes": [{"points": points, "exact": {"seconds": [3.0, 2.0, 5.0]}}]})
        self.assertAlmostEqual(points[0]["seconds"]["median"], 2.0, delta=1e-12)  # of the logarithms
        self.assertLess(points[0]["seconds"]["low"], 1.0)
        self.assertGreater(points[0]["seconds"]["high"], 4.0)
        self.assertEqual(points[0]["seconds"]["repetitions"], 2)
        self.assertIsNone(points[1]["seconds"])

    def test_finds_envelope_times_and_what_is_not_timed(self):
        wrong = {**point("paper", 256, 1e-6, 0.001, 0.001, 0.001), "seconds": None, "not_timed": "twist error 0.06 above 0.001"}
        made, rows = judged(point("coulomb", 64, 2e-3, 1.0, 1.0, 1.0), point("coulomb", 128, 5e-4, 4.0, 4.0, 4.0),
                            point("paper", 128, 5e-4, 8.0, 8.0, 8.0), wrong)
        self.assertEqual(made["scenes"][0]["envelope"]["twist"], [0, 1])
        self.assertEqual(rows[1e-2, "coulomb"]["seconds"], 1.0)
        self.assertEqual((rows[1e-2, "paper"]["point"], rows[1e-3, "any"]["point"]), (2, 1))
        self.assertIsNone(rows[1e-4, "any"]["seconds"])
        self.assertEqual(rows[1e-4, "any"]["reason"], "the best is 0.0005, on 128 x 128 cells")
        self.assertEqual([row["choice"]["cells"] for row in made["not_timed"]], [256])
        self.assertIn("1e-03      4 s  1e-04        -", plane.times_text(made))

    def test_goes_by_medians(self):
        """The choice with the least median differs from the choices with the least lower and upper ends."""
        made, rows = judged(point("coulomb", 64, 1e-3, 0.5, 2.0, 2.1), point("paper", 64, 1e-3, 1.0, 1.5, 4.0),
                            point("other", 64, 1e-3, 0.4, 1.8, 1.9))
        self.assertEqual(made["scenes"][0]["envelope"]["twist"], [1])
        for method, median in (("any", 1.5), ("coulomb", 2.0), ("paper", 1.5), ("other", 1.8), ("exact", 0.4)):
            self.assertEqual(rows[1e-2, method]["seconds"], median)
        self.assertEqual(len(rows), 4 * 5)


def measured(cells, tolerance, error):
    """Two grids whose errors are +-error, and an iteration that adds the tolerance to both."""
    names = ("twist", "traction_l2", "stick_radius")
    return {**plane.DEFAULT, "cells": cells, "tolerance": tolerance, "contact_cells": cells - 4.0, "applications": cells,
            "seconds": {"median": 1e-3 * cells}, "errors": {name: [error + tolerance, tolerance - error] for name in names},
            "error": {name: math.hypot(error, tolerance) for name in names}}


def made_plane():
    """Errors 1/cells^2 at one load, half that at the other; iterations leave the tolerance."""
    return {"application_seconds": 1e-4, "scenes": [
        {"points": [measured(cells, tolerance, part / cells**2)
                    for cells in (16, 64) for tolerance in (1e-2, 1e-4, 1e-6, 1e-8)]} for part in (1.0, 0.5)]}


class AccuracyTest(unittest.TestCase):
    def test_is_the_envelope_of_the_loads(self):
        coarse, fine = plane.accuracy_from_plane(made_plane())
        self.assertEqual((coarse["cells_across"], fine["work"][0]), (12.0, 640.0))
        self.assertAlmostEqual(coarse["twist"]["error"], 1 / 256, delta=1e-9)
        self.assertAlmostEqual(fine["stick_radius"]["error"], 1 / 4096, delta=1e-9)
        # A tenth of 1/256 is 3.9e-4, of 1/4096 2.4e-5: the loosest tolerances that change no more.
        self.assertEqual((coarse["twist"]["tolerance"], fine["twist"]["tolerance"]), (1e-4, 1e-6))

    def test_is_monotone(self):
        lucky = made_plane()
        for scene in lucky["scenes"]:
            for each in scene["points"][:4]:
                each["error"]["twist"] = 1e-9
        coarse, fine = plane.accuracy_from_plane(lucky)
        self.assertEqual(coarse["twist"]["error"], fine["twist"]["error"])

    def test_leaves_out_what_was_not_timed_at_each_load(self):
        made = made_plane()
        for each in made["scenes"][1]["points"][:4]:
            each["seconds"] = None
        with self.assertRaisesRegex(InputError, "too few meshes"):  # one mesh is left
            plane.accuracy_from_plane(made)

    def test_the_file_of_the_program_has_the_written_format(self):
        text = ACCURACY.read_text()
        numbers = r"\[(.*)\]"
        meshes = []
        for part in text.split("[[mesh]]")[1:]:
            mesh = {"cells_across": float(re.search("cells_across = (.*)", part)[1])}
            for name, error, tolerance in re.findall(r"(\w+) = \{ error = (.*), tolerance = (.*) \}", part):
                mesh[name] = {"error": float(error), "tolerance": float(tolerance)}
            for name in ("tolerances", "applications", "work"):
                mesh[name] = [float(value) for value in re.search(f"{name} = {numbers}", part)[1].split(",")]
            meshes.append(mesh)
        self.assertEqual(plane.accuracy_toml(meshes, text.splitlines()[1][2:]), text)
