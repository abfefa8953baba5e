"""slipstick.speed.crossovers: where families of made times meet is known."""
import math
import unittest

import numpy as np
from slipstick.speed.crossovers import answer, crossovers, crossovers_text, find_crossover
from test_growth import drawn, exact, fourth, square

MEET = math.sqrt(3e-8 / 2e-10)  # cells at which fourth() and square() are equal


class CrossoverTest(unittest.TestCase):
    def test_of_powers_is_where_they_meet(self):
        found = find_crossover(exact(fourth), exact(square))
        self.assertAlmostEqual(found["cells"], MEET, delta=1e-9)
        self.assertTrue(math.isnan(found["low"]))
        self.assertIn("one repetition", found["remark"])

    def test_is_the_last_of_several(self):
        found = find_crossover(exact(lambda n: 2.0 if n == 8 or n > 48 else 0.5), exact(lambda n: 1.0))
        self.assertAlmostEqual(found["cells"], math.sqrt(48.0 * 64.0), delta=1e-9)

    def test_uses_the_sizes_that_both_have(self):
        quick = exact(square, (2, 4, 8, 32, 256))
        quick[8] = [math.nan]
        self.assertAlmostEqual(find_crossover(exact(fourth), quick)["cells"], MEET, delta=1e-9)  # powers are straight from 4 to 32
        self.assertIn("no size", find_crossover(exact(fourth, (4,)), exact(square, (8,)))["remark"])

    def test_outside_the_measured_sizes_is_an_answer(self):
        for sizes, says in (((16, 32, 64), "already at 16 cells"), ((4, 8), "not yet at 8 cells")):
            found = find_crossover(exact(fourth, sizes), exact(square, sizes))
            self.assertTrue(math.isnan(found["cells"]))
            self.assertIn(says, found["remark"])

    def test_intervals_hold_the_truth_in_95_of_100_draws(self):
        draw = np.random.default_rng(4)
        for repetitions in (5, 15):
            held = []
            for _ in range(200):
                found = find_crossover(*(drawn(law, 0.1, repetitions, draw, (8, 12, 16, 24)) for law in (fourth, square)))
                held.append(found["low"] <= MEET <= found["high"])
            self.assertTrue(0.93 < np.mean(held) < 0.999, np.mean(held))


def made_families():
    """dense 1e-9 N^4, dcfft 64 times 1e-9 N^2: they meet at 8 cells."""
    return {f"application/{name}": {n: [law(n), 1.01 * law(n), 0.99 * law(n)] for n in (4.0, 6.0, 12.0, 24.0, 48.0)}
            for name, law in (("dense", lambda n: 1e-9 * n**4), ("dcfft", lambda n: 64e-9 * n**2))}


class AnswersTest(unittest.TestCase):
    def test_say_where_dcfft_overtakes(self):
        (found,) = crossovers(made_families())
        self.assertEqual((found["slow"], found["quick"]), ("application/dense", "application/dcfft"))
        self.assertAlmostEqual(found["cells"], 8.0, delta=1e-9)
        self.assertTrue(found["low"] < 8.0 < found["high"])
        self.assertIn("application/dcfft is quicker than application/dense from 8 cells a side", crossovers_text([found]))

    def test_of_operators_name_what_is_missing(self):
        families = {kind: [[cells, seconds] for cells, seconds in made_families()[f"application/{kind}"].items()]
                    for kind in ("dcfft", "dense")}
        families["dense"][0][1] = [None, None, None]
        result = answer({"families": families, "slow": "dense", "quick": "dcfft"})["result"]
        self.assertEqual([row["operator"] for row in result["rows"]], ["dcfft"] * 5 + ["dense"] * 5)
        self.assertEqual((result["rows"][5]["seconds"], result["rows"][5]["seconds_reason"]), (None, "it did not solve"))
        self.assertAlmostEqual(result["cells"], 8.0, delta=1e-9)
        self.assertTrue(result["low"] < 8.0 < result["high"] and result["remark"] == "")
