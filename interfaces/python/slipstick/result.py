"""Results of the program (docs/reference/results.md), with attributes."""
from __future__ import annotations

import copy
import html
from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from typing import Any


def unknown(name: str, names: Iterable[str]) -> str:
    """The end of a message on a name that does not exist: the name that is most like it, else all of them."""
    known = list(names)
    found = get_close_matches(name, known, 1, 0.5)
    return f"; the nearest name is {found[0]}" if found else f"; allowed: {', '.join(known) or 'none'}"


def _wrapped(value: Any) -> Any:
    if isinstance(value, dict):
        return Result(value)
    if isinstance(value, list):
        return [_wrapped(part) for part in value]
    return value


class Result(Mapping[str, Any]):
    """A JSON object: result.certificate.gap is result["certificate"]["gap"]. A number that does not exist is None, and
    `reason` gives the reason. SI units, angles in rad.

    >>> result = Result({"twist": 0.1, "certificate": {"gap": None, "gap_reason": "nothing slips"}})
    >>> result.twist, result.certificate.gap, result.certificate.reason("gap")
    (0.1, None, 'nothing slips')
    >>> result.twst
    Traceback (most recent call last):
    AttributeError: the result has no twst; the nearest name is twist
    """

    def __init__(self, data: dict[str, Any]) -> None:
        self._data = data

    def __getitem__(self, key: str) -> Any:
        return _wrapped(self._data[key])

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._data:
            known = [key for key in self.__dict__.get("_data", {}) if not key.endswith("_reason")]
            raise AttributeError(f"the result has no {name}{unknown(name, known)}")
        return self[name]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._data]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{key}={value!r}' for key, value in self._numbers())})"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{html.escape(key)}</th><td>{html.escape(_shown(value))}</td></tr>"
                       for key, value in self._numbers())
        return f"<table>{rows}</table>"

    def _numbers(self) -> list[tuple[str, Any]]:
        """The values that fit on a line: no tables and no lists of tables."""
        return [(key, value) for key, value in self._data.items()
                if not isinstance(value, dict) and not key.endswith("_reason")
                and not (isinstance(value, list) and value and isinstance(value[0], (dict, list)))]

    def reason(self, key: str) -> str | None:
        """The reason why a number is missing; None if it exists."""
        return self._data.get(f"{key}_reason")

    def to_dict(self) -> dict[str, Any]:
        """A copy of the whole result, as dicts and lists."""
        return copy.deepcopy(self._data)

    def to_frame(self, key: str | None = None) -> Any:
        """A list of the result (the only one, or the one with this key: steps, rows, gates) as a pandas.DataFrame with one row
        for each entry; names of nested numbers are joined by dots. Needs pandas."""
        import pandas

        lists = {name: value for name, value in self._data.items()
                 if isinstance(value, list) and value and isinstance(value[0], dict)}
        if key is None and len(lists) == 1:
            key = next(iter(lists))
        if key not in lists:
            raise KeyError(f"{key}; allowed: {', '.join(lists) or 'none, the result has no table'}")
        return pandas.json_normalize(lists[key])


def _shown(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else "-" if value is None else str(value)
