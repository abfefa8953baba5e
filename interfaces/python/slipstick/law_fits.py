"""The exact law of a contact in torsion as polynomials, a table, springs with sliders, and a limit surface, with their errors.

Dimensionless as slipstick.exact: the rotation as t = G a^2 phi/(mu W), the moment as m = M/M_lim.
"""
from __future__ import annotations

from ctypes import c_double
from dataclasses import dataclass
from functools import partial
from math import exp, hypot, inf, log, pi, tan
from typing import Any, Callable, NamedTuple, Optional

import numpy as np
from numpy.polynomial import chebyshev, legendre
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

from . import _library, exact
from .errors import InputError

STIFFNESS = 16 / 3  #: dM/dphi over G a^3 while everything sticks: exact, and the same for each profile
LAST_DEFICIT = 1e-12  #: 1 - m where the polynomials end
MAX_DEGREE = 15
MAX_PIECES = 200
MAX_ELEMENTS = 200
MAX_EVEN_ROWS = 100000  #: a file of some 10 MB

_NODES = 24  # of the interpolation that a piece is cut out of
_COMPARED = (np.arange(40) + 0.5) / 20 - 1  # points at which a piece is compared with the function, scaled to [-1, 1]


def short(value: float) -> str:
    """The fewest digits that give the same number."""
    return repr(float(value)).removesuffix(".0")


def _require(name: str, error: float, least: float, largest: float) -> None:
    if not least <= error <= largest:
        raise InputError(f"{name}: an error of {short(error)}; allowed: {short(least)} to {short(largest)}")


# ---------------------------------------------------------------- polynomials


@dataclass(frozen=True)
class Fit:
    """A function as polynomials on intervals that follow each other."""

    pieces: list[tuple[float, float, list[float]]]  #: low, high, and coefficients of Chebyshev polynomials
    error: float  #: the largest found, relative, at points between those of the fit

    @property
    def ends(self) -> list[float]:
        return [self.pieces[0][0]] + [high for _, high, _ in self.pieces]

    @property
    def first(self) -> list[int]:
        """Where each piece's coefficients begin, and where the last ones end."""
        return np.cumsum([0] + [len(piece) for *_, piece in self.pieces]).tolist()

    @property
    def coefficients(self) -> list[float]:
        return [number for *_, piece in self.pieces for number in piece]

    def json(self) -> dict[str, Any]:
        return {"error_found": self.error, "degree": max(len(piece) for *_, piece in self.pieces) - 1,
                "pieces": [{"low": low, "high": high, "coefficients": piece} for low, high, piece in self.pieces]}


def fit_chebyshev(f: Callable[[Any], Any], knots: list[float], tolerance: float) -> Fit:
    """Fits f between the first and the last knot, with a piece's end at each knot and at halves between them where the
    tolerance needs it; relative errors found are at most half the tolerance."""
    done, errors, low, high = [], [], np.array(knots[:-1]), np.array(knots[1:])
    while low.size:
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        found = chebyshev.chebinterpolate(lambda x: f(middle + half * x[:, None]), _NODES - 1)
        least = np.minimum(abs(f(low + 1e-9 * (high - low))), abs(f(high)))
        tails = np.cumsum(abs(found[::-1]), axis=0)[::-1]
        sizes = np.maximum(1, (~(tails <= 0.25 * tolerance * least)).sum(axis=0))
        found[np.arange(_NODES)[:, None] >= sizes] = 0
        error = abs(chebyshev.chebval(_COMPARED, found) / f(middle + half * _COMPARED[:, None]).T - 1).max(axis=1)
        good = (sizes <= MAX_DEGREE + 1) & (error <= 0.5 * tolerance)
        done += [(low[k], high[k], found[:sizes[k], k].tolist()) for k in np.flatnonzero(good)]
        errors += error[good].tolist()
        if len(done) + 2 * (~good).sum() > MAX_PIECES or not (low < middle)[~good].all():
            raise InputError(f"--error: {MAX_PIECES} pieces do not reach an error of {short(tolerance)}; allowed: a larger one")
        low, high = np.concatenate([low[~good], middle[~good]]), np.concatenate([middle[~good], high[~good]])
    return Fit(sorted(done), max(errors))


