"""The scenes that come with the package."""
from __future__ import annotations

import re
from pathlib import Path

from .errors import InputError
from .result import unknown

#: Scenes, studies and gates, as in the source tree.
SHARE = Path(__file__).parent / "share" / "slipstick"


class _Listing(dict[str, str]):
    def __repr__(self) -> str:
        return "\n".join(f"{name:<22}{line}" for name, line in self.items())


def scenes() -> dict[str, str]:
    """The names of the package's scenes, each with one line about it.

    >>> "cone" in scenes() and scenes()["flat_punch"]
    'A flat-ended cylinder: the pressure is singular at the edge'
    """
    return _Listing({file.stem: _first_sentence(file) for file in sorted((SHARE / "convergence/scenes").glob("*.toml"))})


def scene(name: str) -> Path:
    """The file of one of the package's scenes, for solve() and check(); overrides change its keys.

    >>> scene("paper").name
    'paper.toml'
    """
    if name not in scenes():
        raise InputError(f"there is no scene {name}{unknown(name, scenes())}")
    return SHARE / "convergence/scenes" / f"{name}.toml"


def _first_sentence(file: Path) -> str:
    """Of the comment at the top."""
    lines = []
    for line in file.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.strip("# "))
    return re.split("[.;] ", " ".join(lines))[0].rstrip(".")
