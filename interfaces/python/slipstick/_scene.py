"""Scenes in Python: the name of a file, text (TOML), or a dict."""
from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Union

import numpy as np

from .errors import InputError

#: A str with a line break is text; any other str is the name of a file.
Scene = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def toml_value(value: Any) -> str:
    """A value in TOML.

    >>> print(toml_value([True, 2, 1e-3, float("inf"), "a", {"b": np.arange(2)}]))
    [true, 2, 0.001, inf, "a", {b = [0, 1]}]
    """
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return _quoted(os.fspath(value))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(name)} = {toml_value(part)}" for name, part in value.items()) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml_value(part) for part in value) + "]"
    raise InputError(f"{value!r}: allowed: numbers, texts, true and false, lists and dicts of them")


def toml_text(scene: Mapping[str, Any]) -> str:
    """A dict of tables as a TOML file.

    >>> print(toml_text({"name": "mine", "load": {"normal": 10.0}, "step": [{"moment_ratio": 0.5}]}))
    name = "mine"
    [load]
    normal = 10.0
    [[step]]
    moment_ratio = 0.5
    """
    lines = []
    tables = []
    for name, value in scene.items():
        rows = value if isinstance(value, (list, tuple)) and value and isinstance(value[0], Mapping) else None
        if isinstance(value, Mapping):
            tables.append((f"[{_key(name)}]", value))
        elif rows is not None:
            tables += [(f"[[{_key(name)}]]", row) for row in rows]
        else:
            lines.append(f"{_key(name)} = {toml_value(value)}")
    for head, table in tables:
        lines += [head, *(f"{_key(name)} = {toml_value(value)}" for name, value in table.items())]
    return "\n".join(lines)


@contextmanager
def prepared(scene: Scene, overrides: Mapping[str, Any]) -> Iterator[tuple[str | None, str, list[str]]]:
    """A scene's text (None if it is a file), its name in messages, and the overrides in the form of --set. Arrays of two dimensions
    in them, height maps for example, are files as long as this lasts."""
    with tempfile.TemporaryDirectory() as folder:
        words = assignments(_with_files(overrides, folder))
        if isinstance(scene, Mapping):
            yield toml_text(_with_files(scene, folder)), "scene", words
        elif isinstance(scene, str) and "\n" in scene:
            yield scene, "scene", words
        else:
            yield None, os.fspath(scene), words


def _with_files(value: Any, folder: str) -> Any:
    """The same with a CSV file in the place of each array of two dimensions."""
    if isinstance(value, Mapping):
        return {name: _with_files(part, folder) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_with_files(part, folder) for part in value]
    if not isinstance(value, np.ndarray) or value.ndim != 2:
        return value
    handle, file = tempfile.mkstemp(".csv", "array-", folder)
    os.close(handle)
    np.savetxt(file, value, fmt="%.17g", delimiter=",")
    return Path(file)


def assignments(overrides: Mapping[str, Any]) -> list[str]:
    """Keyword arguments in the form of --set: load__moment_ratio=0.5 is "load.moment_ratio=0.5".

    >>> assignments({"load__moment_ratio": 0.5, "grid.cells": (48, 48)})
    ['load.moment_ratio=0.5', 'grid.cells=[48, 48]']
    """
    return [f"{name.replace('__', '.')}={toml_value(value)}" for name, value in overrides.items()]


def _key(name: Any) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", str(name)) else _quoted(str(name))


def _quoted(text: str) -> str:
    escaped = "".join(
        f"\\u{ord(letter):04x}" if letter < " " or letter == "\x7f" else "\\" + letter if letter in '"\\' else letter
        for letter in text)
    return f'"{escaped}"'
