"""Tests by ranks and the estimates that belong to them: nothing is assumed of the distribution of times."""
from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy

MAX_COUNTED = 60  # numbers whose arrangements are counted
TAIL = 0.025  # chance beyond either end of a 95 % interval


class Shift(NamedTuple):
    """How far one sample lies above another."""
    estimate: float  # Hodges and Lehmann's (1963)
    low: float  # its 95 % interval; NaN where the samples are too small for one
    high: float
    p_positive: float  # chance of ranks as high as these or higher if there is no shift
    p_negative: float  # of ranks as low or lower


@lru_cache(maxsize=1024)
def _counted(ranks: tuple[int, ...], picked: int | None) -> Any:
    """The chance of each sum of the ranks that chance picks: choices of this number, None: of any number."""
    ways = numpy.zeros((1 if picked is None else picked + 1, sum(ranks) + 1))  # [j, s]: choices of j ranks that sum to s
    ways[0, 0] = 1.0
    for rank in ranks:
        if picked is None:
            ways[0, rank:] += ways[0, :-rank].copy()
        else:
            ways[1:, rank:] += ways[:-1, :-rank].copy()
    return ways[-1] / ways[-1].sum()


def _tails(ranks: list[int], picked: int | None, value: int) -> tuple[float, float]:
    """The chances of a sum of at most and of at least this value. SciPy's exact tests refuse or ignore ties, which clocks of
    whole nanoseconds make: all arrangements of the ranks are counted, ties as they are (mid-ranks), up to MAX_COUNTED numbers;
    beyond, the normal distribution with corrections for ties and continuity. Doubled ranks are whole numbers."""
    count, total = len(ranks), sum(ranks)
    if count <= MAX_COUNTED:
        chances = _counted(tuple(sorted(ranks)), picked)
        return min(1.0, float(chances[:value + 1].sum())), min(1.0, float(chances[value:].sum()))
    part, about = (0.5, 0.0) if picked is None else (picked / count, total / count)
    variance = part * (1.0 - part) * sum((rank - about) ** 2 for rank in ranks)
    variance *= 1.0 if picked is None else count / (count - 1)
    # Doubled ranks are two apart; half of that is the correction for continuity.
    low, high = (0.5 * math.erfc(-(deviation + 1.0) / math.sqrt(2.0 * variance)) if variance > 0.0 else 1.0
                 for deviation in (value - part * total, part * total - value))
    return low, high


@lru_cache(maxsize=1024)
def _beyond(count: int, picked: int | None, least: int, most: int) -> int:
    """How many values the sum of ranks without ties has in one tail, from the least one on."""
    ranks = list(range(2, 2 * count + 1, 2))
    low, high = 0, most // 2 + most % 2
    while low < high:  # the chances rise
        middle = (low + high) // 2
        low, high = (middle + 1, high) if _tails(ranks, picked, least + 2 * middle)[0] <= TAIL else (low, middle)
    return low


def _doubled_ranks(values: Any) -> Any:
    _, places, counts = numpy.unique(values, return_inverse=True, return_counts=True)
    return (2 * numpy.cumsum(counts) - counts + 1)[places]


def _shift(values: Any, beyond: int, tails: tuple[float, float]) -> Shift:
    """The estimate is the median of means or differences. Beyond either end of the interval lie as many of them as the rank sum
    has values in the tail, if there are no ties."""
    values = numpy.sort(values)
    low, high = (float(values[beyond - 1]), float(values[-beyond])) if beyond else (math.nan, math.nan)
    return Shift(float(numpy.median(values)), low, high, tails[1], tails[0])


def signed_rank_shift(differences: Any) -> Shift:
    """The shift of differences of pairs by Wilcoxon's signed ranks (1945), zeros left out. Samples are finite numbers, one at
    least."""
    differences = numpy.asarray(differences, float)
    one, other = numpy.triu_indices(len(differences))
    given = differences[differences != 0.0]
    ranks = _doubled_ranks(abs(given))
    return _shift(0.5 * (differences[one] + differences[other]), _beyond(len(differences), None, 0, len(one)),
                  _tails(ranks.tolist(), None, int(ranks[given > 0.0].sum())))


def rank_sum_shift(base: Any, now: Any) -> Shift:
    """The shift of `now` over `base`, independent samples, by Mann and Whitney's test (1947)."""
    base, now = numpy.asarray(base, float), numpy.asarray(now, float)
    picked = len(now)
    ranks = _doubled_ranks(numpy.concatenate((now, base)))
    differences = numpy.subtract.outer(now, base).ravel()
    return _shift(differences, _beyond(len(ranks), picked, picked * (picked + 1), len(differences)),
                  _tails(ranks.tolist(), picked, int(ranks[:picked].sum())))


def least_chance(base: int, now: int, paired: bool) -> float:
    """The smallest possible chance for these numbers of values: of pairs 2^-n, else one in all choices."""
    return 0.5 ** min(base, now) if paired else 1.0 / math.comb(base + now, base)


def holm(chances: list[float]) -> list[float]:
    """Chances corrected for their number, in their order: one that stays at a level or below is significant at that level over
    all together (Holm 1979)."""
    corrected, largest = [0.0] * len(chances), 0.0
    for left, place in zip(range(len(chances), 0, -1), sorted(range(len(chances)), key=chances.__getitem__)):
        largest = max(largest, left * chances[place])
        corrected[place] = min(1.0, largest)
    return corrected
