#!/usr/bin/env python3
"""spread.py GATES.toml ONE.json OTHER.json...: do two builds of the program give the same numbers?

The JSON files are of `slipstick gate GATES.toml --json`, by builds with other compilers or options. Each gate says by how
much its number may differ between them (platform_spread); gates that do not say it show their differences. Exit code 0: all keep it; 1: some do
not; 2: the files do not belong together."""

import json
import math
import sys
import tomllib
from pathlib import Path


def values(path):
    return {gate["id"]: gate.get("value") for gate in json.loads(Path(path).read_text(encoding="utf-8"))["gates"]}


def gates_in(path):
    """The tables of all gates, with the keys of their groups."""
    read = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    return read.get("gate", []) + [{**group, **gate} for group in read.get("group", []) for gate in group["gate"]]


def difference(one, other):
    """The difference of two numbers; 0 for equal words."""
    numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in (one, other))
    return abs(one - other) if numbers else 0.0 if one == other else math.inf


def main(words):
    if len(words) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    allowed = {gate["id"]: gate.get("platform_spread") for gate in gates_in(words[0])}
    first, *others = map(values, words[1:])
    found = 0
    for path, other in zip(words[2:], others):
        if first.keys() != allowed.keys() or other.keys() != allowed.keys():
            print(f"{path}: has other gates than {words[0]}", file=sys.stderr)
            return 2
        worst = 0.0
        for name, spread in allowed.items():
            apart = difference(first[name], other[name])
            if spread is None:
                if apart:
                    print(f"{path}: {name}: {other[name]}, {words[1]} has {first[name]}; the gate has no platform_spread")
                found += apart == math.inf  # words, such as the parts that a model omits
            elif not apart <= spread:
                print(f"{path}: {name}: {other[name]}, {words[1]} has {first[name]}; allowed difference: {spread:g}")
                found += 1
            else:
                worst = max(worst, apart / spread)
        print(f"{path}: {len(allowed)} numbers; the largest allowed difference is {worst:.2g} of its platform_spread")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
