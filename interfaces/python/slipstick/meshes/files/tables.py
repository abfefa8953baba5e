"""Text tables: columns with names and units."""
from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Optional

import numpy as np
import numpy.typing as npt

from ...errors import InputError
from .mesh import Mesh

_COMMENTS = ("#", "%", "//")
FORMS = ("x1,x2,pressure,q1,q2[,area][,slip1,slip2][,gap]; x1,x2,f1,f2,fn[,area] (nodal forces); r,pressure,q_theta[,q_r] "
         "(radial)")


def _text(path: Path) -> str:
    content = path.read_bytes()
    if b"\0" in content:
        raise InputError(f"{path.name}: it is no text; allowed: a table of text, or a mesh file with its usual extension")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _words(line: str, separator: Optional[str]) -> list[str]:
    if separator is None:
        return [word.strip('"') for word in re.findall(r'"[^"]*"|\S+', line)]
    return [word.strip().strip('"') for word in line.split(separator)]


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _column(words: list[str]) -> npt.NDArray[Any]:
    """Numbers, an empty field as NaN; words where one is no number."""
    try:
        return np.array([word or "nan" for word in words], float)
    except ValueError:
        return np.array(words, object)


def _named(word: str) -> tuple[str, str]:
    """Name and unit of a header's word: "x1 [mm]"."""
    found = re.fullmatch(r"(.+?)\s*[\[(]([^\])]*[A-Za-z][^\])]*)[\])]", word)
    return (found[1], found[2]) if found else (word, "")


def read_table(path: Path) -> Mesh:
    """The columns of a text table, separated by commas, semicolons, tabs or blanks. The header is the first line, or the last
    comment before the numbers."""
    lines = [(number, line.strip()) for number, line in enumerate(_text(path).splitlines(), 1) if line.strip()]
    rows = [(number, line) for number, line in lines if not line.startswith(_COMMENTS)]
    if not rows:
        raise InputError(f"{path.name}: it has no rows; allowed: {FORMS}")
    separator = next((s for s in ";\t," if s in rows[-1][1]), None)
    decimal_comma = separator == ";" and "." not in rows[-1][1]
    header = rows[0]
    if _is_number(_words(header[1].replace(",", "." if decimal_comma else ","), separator)[0]):
        comments = [line for number, line in lines if line.startswith(_COMMENTS) and number < header[0]]
        if not comments:
            raise InputError(f"{path.name}:{header[0]}: the first row has numbers; allowed: a header with names: {FORMS}")
        names = comments[-1].lstrip("#%/ ")
    else:
        names, rows = header[1], rows[1:]
    words = _words(re.sub(r"\s+([\[(])", r"\1", names) if separator is None else names, separator)
    cells = [_words(line.replace(",", ".") if decimal_comma else line, separator) for _, line in rows]
    for (number, _), row in zip(rows, cells):
        if len(row) != len(words):
            raise InputError(f"{path.name}:{number}: it has {len(row)} fields; allowed: {len(words)}, as in the header")
    named = [_named(word) for word in words]
    return Mesh(point_data={name: _column([row[i] for row in cells]) for i, (name, _) in enumerate(named)},
                units={name: unit for name, unit in named if unit})
