"""The documentation, README.md and docs/**/*.md, for its tests."""
import pathlib
import re

FENCE = re.compile(r"^(`{3,})(\w*)\n(.*?)^\1\s*$", re.S | re.M)


def pages(root):
    """Paths of all pages, the README first."""
    return [root / "README.md", *sorted((root / "docs").rglob("*.md"))]


def without_blocks(text):
    """The text with fenced blocks and comments blanked, line by line, so that line numbers stay the same."""
    def blank(match):
        return "\n" * match.group().count("\n")

    return re.sub(r"<!--.*?-->", blank, FENCE.sub(blank, text), flags=re.S)


def line_of(text, place):
    return text.count("\n", 0, place) + 1


def relative(page, root):
    return pathlib.Path(page).relative_to(root).as_posix()
