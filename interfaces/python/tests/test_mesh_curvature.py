"""How much further a sphere turns than a half-space: finite elements of the axisymmetric problem of torsion against the table."""
import unittest

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from slipstick import exact
from slipstick.meshes.curvature import of_sphere

FACES, END = 40, 20.0  # across the contact radius, 1; of the body


def surface_compliance(radii, depths, surface):
    """The turns w = u/r of the contact's nodes (n, n) under unit moments on circles of nodes, for the shear modulus 1. The body lies
    below `surface`, its height at the radii, and is held at the end. Its energy is the integral of pi r^3 |grad w|^2."""
    r, z = np.meshgrid(radii, depths, indexing="ij")
    z = surface[:, None] * (1 - z / END) + z
    number = np.arange(r.size).reshape(r.shape)
    cells = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4)
    corners = np.stack([r.ravel()[cells], z.ravel()[cells]], -1)
    signs, stiffness = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]), 0
    gauss = list(zip(*np.polynomial.legendre.leggauss(3)))
    for (s, u), (t, v) in ((one, other) for one in gauss for other in gauss):
        shape = np.prod(1 + signs * [s, t], axis=1) / 4
        slopes = np.stack([signs[:, 0] * (1 + signs[:, 1] * t), signs[:, 1] * (1 + signs[:, 0] * s)]) / 4
        jacobian = np.einsum("ak,mkc->mac", slopes, corners)
        gradient = np.linalg.solve(jacobian, np.broadcast_to(slopes, (len(cells), 2, 4)))
        weight = 2 * np.pi * (corners[..., 0] @ shape)**3 * np.linalg.det(jacobian) * u * v
        stiffness += np.einsum("m,mak,mal->mkl", weight, gradient, gradient)
    matrix = sparse.csc_matrix((stiffness.ravel(), (np.repeat(cells, 4, axis=1).ravel(), np.tile(cells, (1, 4)).ravel())))
    free = number[:-1, :-1].ravel()
    place = np.searchsorted(free, number[:FACES + 1, 0])
    unit = np.zeros((len(free), FACES + 1))
    unit[place, np.arange(FACES + 1)] = 1
    return splu(matrix[free][:, free]).solve(unit)[place]


def bounds(radii):
    """The moments on the circles of nodes of Hertz's pressure sqrt(1 - r^2)."""
    gauss, weights = np.polynomial.legendre.leggauss(8)
    found = np.zeros(FACES + 1)
    for k, (start, end) in enumerate(zip(radii, radii[1:])):
        share = (1 + gauss) / 2
        r = start + share * (end - start)
        moment = 2 * np.pi * r**2 * np.sqrt(np.maximum(1 - r**2, 0)) * weights * (end - start) / 2
        found[k:k + 2] += moment @ (1 - share), moment @ share
    return found


def moment_of(compliance, bound, twist):
    """The moment at a twist: circles stick until they carry their bound."""
    sticks = np.ones(len(bound), bool)
    while True:
        carried = bound.copy()
        carried[sticks] = np.linalg.solve(compliance[np.ix_(sticks, sticks)], twist - compliance[np.ix_(sticks, ~sticks)] @ bound[~sticks])
        now = np.where(sticks, carried <= bound, compliance @ carried > twist)
        if (now == sticks).all():
            return carried.sum()
        sticks = now


def twist_of(compliance, bound, ratio):
    low, high = 0.0, 10.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if moment_of(compliance, bound, middle) < ratio * bound.sum() else (low, middle)
    return low


class Sphere(unittest.TestCase):
    def test_growth_of_the_twist(self):
        inner = np.sin(np.pi / 2 * np.linspace(0, 1, FACES + 1))
        steps = (1 - inner[-2]) * 1.15**np.arange(60)
        outer = 1 + np.cumsum(steps)
        radii = np.concatenate([inner, outer[outer < END / 1.1], [END]])
        depths = np.cumsum(0.5 / FACES * 1.15**np.arange(60))
        depths = np.concatenate([[0], depths[depths < END / 1.1], [END]])
        flat, bound, curvature = surface_compliance(radii, depths, 0 * radii), bounds(inner), 1e-3
        curved = surface_compliance(radii, depths, curvature * radii**2 / 2)
        self.assertAlmostEqual(of_sphere(0.1, 0.0), 0.1 * 9 / (4 * np.pi), 12)
        for ratio in (0.05, 0.5, 0.9, 0.99):
            with self.subTest(ratio):
                half_space = twist_of(flat, bound, ratio)
                unit = 2 * np.pi / 3  # mu W over mu p0 a^2; the shear modulus is 1
                self.assertLess(abs(half_space / (unit * exact.twist(ratio)) - 1), 5e-3)
                growth = twist_of(curved, bound, ratio) / half_space - 1
                self.assertLess(abs(growth / of_sphere(curvature, ratio) - 1), 0.01)


if __name__ == "__main__":
    unittest.main()
