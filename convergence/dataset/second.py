"""The second path of each exact value: integrals over the friction bound, in 36 decimal digits (mpmath).

It calls no function of slipstick and takes only the definitions from docs/theory.md. A bound f(r), over its
reference p0 and with a = 1, is a superposition of constant bounds on discs: with y = sqrt(1 - r^2) and f = F(y),
    f(r) = F(0) + integral_0^y F'(x) dx,
and twist, moment and traction are the same superposition of Tresca's closed forms. The flat and the rounded punch are
superpositions of bonded punches instead (analytic/references/make_references.py).
"""

import sys
from functools import lru_cache
from pathlib import Path

import numpy as np
from mpmath import mp, mpf
from scipy import special

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "analytic/references"))
import make_references as punches  # noqa: E402

DIGITS = 36
TRACTION_DIGITS = 26
mp.dps = DIGITS


class Discs:
    """A bound as a superposition of constant bounds. slope: F'(y, r); edge: F(0); kink: a y at which the slope jumps."""

    def __init__(self, slope, edge=0, kink=None, exponent=None):
        self.slope, self.edge, self.kink, self.exponent = slope, mpf(edge), kink, exponent

    def _sum(self, part, c, complement, near=()):
        """integral of F'(y) part(t, w) dy over the discs t = sqrt(1 - y^2) > c, w = sqrt(t^2 - c^2), and the edge's part. With
        y = Y sin(root^2) neither a root at w = 0 nor F' ~ y^(-1/2) is left."""
        Y = mp.sqrt(complement * (1 + c))

        def integrand(root):
            angle = root * root
            y, w = Y * mp.sin(angle), Y * mp.cos(angle)
            t = mp.sqrt(c * c + w * w)
            return 2 * root * self.slope(y, t) * part(t, w) * w
        cuts = [mpf(0), mp.pi / 2]
        if self.kink is not None and self.kink < Y:
            cuts.append(mp.asin(self.kink / Y))
        cuts += [mp.pi / 2 - mp.asin(w / Y) for w in (*near, *(c * 10**k for k in range(6))) if w < Y / 2]
        return mp.quad(integrand, sorted(mp.sqrt(angle) for angle in cuts)) + self.edge * part(mpf(1), Y)

    def height(self, c, complement):
        """H(c) = integral of f(r)/sqrt(r^2 - c^2) dr."""
        return self._sum(lambda t, w: mp.asinh(w / c), c, complement)

    def moment(self, c, complement):
        return self._sum(lambda t, w: mpf(4) / 3 * t**3 * (mp.atan2(w, c) + c * w / t**2), c, complement)

    @lru_cache(maxsize=None)
    def limit(self):
        if self.exponent:
            return mp.pi**2 / (2 * (self.exponent + 2))
        return 2 * mp.pi / 3 * (self._moments(3) + self.edge)

    @lru_cache(maxsize=None)
    def load(self):
        if self.exponent:
            return 2 * mp.pi / (self.exponent + 1)
        return mp.pi * (self._moments(2) + self.edge)

    def _moments(self, order):
        cuts = [mpf(0), *([mp.asin(self.kink)] if self.kink is not None else []), mp.pi / 2]
        return mp.quad(lambda u: 2 * u * self.slope(mp.sin(u * u), mp.cos(u * u)) * mp.cos(u * u)**(order + 1), [mp.sqrt(x) for x in cuts])

    def bound(self, r):
        y = mp.sqrt((1 - r) * (1 + r))
        cuts = sorted({mpf(0), y} | ({self.kink} if self.kink is not None and self.kink < y else set()))
        return mp.quad(lambda u: 2 * u * self.slope(u * u, mp.sqrt(1 - u**4)), [mp.sqrt(x) for x in cuts]) + self.edge

    def traction(self, r, c, complement):
        if r >= c:
            return self.bound(r)
        depth = mp.sqrt((c - r) * (c + r))
        return self._sum(lambda t, w: 2 / mp.pi * mp.atan2(r * w, t * depth), c, complement, (depth / r * c, depth))


