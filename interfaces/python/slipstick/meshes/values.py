"""Pressure, shear, slip and gap from a file's arrays, in the contact's frame and in SI units."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy as np
import numpy.typing as npt

from ..errors import InputError
from .field import KINDS, Array
from .names import SCALARS, VECTORS, Arrays
from .plane import Frame
from .units import Units

HOW_TO_NAME = "its names given, as --read-as pressure=NAME (" + ", ".join((*SCALARS, *VECTORS)) + ")"


@dataclass(frozen=True)
class Options:
    """The options of read()."""

    kind: Optional[str]
    names: dict[str, str]
    body: Optional[str]
    normal: Optional[Array]
    basis: Optional[str]

    def __post_init__(self) -> None:
        for key, value, allowed in (("kind", self.kind, tuple(KINDS)), ("body", self.body, ("lower", "upper")),
                                    ("basis", self.basis, ("axes", "lower", "upper"))):
            if value is not None and value not in allowed:
                raise InputError(f'{key} = "{value}"; allowed: {", ".join(allowed)}')


@dataclass
class Values:
    """pressure (n) Pa, traction (n, 2) Pa on the lower body; N instead of Pa if they are forces. slip (n, 2) m, gap (n) m."""

    pressure: Array
    traction: Array
    are_forces: bool
    slip: Optional[Array]
    gap: Optional[Array]
    said: list[str] = field(default_factory=list)


def loaded(arrays: Arrays) -> npt.NDArray[np.bool_]:
    """(n): rows with a pressure, a normal force or, if the source has vectors only, a vector that is more than rounding."""
    role = next(role for role in ("pressure", "fn", "traction", "force") if arrays.arrays_of(role))
    load = np.asarray(arrays.values(role))
    load = load if load.ndim == 1 else np.linalg.norm(load, axis=1)
    size = np.nan_to_num(abs(load))
    return np.asarray(size > 1e-6 * size.max(initial=0))


@dataclass
class _Extraction:
    """Arrays of a file put into the frame and into SI units, with the choices made on the way."""

    arrays: Arrays
    frame: Frame
    units: Units
    tangents: Array  # (2, 2): components along x1 and x2 of the directions of q1 and q2
    said: list[str] = field(default_factory=list)

    def in_plane(self, roles: tuple[str, str], vector_roles: tuple[str, ...]) -> Optional[Array]:
        """(n, 2) along x1 and x2: two arrays, or the first vector that the file has; a vector that the user named comes first."""
        parts = [self.units.scaled(self.arrays, role) for role in roles]
        if parts[0] is not None and parts[1] is not None and not any(map(self.arrays.is_given, vector_roles)):
            return np.stack([parts[0], parts[1]], axis=1) @ self.tangents
        order = sorted(vector_roles, key=lambda role: not self.arrays.is_given(role))
        vectors = [self.units.scaled(self.arrays, role) for role in order]
        return next((self.frame.in_plane(found) for found in vectors if found is not None), None)

    def pressure(self, are_forces: bool, given: Optional[str], usual: str) -> tuple[Array, str]:
        """Pressure or normal force (n), positive in compression, and the body on which the shear acts: the given one, the one
        that vectors with a normal component press on, or the usual one."""
        pressure = self.units.scaled(self.arrays, "fn" if are_forces else "pressure")
        vectors = self.units.scaled(self.arrays, "force" if are_forces else "traction")
        upwards = np.zeros(0) if vectors is None else vectors @ self.frame.x3  # a traction on the upper body
        if pressure is None:
            pressure = upwards if np.nansum(upwards) > 0 else -upwards
        known = pressure[~np.isnan(pressure)]
        if known.size and known.min() < 0 and known.max() <= -1e-9 * known.min():
            self.said.append("Sign: the pressures are negative; they are turned, so that compression is positive.")
            pressure = -pressure
        shown = abs(np.nansum(upwards)) > 0.5 * np.nansum(abs(pressure))
        body = given or (("upper" if np.nansum(upwards) > 0 else "lower") if shown else usual)
        reason = ", as the vectors press on it" if shown and not given else ""
        self.said.append(f"Body: the shear acts on the {body} body{reason}{', and is turned.' if body == 'upper' else '.'}")
        return pressure, body


def values_of(arrays: Arrays, frame: Frame, options: Options, units: Units, source: str, owner: Optional[str] = None) -> Values:
    """The values of all rows. owner: the body whose faces have the values, if that is known. In CalculiX it is the slave, and
    CSHEAR1 and CSHEAR2 act on the master, along tangents made with the master's normal."""
    of_program = arrays.on_surface_tangents("q1")
    master = "upper" if owner == "lower" and of_program else "lower"
    basis = options.basis or ((options.body or master) if of_program else "axes")
    found = _Extraction(arrays, frame, units, np.eye(2) if basis == "axes" else frame.tangents(of_upper=basis == "upper"))
    if of_program and options.basis is None:
        found.said.append("Basis: the shear's components lie along t1, the x axis projected on the surface, and t2 = n x t1, n "
                          f"the {basis} body's outward normal (CalculiX: the master's, Abaqus: the slave's).")
    has_forces, has_stresses = (any(map(arrays.arrays_of, roles)) for roles in (("fn", "force"), ("pressure", "traction")))
    are_forces = has_forces and (options.kind == "forces" or not has_stresses)
    pressure, body = found.pressure(are_forces, options.body, master)
    traction = found.in_plane(("f1", "f2"), ("force",)) if are_forces else found.in_plane(("q1", "q2"), ("shear", "traction"))
    if traction is None:
        raise InputError(f"{source}: it has no shear; it has {arrays.listed()}; allowed: q1 and q2, CSHEAR1 and CSHEAR2, a "
                         f"vector like tangent_traction, or {HOW_TO_NAME}")
    slip = found.in_plane(("slip1", "slip2"), ("slip",))
    if body == "upper":
        traction = -traction
        slip = -slip if slip is not None and arrays.on_surface_tangents("slip1") else slip
    values = Values(pressure, traction, are_forces, slip, units.scaled(arrays, "gap"), found.said)
    _clean(values, source)
    return values


def _clean(values: Values, source: str) -> None:
    """Sets rows without contact to zero, and refuses numbers that are none."""
    absent = np.isnan(values.pressure)
    if absent.any():
        values.said.append(f"Contact: {absent.sum()} rows have no pressure (NaN) and are taken as out of contact.")
        values.pressure[absent] = 0
    values.traction[(values.pressure == 0) & np.isnan(values.traction).any(axis=1)] = 0
    for quantity, array in (("pressure", values.pressure), ("shear", values.traction)):
        bad = np.flatnonzero(~np.isfinite(array.reshape(len(array), -1)).all(axis=1))
        if len(bad):
            raise InputError(f"{source}: row {bad[0] + 1}: the {quantity} is {array[bad[0]]}; allowed: finite numbers, and NaN "
                             "where the pressure is NaN or zero")
    if not values.pressure.max(initial=0) > 0:
        raise InputError(f"{source}: the pressure is zero everywhere; allowed: a contact, or {HOW_TO_NAME}")
    tension = values.pressure < -1e-9 * values.pressure.max()
    if tension.any():
        values.said.append(f"Pressure: {tension.sum()} rows have a negative pressure, down to "
                           f"{-values.pressure.min() / values.pressure.max():.1e} of the largest one.")
