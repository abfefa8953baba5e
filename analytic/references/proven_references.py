#!/usr/bin/env python3
"""proven_references.py PROGRAM table | search [--samples N] [--seed S] | check: the values of `slipstick exact
--certified`, as tests of code in doubles compare with them. Doubles are meant exactly, and are handed over in hexadecimal.

table writes certified_references.csv again. search looks for inputs at which double precision is farther off than at those
in hardest/, in units of the allowed error, and adds them; no row is ever dropped. check makes a sample of the table's rows again
(SLIPSTICK_TEST_ALL=1: all) and fails where one differs."""

import argparse
import csv
import json
import math
import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal, getcontext
from pathlib import Path

HERE = Path(__file__).parent
ABOUT = ("# Proven values at doubles, each meant exactly; cost is |d ln quantity/d ln value|, of a traction its sum over value "
         "and at. Made by proven_references.py {}.\n")
COLUMNS = ["profile", "given", "value", "quantity", "at", "reference", "bound", "cost"]
QUANTITIES = ["moment_deficit", "moment_ratio", "stick_complement", "stick_ratio", "twist"]
DIGITS, COST_DIGITS = 30, 60  # what a double's neighbour changes has 40 of the latter left
EPS = Decimal(2)**-52
getcontext().prec = 2 * COST_DIGITS

SMALL = [1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.05]
MIDDLE = [0.1, 0.2, 0.3, 0.4, 0.5, 0.53, 0.6, 0.7, 0.8, 0.85, 0.9]
LARGE = [0.95, 0.99, 0.994, 0.999, 0.9999, 1 - 1e-6, 1 - 1e-9, 1 - 1e-12]
VALUES = {"moment_deficit": [1e-90, 1e-36, 1e-24, 1e-18] + SMALL + MIDDLE + LARGE, "moment_ratio": [1e-100] + SMALL + MIDDLE + LARGE,
          "stick_complement": [1e-300, 1e-100, 1e-30, 1e-18] + SMALL + MIDDLE + LARGE,
          "stick_ratio": [1e-100, 1e-30] + SMALL + MIDDLE + LARGE, "twist": [1e-100] + SMALL + MIDDLE + [1.0, 1.5, 2.0, 3.0, 5.0]}
# Both sides of where a flat punch begins to slip, M/M_lim = 8/(3 pi).
PUNCH_VALUES = {"moment_deficit": [0.16, 0.152, 0.1512, 0.15117364, 0.15117363, 0.1511, 0.151, 0.14, 0.13],
                "moment_ratio": [0.84, 0.848, 0.8488, 0.84882636, 0.84882637, 0.8489, 0.849, 0.86, 0.87],
                "twist": [0.124, 0.1249999, 0.1250001, 0.126, 0.13, 0.15]}
POWER_VALUES = {"moment_deficit": [1e-12, 1e-4], "moment_ratio": [1e-6, 0.1, 0.5, 0.9, 0.99], "stick_complement": [1e-9, 0.01],
                "stick_ratio": [1e-3, 0.3, 0.7, 0.99], "twist": [1e-3, 0.1, 0.5]}
# Where tractions are tabulated: stick radii and, of each, parts inside; beyond it two more.
FRONTS = {"stick_complement": [1e-12, 1e-6],
          "stick_ratio": [1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.99, 0.9999]}
POWER_FRONTS = {"stick_ratio": [1e-3, 0.3, 0.9]}
INSIDE = [1e-6, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.999]

# The given quantity, and whether tractions are computed, at a part of the stick radius.
FUNCTIONS = [(given, False) for given in QUANTITIES] + [("stick_ratio", True), ("stick_complement", True)]


def shortest(x):
    return repr(x).removesuffix(".0")


def stick_ratio(given, value):
    return value if given == "stick_ratio" else 1 - value


def slope(y0, y1, x0, x1):
    """|d ln y/d ln x|"""
    x0, x1 = Decimal(x0), Decimal(x1)
    return abs((y1 - y0) / (y1 + y0) * (x0 + x1) / (x1 - x0)) if y0 + y1 else Decimal(0)