class Punch:
    """The flat punch: f = 1/sqrt(1 - r^2), bonded up to the moment 4 pi/3."""

    def height(self, c, complement):
        return punches.K(c)

    def moment(self, c, complement):
        return mpf(8) / 3 * (mp.pi / 2 + mp.quad(lambda s: s * s * punches.B(s), [c, 1] if c > 0.1 else [c, 10 * c, 1]))

    def limit(self):
        return mp.pi**2 / 2

    def load(self):
        return 2 * mp.pi

    def bound(self, r):
        return 1 / mp.sqrt((1 - r) * (1 + r))

    def traction(self, r, c, complement):
        if r >= c:
            return self.bound(r)
        return punches.punch_traction(mpf(1), c, (c - r) * (c + r), r)


class Rounded:
    """A punch with a rounded edge, flat out to b."""

    def __init__(self, b):
        self.profile = punches.RoundedPunch(b)
        self.start = self.profile.flat

    def _cuts(self, c):
        start = max(c, self.start)
        return start, punches.split(start, 1, abs(c - self.start) or mpf(10)**-12)

    def height(self, c, complement):
        return mp.quad(lambda x: self.profile.weight(x) / x * punches.K(c / x), self._cuts(c)[1])

    def moment(self, c, complement):
        reached, lacking = punches.moments(self.profile, c)
        return reached * self.limit() if c > 0.5 else self.limit() * (1 - lacking)

    @lru_cache(maxsize=None)
    def limit(self):
        return mp.pi**2 / 2 * self.profile.second_moment(mpf(1))

    def load(self):
        return mp.pi

    def bound(self, r):
        return punches.pressure(self.profile, r)

    def traction(self, r, c, complement):
        if r >= c:
            return self.bound(r)
        inside = (c - r) * (c + r)
        return mp.quad(lambda x: self.profile.weight(x) * punches.punch_traction(x, c, inside, r), self._cuts(c)[1])


def power(n, pressure):
    """The gap r^n: p = integral_r^1 x^(n - 1)/sqrt(x^2 - r^2) dx, the mean being 2/(n + 1), has F' = (1 - (n - 1) p y)/r^2."""
    return Discs(lambda y, r: (1 - (n - 1) * pressure(y, r) * y) / r**2, exponent=mpf(n))


def pressure_of_three_halves(y, r):
    return y / mp.sqrt(r) * mp.hyp2f1(mpf(1) / 2, mpf(1) / 4, mpf(3) / 2, -(y / r)**2)


BOUNDS = {
    "hertz": Discs(lambda y, r: mpf(1)), "cone": Discs(lambda y, r: 1 / r**2, exponent=mpf(1)), "flat_punch": Punch(),
    "power:1.5": power(mpf(3) / 2, pressure_of_three_halves), "power:3": power(3, lambda y, r: (y + r * r * mp.asinh(y / r)) / 2),
    "power:4": Discs(lambda y, r: 1 - 2 * y * y), "rounded_punch:0.5": Rounded(0.5), "constant": Discs(lambda y, r: mpf(0), edge=1),
    "capped:0.5": Discs(lambda y, r: mpf(y < mpf(1) / 2), kink=mpf(1) / 2),
    "pressure_power:0.5": Discs(lambda y, r: 1 / (2 * mp.sqrt(y))),
}


def state(profile, c, complement):
    """The state with this stick ratio: M/M_lim, 1 - M/M_lim, twist G a^2 phi/(mu W)."""
    bound = BOUNDS[profile]
    limit = bound.limit()
    moment = bound.moment(c, complement)
    return {"moment_ratio": moment / limit, "moment_deficit": 1 - moment / limit,
            "twist": bound.height(c, complement) / (2 * bound.load())}


