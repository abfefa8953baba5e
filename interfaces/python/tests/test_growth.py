"""slipstick.speed.growth: laws and crossovers of made times, whose truth is known."""
import math
import unittest

import numpy as np
from slipstick.speed.growth import GROWTHS, family_and_cells, find_crossover, fit_power_law, scaling, typical
from slipstick.speed.timings import Benchmark, Timings

SIZES = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
TRUTH = math.sqrt(3e-8 / 2e-10)  # where fourth() and square() meet


def fourth(cells):
    return 2e-10 * cells**4


def square(cells):
    return 3e-8 * cells**2


def exact(law, sizes=SIZES):
    return {cells: [law(cells)] for cells in sizes}


def drawn(law, scatter, repetitions, draw, sizes=SIZES):
    """Repetitions that miss the law by normal deviates of their logarithm."""
    return {cells: list(law(cells) * np.exp(draw.normal(0.0, scatter, repetitions))) for cells in sizes}


def holds(found, truth):
    return found["low"] <= truth <= found["high"]


class TypicalTest(unittest.TestCase):
    def test_holds_the_truth_in_95_of_100_draws(self):
        draw = np.random.default_rng(1)
        for repetitions in (3, 5, 20):
            intervals = [typical(drawn(square, 0.1, repetitions, draw, [16])[16]) for _ in range(2000)]
            held = np.mean([low <= square(16) <= high for _, low, high in intervals])
            self.assertTrue(0.94 < held < 0.99, held)

    def test_is_the_median_of_valid_times(self):
        for seconds in ([3.0, 1.0, 2.0], [1.0, 4.0], [math.nan, 2.0, -1.0, 2.0, 0.0, math.inf, 2.0]):
            self.assertAlmostEqual(typical(seconds)[0], 2.0, delta=1e-12)  # of the logarithms
        self.assertTrue(math.isnan(typical([2.0])[1]))  # one repetition has no interval
        for none in ([], [math.nan, 0.0]):
            self.assertTrue(math.isnan(typical(none)[0]))


class PowerLawTest(unittest.TestCase):
    def test_of_exact_powers_is_exact(self):
        for exponent in (2.0, 3.0, 4.0):
            law = fit_power_law(exact(lambda n: 1e-9 * n**exponent))
            self.assertAlmostEqual(law["exponent"], exponent, delta=1e-12)
            self.assertAlmostEqual(law["constant"], 1e-9, delta=1e-19)
            self.assertTrue(holds(law, law["exponent"]) and law["high"] - law["low"] < 1e-10)

    def test_is_that_of_the_last_three_doublings(self):
        law = fit_power_law(exact(lambda n: 1.0 if n < 16 else fourth(n)))
        self.assertAlmostEqual(law["exponent"], 4.0, delta=1e-12)
        self.assertEqual(law["cells"], [16, 24, 32, 48, 64, 96, 128])

    def test_holds_the_truth_in_95_of_100_draws(self):
        draw = np.random.default_rng(2)
        held = np.mean([holds(fit_power_law(drawn(fourth, 0.05, 5, draw)), 4.0) for _ in range(1000)])
        self.assertTrue(0.93 < held < 0.97, held)

    def test_needs_three_sizes(self):
        for sizes, says in (((64,), "1 sizes have a time"), ((1, 2, 64, 128), "2 sizes from 16"), ((), "0 sizes")):
            law = fit_power_law(exact(square, sizes))
            self.assertIn(says, law["why_not"])
            self.assertTrue(math.isnan(law["exponent"]) and not law["cells"])

    def test_growth_is_what_its_name_says(self):
        self.assertEqual([GROWTHS[name](8) for name in ("N^2", "N^2 log N", "N^4")], [64.0, 64.0 * 4.0, 4096.0])


