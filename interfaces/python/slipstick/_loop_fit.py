"""The fit of families of laws to a loop."""
from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ._loop_path import COUNTED, Array, Path, Start, row_noise, trimmed_mean

_PRICE = 12.0  # chi squared that a parameter has to gain
_SETTLED = 1e-2  # chi squared that a last step gains
_SLOW = 1e-3  # a slow step lowers the logarithm of the mean square by less
_NEAR = 0.03  # residual over the largest load; two slow steps end the fit of a law that has more
_FAR = 10.0  # residual over that of the nearest law; one slow step ends the fit of a law that has more
_MAX_STARTS = 3  # starts to try with every combination of parameters
_LARGEST_PART = 0.8  # proportion of a field that is added to a law: a larger one hides the law


@dataclass
class Trials:
    """Starts and parameters to try, a row for each; ends: the rotations at the turns of the record."""
    shift: Array
    turned: Array
    ends: Array
    parameters: Array

    def row(self, k: int) -> Trials:
        return Trials(self.shift[k:k + 1], self.turned[k:k + 1], self.ends[k:k + 1], self.parameters[k:k + 1])


@dataclass
class Family:
    """A family of laws with positive parameters."""
    name: str  # one word
    middle: list[float]  # the fit starts around them
    moment: Callable[[Path, Trials], Array]
    sentence: Callable[[Sequence[float]], str]  # the law in physical terms
    beside: Optional[Array] = None  # a term that is added to the moments in some proportion, the first parameter
    has_branches: bool = True  # depends on start and reversals


@dataclass
class Hypothesis:
    """A law fitted to a loop, with the start that it fits best."""
    name: str
    parameters: list[float]  # over the exact ones
    start: Start
    cost: float  # the likeliest law has the lowest
    residual: float  # root mean square distance from the loop, over its largest moment
    offset: float  # of the record's moments
    moment: Array  # in each row, with the offset
    sentence: str = ""

    @property
    def unknowns(self) -> int:
        """Parameters, and the two numbers of a start that is not rest."""
        return len(self.parameters) + (0 if self.start == Start() else 2)


# ---------------------------------------------------------------- the fit


@dataclass
class _Fitted:
    """The fit of each trial."""
    moment: Array
    offset: Array
    part: Array
    residual: Array
    cost: Array


