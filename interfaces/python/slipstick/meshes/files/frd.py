"""Result files of CalculiX (.frd, text)."""
from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import numpy as np

from ...errors import InputError
from ..field import Array, Indices
from .mesh import Blocks, Mesh

# Types of elements and their numbers of nodes; in two of them the vertical edges' middle nodes come before the top's.
_TYPES = {1: ("hexahedron", 8), 2: ("wedge", 6), 3: ("tetra", 4), 4: ("hexahedron20", 20), 5: ("wedge15", 15), 6: ("tetra10", 10),
          7: ("triangle", 3), 8: ("triangle6", 6), 9: ("quad", 4), 10: ("quad8", 8)}
_ORDER = {4: [*range(12), *range(16, 20), *range(12, 16)], 5: [*range(9), *range(12, 15), *range(9, 12)]}


def _rows(lines: Iterator[str], width: int) -> tuple[Indices, Array]:
    """Numbers of nodes and their values (n, k), in fields of 12 characters, up to the end of a block."""
    nodes, values = [], []
    for line in lines:
        if line.startswith(" -3"):
            break
        fields = [float(line[i:i + 12]) for i in range(3 + width, len(line.rstrip()), 12)]
        if line.startswith(" -1"):
            nodes.append(int(line[3:3 + width]))
            values.append(fields)
        else:
            values[-1] += fields
    return np.array(nodes, np.int64), np.array(values, float)


def _elements(lines: Iterator[str], width: int) -> list[tuple[int, list[int]]]:
    """Type and numbers of nodes of each element, up to the end of a block."""
    found: list[tuple[int, list[int]]] = []
    for line in lines:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            found.append((int(line[3 + width:8 + width]), []))
        else:
            found[-1][1].extend(int(line[i:i + width]) for i in range(3, len(line.rstrip()), width))
    return found


def _last_contact(lines: Iterator[str], name: str) -> tuple[Indices, Array, list[tuple[int, list[int]]], dict[str, Array], str]:
    """Nodes, their places, the elements, and the values of the last block CONTACT by component, with the step's time."""
    nodes, places = np.empty(0, np.int64), np.empty((0, 3))
    elements: list[tuple[int, list[int]]] = []
    contact, time, width = {}, "", 10
    for line in lines:
        if line.startswith(("    2C", "    3C", "  100C")):
            form = line.split()[-1]
            if form not in "01":
                raise InputError(f"{name}: a binary .frd file; allowed: text (no OUTPUT=BIN on *NODE FILE and its like)")
            width = 10 if form == "1" else 5
        if line.startswith("    2C"):
            nodes, places = _rows(lines, width)
        elif line.startswith("    3C"):
            elements = _elements(lines, width)
        elif line.startswith("  100C"):
            step = line[12:24].strip()
        elif line.startswith(" -4  CONTACT"):
            components = []
            line = next(lines, "")
            while line.startswith(" -5"):
                components.append(line.split()[1])
                line = next(lines, "")
            rows, values = _rows(chain([line], lines), width)
            contact, time = {**dict(zip(components, values.T)), "nodes": rows}, step
    return nodes, places, elements, contact, time


def read_frd(path: Path) -> Mesh:
    """The mesh, with the contact's values of the last step at its nodes; nodes without values have NaN."""
    with path.open(encoding="latin-1") as lines:
        nodes, places, elements, contact, time = _last_contact(lines, path.name)
    if not contact:
        raise InputError(f"{path.name}: it has no block CONTACT; allowed: the output of *CONTACT FILE with CDIS, CSTR")
    order = np.argsort(nodes)

    def place(numbers: Indices) -> Indices:
        return np.asarray(order[np.searchsorted(nodes, numbers, sorter=order)])
    cells: Blocks = []
    for kind, (name, size) in _TYPES.items():
        rows = [numbers for number, numbers in elements if number == kind]
        if rows:
            cells.append((name, place(np.array(rows, np.int64)[:, _ORDER.get(kind, slice(size))])))
    at = place(contact.pop("nodes").astype(np.int64))
    data = {}
    for name, values in contact.items():
        data[name] = np.full(len(nodes), np.nan)
        data[name][at] = values
    return Mesh(places, cells, data, said=[f"Step: the last one, at time {time}."])
