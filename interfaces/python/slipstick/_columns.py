"""Fields of other programs as columns by name: dicts, DataFrames, arrays of records, Datasets of xarray."""
from __future__ import annotations

import re
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from .errors import InputError

Columns = dict[str, npt.NDArray[Any]]

#: Columns of stresses below the surface, which need x3 and at least one component.
STRESSES = ("s11", "s22", "s33", "s12", "s13", "s23")
#: Columns that a field needs, and others that it may have.
NEEDED, _FURTHER = ("x1", "x2", "pressure", "q1", "q2"), ("area", "slip1", "slip2", "gap")
#: Names of the columns of a loop begin like one of these.
_LOOP = ("moment", "torque", "force", "rotation", "angle", "twist", "displacement")
_WIDEST_VECTOR = 3  # columns; wider arrays are values on a grid


def columns_of(field: Any) -> Columns:
    """The arrays of an object by name, one row a point or a cell; none if it has no columns. Values of a grid, [i, j] at x1[i] and
    x2[j], become rows."""
    if hasattr(field, "to_dataframe"):
        field = field.to_dataframe().reset_index()
    names = getattr(getattr(field, "dtype", None), "names", None) or (list(field.keys()) if hasattr(field, "keys") else [])
    arrays = {str(name): np.asarray(field[name]) for name in names}
    shapes = {array.shape for array in arrays.values() if array.ndim == 2 and array.shape[1] > _WIDEST_VECTOR}
    if len(shapes) != 1:
        return arrays
    grid = shapes.pop()
    axes = _named({name: array for name, array in arrays.items() if array.ndim == 1})
    for axis, role in enumerate(("x1", "x2")):
        if role in axes and arrays[axes[role]].size == grid[axis]:
            arrays[axes[role]] = np.broadcast_to(np.expand_dims(arrays[axes[role]], 1 - axis), grid)
    return {name: array.ravel() if array.shape == grid else array for name, array in arrays.items()}


def _named(columns: Columns) -> dict[str, str]:
    """The names of the columns by their meaning; a unit behind a name, "x1 [mm]", does not count."""
    if columns.keys() >= {*NEEDED}:
        return {role: role for role in (*NEEDED, *_FURTHER, "x3") if role in columns}
    arrays, full = _arrays(columns), {_bare(name): name for name in columns}
    roles = {role: arrays.name_of(role) for role in (*NEEDED, *_FURTHER, "x3")}
    shear = arrays.components_of("shear")  # as tau_x, tau_y
    if roles["q1"] is None and len(shear) == 2:
        roles["q1"], roles["q2"] = shear
    return {role: full[name] for role, name in roles.items() if name is not None}


def _bare(name: str) -> str:
    return re.sub(r"\s*[\[(].*", "", name)


def _arrays(columns: Columns) -> Any:
    from .meshes.names import Arrays  # takes long to import

    return Arrays({_bare(name): values for name, values in columns.items()}, {}, "the field", "column")


def field_columns(columns: Columns) -> Optional[Columns]:
    """The columns under the program's own names, with the units that their names have; None: they are no scalars at points of a
    plane."""
    named = _named(columns)
    if "x3" in named or any(role not in named for role in NEEDED):
        return None
    if named["q1"] != "q1" and _arrays(columns).on_surface_tangents("q1"):  # as CSHEAR1, which does not lie along x1
        return None
    return {role + name[len(_bare(name)):]: columns[name] for role, name in named.items()}


def are_stresses(columns: Columns) -> bool:
    names = {_bare(name).lower() for name in columns}
    return "x3" in names and not names.isdisjoint(STRESSES)


def is_loop(columns: Columns) -> bool:
    return "x1" not in _named(columns) and any(name.lower().startswith(_LOOP) for name in columns)


def is_readable(columns: Columns) -> bool:
    """Whether the mesh judge's reader may know the columns: vectors, forces, radii, or points in space."""
    arrays = _arrays(columns)

    def has(*roles: str) -> bool:
        return all(arrays.arrays_of(role) for role in roles)

    shear = any(has(*roles) for roles in (("q1", "q2"), ("f1", "f2"), ("shear",), ("traction",), ("force",), ("q_theta",)))
    return shear and arrays.has_pressure() and (has("x1", "x2") or has("r"))


def explained(columns: Columns, kind: str) -> InputError:
    """The error for columns that no reader understands."""
    missing = [role for role in NEEDED if role not in _named(columns)]
    return InputError(f"the field has no {', '.join(missing)}; the {kind} has {', '.join(columns) or 'no columns'}; allowed: columns x1, "
                      "x2 (m), pressure, q1, q2 (Pa), also as x, y, p, tau_x, tau_y and under other common names; of a loop moment, "
                      "rotation or force, displacement")
