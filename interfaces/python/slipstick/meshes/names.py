"""Arrays of a file by their meaning: the pressure, the shear, their slip, whatever the program calls them."""
from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Optional

import numpy as np

from ..errors import InputError
from .field import Array, Indices

Names = Optional[Mapping[str, str]]

_SHEAR = ("q", "cshear", "shear", "t", "tau", "tangent traction", "tangential traction", "shear traction", "shear stress",
          "tangential stress", "tangent stress", "friction", "friction stress", "frictional stress", "contact shear")
_FULL = ("contact stress", "contact traction", "traction", "tractions", "stress vector")
_FORCE = ("contact force", "nodal force", "force", "f", "cforce")
_SLIP = ("slip", "cslip", "tangential slip", "relative slip", "contact slip")
# Names of each quantity in order of preference; case, blanks, dots and underscores do not count.
SCALARS: dict[str, tuple[str, ...]] = {
    "x1": ("x1", "x", "coord1", "coordx", "points:0"),
    "x2": ("x2", "y", "coord2", "coordy", "points:1"),
    "x3": ("x3", "z", "coord3", "coordz", "points:2"),
    "r": ("r", "radius"),
    "pressure": ("pressure", "p", "cpress", "contact pressure", "normal pressure", "cont pres", "pn", "normal traction", "lambda",
                 "lambda n", "lagrange multiplier"),
    "q1": tuple(name + "1" for name in (*_SHEAR, *_FULL)),
    "q2": tuple(name + "2" for name in (*_SHEAR, *_FULL)),
    "q_theta": ("q theta", "qtheta", "qt", "tau theta", "t theta", "q phi"),
    "q_r": ("q r", "tau r", "t r"),
    "f1": tuple(name + "1" for name in _FORCE),
    "f2": tuple(name + "2" for name in _FORCE),
    "fn": ("fn", "normal force", "f3"),
    "slip1": tuple(name + "1" for name in _SLIP),
    "slip2": tuple(name + "2" for name in _SLIP),
    "gap": ("gap", "copen", "opening", "contact gap", "clearance"),
    "area": ("area", "weight", "nodal area", "cnarea", "cell area"),
}
VECTORS = {"shear": _SHEAR, "traction": _FULL, "force": _FORCE, "slip": _SLIP}
QUANTITIES = {"length": ("x1", "x2", "x3", "r", "slip1", "slip2", "slip", "gap"),
              "stress": ("pressure", "q1", "q2", "q_theta", "q_r", "shear", "traction"),
              "force": ("f1", "f2", "fn", "force"), "area": ("area",)}
_SURFACE_TANGENTS = ("cshear", "cslip")


def _plain(name: str) -> str:
    return re.sub(r"[\s_.:-]", "", name.lower())


def checked_names(names: Names) -> dict[str, str]:
    """The arrays' names that the user gives for meanings, which must be keys of SCALARS or VECTORS."""
    for role in names or {}:
        if role not in SCALARS and role not in VECTORS:
            raise InputError(f'names: "{role}"; allowed: {", ".join((*SCALARS, *VECTORS))}, each with the name of an array')
    return dict(names or {})


class Arrays:
    """The arrays of n rows of one file. where: "column", "point array" or "cell array", for messages."""

    def __init__(self, arrays: Mapping[str, Array], names: dict[str, str], source: str, where: str):
        self._arrays, self._names, self._source, self._where = dict(arrays), names, source, where
        self._plain = {_plain(name): name for name in reversed(list(arrays))}
        for name in names.values():
            whole, _, column = name.rpartition(":")
            if name not in arrays and whole in arrays and column.isdigit() and int(column) < self._width(whole) > 1:
                self._arrays[name] = arrays[whole][:, int(column)]
            elif name not in arrays:
                raise InputError(f'{source}: it has no {where} "{name}"; it has {self.listed()} (NAME:0 is a first column)')

    def rows(self, which: Indices) -> Arrays:
        """The same arrays, of some rows only."""
        return Arrays({name: array[which] for name, array in self._arrays.items()}, self._names, self._source, self._where)

    def listed(self) -> str:
        return ", ".join(f"'{name}'" for name in self._arrays) or "none"

    def name_of(self, role: str) -> Optional[str]:
        """The name of the array of numbers that has this meaning; None: the file has none."""
        if role in self._names:
            return self._names[role]
        present = (self._plain[_plain(name)] for name in SCALARS[role] if _plain(name) in self._plain)
        return next((name for name in present if self._width(name) == 1), None)

    def is_given(self, role: str) -> bool:
        """Whether the user named the array of this meaning."""
        return role in self._names

    def _width(self, name: str) -> int:
        array = self._arrays[name]
        return 1 if array.ndim == 1 else array.shape[1]

    def arrays_of(self, role: str) -> list[str]:
        """The arrays of a number or a vector of this meaning."""
        return self.components_of(role) if role in VECTORS else [name for name in [self.name_of(role)] if name]

    def components_of(self, role: str) -> list[str]:
        """The arrays of a vector along the file's x, y and z: one with 2 or 3 columns, or 2 or 3 with names like tx, ty, tz."""
        if role in self._names:
            return [self._names[role]]
        for base in map(_plain, VECTORS[role]):
            whole = self._plain.get(base)
            if whole is not None and self._width(whole) in (2, 3):
                return [whole]
            for suffixes in ("xyz", "012"):
                found = [self._plain[base + suffix] for suffix in suffixes if base + suffix in self._plain]
                if len(found) > 1:
                    return found
        return []

    def values(self, role: str) -> Optional[Array]:
        """The numbers (n), or the vectors (n, 3) along the file's axes, that have this meaning; components that the file leaves
        out are zero. None: the file has none."""
        found = [self._numbers(name) for name in self.arrays_of(role)]
        if not found:
            return None
        if role in SCALARS:
            return found[0].reshape(-1)
        array = found[0] if found[0].ndim == 2 else np.stack(found, axis=1)
        return np.pad(array, ((0, 0), (0, 3 - array.shape[1])))

    def on_surface_tangents(self, role: str) -> bool:
        """Whether the components of "q1" or "slip1" lie along tangents that the program makes from the face's normal."""
        return _plain(self.name_of(role) or "").startswith(_SURFACE_TANGENTS)

    def has_pressure(self) -> bool:
        return any(map(self.arrays_of, ("pressure", "fn", "traction", "force")))

    def has_shear(self) -> bool:
        return any(map(self.arrays_of, ("q1", "f1", "shear", "traction", "force")))

    def _numbers(self, name: str) -> Array:
        array = self._arrays[name]
        if array.dtype == object:
            row, word = next((i, word) for i, word in enumerate(array) if not _is_number(word))
            raise InputError(f'{self._source}: row {row + 1}, column {name}: "{word}"; allowed: a number')
        return np.asarray(array, float)


def _is_number(word: object) -> bool:
    try:
        float(word)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return False
    return True