class References:
    def __init__(self, program):
        self.program = Path(program).resolve()

    def state(self, profile, given, value, radii=(), digits=None):
        words = [self.program, "exact", "--profile", profile, "--" + given.replace("_", "-"), value.hex(), "--json", "-"]
        words += ["--certified", str(digits)] if digits else []
        words += ["--radius", ",".join(r.hex() for r in radii)] if radii else []
        run = subprocess.run(words, capture_output=True, text=True)
        return json.loads(run.stdout) if run.returncode == 0 else None  # outside the range of the function

    def beside(self, profile, given, value, radii=()):
        """The value's neighbours among the doubles, and their states."""
        ends = math.nextafter(value, 0), math.nextafter(value, math.inf)
        return ends, [self.state(profile, given, end, radii, COST_DIGITS) for end in ends]

    def state_rows(self, profile, given, value):
        proven = self.state(profile, given, value, digits=DIGITS)
        ends, states = self.beside(profile, given, value)
        if None in (proven, *states):
            return []
        costs = {q: float(slope(*(Decimal(state[q]["value"]) for state in states), *ends)) for q in QUANTITIES}
        return [[profile, given, shortest(value), q, "", *proven[q].values(), f"{costs[q]:.3g}"] for q in QUANTITIES if q != given]

    def traction_rows(self, profile, given, value, radii):
        def tractions(state):
            return [Decimal(at["value"]["value"]) for at in state["traction"]]
        proven = self.state(profile, given, value, radii, DIGITS)
        ends, states = self.beside(profile, given, value, radii)
        around = [(math.nextafter(r, 0), math.nextafter(r, 1)) for r in radii]
        along = self.state(profile, given, value, [r for pair in around for r in pair], COST_DIGITS)
        if None in (proven, along, *states):
            return []
        (low, high), beside = map(tractions, states), tractions(along)
        rows = []
        for i, r in enumerate(radii):
            cost = float(slope(low[i], high[i], *ends)) + float(slope(beside[2 * i], beside[2 * i + 1], *around[i]))
            rows.append([profile, given, shortest(value), "traction", shortest(r), *proven["traction"][i]["value"].values(), f"{cost:.3g}"])
        return rows

    def table(self):
        def states(profile, inputs):
            return [lambda g=given, v=value: self.state_rows(profile, g, v) for given in inputs for value in inputs[given]]
        def tractions(profile, fronts):
            for given, value in ((given, value) for given in fronts for value in fronts[given]):
                c = stick_ratio(given, value)
                radii = [part * c for part in INSIDE] + [r for r in ((1 + c) / 2, 1 - 1e-6) if r > c]
                yield lambda g=given, v=value, r=radii: self.traction_rows(profile, g, v, r)
        jobs = []
        for profile in ("hertz", "cone", "flat_punch", "constant"):
            jobs += states(profile, VALUES) + (states(profile, PUNCH_VALUES) if profile == "flat_punch" else [])
            jobs += tractions(profile, FRONTS)
        for profile in ("power:4", "power:1.5", "power:0.5", "power:8"):
            jobs += [*states(profile, POWER_VALUES), *tractions(profile, POWER_FRONTS)]
        return [row for rows in together(lambda job: job(), jobs) for row in rows]

    def made_again(self, row):
        profile, given, value, quantity, at = row[:5]
        if quantity == "traction":
            return self.traction_rows(profile, given, float(value), [float(at)])[0]
        return next(made for made in self.state_rows(profile, given, float(value)) if made[3] == quantity)

    def hardness(self, row):
        """The error of double precision over what is allowed: 8 units of rounding, or 4 times what one of the input costs."""
        profile, given, value, quantity, at, reference, _, cost = row
        found = self.state(profile, given, float(value), [float(at)] if at else [])
        value = found["traction"][0]["value"] if at else found[quantity]
        error = abs(Decimal(value) / Decimal(reference) - 1) if Decimal(reference) else Decimal(value)
        return float(error / EPS) / max(8, 4 * float(cost))

    def hardest_of(self, profile, function, inputs):
        """By quantity, the hardest of these inputs: hardness, input, row."""
        given, traction = function
        def tried(at):
            value, part = at
            rows = (self.traction_rows(profile, given, value, [part * stick_ratio(given, value)]) if traction else
                    self.state_rows(profile, given, value))
            return [(self.hardness(row), at, row) for row in rows]
        found = {}
        for candidate in (one for several in together(tried, inputs) for one in several):
            found[candidate[2][3]] = max(candidate, found.get(candidate[2][3], (0, None, None)), key=lambda c: c[0])
        return found

    def search(self, samples, seed):
        for given, traction in FUNCTIONS:
            file = HERE / "hardest" / ("traction.csv" if traction else given + ".csv")
            rows = read(file)
            for profile in ("hertz", "cone", "flat_punch"):
                chance = random.Random(seed)
                found = self.hardest_of(profile, (given, traction), [drawn(given, chance) for _ in range(samples)])
                for hard in list(found.values()):
                    for quantity, other in self.hardest_of(profile, (given, traction), [near(hard[1], chance) for _ in range(30)]).items():
                        found[quantity] = max(found.get(quantity, other), other, key=lambda c: c[0])
                for quantity, (hardness, _, row) in found.items():
                    known = [self.hardness(old) for old in rows if (old[0], old[3]) == (profile, quantity)]
                    if hardness > max(known, default=0):
                        rows.append(row)
            write(file, "search, which never drops a row", rows)


def drawn(given, chance):
    """An input uniform in the range, or close to either end by logarithm, and a part of the stick radius."""
    def place():
        close = 10**(-15 * chance.random())
        return chance.choice([chance.random(), close, 1 - close])
    value, part = place(), place()
    if given == "twist":
        value *= 3 * chance.random()
    return min(max(value, 1e-16), 1 - 1e-16), min(max(part, 1e-12), 1 - 1e-13)


def near(at, chance):
    """The same input, changed a little."""
    step = 10**(-2 - 13 * chance.random()) * chance.uniform(-1, 1)
    return min(at[0] * (1 + step), 1 - 1e-16), at[1]


def together(function, jobs):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(function, jobs))


def read(file):
    return list(csv.reader(file.read_text(encoding="ascii").splitlines()[2:])) if file.exists() else []


def write(file, made_by, rows):
    file.write_text(ABOUT.format(made_by) + "".join(",".join(row) + "\n" for row in [COLUMNS, *rows]), encoding="ascii")


def main():
    arguments = argparse.ArgumentParser(usage=__doc__)
    arguments.add_argument("program")
    arguments.add_argument("task", choices=["table", "search", "check"])
    arguments.add_argument("--samples", type=int, default=300)
    arguments.add_argument("--seed", type=int, default=1)
    options = arguments.parse_args()
    references = References(options.program)
    file = HERE / "certified_references.csv"
    if options.task == "table":
        write(file, "table", references.table())
    elif options.task == "search":
        references.search(options.samples, options.seed)
    else:
        rows = read(file)[::1 if os.environ.get("SLIPSTICK_TEST_ALL") == "1" else 37]
        wrong = [(row, made) for row, made in zip(rows, together(references.made_again, rows)) if row != made]
        for row, made in wrong:
            print(f"in the table: {row}\nmade again:   {made}")
        sys.exit(1 if wrong or not rows else 0)


if __name__ == "__main__":
    main()
