"""Displacements of tractions on triangles: against the rectangle's closed form, against quadrature, and Hertz's pressure."""
import unittest

import numpy as np
from scipy import integrate

from slipstick.meshes import displacement
from slipstick.meshes.displacement import KERNELS, integrals

H = {"r": lambda c, s: 1.0, "t11": lambda c, s: c * c, "t12": lambda c, s: c * s, "v1": lambda c, s: c, "v2": lambda c, s: s,
     "even": lambda c, s: abs(c * s)}


def by_quadrature(name, place, corners, values):
    """The integral over a triangle that has the place as a corner, by polar coordinates; other triangles as three of these."""
    gradient = np.linalg.solve(corners[1:] - corners[0], values[1:] - values[0])
    at_place = values[0] + gradient @ (place - corners[0])
    total = 0.0
    for start, end in zip(corners, np.roll(corners, -1, axis=0)):
        a, b = start - place, end - place
        cross = a[0] * b[1] - a[1] * b[0]

        def integrand(s):
            x = a + s * (b - a)
            r = np.hypot(*x)
            h = H[name](*(x / r))
            return h * (at_place * r + gradient @ x * r / 2) * cross / r**2

        bends = sorted(s for d in (0, 1) if a[d] != b[d] and 0 < (s := a[d] / (a[d] - b[d])) < 1)
        total += sum(integrate.quad(integrand, s, e, epsabs=0, epsrel=1e-12, limit=200)[0]
                     for s, e in zip([0, *bends], [*bends, 1]))
    return total * (-1 if name in ("v1", "v2") else 1)


class Triangles(unittest.TestCase):
    def test_equal_quadrature_at_places_inside_outside_and_far(self):
        rng = np.random.default_rng(3)
        for _ in range(20):
            corners, values = rng.normal(size=(3, 2)), rng.normal(size=3)
            signed = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            inside = rng.dirichlet(np.ones(3)) @ corners
            for place in (inside, inside + rng.normal(size=2), inside + rng.normal(size=2) * 60):
                found = integrals(place[None], corners[None], values[None, :, None], KERNELS)[:, 0, 0]
                scale = abs(signed) / 2 * np.abs(values).max() / max(0.1, np.hypot(*(place - corners.mean(0))))
                for name, value in zip(KERNELS, found):
                    right = by_quadrature(name, place, corners, values) * np.sign(signed)
                    bound = 5e-3 if name == "even" else 1e-4 if np.hypot(*(place - inside)) > 4 else 1e-10
                    self.assertLess(abs(value - right), bound * scale + 1e-11, (name, place))

    def test_square_has_loves_value_at_its_centre(self):
        square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1.0]])
        corners = square[[[0, 1, 2], [0, 2, 3]]]
        found = integrals(np.zeros((1, 2)), corners, np.ones((2, 3, 1)), KERNELS)[:, 0, 0]
        self.assertAlmostEqual(found[0], 8 * np.arcsinh(1.0), 13)  # Love 1929: 4 ln(1 + sqrt 2) (a + b) for the square
        self.assertAlmostEqual(found[1], 4 * np.arcsinh(1.0), 13)
        np.testing.assert_allclose(found[2:5], 0, atol=1e-13)
        self.assertAlmostEqual(found[5], 8 - 4 * np.sqrt(2), 6)

    def test_hertz_pressure_makes_a_paraboloid(self):
        """pi^2 (2 - r^2)/4 for p = sqrt(1 - r^2) and kernel 1/r; order 3/2 or better in the size of triangles."""
        errors = []
        for n in (16, 32):
            radii = np.sin(np.pi / 2 * np.arange(n + 1) / n)
            angles = 2 * np.pi * np.arange(2 * n) / (2 * n)
            vertices = np.vstack([[0, 0]] + [r * np.c_[np.cos(angles), np.sin(angles)] for r in radii[1:]])
            ring = np.arange(2 * n)
            first = np.c_[np.zeros(2 * n, int), 1 + ring, 1 + (ring + 1) % (2 * n)]
            quads = np.vstack([np.c_[k + ring, k + 2 * n + ring, k + 2 * n + (ring + 1) % (2 * n), k + (ring + 1) % (2 * n)]
                               for k in range(1, 2 * n * (n - 1) + 1, 2 * n)])
            triangles, _, shares, _ = displacement.triangles_of([first, quads])
            pressure = np.sqrt(np.maximum(0, 1 - np.sum(vertices**2, axis=1)))
            places = np.array([[0.1, 0.05], [0.3, 0.4], [0.0, -0.8]])
            found = integrals(places, vertices[triangles], (pressure[triangles] * shares[:, None])[:, :, None])[0, :, 0]
            errors.append(np.abs(found / (np.pi**2 / 4 * (2 - np.sum(places**2, axis=1))) - 1).max())
        self.assertLess(errors[1], 3e-3)
        self.assertLess(errors[1], errors[0] / 2.5)


if __name__ == "__main__":
    unittest.main()
