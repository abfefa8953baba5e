"""A loop of load against motion in the contact's own units, and the moments that a law with a rule of branches gives for its
motion. Rotations are t = G a^2 phi/(mu W), moments m = M/M_lim; for forces the displacement and the force in their units.

Arrays of moments have a row for each of several trials: other parameters, other starts."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from . import exact

Array = npt.NDArray[np.float64]
Curve = Callable[[Any], Any]  # m at t of first loading from rest, odd; or its inverse

_REVERSAL, _MIN_REVERSAL = 0.04, 1e-3  # part of the range by which a reversal turns back at most before it counts, and at least
_NOISE_SIGMAS = 8.0  # in between it counts beyond this multiple of the noise's standard deviation
_CLOSING = 0.02  # part of a loop's range within which it has to close
_VISIBLE_NOISE = 1e-4  # part of the range: smaller fourth differences belong to a smooth motion, larger ones are noise
COUNTED = 0.98  # part of the rows that counts: the others are farthest off, such as rows just after a jump


class TorsionCurve:
    """M/M_lim of first loading at t under a profile of exact, through states from almost no slip to almost gross slip. The
    interpolated quantity is the moment that slip takes off, by cubics over logarithms with the exact slopes; below the first
    state it is a power of the rotation, so that small moments keep their digits. Relative errors are below 1e-9, for a rounded
    punch below 2e-7."""

    def __init__(self, profile: str) -> None:
        constants, parts = exact.profile_named(profile), 0.5 * 10.0**np.arange(-9, 1 / 256, 1 / 128)
        states = [exact.states(stick_complement=parts, profile=profile),
                  exact.states(stick_ratio=parts[:-513:-1][1:], profile=profile)]
        twist, moment, tangent = (np.concatenate([part[key] for part in states])
                                  for key in ("twist", "moment_ratio", "tangent_stiffness"))
        self.moment_limit = constants.moment_limit
        self.stiffness = 16 / 3 / self.moment_limit  # dm/dt at rest
        self.first, self.last = constants.full_stick / self.stiffness, twist[-1]
        beyond, slip = twist - self.first, self.stiffness * twist - moment
        certain = (slip > 1e-8 * moment) & (beyond > 1e-8 * self.first)
        x, y = np.log(beyond[certain]), np.log(slip[certain])
        power = (beyond * (self.stiffness - tangent / self.moment_limit))[certain] / slip[certain]
        far = 40.0
        x, y, power = np.append(x[0] - far, x), np.append(y[0] - far * power[0], y), np.append(power[0], power)
        step, rise, self.knots = np.diff(x), np.diff(y), x
        one, other = step * power[:-1] - rise, step * power[1:] - rise
        self.cubics = np.array([y[:-1], power[:-1], (-2.0 * one - other) / step**2, (one + other) / step**3])

    def __call__(self, twist: Any) -> Any:
        size = np.abs(twist)
        with np.errstate(divide="ignore", invalid="ignore"):
            x = np.log(np.maximum(size - self.first, 1e-300))
            piece = np.clip(np.searchsorted(self.knots, x) - 1, 0, len(self.knots) - 2)
            c, x = self.cubics[:, piece], x - self.knots[piece]
            slip = np.exp(((c[3] * x + c[2]) * x + c[1]) * x + c[0])
        loaded = self.stiffness * size - np.where(size > self.first, slip, 0.0)
        return np.copysign(np.where(size < self.last, np.minimum(loaded, 1.0), 1.0), twist)


@dataclass
class Start:
    """The history before a record: the contact was rotated from rest to `turned`, against the record's first direction, and
    back to the record's start. 0: the record starts from rest. `shift` is added to the record's rotations."""
    shift: float = 0.0
    turned: float = 0.0  # not negative


@dataclass
class Path:
    """A loop in the contact's units."""
    time: Array  # from 0 to 1 over the record; by rows where no time is given
    duration: float  # s; 0: no time is given
    twist: Array
    moment: Array
    turns: list[int] = field(default_factory=list)  # rows of the reversals, between the first row and the last
    turn_twist: Array = field(default_factory=lambda: np.empty(0))  # the rotation in these rows, smoothed
    twist_noise: float = 0.0  # standard deviation from row to row

    def __post_init__(self) -> None:
        if not self.turns:
            self._find_turns()

    def _find_turns(self) -> None:
        span = float(np.ptp(self.twist))
        self.turns = _turns(self.twist, _REVERSAL * span)
        clear = min(max(_NOISE_SIGMAS * row_noise(self, self.twist), _MIN_REVERSAL * span), _REVERSAL * span)
        self.turns = _turns(self.twist, clear)
        self.twist_noise = row_noise(self, self.twist)
        self.turn_twist = self.twist[self.turns]
        if self.is_noisy:
            for k in range(1, len(self.turns) - 1):
                window = min(self.turns[k] - self.turns[k - 1], self.turns[k + 1] - self.turns[k]) // 8
                if window >= 6:
                    self.turn_twist[k] = _smoothed_turn(self.twist, self.turns[k], window)

    @property
    def is_noisy(self) -> bool:
        return self.twist_noise > _VISIBLE_NOISE * float(np.ptp(self.twist))

    @property
    def begins_at_zero(self) -> bool:
        """Whether the record begins at zero, where it may start from rest."""
        return all(abs(values[0]) <= 0.05 * np.ptp(values) for values in (self.twist, self.moment))

    def in_units(self, load: float, motion: float) -> Path:
        """The same record, with moments and rotations in other units."""
        return Path(self.time, self.duration, self.twist * motion, self.moment * load, self.turns, self.turn_twist * motion,
                    self.twist_noise * motion)

    def starts(self) -> list[Start]:
        """Rest, and other states from which the record may start; a fit varies the others."""
        first, span = float(self.twist[0]), float(np.ptp(self.twist))
        if self.begins_at_zero and len(self.turns) < 3:
            return [Start()]
        sign = 1.0 if self.turn_twist[1] >= self.turn_twist[0] else -1.0
        found = [Start(), Start(-first), Start(-0.5 * float(self.twist.min() + self.twist.max()), 0.5 * span)]
        for part in (0.25, 0.5, 1.0, 2.0):  # elsewhere on first loading; at a reversal; on the way back from one
            far = part * span
            found += [Start(sign * far - first), Start(-sign * far - first, far), Start(-first, far)]
        return found


