"""The verdict on a field on a mesh: each number against the one that right answers on the same mesh have."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field as with_default
from typing import Any, Optional

import numpy as np
from scipy.spatial import KDTree

from ..errors import InputError
from .field import Array, ContactField
from .measures import Bodies, Judge, Kernels, Law, Motion
from .patches import Patches, patches_of, put_on, shortest_around
from .right import Right

#: Errors of right answers on the mesh, times this, are allowed: they know the mesh's own error to about a half.
_WHOLE_MESH = 2.0
#: Allowed whatever the mesh is: digits of moduli, loads and friction coefficients, tolerances of iterations.
_FLOORS = {"coverage": 1e-2, "normal_load": 2e-3, "contact_radius": 2e-3, "pressure": 5e-3, "moment": 2e-3, "force": 2e-3, "friction": 3e-3,
           "friction_bound": 1e-3, "stick_radius": 5e-3, "tractions": 5e-3, "radial_shear": 5e-3, "twist": 2e-3,
           "twist_of_tractions": 2e-3, "displacement_of_tractions": 2e-3, "stick_motion": 5e-3, "slip_direction": 0.5}
#: A mesh that explains more than this part of the tractions cannot show whether they are right.
_SHOWS = 0.2
#: Tractions within which a mesh shows them well; the advice to a user is the mesh for that.
_WELL = 0.05

_WRONG = {
    "coverage": "{part} of the contact has no rows",
    "normal_load": "the normal load is {off}", "contact_radius": "the contact radius is {off}",
    "pressure": "the pressure is {part} off in the mean", "moment": "the moment is {off}",
    "force": "the tangential force is off by {part} of the limit", "friction": "|q| is {off} for its friction bound where it slips",
    "friction_bound": "|q| exceeds the friction bound, by {part} of it in the mean",
    "stick_radius": "the stick radius is {part} of the contact radius too {low}",
    "tractions": "the tractions are {part} off in the mean", "radial_shear": "the shear along the radius is {part} of the tractions",
    "twist": "the twist is {off}", "twist_of_tractions": "the twist that the tractions cause is {off}",
    "displacement_of_tractions": "the displacement that the tractions cause is {part} off",
    "stick_motion": "the stick area does not move rigidly: it is {part} off",
    "slip_direction": "slip is not opposed to traction: {degrees} off in the mean",
}
#: The order in which the first wrong quantity heads the verdict: causes before effects.
_ORDER = ("coverage", "normal_load", "contact_radius", "pressure", "moment", "force", "radial_shear", "friction",
          "friction_bound", "tractions", "stick_radius", "twist", "twist_of_tractions", "displacement_of_tractions", "stick_motion",
          "slip_direction")


@dataclass(frozen=True)
class Judged:
    """A number and the largest size that is allowed, which NaN exceeds. `right`: the largest one of right answers on the mesh.
    without: words on a part that is taken off."""

    quantity: str
    value: float
    allowed: float
    right: float
    without: str = ""

    @property
    def holds(self) -> bool:
        return abs(self.value) <= self.allowed

    @property
    def words(self) -> str:
        low = "low" if self.value < 0 else "high"
        text = _WRONG[self.quantity].format(off=f"{percent(self.value)} too {low}", part=percent(self.value),
                                            low="small" if self.value < 0 else "large", degrees=f"{self.value:.2g} degrees")
        allowed = f"{self.allowed:.2g} degrees" if self.quantity == "slip_direction" else percent(self.allowed)
        return f"{text}{self.without} (allowed on this mesh: {allowed})"


@dataclass
class Examined:
    """A field, the right answer on its mesh, and the numbers of both. values (n, 3): pressure, q1, q2 of the field."""

    field: ContactField
    right: Right
    values: Array
    patches: Patches
    judge: Judge
    kernels: Optional[Kernels]
    motion: Optional[Motion]
    allowances: dict[str, float]
    judged: list[Judged]
    reported: Optional[float]
    right_twist: float
    explained: float
    gap: Optional[float]
    right_gap: float
    across: float
    notes: list[str] = with_default(default_factory=list)

    def number(self, quantity: str) -> Optional[Judged]:
        return next((item for item in self.judged if item.quantity == quantity), None)

    @property
    def reported_of_half_spaces(self) -> Optional[float]:
        """The reported twist as half-spaces would have it: without what curvature and ends of the bodies explain, rad."""
        if self.reported is None:
            return None
        return self.reported - self.explained * self.right_twist + self.right.twist - self.right_twist

    @property
    def wrong(self) -> list[Judged]:
        return sorted((item for item in self.judged if not item.holds), key=lambda item: _ORDER.index(item.quantity))

    @property
    def shows(self) -> bool:
        """Whether the mesh distinguishes right tractions from wrong ones."""
        return self.allowances["tractions"] <= _SHOWS

    @property
    def advice(self) -> str:
        """The mesh that would show it. Errors fall with the power 3/2 of the size of faces, like a field's that ends in a square
        root."""
        wanted = self.across * (self.allowances["tractions"] / _WELL)**(2 / 3)
        return (f"the mesh has {self.across:.0f} faces across the contact radius, and right answers on it are "
                f"{percent(self.allowances['tractions'] / _WHOLE_MESH)} apart; about {wanted:.0f} faces show errors of "
                f"{percent(_WELL)}")


def percent(part: float) -> str:
    size = 100 * abs(part)
    return "not a number" if np.isnan(size) else f"{size:.2g} %" if size < 10 else f"{size:.0f} %"


def examine(field: ContactField, right: Right, others: Mapping[str, Right], law: Law, bodies: Optional[Bodies],
            reported: Optional[float], held: float, curved: float, tolerance: Optional[float]) -> Examined:
    """Measures a field and the errors that its mesh explains:

    1. The right answer is put on the mesh in each way that programs do it, and so are `others`, right answers of other methods.
    2. All of them and the field are measured in the same way.
    3. Twice the worst of the right ones is allowed, or `tolerance` for errors of loads, fields and twist.

    reported: the twist that the program reported, rad; held: the part of the right one that is missing because bodies end, rad;
    curved: how much further a sphere turns than the half-space in its place, over the right twist. Any part of it is allowed.
    """
    values = np.column_stack([field.pressure, field.traction])
    patches = patches_of(field, right.fields)
    answers = put_on(patches, right.fields)
    ways = list(answers.values())
    reference = ways[0]
    if not reference[:, 1:].any():
        raise InputError(f"{field.name}: the scene has no shear at its points; allowed: a scene with torsion or a tangential force, and "
                         "points in its contact")
    judge = Judge(patches, right, reference, law, bodies)
    answers.update((name, _carrying(judge, next(iter(put_on(patches, other.fields).values())))) for name, other in others.items())
    fields = [values, *answers.values()]
    kernels: list[Any] = [None] * len(fields) if bodies is None else judge.kernels(fields)
    found, *measured = [judge.measure(*each) for each in zip(fields, kernels)]
    gap, right_gap = found.pop("gap", None), max(each.get("gap", 0.0) for each in measured)
    worst = {name: max(abs(each.get(name, 0.0)) for each in measured) for name in _FLOORS}
    loaded = reference[:, 0] > 0
    across = right.contact_radius / np.sqrt(patches.weights @ loaded / max(1, np.count_nonzero(loaded)))
    worst["stick_radius"] = max(worst["stick_radius"], *map(judge.stick_radius_steps, answers.values()))
    found["coverage"], worst["coverage"] = _coverage(field, judge, ways, across)
    right_twist, explained = right.twist - held, 0.0
    if reported is not None:
        off = reported / right_twist - 1
        explained = float(np.clip(off, 0, curved))
        found["twist"] = off - explained
        worst["twist"] = worst["twist_of_tractions"]
    allowances = {name: _FLOORS[name] + _WHOLE_MESH * worst[name] for name in _FLOORS}
    unsure = found.pop("unsure_direction", 0.0) * min(1.0, allowances["stick_motion"] / max(found.get("stick_motion", 0.0), 1e-300))
    allowances["slip_direction"] += unsure
    if tolerance is not None:
        allowances = {name: np.degrees(tolerance) if name == "slip_direction" else tolerance for name in _FLOORS}
    without = {"twist": f" after the {percent(explained)} that a sphere turns further"} if explained else {}
    judged = [Judged(name, value, allowances[name], worst[name], without.get(name, "")) for name, value in found.items()]
    motion = None if kernels[0] is None else judge.motion(kernels[0])
    return Examined(field, right, values, patches, judge, kernels[0], motion, allowances, judged, reported, right_twist, explained,
                    gap, right_gap, across)


def _carrying(judge: Judge, values: Array) -> Array:
    """The right answer of another method on the mesh, scaled to the loads of the reference: a program controls its loads."""
    (load, moment, force), (right_load, right_moment, right_force) = judge.loads(values), judge.loads(judge.reference)
    size = np.hypot(*right_force) * judge.right.contact_radius
    if max(size, abs(right_moment)) < 1e-6 * judge.right.contact_radius * (judge.weights @ judge.size):
        shear = 1.0  # pressed only
    elif size > abs(right_moment):
        shear = (right_force @ right_force) / (right_force @ force)
    else:
        shear = right_moment / moment
    return values * np.array([right_load / load, shear, shear])


def _coverage(field: ContactField, judge: Judge, ways: list[Array], across: float) -> tuple[float, float]:
    """The part of the right normal load that the rows of the field leave out: at places further from the nearest row than its triangles
    reach, between given areas, or because no way to put the right answer on the mesh carries it. And the part that half a rim of one
    face has: rows may lack it."""
    patches, right = judge.patches, judge.right
    places = right.centre + 1.5 * right.contact_radius * _disc()
    pressure = right.fields(places)[:, 0]
    edges = np.linalg.norm(patches.corners - np.roll(patches.corners, 1, axis=1), axis=2).max(axis=1)
    if field.faces or field.kind == "points":
        reach = np.zeros(len(patches.points))
        np.maximum.at(reach, patches.rows, edges[:, None])
    else:  # a triangulation of nodes may bridge holes
        reach = shortest_around(patches.rows, edges, len(patches.points))
    away, nearest = KDTree(patches.points).query(places)
    rim = right.fields(right.centre + (places - right.centre) / (1 - min(0.5, 1 / across)))[:, 0] == 0
    loaded = ways[0][:, 0] > 0
    inside = patches.areas[loaded[patches.rows].all(axis=1)].sum()
    left_out = [pressure @ (away > reach[nearest]) / pressure.sum(),
                min(1 - judge.loads(way)[0] / right.normal_load for way in ways),
                1 - patches.weights @ loaded / inside if field.area is not None and inside > 0 else 0.0]
    return float(max(left_out)), float(pressure @ rim / pressure.sum() / 2)


def _disc() -> Array:
    """Places with equal parts of the unit disc, along a spiral (Vogel 1979)."""
    k = np.arange(4000) + 0.5
    angle = np.pi * (1 + np.sqrt(5)) * k
    return np.sqrt(k / len(k))[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