class State(NamedTuple):
    """A state of first loading, as slipstick.exact.states gives it."""

    moment_ratio: float
    moment_deficit: float
    stick_ratio: float
    stick_complement: float
    twist: float
    moment: float
    tangent_stiffness: float


class Curve:
    """The exact curve of first loading under a profile."""

    def __init__(self, profile: str) -> None:
        self.profile, constants = profile, exact.profile_named(profile)
        self.limit, self.full_stick = constants.moment_limit, constants.full_stick
        self.rest = STIFFNESS / self.limit  #: dm/dt at rest
        self._name, self._value, self._state = _library.encoded(profile), (c_double * 1)(), (c_double * len(State._fields))()

    def state(self, **given: float) -> State:
        """As exact.states, of one number and three times as fast."""
        (name, self._value[0]), = given.items()
        _library.checked(_library.function("exact_states")(
            self._name, State._fields.index(name), 1, self._value, self._state))
        return State(*self._state)

    def slope(self, state: State) -> float:
        """dm/dt."""
        return state.tangent_stiffness / self.limit

    def touching(self, slope: float) -> State:
        """Where the curve has this slope."""
        return self.state(stick_ratio=min(1.0, (slope / self.rest)**(1 / 3)))

    def state_where(self, f: Callable[[State], float], low: float, high: float) -> State:
        """The state with a stick ratio between two where a function crosses zero."""
        return self.state(stick_ratio=brentq(lambda c: f(self.state(stick_ratio=c)), low, high, xtol=1e-300, rtol=1e-15))


# ---------------------------------------------------------------- the law as polynomials


class TwistLaw:
    """Moment and rotation as polynomials with a stated error. Near the limit t grows like the logarithm of 1 - m; in
    l = -ln(1 - m) both ways are smooth from rest to limit: l/t is fitted over t, and t/l over l.

    Relative errors of m and t are at most `error`, plus the effect of an ulp of the argument, where 1 - m is at least
    LAST_DEFICIT; a larger rotation carries the limit. A cycle between m and -m loses the energy 4 M phi(m) times (l - l_1)^p
    times a polynomial, l_1 where slip begins and p the power of the smallest losses: relative errors are at most `error`
    however little is lost (a sphere loses M^3, p = 1). After a reversal Masing's rule gives the moment, with errors up to
    three times that of first loading."""

    def __init__(self, curve: Curve, error: float) -> None:
        _require("--error", error, 1e-11, 1e-2)
        self.error, profile = error, curve.profile
        sticks = curve.full_stick > 0
        first_slip = curve.state(stick_ratio=1.0).twist if sticks else 0.0
        self.first_logarithm = -log(1 - curve.full_stick) if sticks else 0.0
        self.last_twist = curve.state(moment_deficit=LAST_DEFICIT).twist

        def logarithm_per_twist(t: Any) -> Any:
            found = exact.states(twist=t, profile=profile)
            small = found.moment_ratio < 0.5
            return np.where(small, -np.log1p(-np.where(small, found.moment_ratio, 0)), -np.log(found.moment_deficit)) / t

        def at_logarithm(quantity: Callable[..., Any], l: Any) -> Any:
            small, result = l < log(2), np.empty_like(l)
            result[small] = quantity(moment_ratio=-np.expm1(-l[small]), profile=profile)
            result[~small] = quantity(moment_deficit=np.exp(-l[~small]), profile=profile)
            return result

        energy_lost = partial(exact.energy_lost, relative_error=max(1e-14, 1e-2 * error))  # a part of the error

        def loss_factor(l: Any) -> Any:
            energy = -4 * curve.limit * np.expm1(-l) * at_logarithm(exact.twist, l)
            return at_logarithm(energy_lost, l) / energy / (l - self.first_logarithm)**self.loss_power

        self.loss_power, smallest = (2.0 if sticks else 0.0), np.array([1e-30, 2e-30])
        if not sticks:
            self.loss_power = float(np.log2(np.divide(*loss_factor(smallest)[::-1])))
        last_logarithm = -log(LAST_DEFICIT)
        self.logarithm = fit_chebyshev(logarithm_per_twist, sorted({0.0, first_slip, self.last_twist}), error)
        self.twist = fit_chebyshev(lambda l: at_logarithm(exact.twist, l) / l,
                                   sorted({0.0, self.first_logarithm, last_logarithm}), error)
        self.loss = fit_chebyshev(loss_factor, [self.first_logarithm, last_logarithm], error)