def _turns(twist: Array, enough: float) -> list[int]:
    """Rows at which the rotation turns back by more than enough, the first and the last."""
    turns, extreme, sign = [0], 0, 0.0
    values = twist.tolist()
    for row, value in enumerate(values):
        if sign == 0.0:
            if abs(value - values[0]) > enough:
                sign, extreme = (1.0 if value > values[0] else -1.0), row
        elif sign * (value - values[extreme]) > 0.0:
            extreme = row
        elif sign * (values[extreme] - value) > enough:
            turns.append(extreme)
            extreme, sign = row, -sign
    return [*turns, len(values) - 1]


def _smoothed_turn(twist: Array, turn: int, window: int) -> float:
    """The rotation at a reversal, from parabolas through some rows before and after it."""
    rows = np.arange(window + 1)
    return float(np.mean([np.polyfit(rows, twist[turn + way * rows], 2)[-1] for way in (-1, 1)]))


def row_noise(path: Path, values: Array) -> float:
    """Standard deviation of the noise from row to row, from fourth differences of values that are smooth between the reversals
    otherwise; the largest 2 % do not count."""
    branches = [values[one + 1:other - 1] for one, other in zip(path.turns, path.turns[1:])]
    differences = np.concatenate([np.diff(branch, 4) for branch in branches])
    return float(trimmed_mean(differences / np.sqrt(70.0))) if differences.size else 0.0  # 70: squares of 1, 4, 6, 4, 1


def trimmed_mean(values: Array) -> Any:
    """The root of the mean square along the last axis, without the largest 2 %, such as rows just after a jump."""
    count = max(1, int(COUNTED * values.shape[-1]))
    with np.errstate(over="ignore"):
        squares = np.partition(np.where(np.isfinite(values), values, np.inf)**2, count - 1, axis=-1)[..., :count]
        return np.sqrt(squares.mean(axis=-1))


def rates(path: Path) -> Array:
    """dt/dtime in each row, from the rows next to it, or from a few more where rotations are noisy."""
    window, found = 4 if path.is_noisy else 1, []
    for row in range(len(path.twist)):
        rows = slice(max(0, row - window), row + window + 1)
        time = path.time[rows] - path.time[rows].mean()
        found.append((time @ path.twist[rows]) / (time @ time))
    return np.array(found)


