#!/usr/bin/env python3
"""Writes the reference tables beside it: 50 digits, by direct quadrature and root-finding (mpmath).

Nothing here shares a series or a Carlson form with the C++ code. Every number is that of the exact value of the
double given, to 25 digits. Run it without arguments; it takes a minute or two.
"""

import pathlib

from mpmath import acos, agm, ellipe, inf, mp, mpf, nstr, pi, quad

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


def H(s):
    """K - E of modulus sqrt(1 - s^2); K by the arithmetic-geometric mean."""
    return pi / (2 * agm(1, s)) - E(s)


def scale():
    return 64 / (3 * pi**2)


def ratio(w):
    """M/M_lim at c = 1 - w."""
    return scale() * quad(lambda x: (1 - x) ** 2 * E(1 - x), [0, w / 2, w])


def deficit(c):
    """1 - M/M_lim."""
    return scale() * quad(lambda s: s * s * E(s), [0, c / 2, c])


def newton(x, step):
    for _ in range(60):
        dx = step(x)
        x += dx
        if abs(dx) < abs(x) * mpf(10) ** (-mp.dps * 2 // 3):
            return x
    raise RuntimeError("no convergence")


def stick(given, value):
    """(c, 1 - c) at the exact value of a double."""
    x = mpf(value)
    if given == "stick_ratio":
        return x, 1 - x
    if given == "stick_complement":
        return 1 - x, x
    if given == "twist":
        h = x * 4 * pi / 3
        if value < 0.1:
            w = newton(2 * h / pi, lambda w: (h - H(1 - w)) * (1 - w) / E(1 - w))
            return 1 - w, w
        t = newton(h * 2 / pi, lambda t: (h - H(mp.exp(-t))) / E(mp.exp(-t)))
        return mp.exp(-t), -mp.expm1(-t)
    small, other = (x, 1 - x) if given == "moment_ratio" else (1 - x, x)
    if small < 0.5:
        w = newton(3 * pi * small / 32, lambda w: (small - ratio(w)) / (scale() * (1 - w) ** 2 * E(1 - w)))
        return 1 - w, w
    c = newton((9 * pi**2 * other / 64) ** (mpf(1) / 3), lambda c: (other - deficit(c)) / (scale() * c * c * E(c)))
    return c, 1 - c


def torsion_row(given, value):
    """All of one state, and what a relative change of the value given costs each (|d ln y/d ln value|)."""
    c, w = stick(given, value)
    m = ratio(w) if w < 0.5 else 1 - deficit(c)
    d = deficit(c) if w >= 0.5 else 1 - m
    h = H(c)
    quantities = {"moment_ratio": m, "moment_deficit": d, "stick_ratio": c, "stick_complement": w, "twist": h}
    slopes = {  # d/dc
        "moment_ratio": scale() * c * c * E(c),
        "moment_deficit": scale() * c * c * E(c),
        "stick_ratio": mpf(1),
        "stick_complement": mpf(1),
        "twist": E(c) / c,
    }
    cost = {k: quantities[given] / slopes[given] * slopes[k] / quantities[k] for k in quantities}
    quantities["twist"] = 3 * h / (4 * pi)
    return (
        [given, repr(value)] + [quantities[k] for k in quantities] + [nstr(cost[k], 6) for k in quantities]
    )


def logarithmic(low, high):
    return [float(f"{lead}e{power}") for power in range(low, high) for lead in (1, 2, 5)]


def torsion_rows():
    mid = [i / 20 for i in range(2, 20)]
    near_one = [1 - 10.0**-n for n in range(2, 13)]
    small = [1e-30, 1e-20, 1e-16] + logarithmic(-12, -1)
    grids = {
        "moment_ratio": small + mid + near_one,
        "moment_deficit": small + mid + near_one,
        "stick_ratio": [1e-20] + logarithmic(-12, -1) + mid + [0.7071067811865475, 0.7071067811865476] + near_one,
        "stick_complement": small + mid + [0.2928932188134524, 0.2928932188134525] + near_one,
        "twist": small + mid + [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0],
    }
    for given, values in grids.items():
        for value in values:
            extreme = value < 1e-13 or (given == "twist" and value > 4)
            with mp.workdps(150 if extreme else GUARD):
                yield torsion_row(given, value)


def elliptic_rows():
    moduli = [1e-300, 1e-150, 1e-50, 1e-20] + logarithmic(-12, 0)
    moduli += [0.999e-9, 1.001e-9, 0.3, 0.7, 0.9, 0.99, 0.9999, 1 - 1e-8, 1 - 1e-12, 1 - 2.0**-53]
    for value in sorted(moduli):
        with mp.workdps(GUARD + int(max(0, -2.2 * mp.log10(value)))):
            s = mpf(value)
            k, e = pi / (2 * agm(1, s)), E(s)
            yield [repr(value), k, e, (k - e) / (1 - s * s)]


def traction(c, r):
    """(2/pi) r integral_c^1 E/(s sqrt(s^2 - r^2)) ds, with s = r/cos(angle)."""
    return 2 / pi * quad(lambda angle: E(r / mp.cos(angle)), mp.linspace(acos(r / c), acos(r), 4))


def traction_rows():
    ratios = [1e-12, 0.999e-9, 1.001e-9, 1e-8, 5e-7, 1e-3, 0.05, 0.23696619252966424, 0.4958950522157781, 0.8135681261276496, 0.95, 0.999, 1 - 1e-6]
    for c in ratios:
        fractions = [1e-12, 1e-6, 1e-3, 0.05, 0.3, 0.6, 0.9, 0.99, 0.9999, 1 - 1e-6, 1 - 1e-9, 1 - 1e-13]
        for r in sorted({c * f for f in fractions}):
            with mp.workdps(GUARD):
                yield ["stick_ratio", repr(c), repr(r), traction(mpf(c), mpf(r))]
    for w in [1e-12, 1e-9, 1e-4, 0.01, 0.3]:
        for r in [1e-9, 0.1, 0.5, 0.9 * (1 - w), 1 - 2 * w, 1 - 1.001 * w]:
            if 0 < r < mpf(1) - mpf(w):
                with mp.workdps(GUARD):
                    yield ["stick_complement", repr(w), repr(r), traction(1 - mpf(w), mpf(r))]


def main():
    names = ["moment_ratio", "moment_deficit", "stick_ratio", "stick_complement", "twist"]
    write(
        "torsion_references.csv",
        "States of the sphere in torsion; a cost is |d ln y/d ln value|.",
        ["given", "value"] + names + [f"cost_{name}" for name in names],
        torsion_rows(),
    )
    write(
        "elliptic_references.csv",
        "Complete elliptic integrals of the complementary modulus.",
        ["complementary_modulus", "k", "e", "d"],
        elliptic_rows(),
    )
    write(
        "traction_references.csv",
        "Traction in the stick zone, q/(mu p0).",
        ["given", "value", "radius", "traction"],
        traction_rows(),
    )


if __name__ == "__main__":
    main()
