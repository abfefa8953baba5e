"""slipstick.speed.growth: laws of made times, whose truth is known."""
import math
import unittest

import numpy as np
from slipstick.speed.growth import GROWTHS, family_and_cells, fit_power_law, scaling, typical
from slipstick.speed.timings import Benchmark, Timings

SIZES = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)


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


class LawsTest(unittest.TestCase):
    def test_intervals_hold_the_truth_in_95_of_100_draws(self):
        draw = np.random.default_rng(1)
        for repetitions in (3, 5, 20):
            intervals = [typical(drawn(square, 0.1, repetitions, draw, [16])[16]) for _ in range(2000)]
            held = np.mean([low <= square(16) <= high for _, low, high in intervals])
            self.assertTrue(0.94 < held < 0.99, held)
        held = np.mean([holds(fit_power_law(drawn(fourth, 0.05, 5, draw)), 4.0) for _ in range(1000)])
        self.assertTrue(0.93 < held < 0.97, held)

    def test_typical_seconds_are_the_median_of_valid_times(self):
        for seconds in ([3.0, 1.0, 2.0], [1.0, 4.0], [math.nan, 2.0, -1.0, 2.0, 0.0, math.inf, 2.0]):
            self.assertAlmostEqual(typical(seconds)[0], 2.0, delta=1e-12)  # of the logarithms
        self.assertTrue(math.isnan(typical([2.0])[1]))  # one repetition has no interval
        for none in ([], [math.nan, 0.0]):
            self.assertTrue(math.isnan(typical(none)[0]))

    def test_a_power_law_is_that_of_the_last_three_doublings(self):
        for exponent in (2.0, 3.0, 4.0):
            law = fit_power_law(exact(lambda n: 1e-9 * n**exponent if n >= 16 else 1.0))
            self.assertAlmostEqual(law["exponent"], exponent, delta=1e-12)
            self.assertAlmostEqual(law["constant"], 1e-9, delta=1e-19)
            self.assertTrue(holds(law, law["exponent"]) and law["high"] - law["low"] < 1e-10)
            self.assertEqual(law["cells"], [16, 24, 32, 48, 64, 96, 128])
        for sizes, says in (((64,), "1 sizes have a time"), ((1, 2, 64, 128), "2 sizes from 16"), ((), "0 sizes")):
            law = fit_power_law(exact(square, sizes))
            self.assertIn(says, law["why_not"])
            self.assertTrue(math.isnan(law["exponent"]) and not law["cells"])
        self.assertEqual([GROWTHS[name](8) for name in ("N^2", "N^2 log N", "N^4")], [64.0, 64.0 * 4.0, 4096.0])


def timed(name, seconds):
    return Benchmark(name, real=[seconds, 1.01 * seconds, 0.99 * seconds], counters={"error": 1e-15})


def made():
    """dense 1e-9 N^4, dcfft 64 times 1e-9 N^2."""
    return Timings("made.json", [timed(f"application/{name}/cells:{n}", law(n)) for n in (4, 6, 12, 24, 48) for name, law in (
        ("dense", lambda n: 1e-9 * n**4), ("dcfft", lambda n: 64e-9 * n**2))])


class ScalingTest(unittest.TestCase):
    def test_has_the_families_in_their_order_by_size_with_theory(self):
        dense, dcfft = scaling(made())
        self.assertEqual((dense["name"], dcfft["name"]), ("application/dense", "application/dcfft"))
        self.assertEqual([row["cells"] for row in dense["rows"]], [4, 6, 12, 24, 48])
        row = dense["rows"][2]
        self.assertAlmostEqual(row["seconds"], 1e-9 * 12**4, delta=1e-16)
        self.assertTrue(row["low"] < row["seconds"] < row["high"])
        self.assertEqual((row["repetitions"], row["error"]), (3, 1e-15))
        self.assertEqual((dense["power_law"]["theory"], dcfft["power_law"]["theory"]), ("N^4", "N^2 log N"))
        for key in ("exponent", "expected"):
            self.assertAlmostEqual(dense["power_law"][key], 4.0, delta=1e-12)
        # N^2 log 2N from 6 to 48 cells.
        self.assertAlmostEqual(dcfft["power_law"]["expected"], 2 + math.log2(math.log(96) / math.log(12)) / 3, delta=1e-12)

    def test_takes_the_cells_out_of_any_place_of_a_name(self):
        places = {"cells:8": ("", 8.0), "solve/coulomb/cells:64/permille:900": ("solve/coulomb/permille:900", 64.0),
                  "a/b": None, "a/cells:/b": None, "a/cells:x": None, "a/notcells:8": None, "cells:8/b": ("b", 8.0),
                  "a/cells:1234567890": None}
        self.assertEqual({name: family_and_cells(name) for name in places}, places)

    def test_says_why_there_is_no_number(self):
        timings = made()
        timings.benchmarks[2].error = "disagrees with its reference"
        timings.benchmarks[0].real, timings.benchmarks[0].counters = [math.nan], {}
        family = scaling(timings)[0]
        rows = family["rows"]
        self.assertEqual((rows[1]["seconds"], rows[1]["seconds_reason"]), (None, "disagrees with its reference"))
        self.assertEqual((rows[0]["seconds"], rows[0]["error"]), (None, None))
        self.assertAlmostEqual(family["power_law"]["exponent"], 4.0, delta=1e-12)
        law = scaling(Timings("one.json", [timed("set_up/dcfft/cells:64", 1.0)]))[0]["power_law"]
        self.assertEqual((law["exponent"], law["theory"]), (None, None))
        self.assertEqual(scaling(Timings("none.json", [])), [])
