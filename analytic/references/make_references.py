#!/usr/bin/env python3
"""Writes elliptic_references.csv: 50 digits (mpmath). States and tractions stand in certified_references.csv.

It shares no series and no Carlson form with the C++ code. Every number belongs to the exact value of the given
double, to 25 digits. Run it without arguments.
"""

import pathlib

from mpmath import agm, ellipe, inf, mp, mpf, nstr, pi

HERE = pathlib.Path(__file__).parent
GUARD = 60  # digits worked with; more for arguments that need them


def digits(x):
    return nstr(x, 25, min_fixed=-inf if x == 0 else 0, max_fixed=0)


def write(name, about, columns, rows):
    with open(HERE / name, "w", encoding="ascii") as file:
        file.write(f"# {about} Made by make_references.py (mpmath, 50 digits).\n")
        file.write(",".join(columns) + "\n")
        for row in rows:
            file.write(",".join(x if isinstance(x, str) else digits(x) for x in row) + "\n")


def E(s):
    """Complete elliptic integral of the second kind, of modulus sqrt(1 - s^2)."""
    return ellipe(1 - s * s)


def logarithmic(low, high):
    return [float(f"{lead}e{power}") for power in range(low, high) for lead in (1, 2, 5)]


def elliptic_rows():
    moduli = [1e-300, 1e-150, 1e-50, 1e-20] + logarithmic(-12, 0)
    moduli += [0.999e-9, 1.001e-9, 0.3, 0.7, 0.9, 0.99, 0.9999, 1 - 1e-8, 1 - 1e-12, 1 - 2.0**-53]
    for value in sorted(moduli):
        with mp.workdps(GUARD + int(max(0, -2.2 * mp.log10(value)))):
            s = mpf(value)
            k, e = pi / (2 * agm(1, s)), E(s)
            yield [repr(value), k, e, (k - e) / (1 - s * s)]


def main():
    write(
        "elliptic_references.csv",
        "Complete elliptic integrals of the complementary modulus.",
        ["complementary_modulus", "k", "e", "d"],
        elliptic_rows(),
    )


if __name__ == "__main__":
    main()
