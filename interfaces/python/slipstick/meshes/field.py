"""Tractions of one contact on another program's own points, with the mesh between them where it is known."""
from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

KINDS = {
    "nodes": "values at the mesh's nodes, between which the tractions are linear",
    "faces": "means over faces",
    "points": "values at quadrature points, each with its area",
    "forces": "forces at nodes, divided by each node's area",
}


@dataclass
class ContactField:
    """A field of n rows, in the scene's frame and in SI units: the body's axis at the origin, x1 to x2 positive.

    kind: a key of KINDS. points (n, 2) m: nodes, centres of faces or quadrature points. pressure (n) Pa, positive in compression.
    traction (n, 2) Pa, on the lower body. area (n) m^2: the weight of each row; None: it follows from the mesh, or from a
    triangulation of the points. vertices (m, 2) m and faces: the mesh, where the file has one; each array of `faces` holds faces of
    one type, as rows of indices into the vertices: 3 or 6 for triangles, 4, 8 or 9 for quadrilaterals, in VTK's order of nodes. For
    kinds "nodes" and "forces" the vertices are the points; for "faces" the rows are the faces, in the order of the arrays.
    slip (n, 2) m: of the upper body over the lower one. gap (n) m. said: the choices that the reader made, one sentence each. added:
    rows at the end that are not the source's.
    """

    kind: str
    points: Array
    pressure: Array
    traction: Array
    area: Optional[Array] = None
    vertices: Optional[Array] = None
    faces: list[Indices] = field(default_factory=list)
    slip: Optional[Array] = None
    gap: Optional[Array] = None
    name: str = "the field"
    said: list[str] = field(default_factory=list)
    added: int = 0

    def replaced(self, **changes: Any) -> ContactField:
        """A copy with other arrays."""
        return ContactField(**{**self.__dict__, **changes})

    def save(self, file: Path) -> None:
        """Writes a file for the program, which load() reads."""
        arrays = {name: value for name, value in self.__dict__.items() if isinstance(value, np.ndarray)}
        faces = {f"faces{k}": array for k, array in enumerate(self.faces)}
        with file.open("wb") as stream:
            np.savez(stream, texts=json.dumps([self.kind, self.name, self.said, self.added]), **arrays, **faces)

    @classmethod
    def load(cls, file: Path) -> ContactField:
        with np.load(file) as data:
            arrays = dict(data)
        kind, name, said, added = json.loads(str(arrays.pop("texts")))
        faces = [arrays.pop(key) for key in sorted(arrays) if key.startswith("faces")]
        return cls(kind=kind, name=name, said=said, added=added, faces=faces, **arrays)
