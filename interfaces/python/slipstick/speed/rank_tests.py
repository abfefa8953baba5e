"""Tests by ranks and the estimates that belong to them: nothing is assumed of the distribution of times."""
from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy

MAX_COUNTED = 60  # numbers whose arrangements are counted
TAIL = 0.025  # chance beyond either end of a 95 % interval


@dataclass
class Shift:
    """How far one sample lies above another."""
    estimate: float  # Hodges and Lehmann's (1963)
    low: float  # its 95 % interval; NaN where the samples are too small for one
    high: float
    p_positive: float  # chance of ranks as high as these or higher if there is no shift
    p_negative: float  # of ranks as low or lower


class _RankSum:
    """The distribution of the sum of ranks that chance picks, all choices equally likely. picked: choices of this number; None:
    of any number. SciPy's exact tests refuse or ignore ties, which clocks of whole nanoseconds make: all arrangements of the
    ranks are counted, ties as they are (mid-ranks), up to MAX_COUNTED numbers; beyond, the normal distribution with corrections
    for ties and continuity. Ranks are doubled, which makes whole numbers of mid-ranks."""

    def __init__(self, ranks: tuple[int, ...], picked: int | None) -> None:
        count, total = len(ranks), sum(ranks)
        part = 0.5 if picked is None else picked / count
        about = 0.0 if picked is None else total / count
        self._mean = part * total
        self._variance = part * (1.0 - part) * sum((rank - about) ** 2 for rank in ranks)
        if picked is not None and count > 1:
            self._variance *= count / (count - 1.0)
        self._chances = None if count > MAX_COUNTED else self._counted(ranks, picked)

    @staticmethod
    def _counted(ranks: tuple[int, ...], picked: int | None) -> Any:
        # ways[j, s]: choices of j ranks that sum to s; of any number of ranks they are in one row.
        ways = numpy.zeros((1 if picked is None else picked + 1, sum(ranks) + 1))
        ways[0, 0] = 1.0
        for rank in ranks:
            if picked is None:
                ways[0, rank:] += ways[0, :-rank].copy()
            else:
                ways[1:, rank:] += ways[:-1, :-rank].copy()
        return ways[-1] / ways[-1].sum()

    def at_most(self, value: int) -> float:
        if self._chances is None:
            return self._normal(value - self._mean)
        return min(1.0, float(self._chances[:value + 1].sum()))

    def at_least(self, value: int) -> float:
        if self._chances is None:
            return self._normal(self._mean - value)
        return min(1.0, float(self._chances[value:].sum()))

    def _normal(self, deviation: float) -> float:
        """Chance of a deviation at most this far above the mean. Doubled ranks are two apart; half of that is the correction
        for continuity."""
        if not self._variance > 0.0:
            return 1.0
        return 0.5 * math.erfc(-(deviation + 1.0) / math.sqrt(2.0 * self._variance))


_rank_sum = lru_cache(maxsize=1024)(_RankSum)


@lru_cache(maxsize=1024)
def _beyond(count: int, picked: int | None, least: int, most: int) -> int:
    """How many values the sum of ranks without ties has in one tail, from the least one on."""
    chance = _rank_sum(tuple(range(2, 2 * count + 1, 2)), picked)
    beyond = 0
    while 2 * beyond < most and chance.at_most(least + 2 * beyond) <= TAIL:
        beyond += 1
    return beyond


def _doubled_ranks(values: Any) -> Any:
    _, places, counts = numpy.unique(values, return_inverse=True, return_counts=True)
    return (2 * numpy.cumsum(counts) - counts + 1)[places]


def _shift(values: Any, beyond: int, chance: _RankSum, observed: int) -> Shift:
    """The estimate is the median of means or differences. Beyond either end of the interval lie as many of them as the rank sum
    has values in the tail, if there are no ties."""
    values = numpy.sort(values)
    low, high = (values[beyond - 1], values[len(values) - beyond]) if beyond else (math.nan, math.nan)
    return Shift(float(numpy.median(values)), float(low), float(high), chance.at_least(observed), chance.at_most(observed))


def signed_rank_shift(differences: Any) -> Shift:
    """The shift of differences of pairs by Wilcoxon's signed ranks (1945), zeros left out. Samples are finite numbers, one at
    least."""
    differences = numpy.asarray(differences, float)
    count = len(differences)
    one, other = numpy.triu_indices(count)
    means = 0.5 * (differences[one] + differences[other])
    given = differences[differences != 0.0]
    ranks = _doubled_ranks(abs(given))
    chance = _rank_sum(tuple(sorted(ranks.tolist())), None)
    return _shift(means, _beyond(count, None, 0, len(means)), chance, int(ranks[given > 0.0].sum()))


def rank_sum_shift(base: Any, now: Any) -> Shift:
    """The shift of `now` over `base`, independent samples, by Mann and Whitney's test (1947)."""
    base, now = numpy.asarray(base, float), numpy.asarray(now, float)
    count, picked = len(now) + len(base), len(now)
    ranks = _doubled_ranks(numpy.concatenate((now, base)))
    differences = numpy.subtract.outer(now, base).ravel()
    chance = _rank_sum(tuple(sorted(ranks.tolist())), picked)
    beyond = _beyond(count, picked, picked * (picked + 1), len(differences))
    return _shift(differences, beyond, chance, int(ranks[:picked].sum()))


def least_chance(base: int, now: int, paired: bool) -> float:
    """The smallest possible chance for these numbers of values: of pairs 2^-n, else one in all choices."""
    return 0.5 ** min(base, now) if paired else 1.0 / math.comb(base + now, base)


def holm(chances: list[float]) -> list[float]:
    """Chances corrected for their number, in their order: one that stays at a level or below is significant at that level over
    all together (Holm 1979)."""
    order = sorted(range(len(chances)), key=chances.__getitem__)
    corrected, largest = [0.0] * len(chances), 0.0
    for i, place in enumerate(order):
        largest = max(largest, (len(order) - i) * chances[place])
        corrected[place] = min(1.0, largest)
    return corrected
