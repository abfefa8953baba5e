"""The laws that a loop is compared with: the exact law, and laws that simulators use instead of it."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from ._loop_fit import Family, Hypothesis, Trials, fit
from ._loop_path import Array, Curve, Law, Path, Start, correlation, follow, rates, row_noise

_SAME_FACTOR = 0.02  # relative difference within which a limit or a stiffness is the exact one, or a named one
_SAME_STIFFNESS = 0.03  # the same for the stiffness of a wrong compliance


@dataclass
class Contact:
    """The contact that a loop is compared with."""
    normal_load: float  # N
    limit: float  # N m or N, of m = 1
    motion_unit: float  # rad or m, of t = 1
    loading: Curve  # the exact law: m at t
    stiffness: float  # dm/dt at rest
    limit_exponent: float  # d ln(limit)/d ln(normal load)
    stiffness_exponent: float  # d ln(stiffness at rest)/d ln(normal load)
    one_body: list[float]  # stiffness with the other body rigid, over the pair's
    other_profiles: dict[str, Curve]  # the first loading of other profiles of the same radius
    law_error: float  # relative, of loading
    load_name: str  # moment
    motion_name: str  # rotation
    rate_unit: str  # of a thousandth: mrad/s
    uniform_pressure_limit: float = math.nan  # over the exact one; only for torsion
    sphere_limit: Optional[float] = None  # of a sphere in torsion, M_lim/(mu W a), for the paper's Eq. (7)


def fit_exact_law(path: Path, contact: Contact, starts: list[Start]) -> Hypothesis:
    """The exact law, from the one of these starts that brings it closest to the loop."""
    family = Family("exact", [], lambda at, trials: _follow(at, trials, Law(contact.loading)), lambda p: "")
    return fit(path, contact.law_error, starts, [family], len(starts))[0]


def fit_wrong_laws(path: Path, contact: Contact, starts: list[Start]) -> list[Hypothesis]:
    """The laws that simulators use instead of the exact one, each with its best parameters."""
    return fit(path, contact.law_error, starts, list(_Families(path, contact).all()), 2)


# ---------------------------------------------------------------- their moments


def _follow(path: Path, trials: Trials, law: Law, limit: Any = 1.0, stiffness: Any = 1.0) -> Array:
    """Moments of a law with limit and stiffness scaled by other factors in each trial, or in each row."""
    factor = np.broadcast_to(stiffness / limit, (len(trials.shift), len(path.twist)))
    twist = (path.twist + trials.shift[:, None]) * factor
    ends = (trials.ends + trials.shift[:, None]) * factor[:, path.turns]
    return limit * follow(path.turns, twist, ends, trials.turned * factor[:, 0], law)


# ---------------------------------------------------------------- words


def _is_near(value: float, wanted: float, within: float = _SAME_FACTOR) -> bool:
    return abs(value / wanted - 1.0) <= within


def _is_far(stiffness: float) -> bool:
    """Whether a stiffness over the exact one shows another unit, not another law."""
    return not 0.1 < stiffness < 10.0


def _slips_at(limit: float, contact: Contact) -> str:
    if _is_near(limit, 1.0):
        return "slips at the limit"
    uniform = ": uniform pressure assumed" if _is_near(limit, contact.uniform_pressure_limit) else ""
    return f"slips at {limit:.2f} of the limit{uniform}"


def _stiffness_text(stiffness: float, contact: Contact) -> str:
    if _is_far(stiffness):
        return f"the stiffness at rest is {stiffness:.3g} of the exact one, as in another unit"
    text = f"the stiffness at rest is {stiffness:.2f} of the exact one"
    if any(_is_near(stiffness, each, _SAME_STIFFNESS) for each in contact.one_body):
        return text + ": the compliance of one body only, the other taken to be rigid"
    return text + (": twice the compliance of the pair" if _is_near(stiffness, 0.5, _SAME_STIFFNESS) else "")


# ---------------------------------------------------------------- the laws that are tried

_LARGEST_LIMIT = 30.0  # limit over the exact one; at larger ones, and below the inverse, the curve imitates another law
_SLOWEST = 0.03  # rate of creep over the fastest rate; slower creep is a rigid law's
_LARGEST_STIFFNESS = 60.0  # stiffness times the range of rotations over the limit; stiffer laws are called rigid
_RIGID = 1e5
_BEGINS = 0.25  # of the velocity at which Stribeck's friction has fallen

Words = Callable[[float, float], str]  # for a limit and a stiffness over the exact ones


def _factors(free: str, p: Array) -> tuple[Any, Any]:
    """The factors of limit and stiffness that a family varies, for parameters in rows."""
    one = np.ones(p.shape[:-1])
    first, last = (p[..., 0], p[..., -1]) if p.shape[-1] else (one, one)
    return {"limit": (first, one), "stiffness": (one, last)}.get(free, (first, last))


class _Families:
    """Makes families of wrong laws."""

    def __init__(self, path: Path, contact: Contact) -> None:
        self.path, self.contact, self.rate = path, contact, rates(path)
        self.fastest = float(np.abs(self.rate).max())
        self.span, moments = float(np.ptp(path.twist)), float(np.ptp(path.moment))
        self.mean_stiffness = moments / self.span / contact.stiffness  # over the exact one
        # Correlation at which the record's noise hides the difference between a law and a line, as for a flat punch before it
        # slips: such a law is a spring.
        self.of_a_line = 1.0 - 0.5 * max(1e-4, 2.0 * row_noise(path, path.moment) / moments)**2

    def all(self) -> Iterator[Family]:
        """Scaled curves come before wrong rules: from a reversal on, twice the limit without enlarging is the same law."""
        rest = self.contact.stiffness
        yield from self._springs(rest)
        yield from self._scaled(Law(self.contact.loading))
        yield from self._rules()
        yield from self._curves(rest)
        yield from self._forgetful(rest)
        yield from self._rate_laws(rest)
        yield from self._changing()

    def _add(self, name: str, law: Law, sentence: str | Words, *sets: str) -> Iterator[Family]:
        """A law with limit and stiffness that are free, or not."""
        for free in sets:
            middle = [1.0] * {"none": 0, "both": 2}.get(free, 1)
            if free in ("stiffness", "both") and _is_far(self.mean_stiffness):
                middle[-1] = self.mean_stiffness

            def moment(path: Path, trials: Trials, free: str = free) -> Array:
                limit, stiffness = _factors(free, trials.parameters)
                moment = _follow(path, trials, law, limit[:, None], stiffness[:, None])
                is_rigid = stiffness > np.maximum(1.0, _LARGEST_STIFFNESS * limit / (self.contact.stiffness * self.span))
                fails = (limit < 1.0 / _LARGEST_LIMIT) | (limit > _LARGEST_LIMIT) | (is_rigid & (law.rule != "elastic"))
                if name in ("other_profile", "spring_and_cap"):
                    fails |= np.abs(correlation(path.twist, moment)) >= self.of_a_line
                moment[fails] = np.nan
                return moment

            def words(p: Sequence[float], free: str = free) -> str:
                limit, stiffness = (float(value) for value in _factors(free, np.array(p)))
                if callable(sentence):
                    return sentence(limit, stiffness)
                return "; ".join([sentence] + [_slips_at(limit, self.contact)] * (not _is_near(limit, 1.0))
                                 + [_stiffness_text(stiffness, self.contact)] * (not _is_near(stiffness, 1.0)))

            yield Family(name, middle, moment, words)

    def _springs(self, rest: float) -> Iterator[Family]:
        def spring(t: Any) -> Any:
            return np.clip(rest * t, -1.0, 1.0)

        def cap(limit: float, stiffness: float) -> str:
            right = "the stiffness at rest is right" if _is_near(stiffness, 1.0) else _stiffness_text(stiffness, self.contact)
            return _slips_at(limit, self.contact) + "; a spring up to there, without partial slip; " + right

        elastic = Law(lambda t: rest * t, "elastic")
        yield from self._add("elastic", elastic, "no slip: elastic, no energy is lost", "none", "stiffness")
        yield from self._add("rigid", Law(lambda t: spring(_RIGID * t)), "no presliding: the law is rigid", "none", "limit")
        yield from self._add("spring_and_cap", Law(spring), cap, "none", "limit", "stiffness", "both")
        # One element of Iwan's that slips, and a spring next to it.
        yield Family(
            "bilinear", [1.0, 1.0],
            lambda path, trials: _follow(path, trials, Law(spring), trials.parameters[:, :1], trials.parameters[:, 1:]),
            lambda p: f"two springs: one slips at {p[1]:.2f} of the limit, and {p[0]:.2f} of the exact stiffness stay",
            rest * self.path.twist)

    def _scaled(self, exact: Law) -> Iterator[Family]:
        contact = self.contact

        def all_loads(factor: float, _: float) -> str:
            counted = ": counted twice" if _is_near(factor, 2.0) else ": halved" if _is_near(factor, 0.5) else ""
            return f"all {contact.load_name}s are {factor:.2f} times the exact ones{counted}"

        yield from self._add("stiffness", exact, lambda _, stiffness: _stiffness_text(stiffness, contact), "stiffness")
        yield from self._add("limit", exact, lambda limit, _: _slips_at(limit, contact), "limit")
        yield from self._add("factor", exact, all_loads, "factor")
        yield from self._add("limit_and_stiffness", exact, lambda limit, stiffness: (
            f"{_slips_at(limit, contact)}; {_stiffness_text(stiffness, contact)}"), "both")

    def _rules(self) -> Iterator[Family]:
        for name, rule, words in (
                ("not_enlarged", "not_enlarged", "along the curve of first loading, not enlarged twice"),
                ("unloads_without_slip", "no_slip_back", "with the stiffness at rest, without slip"),
                ("elastic", "elastic", "along the curve of first loading itself: no energy is lost")):
            sentence = f"unloads {words}{',' if rule == 'elastic' else ':'} breaks Masing's rule"
            law = Law(self.contact.loading, rule, self.contact.stiffness)
            yield from self._add(name, law, sentence, "none", "stiffness", "limit")

    def _curves(self, rest: float) -> Iterator[Family]:
        if cap := self.contact.sphere_limit:
            def equation_7(t: Any) -> Any:  # beyond its largest t the limit
                root = np.maximum(0.0, 2.0 - np.sqrt(1.0 + 8.0 * np.abs(t)))  # sqrt(1 - 3 M/2)
                return np.copysign(np.minimum(1.0, 2.0 / 3.0 * (1.0 - root**2) / cap), t)
            words = "too stiff near the limit, which it reaches at a finite rotation: the paper's Eq. (7), " \
                    "an approximation for small moments"
            yield from self._add("equation_7", Law(equation_7), words, "none")
        for name, loading in self.contact.other_profiles.items():
            yield from self._add("other_profile", Law(loading), "the law of another profile: " + name, "none", "limit")
        sets = ("none", "limit", "stiffness", "both")
        yield from self._add("exponential", Law(lambda t: np.copysign(np.expm1(-rest * np.abs(t)), t)),
                             "an exponential approach to the limit instead of partial slip", *sets)
        yield from self._add("hyperbola", Law(lambda t: rest * t / (1.0 + rest * np.abs(t))),
                             "a hyperbola towards the limit instead of partial slip", *sets)

    def _forgetful(self, rest: float) -> Iterator[Family]:
        """Laws of control and of structures: the stiffness follows from the moment in the direction of motion, and reversals
        leave no memory."""
        for name, words, curve, inverse in (
                ("dahl", "Dahl's law", lambda u: -np.expm1(-u), lambda m: -np.log1p(-m)),
                ("dahl", "Dahl's law with the exponent 2", lambda u: u / (1.0 + u), lambda m: m / (1.0 - m)),
                ("dahl", "Dahl's law with the exponent 1/2", lambda u: np.where(u < 2.0, u - 0.25 * u * u, 1.0),
                 lambda m: 2.0 - 2.0 * np.sqrt(1.0 - m)),
                ("bouc_wen", "Bouc's and Wen's law with the exponent 2", lambda u: np.where(u < 0.0, u, np.tanh(u)),
                 lambda m: np.where(m < 0.0, m, np.arctanh(np.maximum(m, 0.0))))):
            law = Law(lambda t, curve=curve: curve(rest * t), "by_moment", rest,
                      lambda m, inverse=inverse: inverse(np.minimum(m, 1.0 - 1e-12)) / rest)
            yield from self._add(name, law, words + ", without memory of reversals", "none", "both")

    def _rate_laws(self, rest: float) -> Iterator[Family]:
        contact, fastest, load = self.contact, self.fastest, self.contact.load_name
        viscous = self.rate * 0.5 * np.ptp(self.path.moment) / fastest  # of half the range of moments at the fastest
        exact, line = Law(contact.loading), Law(lambda t: rest * t, "elastic")

        def part(p: Sequence[float]) -> str:
            return f"a part of the {load} is viscous, {100.0 * p[0]:.2g} % of the largest at the fastest"

        yield Family("viscous", [], lambda path, trials: _follow(path, trials, exact), part, viscous)
        yield Family("viscous", [1.0], lambda path, trials: _follow(path, trials, line, 1.0, trials.parameters),
                     lambda p: part(p) + "; nothing slips", viscous)
        per_second = contact.motion_unit / self.path.duration if self.path.duration > 0.0 else math.nan
        for shape, half in ((np.tanh, math.atanh(0.5)), (lambda r: np.clip(r, -1.0, 1.0), 0.5)):
            def moment(_: Path, trials: Trials, shape: Any = shape) -> Array:
                limit, slow = trials.parameters[:, :1], trials.parameters[:, 1:]
                return np.where(slow < _SLOWEST, np.nan, limit * shape(self.rate / (slow * fastest)))

            def sentence(p: Sequence[float], half: float = half) -> str:
                creep = 1e3 * half * p[1] * fastest * per_second
                at = "" if math.isnan(creep) else f", at {creep:.2g} {contact.rate_unit} under half of it"
                return (f"creeps below the limit{at}: regularised friction, the {load} follows from the rate; "
                        + _slips_at(p[0], contact))

            yield Family("regularised", [1.0, 0.15], moment, sentence, has_branches=False)

        def stribeck(_: Path, trials: Trials) -> Array:
            limit, falls, slow = (trials.parameters[:, k:k + 1] for k in range(3))
            x = self.rate / (slow * fastest)
            return limit * np.tanh(x / _BEGINS) * (1.0 + falls * np.exp(-x * x))

        falls = "friction falls with the rate, Stribeck's law: from {:.2f} of the limit to {:.2f}"
        yield Family("stribeck", [1.0, 0.5, 0.2], stribeck, lambda p: falls.format(p[0] * (1.0 + p[1]), p[0]),
                     has_branches=False)

    def _changing(self) -> Iterator[Family]:
        """A delay, and a normal load that drifts."""
        contact, exact = self.contact, Law(self.contact.loading)
        branch = 1.0 / (len(self.path.turns) - 1)

        def drifting(path: Path, trials: Trials) -> Array:
            def one(trial: Trials) -> Array:  # which reversals are closed depends on the drift
                load = np.maximum(0.05, 1.0 + (trial.parameters - 1.0) * path.time)
                return _follow(path, trial, exact, load**contact.limit_exponent, load**contact.stiffness_exponent)
            return np.concatenate([one(trials.row(k)) for k in range(len(trials.shift))])

        def late(path: Path, trials: Trials) -> Array:
            each = zip(trials.parameters[:, 0] * branch, _follow(path, trials, exact))
            return np.array([np.interp(path.time - delay, path.time, moment) for delay, moment in each])

        yield Family("delayed", [0.04], late,
                     lambda p: f"the {contact.load_name} comes {p[0] * branch * (len(self.path.time) - 1):.2g} rows late")
        yield Family("normal_load_drifts", [1.0], drifting,
                     lambda p: f"the normal load drifts: by {100.0 * (p[0] - 1.0):+.0f} % over the record")
