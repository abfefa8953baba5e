"""VTK's XML files: .vtu and .vtp, and the .pvtu, .pvtp and .pvd that name several of them."""
from __future__ import annotations

import base64
import re
import xml.etree.ElementTree as xml
import zlib
from pathlib import Path
from typing import Literal, Optional

import numpy as np

from ...errors import InputError
from ..field import Array
from .mesh import Mesh, of_vtk

_SECTIONS = {"Verts": 1, "Lines": 3, "Polys": 7, "Strips": 6}  # of .vtp, in the order of the cell data


def _decompressed(block: bytes, size: int, compressor: str) -> bytes:
    if compressor == "vtkZLibDataCompressor":
        return zlib.decompress(block)
    if compressor == "vtkLZMADataCompressor":
        import lzma
        return lzma.decompress(block)
    import lz4.block  # type: ignore[import-not-found]
    return bytes(lz4.block.decompress(block, uncompressed_size=size))


def _base64(text: bytes) -> bytes:
    """Decoded text; header and data may be encoded one by one, each with its own padding."""
    return b"".join(base64.b64decode(part) for part in re.findall(rb"[A-Za-z0-9+/]+=*", re.sub(rb"\s+", b"", text)))


class _File:
    """One XML file: its tree, and the way to the numbers of a DataArray."""

    def __init__(self, path: Path):
        content = path.read_bytes()
        self._appended, self._encoding, self._starts = b"", "raw", []
        found = re.search(rb"<AppendedData([^>]*)>\s*_", content)
        if found:
            self._encoding = "base64" if b"base64" in found[1] else "raw"
            self._appended = content[found.end():content.rindex(b"</AppendedData")]
            content = content[:found.start()] + b"</VTKFile>"
        try:
            self.root = xml.fromstring(content)
        except xml.ParseError as error:
            raise InputError(f"{path.name}: it is no whole XML file: {error}") from None
        self._starts = sorted(int(a.get("offset", 0)) for a in self.root.iter("DataArray") if a.get("format") == "appended")
        self._order: Literal["<", ">"] = ">" if self.root.get("byte_order") == "BigEndian" else "<"
        self._header = self._order + ("u8" if self.root.get("header_type") == "UInt64" else "u4")
        self._compressor = self.root.get("compressor")

    def _bytes(self, data: bytes) -> bytes:
        """The array of a block of bytes: a header of lengths, then the data, whole or compressed in parts."""
        word = np.dtype(self._header).itemsize
        if self._compressor is None:
            length = int(np.frombuffer(data, self._header, 1)[0])
            return data[word:word + length]
        parts, size, last = (int(n) for n in np.frombuffer(data, self._header, 3)) if len(data) >= 3 * word else (0, 0, 0)
        lengths = np.frombuffer(data, self._header, parts, 3 * word)
        ends = np.cumsum(lengths) + (3 + parts) * word
        sizes = [size] * (parts - 1) + [last or size]
        return b"".join(_decompressed(data[int(end - length):int(end)], whole, self._compressor)
                        for end, length, whole in zip(ends, lengths, sizes))

    def numbers(self, array: xml.Element) -> Array:
        """The numbers of a DataArray: one row a point or cell, if it has several components."""
        kind = array.get("type", "Float64")
        dtype = np.dtype({"I": "i", "U": "u", "F": "f"}[kind[0]] + str(int(re.sub(r"\D", "", kind)) // 8))
        if array.get("format") == "ascii":
            values = np.array((array.text or "").split(), dtype)
        else:
            if array.get("format") == "appended":
                start = int(array.get("offset", 0))
                end = next((s for s in self._starts if s > start), len(self._appended))
                data, text = self._appended[start:end], self._encoding == "base64"
            else:
                data, text = (array.text or "").encode(), True
            values = np.frombuffer(self._bytes(_base64(data) if text else data), dtype.newbyteorder(self._order)).astype(dtype)
        columns = int(array.get("NumberOfComponents") or 1)
        return values.reshape(-1, columns) if columns > 1 else values

    def arrays(self, section: Optional[xml.Element]) -> dict[str, Array]:
        """The arrays of a section by name; components that have names of their own are arrays of their own."""
        found: dict[str, Array] = {}
        for array in section if section is not None else ():
            if array.tag != "DataArray" or array.get("type") == "String":
                continue
            values = self.numbers(array)
            labels = [array.get(f"ComponentName{i}", "") for i in range(values.shape[1] if values.ndim > 1 else 0)]
            if len(labels) > 3 and all(labels):
                found.update(zip(labels, values.T))
            else:
                found[array.get("Name", "")] = values
        return found

    def piece(self, piece: xml.Element) -> Mesh:
        """The mesh of one piece."""
        points, cells, none = self.arrays(piece.find("Points")), self.arrays(piece.find("Cells")), np.empty(0, np.int64)
        if cells:
            types, nodes, sizes = cells["types"], cells["connectivity"], np.diff(cells["offsets"], prepend=0)
        else:
            sections = [(number, self.arrays(piece.find(tag))) for tag, number in _SECTIONS.items()]
            each = [np.diff(section.get("offsets", none), prepend=0) for _, section in sections]
            types = np.concatenate([np.full(len(sizes), number) for (number, _), sizes in zip(sections, each)])
            nodes, sizes = np.concatenate([section.get("connectivity", none) for _, section in sections]), np.concatenate(each)
        if len(types) != len(sizes) or sizes.min(initial=0) < 0 or sizes.sum() != len(nodes):
            raise ValueError("its cells' types, offsets and connectivity do not belong together")
        at_cells = self.arrays(piece.find("CellData"))
        own = at_cells.pop("vtkGhostType", np.zeros(len(types))) == 0  # the rest repeats cells of other pieces
        return of_vtk(next(iter(points.values()), np.empty((0, 3))), types[own], sizes[own], nodes[np.repeat(own, sizes)],
                      self.arrays(piece.find("PointData")), {name: array[own] for name, array in at_cells.items()})


def _joined(pieces: list[Mesh]) -> Mesh:
    """One mesh of several; arrays that a piece lacks are left out."""
    whole = pieces[0]
    for piece in pieces[1:]:
        whole = Mesh(np.concatenate([whole.points, piece.points]),
                     whole.cells + [(name, nodes + len(whole.points)) for name, nodes in piece.cells],
                     {name: np.concatenate([array, piece.point_data[name]]) for name, array in whole.point_data.items()
                      if name in piece.point_data},
                     {name: arrays + piece.cell_data[name] for name, arrays in whole.cell_data.items()
                      if name in piece.cell_data})
    return whole


def _pieces(path: Path) -> list[Mesh]:
    file = _File(path)
    sources = [path.parent / piece.get("Source", "") for piece in file.root.iter("Piece") if piece.get("Source")]
    steps = [(float(data.get("timestep", 0)), data.get("file", "")) for data in file.root.iter("DataSet")]
    if steps:
        last = max(time for time, _ in steps)
        sources = [path.parent / name for time, name in steps if time == last]
    if sources:
        return [mesh for source in sources for mesh in _pieces(source)]
    return [file.piece(piece) for piece in file.root.iter("Piece") if int(piece.get("NumberOfPoints", 0))]


def read_vtu(path: Path) -> Mesh:
    """The mesh of a file, its pieces joined; of a .pvd the last time."""
    pieces = _pieces(path)
    if not pieces:
        raise InputError(f"{path.name}: it has no points")
    return _joined(pieces)
