#!/usr/bin/env python3
"""make_references.py [elliptic | profile]: writes elliptic_references.csv, 50 digits, and profile_references.csv, profiles made
of flat punches (mpmath). States and tractions stand in certified_references.csv.

The quadratures are over plain radii, split where the integrand changes, with Legendre's integrals; no series and no Carlson
form is shared with the C++ code. Every number belongs to the exact values of the given doubles. The profiles take some minutes,
on all processors.
"""

import multiprocessing
import pathlib
import sys

from mpmath import acos, acosh, agm, ellipe, ellippi, inf, log, mp, mpf, nstr, pi, quad, sqrt

HERE = pathlib.Path(__file__).parent
DIGITS = 40
GUARD = 60  # digits that elliptic integrals are computed with; more for arguments that need them

PROFILES = [("power", n) for n in (0.01, 0.5, 1.5, 4.0, 30.0, 1000.0)]
PROFILES += [("rounded_punch", b) for b in (0.001, 0.5, 0.95, 0.999999999)]
STICKS = [("stick_ratio", c) for c in (1e-6, 0.001, 0.3, 0.7, 0.97)] + [("stick_complement", 1e-6)]
INWARD = {"centre": 0.99, "middle": 0.1, "front": 1e-9}  # 1 - r/c


def digits(x, count=22):
    return nstr(x, count, min_fixed=-inf if x == 0 else 0, max_fixed=0)


def K(s):
    """Elliptic integral of modulus sqrt(1 - s^2)."""
    return pi / (2 * agm(1, s))


def B(s):
    """(E - s^2 K)/(1 - s^2), modulus sqrt(1 - s^2); leading terms where it would cancel, or E lose s."""
    m = 1 - s * s
    if m < mpf(10) ** -14:
        return pi / 4 * (1 + m / 8 + 3 * m * m / 64)
    if s < mpf(10) ** -14:
        return 1 - s * s * (log(4 / s) - mpf(3) / 2)
    return (ellipe(m) - s * s * K(s)) / m


def punch_traction(x, c, inside, r):
    """q of a flat punch of radius x, inside = c^2 - r^2."""
    rim = x * x - r * r
    slip = x * x - c * c
    return 2 / pi * r * sqrt(inside) / rim / x * ellippi(slip / rim, slip / x**2)


class Power:
    flat = 0

    def __init__(self, n):
        self.n = mpf(n)
        self.steep = [k / self.n for k in (1, 2, 4, 8, 16, 32, 64, 128)] if n > 10 else []

    def weight(self, x):
        return x ** (self.n - 1)

    def second_moment(self, x):
        """integral of w x^2 up to x."""
        return x ** (self.n + 2) / (self.n + 2)


class RoundedPunch:
    steep = []

    def __init__(self, b):
        self.flat = b = mpf(b)
        self.norm = 1
        self.norm = 2 * quad(lambda x: self.weight(x) * x, split(b, 1, 1 - b))

    def weight(self, x):
        b = self.flat
        return (2 * sqrt(x * x - b * b) - b * acos(b / x)) / self.norm if x > b else mpf(0)

    def second_moment(self, x):
        b = self.flat
        if x <= b:
            return mpf(0)
        s = sqrt(x * x - b * b)
        u = acosh(x / b)
        root = x * (2 * x * x - b * b) * s / 4 - b**4 * u / 4
        angle = x**3 * acos(b / x) / 3 - b * (x * s + b * b * u) / 6
        return (root - b * angle) / self.norm


def split(low, high, near, steep=()):
    """Break points by decades off `low`, from `near` on; and off `high` for a steep power."""
    points = {mpf(low), mpf(high)} | {high - x for x in steep}
    while near < high - low:
        points.add(low + near)
        near *= 10
    return sorted(p for p in points if low <= p <= high)


