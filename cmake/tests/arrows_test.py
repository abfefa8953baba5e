"""arrows_test.py SOURCE_DIR: every include of a file is allowed for its folder by arrows.txt, and no folder has more than a
dozen units (a unit: a header, its source, or both)."""

import pathlib
import re
import sys

TOPS = ("analytic", "bench", "convergence", "docs/generator", "interfaces", "solver")
MAX_UNITS = 12
LARGER = {"analytic": 20}  # flat: each unit is one theory
OTHER_SIDE = {"analytic": ("solver", "convergence", "bench"), "solver": ("analytic", "convergence", "bench")}


def read_arrows(file):
    arrows = {}
    for line in file.read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            folder, _, allowed = line.partition("->")
            arrows[folder.strip()] = allowed.split()
    return arrows


def is_allowed(included, folder, allowed):
    target = included.rpartition("/")[0]
    return target == folder or any(
        included == entry or target == entry or (entry.endswith("/*") and (target + "/").startswith(entry[:-1]))
        for entry in allowed)


def violations(root, arrows):
    units = {}
    files = [file for top in TOPS for file in (root / top).rglob("*.[ch]pp")] + [root / "main.cpp"]
    for file in files:
        path = file.relative_to(root)
        folder = path.parent.as_posix()
        own = re.findall(r'^#include [<"]((?:%s)/[^">]+)[>"]' % "|".join((*TOPS, "cmake")), file.read_text(), re.MULTILINE)
        if "tests" in path.parts:
            for included in own:
                if included.split("/")[0] in OTHER_SIDE.get(path.parts[0], ()):
                    yield f"{path} includes {included}: the two sides never meet"
            continue
        units.setdefault(folder, set()).add(path.stem)
        if folder not in arrows:
            yield f"{path}: arrows.txt does not name the folder {folder}"
            continue
        for included in own:
            if not is_allowed(included, folder, arrows[folder]):
                yield f"{path} includes {included}: arrows.txt has no arrow from {folder} to there"
    for folder, names in sorted(units.items()):
        if len(names) > LARGER.get(folder, MAX_UNITS):
            yield f"{folder} holds {len(names)} units, allowed: {LARGER.get(folder, MAX_UNITS)}"
    for folder in arrows.keys() - units.keys():
        yield f"arrows.txt: nothing in {folder}"


if __name__ == "__main__":
    found = list(violations(pathlib.Path(sys.argv[1]), read_arrows(pathlib.Path(__file__).with_name("arrows.txt"))))
    sys.exit("\n".join(found) or 0)
