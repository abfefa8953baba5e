"""The second path of a sphere on a coated half-space: two Fredholm equations by Gauss' rule on Legendre polynomials (NumPy, SciPy).
The shear kernel is summed by images, the normal one integrates the layer's compliance of O'Sullivan and King (1988)."""

import numpy as np
from numpy.polynomial import legendre
from scipy import optimize, special

POINTS, IMAGES = 60, 400
NODES, WEIGHTS = legendre.leggauss(POINTS)


def on(low, high):
    return low + (high - low) * (NODES + 1) / 2, WEIGHTS * (high - low) / 2


def shear_kernel(t, s, thickness, reflection, share):
    """share: the layer's part of the compliance. m(k) = 2 sum of L^n e^(-2 n k h)."""
    total = np.zeros(np.broadcast(t, s).shape)
    for n in range(1, IMAGES):
        factor, b = 2 * share * reflection**n, 2 * n * thickness
        if abs(factor) < 1e-18:
            break
        total += factor / np.pi * (b / (b * b + (t - s)**2) - b / (b * b + (t + s)**2))
    return total


def normal_kernel(t, s, thickness, layer, base, share):
    """k h on Gauss panels: m decays like e^(-2 k h)."""
    (g1, nu1), (g2, nu2) = layer, base
    ratio = g1 / g2
    lam = 1 - 4 * (1 - nu1) / (1 + ratio * (3 - 4 * nu2))
    kappa = (ratio - 1) / (ratio + 3 - 4 * nu1)
    total = np.zeros(np.broadcast(t, s).shape)
    for low in np.arange(0.0, 24.0, 2.0):
        for z, weight in zip(*on(low, low + 2)):
            e = np.exp(-2 * z)
            below = 1 - (lam + kappa + 4 * kappa * z * z) * e + lam * kappa * e * e
            m = ((1 + 4 * z * kappa * e - lam * kappa * e * e) / below - 1) * share
            total += weight / thickness * m / np.pi * (np.cos(z / thickness * (t - s)) + np.cos(z / thickness * (t + s)))
    return total


class CoatedSphere:
    """Lengths in m, moduli in Pa; bodies are pairs of shear modulus and Poisson's ratio."""

    def __init__(self, load, radius, upper, layer, base, thickness):
        self.thickness, self.shear = thickness, 1 / (1 / upper[0] + 1 / layer[0])
        self.modulus = 1 / ((1 - upper[1]) / (2 * upper[0]) + (1 - layer[1]) / (2 * layer[0]))
        normal_share = (1 - layer[1]) / (2 * layer[0]) * self.modulus
        self.reflection, self.share = (layer[0] - base[0]) / (layer[0] + base[0]), self.shear / layer[0]
        self.pressing = lambda t, s: normal_kernel(t, s, thickness, layer, base, normal_share)
        self.curvature = 1 / radius
        hertz = (0.75 * load * radius / self.modulus)**(1 / 3)
        self.radius = optimize.brentq(lambda a: self.press(a) - load, hertz / 3, 3 * hertz, xtol=1e-16, rtol=1e-14)
        self.press(self.radius)
        self.moment_limit = np.pi**2 * (self.weights * self.nodes) @ self.psi  # over mu

    def press(self, a):
        """The load; keeps psi, an even polynomial, and the approach."""
        t, w = self.nodes, self.weights = on(0.0, a)
        edge = self.pressing(a, t) * w
        matrix = np.eye(POINTS) + self.pressing(t[:, None], t[None, :]) * w
        of_one, of_square = np.linalg.solve(matrix, np.column_stack([np.ones(POINTS), t * t])).T
        self.approach = self.curvature * (a * a - edge @ of_square) / (1 - edge @ of_one)
        self.psi = self.modulus / np.pi * (self.approach * of_one - self.curvature * of_square)
        even = legendre.legfit(np.concatenate([-t, t]) / a, np.concatenate([self.psi, self.psi]), 2 * 22)
        self.slope = lambda s: legendre.legval(s / a, legendre.legder(even)) / a
        self.peak = -(w * self.slope(t) / t).sum()
        return 2 * np.pi * w @ self.psi

    def height(self, s):
        """H of the pressure; u^4 takes away the logarithm at t = s only in part, panels do the rest."""
        total = np.zeros_like(s)
        top = np.log(self.radius / s)
        for low, high in ((0, 1e-4), (1e-4, 1e-2), (1e-2, 0.1), (0.1, 1)):
            u, w = on(low, high)
            t = s[:, None] * np.exp(top[:, None] * u)
            total -= (self.slope(t) * special.ellipk(-np.expm1(-2 * top[:, None] * u)) * w).sum(axis=1) * top
        return total

    def stuck(self, c):
        """Twist over mu and moment over mu with the stick radius c."""
        (t, w), (ring, ring_w) = on(0.0, c), on(c, self.radius)
        def kernel(x, y):
            return shear_kernel(x, y, self.thickness, self.reflection, self.share)
        chi_ring = 2 / np.pi * ring * self.height(ring)
        matrix = np.eye(POINTS) + kernel(t[:, None], t[None, :]) * w
        of_twist, of_ring = np.linalg.solve(matrix, np.column_stack([4 * self.shear / np.pi * t,
                                                                      -(kernel(t[:, None], ring[None, :]) * ring_w) @ chi_ring])).T
        edge, front = kernel(c, t) * w, 2 / np.pi * c * self.height(np.array([c]))[0]
        outside = -(kernel(c, ring) * ring_w) @ chi_ring
        twist = (front - outside + edge @ of_ring) / (4 * self.shear / np.pi * c - edge @ of_twist)
        moment = 4 * np.pi * ((w * t) @ (twist * of_twist + of_ring) + (ring_w * ring) @ chi_ring)
        return twist, moment

    def state(self, ratio):
        """Stick radius and twist over mu at a moment over its limit."""
        c = optimize.brentq(lambda c: self.stuck(c)[1] - ratio * self.moment_limit, 1e-3 * self.radius, (1 - 1e-6) * self.radius,
                            xtol=1e-18, rtol=1e-14)
        return c, self.stuck(c)[0]