# ---------------------------------------------------------------- laws of straight lines. Errors are of m, absolute.


def _rise_above(curve: Curve, one: State, other: State) -> float:
    """How far the curve rises above the straight line between two of its states."""
    slope = (other.moment_ratio - one.moment_ratio) / (other.twist - one.twist)
    state = curve.touching(slope)
    return state.moment_ratio - one.moment_ratio - slope * (state.twist - one.twist)


def tabulate(curve: Curve, error: float) -> Any:
    """States from rest to where 1 - m is the error: as few as keep it with straight lines between them, and the last moment
    beyond."""
    _require("--table-error", error, 1e-7, 0.5)
    rows, last = [curve.state(moment_ratio=0.0)], curve.state(moment_deficit=error)

    def too_far(state: State) -> float:
        return (_rise_above(curve, rows[-1], state) if state.twist > rows[-1].twist else 0) - error

    while _rise_above(curve, rows[-1], last) > error:
        rows.append(curve.state_where(too_far, last.stick_ratio, rows[-1].stick_ratio))
    return np.rec.array(rows + [last], dtype=[(name, float) for name in State._fields])


def tabulate_evenly(curve: Curve, error: float) -> Any:
    """States at equal steps of the rotation, for readers that draw cubic splines through them or step evenly: with either, and
    with straight lines, the error is kept."""
    last, steps, worst = curve.state(moment_deficit=error), 32, inf
    while worst > error:
        if steps > MAX_EVEN_ROWS:
            raise InputError(f"--table-error: more than {MAX_EVEN_ROWS} even rows for an error of {short(error)}; "
                             "allowed: a larger --table-error")
        rows = exact.states(twist=last.twist * np.arange(steps + 1) / steps, profile=curve.profile)
        rows[-1] = last
        m, t = rows.moment_ratio, rows.twist
        slope = np.diff(m) / np.diff(t)
        touching = exact.states(stick_ratio=np.minimum(1, np.cbrt(slope / curve.rest)), profile=curve.profile)
        worst = (touching.moment_ratio - m[:-1] - slope * (touching.twist - t[:-1])).max()
        steps = int(1.1 * steps * (worst / error)**0.5) + 1
    return rows


def _next_corner(curve: Curve, start: tuple[float, float], last: State, error: float) -> tuple[float, float]:
    """The next corner of lines that stay within the error of the curve, from one where they start at its origin or `error`
    above it; the last has moment ratio 1."""
    twist, moment_ratio = start
    if 1 - moment_ratio <= error:
        return last.twist, 1.0
    stick_ratio = curve.state(twist=twist).stick_ratio if twist > 0 else 1.0
    tangent = curve.state_where(
        lambda state: state.moment_ratio - moment_ratio - curve.slope(state) * (state.twist - twist) - error, 1e-9, stick_ratio)
    slope = curve.slope(tangent)
    reaches = twist + (1 - moment_ratio) / slope
    if reaches >= last.twist:
        return reaches, 1.0
    end = curve.state_where(lambda state: moment_ratio + slope * (state.twist - twist) - state.moment_ratio - error,
                            last.stick_ratio, tangent.stick_ratio)
    return end.twist, min(1.0, end.moment_ratio + error)


def _corners(curve: Curve, error: float, most: float = inf) -> list[tuple[float, float]]:
    """The origin and the corners, as few as keep the error; if there are more than `most`, the first of them."""
    last, corners = curve.state(moment_deficit=error), [(0.0, 0.0)]
    while corners[-1][1] < 1 and len(corners) <= most:
        corners.append(_next_corner(curve, corners[-1], last, error))
    return corners


