"""slipstick.speed.rank_tests: against SciPy, published tables and full enumeration; intervals by how often they hold."""
import itertools
import math
import unittest

import numpy as np
from scipy import stats
from slipstick.speed.rank_tests import MAX_COUNTED, holm, least_chance, rank_sum_shift, signed_rank_shift


def samples_with(u, n, m):
    """Values 1 to n + m, so dealt that the second sample (of m) exceeds the first one (of n) in u pairs."""
    places = []
    for i in reversed(range(m)):
        step = min(u, n)
        u -= step
        places.append(i + step + 1)
    return [value for value in range(1, n + m + 1) if value not in places], places


def differences_with(t, n):
    """1 to n, so signed that the positive ones sum to t."""
    differences = []
    for rank in range(n, 0, -1):
        positive = rank <= t
        t -= rank if positive else 0
        differences.append(rank if positive else -rank)
    return differences


def rank_sum_chance(u, n, m):
    """That two samples without ties exceed each other in at most u pairs."""
    base, now = samples_with(u, n, m)
    return stats.mannwhitneyu(now, base, alternative="less", method="exact").pvalue


class RankSumTest(unittest.TestCase):
    def test_counts_as_scipy_does(self):
        for n, m in ((3, 9), (10, 10), (30, 30), (7, 40)):
            for u in (0, n, n * m // 4, n * m // 2, n * m):
                shift = rank_sum_shift(*samples_with(u, n, m))
                self.assertAlmostEqual(shift.p_negative / rank_sum_chance(u, n, m), 1.0, delta=1e-11)
                self.assertAlmostEqual(shift.p_positive / rank_sum_chance(n * m - u, n, m), 1.0, delta=1e-11)

    def test_counts_ties_as_they_are(self):
        """By hand: mid-ranks 1, 2.5, 2.5, 4, pairs sum to 3.5 (twice), 5 (twice) and 6.5 (twice)."""
        shift = rank_sum_shift([1.0, 2.0], [2.0, 3.0])
        self.assertAlmostEqual(shift.p_positive, 2 / 6, delta=1e-15)
        self.assertEqual(shift.p_negative, 1.0)
        self.assertAlmostEqual(rank_sum_shift([1.0, 3.0], [2.0, 2.0]).p_positive, 4 / 6, delta=1e-15)
        draw = np.random.default_rng(5)
        for _ in range(20):  # all choices of four of nine
            pooled = draw.integers(0, 4, 9)
            ranks = stats.rankdata(pooled)
            sums = np.array([sum(choice) for choice in itertools.combinations(ranks, 4)])
            shift = rank_sum_shift(pooled[4:], pooled[:4])
            self.assertAlmostEqual(shift.p_positive, np.mean(sums >= ranks[:4].sum()), delta=1e-14)
            self.assertAlmostEqual(shift.p_negative, np.mean(sums <= ranks[:4].sum()), delta=1e-14)


class SignedRankTest(unittest.TestCase):
    def test_has_the_published_critical_values(self):
        """Of the smaller sum, one-sided 2.5 % (Wilcoxon and Wilcox 1964)."""
        for n, critical in ((6, 0), (7, 2), (8, 3), (9, 5), (10, 8), (12, 13), (15, 25), (20, 52), (25, 89), (30, 137)):
            self.assertLessEqual(signed_rank_shift(differences_with(critical, n)).p_negative, 0.025)
            self.assertGreater(signed_rank_shift(differences_with(critical + 1, n)).p_negative, 0.025)
            rest = n * (n + 1) // 2 - critical
            self.assertLessEqual(signed_rank_shift(differences_with(rest, n)).p_positive, 0.025)
            self.assertGreater(signed_rank_shift(differences_with(rest - 1, n)).p_positive, 0.025)

    def test_counts_ties_as_they_are_and_no_zeros(self):
        """By hand: the zero is left out, and 1, 1, -1, 2 have the ranks 2, 2, 2, 4. The positive ones sum to 8, and to as much
        or more in four of the sixteen ways to sign them."""
        shift = signed_rank_shift([0.0, 1.0, 1.0, -1.0, 2.0])
        self.assertEqual((shift.p_positive, shift.p_negative), (4 / 16, 15 / 16))


class RankTestsTest(unittest.TestCase):
    def test_take_the_normal_distribution_beyond_counting(self):
        """Tails of the sums are thinner than normal ones: beyond counting, chances are up to a fifth too large, which is the
        safe side."""
        cases = []
        for u in (481, 420, 360, 300, 262):
            shift = rank_sum_shift(*samples_with(u, 31, 31))
            cases.append((shift.p_negative, rank_sum_chance(u, 31, 31)))
            self.assertAlmostEqual(rank_sum_shift(*samples_with(961 - u, 31, 31)).p_positive, shift.p_negative, delta=1e-15)
        for t in (945, 800, 700, 600, 540):
            differences = differences_with(t, 61)
            cases.append((signed_rank_shift(differences).p_negative,
                          stats.wilcoxon(differences, alternative="less", method="exact").pvalue))
        for found, exact in cases:
            self.assertGreater(found, 0.99 * exact)
            self.assertLess(found, (1.01 if exact > 0.02 else 1.2) * exact)

    def test_separated_samples_have_the_least_chance(self):
        for n, m, choices in ((10, 10, 184756.0), (3, 5, 56.0)):
            shift = rank_sum_shift(*samples_with(n * m, n, m))
            self.assertAlmostEqual(least_chance(n, m, False) * choices, 1.0, delta=1e-14)
            self.assertAlmostEqual(shift.p_positive * choices, 1.0, delta=1e-12)
            self.assertEqual(shift.p_negative, 1.0)
        for n in (10, MAX_COUNTED):  # as many as are counted
            self.assertEqual(least_chance(n, n, True), 2.0**-n)
            self.assertEqual(signed_rank_shift(range(1, n + 1)).p_positive, 2.0**-n)
        none = signed_rank_shift(5 * [0.0])
        self.assertEqual((none.p_positive, none.p_negative), (1.0, 1.0))

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
        paired, independent = signed_rank_shift(range(1, 7)), rank_sum_shift([1, 2, 3, 4], [11, 12, 13, 14])
        self.assertEqual((paired.estimate, paired.low, paired.high), (3.5, 1.0, 6.0))
        self.assertEqual((independent.estimate, independent.low, independent.high), (10.0, 7.0, 13.0))

    def test_intervals_hold_as_often_as_they_say(self):
        """The chance of an interval is known whatever the distribution: 1 - 2 P(U <= 23) of 10 and 10; of 12 pairs 1 - 2 P(T <=
        13), where 87 of 4096 sign patterns sum to 13 or less. Within three standard deviations."""
        draw = np.random.default_rng(9)
        draws, moved = 4000, 0.7
        hits = np.zeros(2)
        for _ in range(draws):
            base, now = draw.lognormal(0.0, 0.5, 10), moved + draw.lognormal(0.0, 0.5, 10)
            differences = moved + draw.standard_t(2, 12)  # symmetric, as signed ranks ask
            for i, shift in enumerate((rank_sum_shift(base, now), signed_rank_shift(differences))):
                hits[i] += shift.low <= moved <= shift.high
        for hit, share in zip(hits, (1 - 2 * rank_sum_chance(23, 10, 10), 1 - 2 * 87 / 4096)):
            self.assertAlmostEqual(hit / draws, share, delta=3 * math.sqrt(share * (1 - share) / draws))


if __name__ == "__main__":
    unittest.main()