def ratio_slope(profile, c, complement):
    """d(M/M_lim)/dc = -(8/3) c^3 (-H')/M_lim, H' by a difference over a thousandth of the shorter side."""
    bound, d = BOUNDS[profile], min(c, complement) / 1000
    ends = [bound.height(c + s * d, complement - s * d) for s in (1, -1)]
    return mpf(8) / 3 * c**3 * (ends[0] - ends[1]) / (2 * d) / bound.limit()


# ---------------------------------------------------------------- energies, in doubles

def tanh_sinh(count):
    """Nodes, their distances from 1, and weights on (0, 1)."""
    u = np.linspace(-3.6, 3.6, 2 * count + 1)
    rest = 1 / (1 + np.exp(np.pi * np.sinh(u)))
    return rest[::-1], rest, np.pi * np.cosh(u) * rest * rest[::-1] * (u[1] - u[0])


BREAKS = {"capped:0.5": 0.75**0.5, "rounded_punch:0.5": 0.5}  # radii at which H bends
EXPONENTS = {"hertz": 2.0, "cone": 1.0, "power:1.5": 1.5, "power:3": 3.0, "power:4": 4.0}


def height_of(profile, c, complement):
    """H(c), arrays."""
    x, rest, weight = tanh_sinh(100)
    c, complement = c[:, None], complement[:, None]
    Y = np.sqrt(complement * (1 + c))
    if profile == "flat_punch":
        return special.ellipkm1(c[:, 0]**2)
    if profile == "constant":
        return np.arcsinh(Y / c)[:, 0]
    if profile == "capped:0.5":
        top = np.minimum(Y, 0.5)
        return (np.arcsinh(np.sqrt((Y - top + top * rest) * (Y + top * x)) / c) * weight * top).sum(axis=1)
    if profile == "pressure_power:0.5":  # y = Y x^2
        return (np.arcsinh(Y * np.sqrt(rest * (1 + x) * (1 + x * x)) / c) * weight * np.sqrt(Y)).sum(axis=1)
    # Punches of the radii X; ln X goes from -depth to 0.
    flat = BREAKS.get(profile, 0.0)
    depth = np.where(c < flat, -np.log(max(flat, 1e-300)), -np.log1p(-complement))
    X = np.exp(-depth * x)
    lacking = -np.expm1(-2 * np.where(c < flat, -np.log(c) - depth * x, depth * rest))  # 1 - (c/X)^2
    K = np.where(lacking < 0.5, special.ellipk(np.minimum(lacking, 0.5)), special.ellipkm1((c / X)**2))
    if profile in EXPONENTS:
        density = X**(EXPONENTS[profile] - 1)
    else:
        side = np.sqrt(np.maximum(X * X - flat * flat, 0.0))
        density = (2 * side - flat * np.arctan2(side, flat)) / float(BOUNDS[profile].profile.norm)
    return (density * K * depth * weight).sum(axis=1)


def energy_lost(profile, stick_ratio, complement):
    """Energy lost in a cycle, over (mu W)^2/(G a). First loading loses 4 integral_c^1 x^2 H(x) (H(c) - H(x)) dx over the square of
    the load, a cycle four times as much."""
    c, complement = float(stick_ratio), float(complement)
    if complement == 0:
        return 0.0
    x, _, weight = tanh_sinh(80)
    ends = [0.0, -np.log1p(-complement)]
    ends[1:1] = [-np.log(b) for name, b in BREAKS.items() if name == profile and c < b]
    whole, total = height_of(profile, np.array([c]), np.array([complement])), 0.0
    for low, high in zip(ends, ends[1:]):
        depth = low + (high - low) * x
        X = np.exp(-depth)
        H = height_of(profile, X, -np.expm1(-depth))
        total += (X**3 * H * (whole - H) * weight).sum() * (high - low)
    return float(16 * total / float(BOUNDS[profile].load())**2)