def _missing(curve: Curve, error: float, count: int) -> float:
    """Positive: the part of the limit that `count` lines do not reach. Negative: the lines reach the limit; the value is the
    rotation by which they exceed the allowed one."""
    corners = _corners(curve, error, count)
    if corners[-1][1] < 1:
        return 1 - corners[-1][1]
    if len(corners) <= count or 1 - corners[-2][1] <= error:
        return -1.0
    return max(-1.0, curve.state(moment_deficit=error).twist - corners[-1][0])


class ParallelElements:
    """Jenkins elements side by side, each a spring in series with a slider. Together they stick and slip as the contact does,
    Masing's rule included; their slip moments sum up to 1, the exact limit.

    After any rotations the error is e(x_0) - 2 e(x_1) + 2 e(x_2) - ... with e that of first loading, x_0 the largest rotation
    and x_1 > x_2 > ... half the ranges of the branches still open. As x_0 >= x_1, it is a sum of differences of e over
    intervals side by side: at most the total variation of e, which reversals at its extremes reach."""

    def __init__(self, curve: Curve, error: float, count: Optional[int] = None) -> None:
        """As few elements as keep the error, or at most `count` with the least error."""
        if count is None:
            _require("--element-error", error, 1e-5, 0.5)
        elif not 1 <= count <= MAX_ELEMENTS:
            raise InputError(f"--elements: {count} elements; allowed: 1 to {MAX_ELEMENTS}")
        else:  # MAX_ELEMENTS have an error above 1e-8 with each profile
            accuracy = 1e-9
            found = brentq(lambda error: _missing(curve, exp(error), count), log(1e-8), log(0.5), xtol=accuracy)
            error = exp(found + 2 * accuracy)
        self.error = error  #: the largest on first loading; on loops between t and -t three times that
        corners = _corners(curve, error)
        t, m = np.array(corners).T
        slopes = np.diff(m) / np.diff(t)
        stiffness = -np.diff(slopes, append=0.0)
        self.each = np.column_stack([stiffness, stiffness * t[1:]])  #: m over t, and m at slip; the first to slip first
        # The lines' error falls and rises between two corners, and falls after the last.
        touching = [curve.touching(slope) for slope in slopes]
        least = [m0 + slope * (state.twist - t0) - state.moment_ratio for t0, m0, slope, state in zip(t, m, slopes, touching)]
        ends = m - exact.moment_ratio(twist=t, profile=curve.profile)
        #: the largest error after any rotations: the total variation of that on first loading
        self.history_error = float(2 * ends.sum() - 2 * sum(least))


def _distances(curve: Curve, stiffness: float) -> tuple[float, float]:
    """How far min(stiffness t, 1) is from m: below where the curve has the spring's slope, and above at the cap."""
    touching = curve.touching(stiffness)
    return touching.moment_ratio - stiffness * touching.twist, curve.state(twist=1 / stiffness).moment_deficit


def spring_error(curve: Curve, stiffness: float) -> float:
    """The largest error of a spring with a cap, as many programs have it: min(stiffness t, 1) instead of m."""
    return max(_distances(curve, stiffness))


def best_spring(curve: Curve) -> float:
    """The stiffness with the least error: as far below the curve as above it."""
    return brentq(lambda k: np.subtract(*_distances(curve, k)), 0.1 * curve.rest, curve.rest, xtol=1e-300, rtol=1e-15)


# ---------------------------------------------------------------- limit loads


class LimitLoad(NamedTuple):
    """A load under which all of the contact slides, turning about a point at a distance from its axis. The loads that the
    contact carries lie on one side of the plane through this one whose normal is that motion: force * centre + moment is
    largest here (Goyal 1991)."""

    centre: float  #: distance over a; infinite: it slides without turning
    force: float  #: |F|/(mu W), perpendicular to the arm
    moment: float  #: M/M_lim


