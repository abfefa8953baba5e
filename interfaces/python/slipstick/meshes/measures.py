"""The numbers by which a field on a mesh is judged: each is zero for the right answer on an infinitely fine mesh."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from .displacement import KERNELS, integrals
from .field import Array
from .patches import Patches
from .right import Right

#: A row sticks if |q| is below this part of its friction bound; on coarse meshes means of turned vectors lose a hundredth.
_STICKS, _ABOUT_STICKS = 0.98, (0.97, 0.99)
#: A row surely sticks in the right answer below this part of the bound, and slips above the other one.
_SURELY_STICKS, _SURELY_SLIPS = 0.95, 0.999
#: Rows with less than this part of the largest pressure say nothing about friction.
_CARRIES = 0.05
#: Places of each of the stick and slip area at which displacements are summed.
_PLACES = 150
#: A median over fewer rows would show the edges of the slip area.
_FEWEST = 8


class Law:
    """The friction law of a scene: bound(pressure), Pa."""

    def __init__(self, numbers: Mapping[str, Any]) -> None:
        self.coefficient, self._strength = numbers["coefficient"], numbers["shear_strength"]
        self._kind, self._exponent = numbers["kind"], numbers["exponent"]

    def bound(self, pressure: Array) -> Array:
        positive = np.maximum(pressure, 0)
        if self._kind == "tresca":
            return np.where(positive > 0, self._strength, 0.0)
        if self._kind == "capped":
            return np.minimum(self.coefficient * positive, self._strength)
        return np.asarray(self.coefficient * (positive if self._kind == "coulomb" else positive**self._exponent))


@dataclass(frozen=True)
class Bodies:
    """Two half-spaces: u1 = normal [q1]/r + shear ([q1] x1^2 + [q2] x1 x2)/r^3 - coupled [p] x1/r^2, summed over both bodies; and
    the penalty springs between them, m/Pa."""

    normal: float
    shear: float
    coupled: float
    spring: float = 0.0

    @classmethod
    def of(cls, upper: Mapping[str, float], lower: Mapping[str, float], spring: float) -> Bodies:
        def part(body: Mapping[str, float], factor: float) -> float:
            return float(body["shear_compliance"] * factor / (2 * np.pi))

        nu, nl = upper["poisson_ratio"], lower["poisson_ratio"]
        return cls(part(upper, 1 - nu) + part(lower, 1 - nl), part(upper, nu) + part(lower, nl),
                   (part(lower, 1 - 2 * nl) - part(upper, 1 - 2 * nu)) / 2, spring)


@dataclass(frozen=True)
class Kernels:
    """The integrals of pressure and tractions at chosen rows of a field. values (kernels, n, 3): the integrals of pressure, q1
    and q2; own (n, 2): the tractions there."""

    places: Array
    weights: Array
    sticks: Array
    values: Array
    own: Array

    def displacement(self, bodies: Bodies, cross: float = 1.0, even: bool = False, swapped: bool = False) -> Array:
        """The tangential displacement (n, 2), m. cross, even, swapped: the mistakes of kernels that causes.py tries."""
        (r1, a1, c1), (r2, a2, c2) = self.values[:3, :, 1], self.values[:3, :, 2]
        v1, v2 = self.values[3, :, 0], self.values[4, :, 0]
        d1, d2 = r1 - a1, r2 - a2  # kernel x2^2/r^3
        k11, k22 = (d1, a2) if swapped else (a1, d2)
        k12 = (self.values[5, :, 1], self.values[5, :, 2]) if even else (c1, c2)
        u1 = bodies.normal * r1 + bodies.shear * (k11 + cross * k12[1]) - bodies.coupled * v1
        u2 = bodies.normal * r2 + bodies.shear * (k22 + cross * k12[0]) - bodies.coupled * v2
        return np.column_stack([u1, u2]) + bodies.spring * self.own


@dataclass(frozen=True)
class Motion:
    """The rigid motion that the stick area shows: twist rad, displacement m; scatter: mean distance of the displacements from it,
    relative to it."""

    twist: float
    displacement: Array
    scatter: float

    def at(self, places: Array) -> Array:
        return self.displacement + self.twist * np.column_stack([-places[:, 1], places[:, 0]])


class Judge:
    """Measures fields on one mesh. right: fields on it are compared with `reference` (n, 3), its values there."""

    def __init__(self, patches: Patches, right: Right, reference: Array, law: Law, bodies: Optional[Bodies]) -> None:
        self.patches, self.right, self.reference, self.law, self.bodies = patches, right, reference, law, bodies
        self.x = patches.points - right.centre
        self.weights = patches.weights
        self.size = np.hypot(reference[:, 1], reference[:, 2])
        pressure, q1, q2 = right.fields(patches.points).T  # means over faces are lower where directions turn
        bound, size = law.bound(pressure), np.hypot(q1, q2)
        carries = pressure > _CARRIES * pressure.max()
        self.slips = carries & (size >= _SURELY_SLIPS * bound)
        self.sticks = carries & (size < _SURELY_STICKS * bound)
        self.chosen = np.concatenate([self._sample(self.sticks), self._sample(self.slips)])

    def _sample(self, mask: Array) -> Array:
        """Rows of a mask, drawn with equal chances for equal areas."""
        rows = np.flatnonzero(mask & (self.weights > 0))
        if len(rows) <= _PLACES:
            return rows
        chances = self.weights[rows] / self.weights[rows].sum()
        return np.sort(np.random.default_rng(1).choice(rows, _PLACES, replace=False, p=chances))

    def kernels(self, fields: list[Array], kernels: Sequence[str] = KERNELS[:5]) -> list[Kernels]:
        """Sums the displacements under several fields (n, 3) at once."""
        once = self.patches.once
        densities = np.concatenate(fields, axis=1)[self.patches.rows[once]]
        sums = integrals(self.patches.points[self.chosen], self.patches.corners[once], densities, kernels)
        return [Kernels(self.x[self.chosen], self.weights[self.chosen], self.sticks[self.chosen], sums[:, :, 3 * k:3 * k + 3],
                        values[self.chosen, 1:]) for k, values in enumerate(fields)]

    def loads(self, field: Array) -> tuple[float, float, Array]:
        """Normal load N, moment N m, force N."""
        p, q = field[:, 0], field[:, 1:]
        moment = self.weights @ (self.x[:, 0] * q[:, 1] - self.x[:, 1] * q[:, 0])
        return float(self.weights @ p), float(moment), self.weights @ q

    def radius(self, field: Array) -> float:
        """The contact's radius by the pressure's radius of gyration, m."""
        def gyration(p: Array) -> float:
            middle = self.weights * p @ self.x / (self.weights @ p)
            return float(np.sqrt(self.weights * p @ np.sum((self.x - middle)**2, axis=1) / (self.weights @ p)))

        return self.right.contact_radius * gyration(field[:, 0]) / gyration(self.reference[:, 0])

    def stick_radius(self, field: Array, sticks_below: float = _STICKS) -> float:
        """The radius of the circle with the area of the rows that stick, below this part of their friction bound, m."""
        bound = self.law.bound(field[:, 0])
        sticks = (field[:, 0] > 0) & (np.hypot(field[:, 1], field[:, 2]) < sticks_below * bound)
        return float(np.sqrt(self.weights @ sticks / np.pi))

    def stick_radius_steps(self, field: Array) -> float:
        """How far the stick radius of a field is off where slightly other rows stick, over the contact radius: a ring of rows sticks or
        slips as a whole."""
        own = self.stick_radius(self.reference)
        return max(abs(self.stick_radius(field, part) - own) for part in _ABOUT_STICKS) / self.right.contact_radius

    def friction_ratio(self, field: Array) -> Array:
        """|q| over its bound in the rows that slip in the right answer and carry in both."""
        rows = self.slips & (field[:, 0] > _CARRIES * field[:, 0].max())
        return np.asarray(np.hypot(field[rows, 1], field[rows, 2]) / self.law.bound(field[rows, 0]))

    def motion(self, kernels: Kernels) -> Optional[Motion]:
        """The motion of the stick area. None: too few rows stick."""
        if self.bodies is None or kernels.sticks.sum() < _FEWEST:
            return None
        return self.rigid(kernels, kernels.displacement(self.bodies))

    @staticmethod
    def rigid(kernels: Kernels, displacement: Array) -> Motion:
        """The rigid motion that is closest to displacements (n, 2) of the rows that stick."""
        places, weights = kernels.places[kernels.sticks], np.sqrt(kernels.weights[kernels.sticks])
        u = displacement[kernels.sticks]
        zero, one = np.zeros(len(places)), np.ones(len(places))
        matrix = np.concatenate([np.column_stack([one, zero, -places[:, 1]]), np.column_stack([zero, one, places[:, 0]])])
        both = np.concatenate([weights, weights])
        d1, d2, twist = np.linalg.lstsq(matrix * both[:, None], u.T.ravel() * both, rcond=None)[0]
        motion = Motion(float(twist), np.array([d1, d2]), 0.0)
        rigid = motion.at(places)
        off, size = (np.sum(weights[:, None]**2 * part**2) for part in (u - rigid, rigid))
        return Motion(motion.twist, motion.displacement, float(np.sqrt(off / size)) if size > 0 else np.inf)

    def slip_angle(self, kernels: Kernels, motion: Motion, displacement: Array) -> Optional[tuple[float, float]]:
        """The mean angle between slip and traction, weighted with the slip, degrees; and the angle, degrees, by which slip may be off
        where displacements are as uncertain as the stick area's. None: hardly any row slips."""
        rows = ~kernels.sticks
        slip = motion.at(kernels.places[rows]) - displacement[rows]
        weights = kernels.weights[rows] * np.hypot(slip[:, 0], slip[:, 1])
        if rows.sum() < _FEWEST or not weights.sum() > 0:
            return None
        own = kernels.own[rows]
        angle = np.arctan2(np.abs(slip[:, 0] * own[:, 1] - slip[:, 1] * own[:, 0]), np.sum(slip * own, axis=1))
        unsure = motion.scatter * np.hypot(*motion.at(kernels.places[rows]).T) * kernels.weights[rows]
        return float(np.degrees(weights @ angle / weights.sum())), float(np.degrees(unsure.sum() / weights.sum()))

    def gap(self, field: Array, kernels: Kernels, motion: Motion, displacement: Array) -> float:
        """Coulomb's gap at the chosen rows: the sum of bound |s| - q.s over the sum of |q| |motion|, where s is the slip. It is zero
        where tractions fulfil the law of friction and elasticity together."""
        rigid = motion.at(kernels.places)
        slip, own = rigid - displacement, kernels.own
        bound = self.law.bound(field[self.chosen, 0])
        lost = kernels.weights @ (bound * np.hypot(*slip.T) - np.sum(own * slip, axis=1))
        return float(lost / max(kernels.weights @ (np.hypot(*own.T) * np.hypot(*rigid.T)), 1e-300))

    def angle_of_given_slip(self, traction: Array, slip: Array) -> Optional[float]:
        """The mean angle between the slip (n, 2) that a file has and the traction (n, 2) where the right answer slips, weighted with the
        slip, degrees. None: hardly any row slips."""
        weights = self.weights[self.slips] * np.hypot(*slip[self.slips].T)
        if self.slips.sum() < _FEWEST or not weights.sum() > 0:
            return None
        (s1, s2), (q1, q2) = slip[self.slips].T, traction[self.slips].T
        angle = float(np.degrees(weights @ np.arctan2(np.abs(s1 * q2 - s2 * q1), s1 * q1 + s2 * q2) / weights.sum()))
        return min(angle, 180 - angle)  # programs differ in whose slip they write

    def measure(self, field: Array, kernels: Optional[Kernels]) -> dict[str, float]:
        """All numbers of a field (n, 3); a number that cannot be measured is missing."""
        right, w, p, q = self.right, self.weights, field[:, 0], field[:, 1:]
        load, moment, force = self.loads(field)
        bound, size = self.law.bound(p), np.hypot(q[:, 0], q[:, 1])
        scale = load / (w @ self.reference[:, 0])
        unit = w @ self.law.bound(self.reference[:, 0])
        carried = w @ self.size
        found = {"normal_load": load / right.normal_load - 1,
                 "contact_radius": self.radius(field) / right.contact_radius - 1,
                 "pressure": float(w @ np.abs(p / scale - self.reference[:, 0]) / (w @ self.reference[:, 0]))}
        if abs(right.moment) > 1e-6 * unit * right.contact_radius:
            found["moment"] = moment / right.moment - 1
        found["force"] = float(np.hypot(*(force - right.force)) / unit)
        ratio = self.friction_ratio(field)
        if len(ratio) >= _FEWEST:
            found["friction"] = float(np.median(ratio)) - 1
        found["friction_bound"] = float(w @ np.maximum(size - bound, 0) / (w @ bound))
        found["stick_radius"] = (self.stick_radius(field) - self.stick_radius(self.reference)) / right.contact_radius
        found["tractions"] = float(w @ np.hypot(*(q - self.reference[:, 1:]).T) / carried)
        if right.radial:
            r = np.maximum(np.hypot(*self.x.T), 1e-300)
            found["radial_shear"] = float(w @ np.abs(np.sum(q * self.x, axis=1) / r) / carried)
        motion = None if kernels is None else self.motion(kernels)
        if motion is not None and kernels is not None and self.bodies is not None:
            if right.twist:
                found["twist_of_tractions"] = motion.twist / right.twist - 1
            if right.displacement.any():
                found["displacement_of_tractions"] = float(
                    np.hypot(*(motion.displacement - right.displacement)) / np.hypot(*right.displacement))
            found["stick_motion"] = motion.scatter
            displacement = kernels.displacement(self.bodies)
            found["gap"] = self.gap(field, kernels, motion, displacement)
            angle = self.slip_angle(kernels, motion, displacement)
            if angle is not None:
                found["slip_direction"], found["unsure_direction"] = angle
        return found
