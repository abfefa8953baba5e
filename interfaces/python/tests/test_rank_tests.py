"""slipstick.speed.rank_tests: against SciPy and full enumeration; intervals by how often they hold."""
import itertools
import math
import unittest

import numpy as np
from scipy import stats
from slipstick.speed.rank_tests import MAX_COUNTED, holm, least_chance, rank_sum_shift, signed_rank_shift


def drawn(draw, n, m):
    """Two samples and differences without ties, and SciPy's exact chances of these ranks: (shift, low, high) of both tests."""
    base, now = draw.normal(0, 1, n), draw.normal(draw.choice([-1, 0, 1]), 1, m)
    differences = draw.normal(draw.choice([-1, 0, 0.5]), 1, n)
    yield rank_sum_shift(base, now), *(stats.mannwhitneyu(now, base, alternative=side, method="exact").pvalue
                                       for side in ("less", "greater"))
    yield signed_rank_shift(differences), *(stats.wilcoxon(differences, alternative=side, method="exact").pvalue
                                            for side in ("less", "greater"))


class RankTestsTest(unittest.TestCase):
    def test_count_as_scipy_does(self):
        draw = np.random.default_rng(3)
        for n, m in (*itertools.product((1, 3, 10), repeat=2), (30, 30), (7, 40), (40, 7)):
            for shift, low, high in itertools.chain(*(drawn(draw, n, m) for _ in range(10))):
                self.assertAlmostEqual(shift.p_negative / low, 1.0, delta=1e-11)
                self.assertAlmostEqual(shift.p_positive / high, 1.0, delta=1e-11)

    def test_count_ties_as_they_are(self):
        """By hand: mid-ranks 1, 2.5, 2.5, 4, pairs sum to 3.5 (twice), 5 (twice) and 6.5 (twice). The difference
        of zero is left out, and 1, 1, -1, 2 have the ranks 2, 2, 2, 4: the positive ranks sum to 8, and to 8 or more in four of
        the sixteen ways to sign them. Then all choices of four of nine."""
        self.assertAlmostEqual(rank_sum_shift([1.0, 2.0], [2.0, 3.0]).p_positive, 2 / 6, delta=1e-15)
        self.assertEqual(rank_sum_shift([1.0, 2.0], [2.0, 3.0]).p_negative, 1.0)
        signed = signed_rank_shift([0.0, 1.0, 1.0, -1.0, 2.0])
        self.assertEqual((signed.p_positive, signed.p_negative), (4 / 16, 15 / 16))
        draw = np.random.default_rng(5)
        for _ in range(20):
            pooled = draw.integers(0, 4, 9)
            ranks = stats.rankdata(pooled)
            sums = np.array([sum(choice) for choice in itertools.combinations(ranks, 4)])
            shift = rank_sum_shift(pooled[4:], pooled[:4])
            self.assertAlmostEqual(shift.p_positive, np.mean(sums >= ranks[:4].sum()), delta=1e-14)
            self.assertAlmostEqual(shift.p_negative, np.mean(sums <= ranks[:4].sum()), delta=1e-14)

    def test_take_the_normal_distribution_beyond_counting(self):
        """Tails of the sums are thinner than normal ones: beyond counting, chances down to 1e-3 are up to a fifth too large,
        which is the safe side."""
        draw = np.random.default_rng(7)
        for shift, *exact in itertools.chain(*(drawn(draw, 61, 30) for _ in range(20))):
            for found, chance in zip((shift.p_negative, shift.p_positive), exact):
                if chance > 1e-3:
                    self.assertGreater(found, 0.99 * chance)
                    self.assertLess(found, (1.01 if chance > 0.02 else 1.2) * chance)

    def test_separated_samples_have_the_least_chance(self):
        for n, m, choices in ((10, 10, 184756.0), (3, 5, 56.0)):
            self.assertAlmostEqual(least_chance(n, m, False) * choices, 1.0, delta=1e-14)
            self.assertAlmostEqual(rank_sum_shift(range(n), range(n, n + m)).p_positive * choices, 1.0, delta=1e-12)
        for n in (10, MAX_COUNTED):  # as many as are counted
            self.assertEqual((least_chance(n, n, True), signed_rank_shift(range(1, n + 1)).p_positive), (2.0**-n, 2.0**-n))
        self.assertEqual(signed_rank_shift(5 * [0.0])[3:], (1.0, 1.0))

    def test_holm_multiplies_by_those_that_are_left(self):
        """Four chances, by hand: 0.005 x 4, 0.01 x 3, 0.03 x 2, then 0.04 x 1, which may not be below the one before."""
        np.testing.assert_allclose(holm([0.01, 0.04, 0.03, 0.005]), [0.03, 0.06, 0.06, 0.02], rtol=1e-14)
        self.assertEqual((holm([0.6, 0.7]), holm([])), ([1.0, 1.0], []))


class HodgesLehmannTest(unittest.TestCase):
    def test_is_the_median_of_means_or_differences_with_its_interval(self):
        """By hand: means of two of -1, 2, 3 are -1, 0.5, 1, 2, 2.5, 3; differences of {1, 2} from {4, 8} 3, 7, 2, 6. There is
        no interval where none reaches 95 %."""
        for small, estimate in ((signed_rank_shift([-1.0, 2.0, 3.0]), 1.5), (signed_rank_shift([1, 2, 3, 4, 5]), 3.0),
                                (rank_sum_shift([1.0, 2.0], [4.0, 8.0]), 4.5)):
            self.assertEqual(small.estimate, estimate)
            self.assertTrue(math.isnan(small.low) and math.isnan(small.high))
        self.assertEqual(signed_rank_shift(range(1, 7))[:3], (3.5, 1.0, 6.0))
        self.assertEqual(rank_sum_shift([1, 2, 3, 4], [11, 12, 13, 14])[:3], (10.0, 7.0, 13.0))

    def test_intervals_hold_as_often_as_they_say(self):
        """The chance of an interval is known whatever the distribution: 1 - 2 P(U <= 23) of 10 and 10; of 12 pairs 1 - 2 P(T <=
        13), where 87 of 4096 sign patterns sum to 13 or less. Within three standard deviations."""
        draw = np.random.default_rng(9)
        draws, moved, hits = 4000, 0.7, np.zeros(2)
        for _ in range(draws):
            differences = moved + draw.standard_t(2, 12)  # symmetric, as signed ranks ask
            shifts = (rank_sum_shift(draw.lognormal(0.0, 0.5, 10), moved + draw.lognormal(0.0, 0.5, 10)),
                      signed_rank_shift(differences))
            hits += [shift.low <= moved <= shift.high for shift in shifts]
        for hit, share in zip(hits, (1 - 2 * 3996 / 184756, 1 - 2 * 87 / 4096)):
            self.assertAlmostEqual(hit / draws, share, delta=3 * math.sqrt(share * (1 - share) / draws))