@dataclass
class _Fitter:
    """Fits a family from one start: parameters, the start unless it is fixed, the offset of the record's moments and, where
    rows are noisy, the rotations at its reversals."""
    path: Path
    law_error: float
    family: Family
    start: Start
    start_is_free: bool
    columns: Array = field(init=False)  # fields added in proportion: an offset, unless the path begins at rest; Family.beside

    def __post_init__(self) -> None:
        rows = len(self.path.twist)
        added = [] if self.path.begins_at_zero and not self.start_is_free else [np.ones(rows)]
        self.columns = np.array(added + ([] if self.family.beside is None else [self.family.beside])).reshape(-1, rows)

    def at(self, trials: Trials) -> _Fitted:
        own, columns, rows = self.path.moment, self.columns, len(self.path.moment)
        with np.errstate(all="ignore"):
            moment = self.family.moment(self.path, trials)
        fails = ~np.isfinite(moment).all(axis=1)
        moment = np.where(fails[:, None], 0.0, moment)
        share = np.zeros((len(moment), len(columns)))
        counts = np.ones(moment.shape)
        for _ in range(2 if len(columns) else 0):
            square = (counts @ (columns[:, None] * columns).reshape(-1, rows).T).reshape(-1, len(columns), len(columns))
            right = (counts * (own - moment)) @ columns.T
            share = np.linalg.solve(square + 1e-300 * np.eye(len(columns)), right[..., None])[..., 0]
            counts = _that_count(own - moment - share @ columns)
        moment = moment + share @ columns
        offset = share[:, 0] if len(columns) > (self.family.beside is not None) else np.zeros(len(moment))
        part = np.zeros(len(moment)) if self.family.beside is None else share[:, -1]
        rms = trimmed_mean(moment - own)
        count = len(self.family.middle) + (self.family.beside is not None) + 2 * self.start_is_free
        cost = rows * np.log(rms**2 + (self.law_error * np.ptp(own))**2) + _PRICE * count
        cost[fails | (part < 0.0) | (part > _LARGEST_PART) | ~np.isfinite(cost)] = np.inf
        return _Fitted(moment, offset, part, rms / np.abs(own - offset[:, None]).max(axis=1), cost)

    def trials(self, parameters: Array, x: Optional[Array] = None) -> Trials:
        """For parameters in rows; or one row of them, and changes x in rows: logarithms of parameters; over the range of
        rotations, the start's two numbers and the rotations at the reversals."""
        rows, span = (len(parameters) if x is None else len(x)), np.ptp(self.path.twist)
        shift, turned = np.full(rows, self.start.shift), np.full(rows, self.start.turned)
        ends = np.tile(self.path.turn_twist, (rows, 1))
        if x is not None:
            count = parameters.shape[1]
            parameters = parameters * np.exp(np.clip(x[:, :count], -12.0, 12.0))
            if self.start_is_free:
                shift = shift + span * x[:, count]
                turned = np.abs(turned + span * x[:, count + 1]) if self.start.turned > 0.0 else turned
                count += 2
            ends[:, 1:1 + x.shape[1] - count] += span * x[:, count:]
        return Trials(shift, turned, ends, parameters)

    def on_grid(self) -> tuple[float, Array]:
        """The least cost of combinations of parameters that differ from the middle ones by a few steps of a factor."""
        steps = np.array(list(itertools.product(range(-3, 4), repeat=len(self.family.middle))), float)
        grid = np.array(self.family.middle) * np.exp(0.4 * steps)
        cost = self.at(self.trials(grid)).cost
        return float(cost.min()), grid[[int(cost.argmin())]]

    def polished(self, parameters: Array, bar: float) -> Hypothesis:
        """Levenberg's and Marquardt's method from these parameters, in a row. It ends early where the law stays far off, over
        `bar`, the least residual of other laws."""
        fixed = parameters.shape[1] + 2 * self.start_is_free
        free = self.family.has_branches and self.path.is_noisy and len(self.path.turns) <= 24
        x = np.zeros(fixed + (len(self.path.turns) - 2 if free else 0))
        best, damping, slow = self.at(self.trials(parameters, x[None])), 1e-3, 0
        for step in range(30 if x.size and np.isfinite(best.cost[0]) else 0):
            square, right, size = self._equations(parameters, x, fixed, best)
            gain, expected = 0.0, math.inf
            while damping < 1e6 and gain <= 0.0 and expected > _SETTLED:
                change = np.linalg.lstsq(square + np.diag(damping * np.diag(square) + 1e-300), right, rcond=None)[0]
                expected = len(self.path.moment) * float(right @ change) / size
                tried = self.at(self.trials(parameters, (x - change)[None]))
                gain = float(best.cost[0] - tried.cost[0])
                damping *= 0.1 if gain > 0.0 else 10.0
                if gain > 0.0:
                    best, x = tried, x - change
            slow = slow + 1 if gain < _SLOW * len(self.path.moment) else 0
            is_far = (slow > 1 and best.residual[0] > _NEAR) or (slow and step > 2 and best.residual[0] > _FAR * bar)
            if gain < _SETTLED or is_far:
                break
        found = self.trials(parameters, x[None])
        parts = [] if self.family.beside is None else [float(best.part[0])]
        hypothesis = Hypothesis(
            self.family.name, parts + found.parameters[0].tolist(), Start(float(found.shift[0]), float(found.turned[0])),
            float(best.cost[0]), float(best.residual[0]), float(best.offset[0]), best.moment[0])
        if not np.isfinite(hypothesis.cost):
            hypothesis.residual, hypothesis.moment = math.nan, np.full(best.moment[0].shape, np.nan)
        else:
            hypothesis.sentence = self.family.sentence(hypothesis.parameters)
        return hypothesis

    def _equations(self, parameters: Array, x: Array, fixed: int, there: _Fitted) -> tuple[Array, Array, float]:
        """Normal equations of a step from x, and the sum of the squares that it lessens. The unknowns from `fixed` on are
        measured, with noise."""
        difference = 1e-6
        beyond = self.at(self.trials(parameters, np.vstack([x, x + difference * np.eye(len(x))])))
        error = there.moment[0] - self.path.moment
        slopes = _that_count(error) * (beyond.moment[1:] - there.moment) / difference
        square, right = slopes @ slopes.T, slopes @ error
        if len(x) > fixed:
            stiff = (there.residual[0] * 0.5 * np.ptp(self.path.moment) * np.ptp(self.path.twist) / self.path.twist_noise)**2
            square[range(fixed, len(x)), range(fixed, len(x))] += stiff
            right[fixed:] += stiff * x[fixed:]
        return square, right, float(error @ error) + len(error) * (self.law_error * np.ptp(self.path.moment))**2


def _that_count(error: Array) -> Array:
    """0 for the 2 % of rows that are farthest off, such as rows at a jump; 1 for the others."""
    size, last = np.abs(error), max(0, int(COUNTED * error.shape[-1]) - 1)
    return (size <= np.partition(size, last, axis=-1)[..., last:last + 1]).astype(float)


def fit(path: Path, law_error: float, starts: list[Start], families: list[Family], most: int) -> list[Hypothesis]:
    """Fits each family to a loop; the first of these starts is fixed, the others are varied. Starts from `most` of them, the
    nearest by a grid of parameters, until the law differs from the loop by no more than noise."""
    tries = []
    for k, family in enumerate(families):
        own_starts = starts[:1] if not family.has_branches else starts[:_MAX_STARTS] if family.middle else starts
        fitters = [_Fitter(path, law_error, family, start, n > 0) for n, start in enumerate(own_starts)]
        grids = [(*fitter.on_grid(), fitter) for fitter in fitters]
        equal = min(grid[0] for grid in grids) + _PRICE  # such starts are as good: the first of them has the least offset
        grids = sorted(((max(cost, equal), *rest) for cost, *rest in grids), key=lambda grid: grid[0])[:most]
        tries += [(cost, k, fitter, parameters) for cost, parameters, fitter in grids]
    found: dict[int, Hypothesis] = {}
    at_noise: set[int] = set()
    bar = math.inf
    for _, k, fitter, parameters in sorted(tries, key=lambda each: each[:2]):
        if k in at_noise:
            continue
        tried = fitter.polished(parameters, bar)
        if k not in found or tried.cost < found[k].cost:
            found[k] = tried
        if math.isfinite(tried.cost):
            bar = min(bar, tried.residual) if len(families) > 1 else bar
            noise = row_noise(path, path.moment - tried.moment) / np.abs(path.moment - tried.offset).max()
            if tried.residual <= 1.1 * max(noise, law_error):
                at_noise.add(k)
    return [found[k] for k in range(len(families))]