class CrossoverTest(unittest.TestCase):
    def test_of_powers_is_where_they_meet(self):
        found = find_crossover(exact(fourth), exact(square))
        self.assertAlmostEqual(found["cells"], TRUTH, delta=1e-9)
        self.assertTrue(math.isnan(found["low"]))
        self.assertIn("one repetition", found["remark"])

    def test_is_the_last_of_several(self):
        found = find_crossover(exact(lambda n: 2.0 if n == 8 or n > 48 else 0.5), exact(lambda n: 1.0))
        self.assertAlmostEqual(found["cells"], math.sqrt(48.0 * 64.0), delta=1e-9)

    def test_uses_the_sizes_that_both_have(self):
        quick = {**exact(square, (2, 4, 8, 32, 256)), 8: [math.nan]}
        self.assertAlmostEqual(find_crossover(exact(fourth), quick)["cells"], TRUTH, delta=1e-9)  # powers are straight
        self.assertIn("no size", find_crossover(exact(fourth, [4]), exact(square, [8]))["remark"])

    def test_outside_the_measured_sizes_is_an_answer(self):
        for sizes, says in (((16, 32, 64), "already at 16 cells"), ((4, 8), "not yet at 8 cells")):
            found = find_crossover(exact(fourth, sizes), exact(square, sizes))
            self.assertTrue(math.isnan(found["cells"]))
            self.assertIn(says, found["remark"])

    def test_holds_the_truth_in_95_of_100_draws(self):
        draw = np.random.default_rng(4)
        for repetitions in (5, 15):
            held = np.mean([holds(find_crossover(*(drawn(law, 0.1, repetitions, draw, (8, 12, 16, 24))
                                                   for law in (fourth, square))), TRUTH) for _ in range(200)])
            self.assertTrue(0.93 < held < 0.999, held)

    def test_is_the_more_certain_the_less_the_scatter(self):
        draw = np.random.default_rng(5)

        def width(scatter):
            found = find_crossover(drawn(fourth, scatter, 10, draw), drawn(square, scatter, 10, draw))
            return math.log(found["high"] / found["low"])
        coarse = width(0.05)
        self.assertLess(width(0.005), 0.3 * coarse)
        # Both medians' errors, 1.25 * 0.05 / sqrt(10) each, over the difference of the exponents, 95 % of Student's.
        self.assertAlmostEqual(coarse, 2 * 2.26 * math.sqrt(2) * 1.25 * 0.05 / math.sqrt(10) / 2, delta=0.5 * coarse)


def timed(name, seconds):
    return Benchmark(name, real=[seconds, 1.01 * seconds, 0.99 * seconds], counters={"error": 1e-15})


def made():
    """dense 1e-9 N^4, dcfft 64 times 1e-9 N^2: they meet at 8 cells."""
    return Timings("made.json", [timed(f"application/{name}/cells:{n}", law(n)) for n in (4, 6, 12, 24, 48) for name, law in (
        ("dense", lambda n: 1e-9 * n**4), ("dcfft", lambda n: 64e-9 * n**2))])


class ScalingTest(unittest.TestCase):
    def test_has_the_families_in_their_order_by_size(self):
        dense, dcfft = scaling(made())["families"]
        self.assertEqual((dense["name"], dcfft["name"]), ("application/dense", "application/dcfft"))
        self.assertEqual([row["cells"] for row in dense["rows"]], [4, 6, 12, 24, 48])
        row = dense["rows"][2]
        self.assertAlmostEqual(row["seconds"], 1e-9 * 12**4, delta=1e-16)
        self.assertTrue(row["low"] < row["seconds"] < row["high"])
        self.assertEqual((row["repetitions"], row["error"]), (3, 1e-15))

    def test_says_what_theory_and_times_say(self):
        dense, dcfft = (family["power_law"] for family in scaling(made())["families"])
        self.assertAlmostEqual(dense["exponent"], 4.0, delta=1e-12)
        self.assertEqual((dense["theory"], dcfft["theory"]), ("N^4", "N^2 log N"))
        self.assertAlmostEqual(dense["expected"], 4.0, delta=1e-12)
        # N^2 log 2N from 6 to 48 cells.
        self.assertAlmostEqual(dcfft["expected"], 2.0 + math.log2(math.log(96.0) / math.log(12.0)) / 3.0, delta=1e-12)

    def test_says_where_dcfft_overtakes(self):
        crossover, = scaling(made())["crossovers"]
        self.assertEqual((crossover["slow"], crossover["quick"]), ("application/dense", "application/dcfft"))
        self.assertAlmostEqual(crossover["cells"], 8.0, delta=1e-9)
        self.assertTrue(holds(crossover, 8.0))

    def test_takes_the_cells_out_of_any_place_of_a_name(self):
        places = {"cells:8": ("", 8.0), "solve/coulomb/cells:64/permille:900": ("solve/coulomb/permille:900", 64.0),
                  "a/b": None, "a/cells:/b": None, "a/cells:x": None, "a/notcells:8": None, "cells:8/b": ("b", 8.0),
                  "a/cells:1234567890": None}
        self.assertEqual({name: family_and_cells(name) for name in places}, places)

    def test_of_what_was_not_timed_says_why(self):
        timings = made()
        timings.benchmarks[2].error = "disagrees with its reference"
        timings.benchmarks[0].real, timings.benchmarks[0].counters = [math.nan], {}
        family = scaling(timings)["families"][0]
        rows = family["rows"]
        self.assertEqual((rows[1]["seconds"], rows[1]["seconds_reason"]), (None, "disagrees with its reference"))
        self.assertEqual((rows[0]["seconds"], rows[0]["error"]), (None, None))
        self.assertAlmostEqual(family["power_law"]["exponent"], 4.0, delta=1e-12)

    def test_of_one_size_fits_nothing(self):
        law = scaling(Timings("one.json", [timed("set_up/dcfft/cells:64", 1.0)]))["families"][0]["power_law"]
        self.assertEqual((law["exponent"], law["theory"]), (None, None))
        self.assertEqual(scaling(Timings("none.json", [])), {"families": [], "crossovers": []})


if __name__ == "__main__":
    unittest.main()