def _graded(low: float, to_low: int, high: float, to_high: int) -> Any:
    """Ends of panels between two angles, narrower by 1/4 each time towards an end."""
    half = 0.5 * (high - low)
    return np.concatenate([[low], low + half * 0.25**np.arange(to_low, 0, -1), [low + half],
                           high - half * 0.25**np.arange(1, to_high + 1), [high]])


def _sliding_load(curve: Curve, centre: float) -> LimitLoad:
    """The load that slides the contact about a centre. The radius is the sine of an angle, so that a pressure that is infinite
    at the edge is not. Panels get narrower towards the circle where the contact turns, at which the integrand bends, and
    towards both ends, nearer to which an angle's sine does not hold the digits of 1 - r."""
    to_centre, to_edge, turning = 12, 5, np.arcsin(min(centre, 1))
    if centre < 1:
        inner = _graded(0, to_edge, turning, to_centre)[:-1] if centre > 0 else []
        ends = np.concatenate([inner, _graded(turning, to_centre, pi / 2, to_edge)])
    else:
        ends = _graded(0, to_edge, pi / 2, to_edge)
    nodes, weights = legendre.leggauss(20)
    half = 0.5 * np.diff(ends)[:, None]
    angles = (0.5 * (ends[1:] + ends[:-1])[:, None] + half * nodes).ravel()
    r = np.sin(angles)
    density = exact.pressure(r, curve.profile) * r * np.cos(angles) * (half * weights).ravel()
    # Integrals around a circle of the sliding direction's part along the force, and of its arm.
    if centre == 0:
        force, moment = 0 * r, 2 * pi * r
    elif centre == inf:
        force, moment = 2 * pi + 0 * r, 0 * r
    else:
        total, difference = centre + r, centre - r
        complement = np.maximum((difference / total)**2, 1e-300)
        e, k = total * ellipe(1 - complement), difference * ellipkm1(complement)
        force, moment = 2 / centre * (e + k), 2 * (e - k)
    load = exact.profile_named(curve.profile).load
    return LimitLoad(centre, float(density @ force) / load, float(density @ moment) / load / curve.limit)


class LimitSurface:
    """The loads that a contact carries. The surface is symmetric about the axis of moments."""

    def __init__(self, curve: Curve, count: int) -> None:
        if count < 3:
            raise InputError(f"--limit-loads: {count} loads; allowed: at least 3")
        #: from pure moment to pure force; the motions are spread evenly
        self.loads = [_sliding_load(curve, curve.limit * tan(0.5 * pi * i / (count - 1))) for i in range(count - 1)]
        self.loads.append(_sliding_load(curve, inf))
        #: (F/(mu W))^2 + (M/M_lim)^2 = 1, which is used in its place (Howe and Cutkosky 1996): its distance from the origin
        #: over the exact one, less 1, where that is farthest from 0
        self.ellipsoid_error, self.ellipsoid_farthest = max(
            ((1 / hypot(load.force, load.moment) - 1, load) for load in self.loads), key=lambda pair: abs(pair[0]))
        self.gap = self._gap(curve.limit)

    def _gap(self, arm: float) -> float:
        """Between loads next to each other the surface lies between their chord and their tangents: how far apart these are at
        most, over the distance from the origin."""
        centre, f, m = np.array(self.loads).T
        n = np.append(centre[:-1] / arm, 1.0)  # normals (n, o) in the plane of the two ratios
        o = np.append(np.ones(len(n) - 1), 0.0)
        support = n * f + o * m
        determinant = n[:-1] * o[1:] - n[1:] * o[:-1]
        force = (support[:-1] * o[1:] - support[1:] * o[:-1]) / determinant
        moment = (n[:-1] * support[1:] - n[1:] * support[:-1]) / determinant
        # The chord through both loads crosses the ray to (force, moment) at this part of it.
        part = (f[:-1] * np.diff(m) - m[:-1] * np.diff(f)) / (force * np.diff(m) - moment * np.diff(f))
        return float((1 / part - 1).max())
