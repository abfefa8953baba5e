"""Pressure, shear, slip and gap from a file's arrays, in the contact's frame and in SI units."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from ..errors import InputError
from .field import KINDS, Array
from .names import SCALARS, VECTORS, Arrays
from .surface import Axis, Frame
from .units import Units

HOW_TO_NAME = 'names, as "pressure=NAME,q1=NAME,q2=NAME" (' + ", ".join((*SCALARS, *VECTORS)) + ")"


@dataclass(frozen=True)
class Options:
    """The options of read()."""

    kind: Optional[str]
    names: dict[str, str]
    body: Optional[str]
    axis: Axis
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


def loads(arrays: Arrays) -> Array:
    """(n): pressure or normal force of each row; the length of its vector if the file has vectors only; zero for NaN."""
    load = next((arrays.scalar(role) for role in ("pressure", "fn") if arrays.name_of(role)), None)
    if load is None:
        vectors = arrays.vector("traction")
        load = np.linalg.norm(arrays.vector("force") if vectors is None else vectors, axis=1)
    return np.nan_to_num(load)


def values_of(arrays: Arrays, frame: Frame, options: Options, units: Units, source: str) -> Values:
    """The values of all rows."""
    said: list[str] = []
    basis = options.basis or ("lower" if arrays.on_surface_tangents("q1") else "axes")
    if arrays.on_surface_tangents("q1") and options.basis is None:
        said.append("Basis: the shear's components lie along t1, the x axis projected on the surface, and t2 = n x t1, n the "
                    "lower body's outward normal (CalculiX: the master's, Abaqus: the slave's).")
    tangents = np.eye(2) if basis == "axes" else frame.tangents(of_upper=basis == "upper")

    def in_frame(roles: tuple[str, str], vector_roles: tuple[str, ...], quantity: str) -> Optional[Array]:
        """(n, 2): components along x1 and x2 of two arrays, or of the first vector that the file has."""
        parts, columns = [arrays.scalar(role) for role in roles], [arrays.name_of(role) or "" for role in roles]
        if parts[0] is not None and parts[1] is not None:
            units.note(quantity, columns)
            return np.stack([part * units.size(quantity, column) for part, column in zip(parts, columns)], axis=1) @ tangents
        for role in vector_roles:
            vectors = arrays.vector(role)
            if vectors is not None:
                units.note(quantity, arrays.components_of(role))
                return frame.in_plane(vectors) * units.size(quantity, arrays.components_of(role)[0])
        return None

    are_forces = arrays.name_of("pressure") is None and not arrays.components_of("traction")
    quantity = "force" if are_forces else "stress"
    normal = arrays.name_of("fn" if are_forces else "pressure")
    vector = "force" if are_forces else "traction"
    if normal is not None:
        units.note(quantity, [normal])
        pressure = _of(arrays.scalar("fn" if are_forces else "pressure")) * units.size(quantity, normal)
        turned = pressure[~np.isnan(pressure)].max(initial=0) <= 0
        if turned:
            pressure = -pressure
            said.append("Sign: all pressures are negative; compression is taken as positive and they are turned.")
        on_upper = options.body == "upper"
    else:
        units.note(quantity, arrays.components_of(vector))
        along = _of(arrays.vector(vector)) @ frame.x3 * units.size(quantity, arrays.components_of(vector)[0])
        on_upper = bool(np.nansum(along) > 0)
        pressure = along if on_upper else -along
        said.append(f"Body: '{arrays.components_of(vector)[0]}' acts on the {'upper' if on_upper else 'lower'} body.")
    if are_forces:
        traction = in_frame(("f1", "f2"), ("force",), quantity)
    else:
        traction = in_frame(("q1", "q2"), ("shear", "traction"), quantity)
    if traction is None:
        raise InputError(f"{source}: it has no shear; it has {arrays.listed()}; allowed: q1 and q2, CSHEAR1 and CSHEAR2, a "
                         f"vector like tangent_traction, or {HOW_TO_NAME}")
    if on_upper:
        traction = -traction
    if normal is not None:
        said.append(f"Body: the shear acts on the {options.body or 'lower'} body" + (", and is turned." if on_upper else "."))
    slip = in_frame(("slip1", "slip2"), ("slip",), "length")
    if slip is not None and on_upper and arrays.on_surface_tangents("slip1"):
        slip = -slip
    gap = arrays.scalar("gap")
    if gap is not None:
        gap = gap * units.size("length", arrays.name_of("gap") or "")
    values = Values(pressure, traction, are_forces, slip, gap, said)
    _clean(values, source)
    return values


def _of(array: Optional[Array]) -> Array:
    assert array is not None
    return array


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