def correlation(twist: Array, moment: Array) -> Any:
    """1 or -1 where the points lie on a line; moment may have several rows."""
    one, other = twist - twist.mean(), moment - moment.mean(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        return other @ one / (np.linalg.norm(one) * np.linalg.norm(other, axis=-1))


def loop_areas(path: Path, moment: Array) -> list[float]:
    """Areas of the closed loops, m times t. A loop runs from a reversal through the next one and back; it is closed if the
    rotation comes back within a part of the loop's range."""
    areas, turn = [], 1
    while turn + 2 < len(path.turns):
        first, middle, last = path.turns[turn:turn + 3]
        turn += 1
        if abs(path.twist[last] - path.twist[first]) <= _CLOSING * abs(path.twist[middle] - path.twist[first]):
            rows, steps = moment[first:last + 1], np.diff(path.twist[first:last + 1])
            areas.append(float(0.5 * steps @ (rows[:-1] + rows[1:])))
            turn += 1
    return areas


# ---------------------------------------------------------------- branches


@dataclass(frozen=True)
class Law:
    """First loading, and the rule for branches after a reversal.

    masing        a branch is the first loading, enlarged twice; a closed loop leaves no memory
    not_enlarged  a branch is the first loading in its own size
    no_slip_back  a branch has the stiffness at rest up to the largest moment so far: isotropic hardening
    elastic       moment and rotation stay on the curve of first loading
    by_moment     a branch is a part of one curve, from its moment on: reversals are not remembered
    """
    loading: Curve  # from rest; for by_moment from loads against the motion on
    rule: str = "masing"
    stiffness: float = 0.0  # of loading at rest, for no_slip_back
    inverse: Curve = abs  # of loading, from -1 to 1, for by_moment


def follow(turns: list[int], twist: Array, ends: Array, turned: Array, law: Law) -> Array:
    """The law's moments, for each trial (rows of twist, of the rotations at its turns, and of how far it was turned before).
    The reversals of the first trial are the reversals of all."""
    signs = np.where(ends[0, 1:] >= ends[0, :-1], 1.0, -1.0)
    before = -signs[0] * turned[:, None]
    if law.rule == "elastic":
        return np.asarray(law.loading(twist))
    if law.rule in ("masing", "not_enlarged"):
        return _remembered(turns, twist, ends, before, signs, law)
    rule, state = _flow, (before, np.copysign(law.loading(np.abs(before)), before))
    if law.rule == "no_slip_back":
        first = twist[:, :1]
        rule, state = _harden, (first, law.loading(first), np.abs(np.where(before != 0.0, before, first)))
    states = []
    for end, sign in zip(ends.T[1:], signs):
        states.append(state)
        state = rule(law, state, end[:, None], sign)
    branch = np.repeat(np.arange(len(signs)), np.diff(turns) + np.append(np.zeros(len(signs) - 1, int), 1))
    return rule(law, [np.hstack(part)[:, branch] for part in zip(*states)], twist, signs[branch])[1]


def _harden(law: Law, state: Any, twist: Array, sign: Any) -> tuple[Array, ...]:
    """Rotation and moment, and the rotation up to which the contact was loaded, after a branch from such a state."""
    at, there, loaded = state
    elastic = there + law.stiffness * (twist - at)
    beyond = np.maximum(0.0, (sign * elastic - law.loading(loaded)) / law.stiffness)
    return twist, np.where(beyond > 0.0, sign * law.loading(loaded + beyond), elastic), loaded + beyond


def _flow(law: Law, state: Any, twist: Array, sign: Any) -> tuple[Array, ...]:
    """Rotation and moment after a branch from such a state."""
    at, there = state
    return twist, sign * law.loading(law.inverse(sign * there) + sign * (twist - at))


def _remembered(turns: list[int], twist: Array, ends: Array, before: Array, signs: Array, law: Law) -> Array:
    """Moments on branches from reversals: 0: rest, 1: before the record, 2 and on: in the record."""
    rows, at_ends = _reversals(turns, twist[0], ends[0], before[0, 0], signs, law.rule == "masing")
    reversal = np.concatenate([rows, at_ends])
    size = np.where(reversal == 0, 1.0, 2.0 if law.rule == "masing" else 1.0)
    twists = np.hstack([np.zeros_like(before), before, ends[:, 1:]])
    change = size * law.loading((np.hstack([twist, ends[:, 1:]]) - twists[:, reversal]) / size)
    moments = np.zeros_like(twists)
    moments[:, 1:2] = law.loading(before)
    for k, one in enumerate(at_ends):
        moments[:, k + 2] = moments[:, one] + change[:, len(rows) + k]
    return np.asarray(change[:, :len(rows)] + moments[:, rows])


def _reversals(turns: list[int], twist: Array, ends: Array, before: float, signs: Array,
               forgets: bool) -> tuple[Any, list[int]]:
    """The reversals from which the branches in each row, and at each turn after the first, start. A branch that comes back to
    the reversal before its own continues the branch before that; beyond the largest rotation it is first loading."""
    still_open = [(1, before)] if before != 0.0 else []
    rows, at_ends = np.zeros(len(twist), int), []
    for k, (one, other) in enumerate(zip(turns, turns[1:])):
        at = signs[k] * np.append(twist[one:other], ends[k + 1])
        count = np.full(len(at), len(still_open))
        if forgets:
            for left in range(len(still_open), 1, -2):
                count[(count == left) & (at >= signs[k] * still_open[left - 2][1])] -= 2
            if still_open:
                count[(count == 1) & (at >= -signs[k] * still_open[0][1])] = 0
        found = np.array([0] + [number for number, _ in still_open])[count]
        rows[one:other], rows[-1] = found[:-1], found[-1]
        at_ends.append(int(found[-1]))
        still_open = [*still_open[:count[-1]], (k + 2, ends[k + 1])]
    return rows, at_ends
