"""Units of lengths, stresses and forces: given, named in a header, or the pair that fits an expected contact."""
from __future__ import annotations

import re
from typing import Optional

import numpy as np

from ..errors import InputError
from .field import Array, ContactField
from .names import QUANTITIES, Arrays

_SI = {
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "in": 0.0254},
    "stress": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/m2": 1.0, "N/mm2": 1e6, "psi": 6894.757293168361,
               "ksi": 6894757.293168361},
    "force": {"N": 1.0, "kN": 1e3, "mN": 1e-3, "uN": 1e-6, "lbf": 4.4482216152605},
}
_SI["area"] = {f"{unit}2": size**2 for unit, size in _SI["length"].items()}
_TO_CHOOSE = {"length": ("m", "mm", "um"), "stress": ("Pa", "kPa", "MPa", "GPa")}
_UNKNOWN = {"length": "Units: no unit of length is given; m is taken.",
            "stress": "Units: no unit of stress is given; Pa is taken."}


def _plain(unit: str) -> str:
    return re.sub(r"[\s^*]", "", unit.replace("µ", "u").replace("μ", "u").replace("²", "2"))


class Units:
    """Factors to SI units. given: "mm,MPa", "mm,N" and so on, for all columns; headers: by name of the column."""

    def __init__(self, given: Optional[str], headers: dict[str, str], name: str):
        self._name, self._headers, self._given = name, headers, {}
        self._found: dict[str, str] = {}
        for unit in map(_plain, re.split(r"[,\s]+", given.strip()) if given else ()):
            quantity = next((quantity for quantity in ("length", "stress", "force") if unit in _SI[quantity]), None)
            if quantity is None:
                allowed = ", ".join(unit for quantity in ("length", "stress", "force") for unit in _SI[quantity])
                raise InputError(f'units: "{unit}"; allowed, separated by commas: {allowed}')
            self._given[quantity] = unit

    def _own(self, quantity: str, column: str) -> Optional[str]:
        """The unit in the header of a column."""
        if column not in self._headers:
            return None
        unit = _plain(self._headers[column])
        if unit not in _SI[quantity]:
            raise InputError(f'{self._name}: column {column}: unit "{self._headers[column]}"; allowed: '
                             f'{", ".join(_SI[quantity])}')
        return unit

    def learn(self, arrays: Arrays) -> None:
        """Takes units from headers; one column's unit holds for the columns without one of the same quantity too."""
        for quantity in ("length", "stress", "force"):
            units = [self._own(quantity, column) for role in QUANTITIES[quantity] for column in arrays.arrays_of(role)]
            self._found[quantity] = next(filter(None, units), "")

    def _general(self, quantity: str) -> Optional[float]:
        """The size of a quantity's unit, given, found in a header or made of the others; None: unknown."""
        unit = self._given.get(quantity) or self._found.get(quantity)
        return _SI[quantity][unit] if unit else None

    def size(self, quantity: str, column: str = "") -> float:
        """The factor of a column to SI."""
        own = None if quantity in self._given else self._own(quantity, column)
        if own:
            return _SI[quantity][own]
        length, stress, force = (self._general(q) for q in ("length", "stress", "force"))
        if quantity == "area":
            return (length or 1.0)**2
        if quantity == "stress" and stress is None and force is not None:
            return force / (length or 1.0)**2
        if quantity == "force" and force is None:
            return (stress or 1.0) * (length or 1.0)**2
        return self._general(quantity) or 1.0

    def scaled(self, arrays: Arrays, role: str) -> Optional[Array]:
        """The numbers (n) or vectors (n, 3) with this meaning in SI units; None: the source has none."""
        values = arrays.values(role)
        quantity = next(quantity for quantity, roles in QUANTITIES.items() if role in roles)
        return None if values is None else values * self.size(quantity, arrays.arrays_of(role)[0])

    def said(self) -> list[str]:
        """The units that are taken, and the ones that are not known."""
        of_force = self._general("force") and self._general("length")  # a stress follows
        sentences = []
        for quantity in ("length", "stress"):
            unit, source = self._given.get(quantity), "as given"
            if unit is None:
                unit, source = self._found.get(quantity), "from the header"
            if unit:
                sentences.append(f"Units: {quantity} in {unit}, {source}.")
            elif not (quantity == "stress" and of_force):
                sentences.append(_UNKNOWN[quantity])
        return sentences


def in_units_of(field: ContactField, contact_radius: float, load: float) -> ContactField:
    """The field in SI units, if its file gives no units: in m, mm or um and Pa, kPa, MPa or GPa, so that its contact's radius and
    mean pressure fit a contact of this radius (m) under this load (N). A field with known units is not changed."""
    missing = [quantity for quantity, sentence in _UNKNOWN.items() if sentence in field.said]
    in_contact = field.pressure > 1e-3 * field.pressure.max(initial=0)
    if not missing or not in_contact.any():
        return field
    measured = {"length": np.ptp(field.points[in_contact], axis=0).max() / 2, "stress": field.pressure[in_contact].mean()}
    expected = {"length": contact_radius, "stress": load / (np.pi * contact_radius**2)}
    named = {"length": "radius", "stress": "mean pressure"}
    size, said = {"length": 1.0, "stress": 1.0}, [sentence for sentence in field.said if sentence not in _UNKNOWN.values()]
    for quantity in missing:
        ratio = expected[quantity] / max(measured[quantity], 1e-300)
        unit = min(_TO_CHOOSE[quantity], key=lambda unit: abs(np.log(_SI[quantity][unit] / ratio)))
        size[quantity] = _SI[quantity][unit]
        said.append(f"Units: {quantity} in {unit}, because the contact's {named[quantity]} is then "
                    f"{measured[quantity] * size[quantity]:.3g} and {expected[quantity]:.3g} is expected (SI).")
    length, stress = size["length"], size["stress"]
    scaled = {"area": length**2, "vertices": length, "slip": length, "gap": length}
    others = {name: getattr(field, name) * factor for name, factor in scaled.items() if getattr(field, name) is not None}
    return field.replaced(points=field.points * length, pressure=field.pressure * stress, traction=field.traction * stress,
                          said=said, **others)
