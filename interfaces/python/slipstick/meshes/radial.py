"""Tables of an axisymmetric contact: values on a radius, turned about the axis."""
from __future__ import annotations

import numpy as np

from ..errors import InputError
from .field import Array, ContactField, Indices
from .files.tables import FORMS
from .names import Arrays
from .units import Units
from .values import HOW_TO_NAME, Options

_LEAST_ANGLES, _MOST_NODES = 36, 8000
_MOST_RADII = _MOST_NODES // _LEAST_ANGLES


def of_radial_table(arrays: Arrays, options: Options, units: Units, name: str) -> ContactField:
    """Values on a radius, put on circles of nodes. q_theta: around the axis; q_r: away from it."""
    if not arrays.name_of("pressure"):
        raise InputError(f"{name}: it has the columns {arrays.listed()} and no pressure; allowed: {FORMS}; or {HOW_TO_NAME}")
    units.learn(arrays)
    columns = [units.scaled(arrays, role) for role in ("r", "pressure", "q_theta", "q_r")]
    order = np.argsort(np.asarray(columns[0]))
    radii, pressure, around, outward = (np.zeros(len(order)) if column is None else np.nan_to_num(column[order])
                                        for column in columns)
    if not (radii[0] >= 0 and np.all(np.diff(radii) > 0) and pressure.max() > 0):
        raise InputError(f"{name}: allowed: radii that differ, from 0, and a positive pressure at one or more of them")
    said = []
    if len(radii) > _MOST_RADII:
        every = -(-len(radii) // _MOST_RADII)
        radii, pressure, around, outward = (column[::every] for column in (radii, pressure, around, outward))
        said.append(f"Rows: one radius of {every} is taken.")
    vertices, faces, on_nodes, traction = _swept(radii, pressure, around, outward)
    said.append(f"Kind: {len(radii)} radii are turned about the axis, to {len(vertices)} nodes with {len(faces[0])} angles.")
    if options.body == "upper":
        traction = -traction
        said.append("Body: the shear acts on the upper body, and is turned.")
    if radii[0] > 0:
        said.append("Axis: the pressure at the axis is extrapolated from the first two radii.")
    return ContactField("nodes", vertices, on_nodes, traction, vertices=vertices, faces=faces, name=name, said=said)


def _swept(radii: Array, pressure: Array, around: Array, outward: Array) -> tuple[Array, list[Indices], Array, Array]:
    """Nodes (n, 2) on circles of these radii, the triangles and quadrilaterals between them, and the nodes' pressure and
    tractions, from values on a radius: traction around the axis and away from it. Faces are about square at the contact's rim."""
    contact = radii[pressure > 0]
    inner = radii[radii <= contact.max()]
    wanted = 2 * np.pi * contact.max() / np.median(np.diff(inner)) if len(inner) > 1 else 0
    angles = int(max(_LEAST_ANGLES, min(wanted, _MOST_NODES / len(radii))))
    angle = 2 * np.pi * np.arange(angles) / angles
    axis, rings = radii[0] == 0, radii[radii > 0]
    first = int(axis)
    unit = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    turned = np.stack([-unit[:, 1], unit[:, 0]], axis=1)
    on_rings = (rings[:, None, None] * unit).reshape(-1, 2)
    shear = (around[first:, None, None] * turned + outward[first:, None, None] * unit).reshape(-1, 2)
    if axis:
        middle = pressure[0]
    else:  # an even function of the radius through the first two values
        slope = (pressure[1] - pressure[0]) / (rings[1]**2 - rings[0]**2) if len(rings) > 1 else 0.0
        middle = pressure[0] - slope * rings[0]**2
    place = 1 + np.arange(len(rings) * angles).reshape(-1, angles)
    after = np.roll(place, -1, axis=1)
    triangles = np.stack([np.zeros(angles, np.int64), place[0], after[0]], axis=1)
    quads = np.stack([place[:-1], place[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    return (np.concatenate([np.zeros((1, 2)), on_rings]), [triangles, quads],
            np.concatenate([[middle], np.repeat(pressure[first:], angles)]), np.concatenate([np.zeros((1, 2)), shear]))