def moments(profile, c):
    """M/M_lim and 1 - M/M_lim: V(x) = integral of w x^2 up to x, s = c/x, and integrals exchanged."""
    V = profile.second_moment
    whole = V(mpf(1)) * pi**2 / 2

    def f(s):
        return s * s * B(s)

    b = profile.flat
    cuts = {c, mpf(1)} | {c + (1 - c) * mpf(10) ** -k for k in range(1, 4)} | {c * (1 + x) for x in profile.steep}
    cuts |= {c * mpf(10) ** k for k in range(1, 13)} | ({c / b} if b > c else set())
    cuts = sorted(x for x in cuts if c <= x <= 1)

    def most(s):
        return V(min(mpf(1), c / s))

    lacking = mpf(8) / 3 * (quad(f, [0, c / 2, c]) * (V(mpf(1)) - V(c)) + quad(lambda s: f(s) * (most(s) - V(c)), cuts))
    lacking += pi**2 / 2 * V(c)
    reached = mpf(8) / 3 * (quad(lambda s: f(s) * (V(mpf(1)) - most(s)), cuts) + pi / 2 * (V(mpf(1)) - V(c)))
    assert abs(lacking + reached - whole) < whole * mpf(10) ** -22, (profile.flat, c, (lacking + reached) / whole)
    return reached / whole, lacking / whole


def row(task):
    (kind, parameter), (given, value) = task
    mp.dps = DIGITS
    profile = {"power": Power, "rounded_punch": RoundedPunch}[kind](parameter)
    w = profile.weight
    c = mpf(value) if given == "stick_ratio" else 1 - mpf(value)
    start = max(c, profile.flat)
    near = abs(c - profile.flat) or mpf(10) ** -12

    points = split(start, 1, near, profile.steep)
    twist = quad(lambda x: w(x) / x * K(c / x), points)
    slope = quad(lambda x: w(x) / x * B(c / x), points) + (pi / 2 * w(c) if c > profile.flat else 0)
    tractions = []
    for fraction in INWARD.values():
        inward = mpf(float(c) * fraction)
        r = c - inward
        inside = inward * (c + r)
        points = split(start, 1, inward if start == c else near, profile.steep)
        tractions.append(quad(lambda x: w(x) * punch_traction(x, c, inside, r), points))
    numbers = (twist, slope, *moments(profile, c), pressure(profile, mpf(float(c))), *tractions)
    return [kind, repr(parameter), given, repr(value)] + [digits(x) for x in numbers]


def pressure(profile, r):
    """x = sqrt(r^2 + h^2) takes away the root at r."""
    low = sqrt(max(profile.flat, r) ** 2 - r * r)
    high = sqrt(1 - r * r)
    steep = [h for h in profile.steep if h < high]
    near = max(abs(r - profile.flat), mpf(10) ** -12)
    return quad(lambda h: profile.weight(sqrt(r * r + h * h)) / sqrt(r * r + h * h), split(low, high, near, steep))


def profiles():
    tasks = [(profile, stick) for profile in PROFILES for stick in STICKS]
    with multiprocessing.Pool() as pool:
        rows = pool.map(row, tasks, chunksize=1)
    columns = ["profile", "parameter", "given", "value", "twist_integral", "twist_slope", "moment_ratio"]
    columns += ["moment_deficit", "pressure"] + [f"traction_{name}" for name in INWARD]
    write("profile", "Profiles made of flat punches.", columns, rows)


def elliptic():
    moduli = [1e-300, 1e-150, 1e-50, 1e-20] + [float(f"{lead}e{power}") for power in range(-12, 0) for lead in (1, 2, 5)]
    moduli += [0.999e-9, 1.001e-9, 0.3, 0.7, 0.9, 0.99, 0.9999, 1 - 1e-8, 1 - 1e-12, 1 - 2.0**-53]
    rows = []
    for value in sorted(moduli):
        with mp.workdps(GUARD + int(max(0, -2.2 * mp.log10(value)))):
            s = mpf(value)
            k, e = K(s), ellipe(1 - s * s)
            rows.append([repr(value), *(digits(x, 25) for x in (k, e, (k - e) / (1 - s * s)))])
    write("elliptic", "Complete elliptic integrals of the complementary modulus.", ["complementary_modulus", "k", "e", "d"], rows)


def write(name, about, columns, rows):
    with open(HERE / f"{name}_references.csv", "w", encoding="ascii") as file:
        file.write(f"# {about} Made by make_references.py (mpmath).\n")
        file.writelines(",".join(line) + "\n" for line in [columns, *rows])


if __name__ == "__main__":
    for name in sys.argv[1:] or ("elliptic", "profile"):
        {"elliptic": elliptic, "profile": profiles}[name]()
