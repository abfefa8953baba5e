#!/usr/bin/env python3
"""exact_errors.py PROGRAM FILE.json: how far `slipstick exact` is from the values of certified_references.csv (proven),
of profile_references.csv and, for a table, of closed forms, at 20 states of each profile. Writes the largest error of
each quantity, relative, in units of rounding (2^-52); null where the program gives no number. Values that the rounding
of their argument could change by more are skipped.
"""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile
from decimal import Decimal

STATES = 20
MAX_COST = 2.5  # |d ln quantity/d ln argument|: half a unit of the argument then costs 1.25 units
UNIT = Decimal(2) ** -52
PI = Decimal("3.14159265358979323846264338328")
LINEAR = "linear.csv"
QUANTITIES = {
    "moment": ("moment_ratio", "moment_deficit", "moment"),
    "stick_radius": ("stick_ratio", "stick_complement"),
    "twist": ("twist",),
    "traction": ("traction",),
}


def moment_limit(profile):
    """Over mu W a; N = 2 and 1 of the gap r^N are sphere and cone."""
    if profile == "flat_punch":
        return PI / 4
    if profile == "constant":
        return Decimal(2) / 3
    n = Decimal({"hertz": "2", "cone": "1"}.get(profile) or profile.partition(":")[2])
    return PI / 4 * (n + 1) / (n + 2)


def table(name):
    with open(pathlib.Path(__file__).parent / name, encoding="ascii", newline="") as file:
        next(file)
        yield from csv.DictReader(file)


def references():
    """(profile, given, value), quantity, radius of a traction, reference."""
    for row in table("certified_references.csv"):
        if float(row["cost"]) > MAX_COST:
            continue
        state = row["profile"], row["given"], row["value"]
        yield state, row["quantity"], row["at"], Decimal(row["reference"])
        if row["quantity"] == "moment_ratio":
            yield state, "moment", "", moment_limit(row["profile"]) * Decimal(row["reference"])
    for row in table("profile_references.csv"):
        if row["profile"] != "rounded_punch":
            continue
        profile = f"rounded_punch:{row['parameter']}"
        state = profile, row["given"], row["value"]
        yield state, "twist", "", Decimal(row["twist_integral"]) / (2 * PI)
        for quantity in ("moment_ratio", "moment_deficit"):
            yield state, quantity, "", Decimal(row[quantity])
        if Decimal(row["moment_deficit"]) < Decimal("0.5"):  # the way back costs no digits
            deficit = repr(float(row["moment_deficit"]))
            yield (profile, "moment_deficit", deficit), row["given"], "", Decimal(row["value"])
    for k in range(STATES):  # doubles, and so exact as written
        state = f"file:{LINEAR}", "stick_ratio", str(Decimal(1 + 50 * k) / 1024)
        yield state, "twist", "", linear_twist(Decimal(state[2]))


def linear_twist(c):
    """The twist under the pressure 3 (1 - r), which a table reproduces: H over 2 pi."""
    x = (1 - c * c).sqrt()
    return 3 * ((1 + x).ln() - c.ln() - x) / (2 * PI)


def error(value, reference):
    if value is None or not math.isfinite(value):
        return math.inf
    if reference == 0:
        return 0.0 if value == 0 else math.inf
    return float(abs(Decimal(value) / reference - 1) / UNIT)


def errors(program, folder, state, rows):
    """quantity and error, in units of rounding."""
    profile, given, value = state
    radii = [at for _, at, _ in rows if at]
    words = [program, "exact", "--profile", profile, "--" + given.replace("_", "-"), value, "--quiet", "--json", "-"]
    if radii:
        words += ["--radius", ",".join(radii)]
    found = json.loads(subprocess.run(words, check=True, cwd=folder, stdout=subprocess.PIPE).stdout)
    tractions = iter(found["traction"])
    for quantity, at, reference in rows:
        yield quantity, error(next(tractions)["value"] if at else found[quantity], reference)


def spread(names):
    """Names at equal distances in the table."""
    return [names[k * len(names) // STATES] for k in range(STATES)] if len(names) > STATES else names


def worst_errors(program, folder):
    """By profile and quantity."""
    rows = "".join(f"{k / 16},{3 - 3 * k / 16}\n" for k in range(17))
    pathlib.Path(folder, LINEAR).write_text("radius,pressure\n" + rows, encoding="ascii")
    profiles = {}
    for state, *row in references():
        profiles.setdefault(state[0].partition(":")[0], {}).setdefault(state, []).append(row)
    worst = {}
    for profile, states in profiles.items():
        if len(states) < STATES:
            sys.exit(f"exact_errors.py: {profile} has {len(states)} states, fewer than {STATES}")
        with_tractions = [state for state, rows in states.items() if any(at for _, at, _ in rows)]
        every = {}
        for state in dict.fromkeys([*spread(list(states)), *spread(with_tractions)]):
            for quantity, size in errors(program, folder, state, states[state]):
                every.setdefault(quantity, []).append(size)
        worst[profile] = {}
        for name, quantities in QUANTITIES.items():
            sizes = [size for quantity in quantities for size in every.get(quantity, [])]
            if sizes:
                worst[profile][name] = max(sizes) if math.isfinite(max(sizes)) else None
    return worst


def main(program, output):
    with tempfile.TemporaryDirectory(prefix="slipstick-exact-") as folder:
        worst = worst_errors(pathlib.Path(program).absolute(), folder)
    pathlib.Path(output).parent.mkdir(parents=True, exist_ok=True)
    pathlib.Path(output).write_text(json.dumps({"states": STATES, "worst": worst}, indent=2) + "\n", encoding="ascii")


if __name__ == "__main__":
    main(*sys.argv[1:])
