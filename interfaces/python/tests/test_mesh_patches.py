"""Triangles of meshes, and right answers put on them: facts of geometry and of least squares."""
import unittest

import numpy as np
from scipy.spatial import ConvexHull

from slipstick.meshes.field import ContactField
from slipstick.meshes.patches import areas_around, patches_of, put_on, with_edge


def square(n):
    """Quadrilaterals of the square [-1, 1]^2, and their nodes."""
    x = np.linspace(-1, 1, n + 1)
    nodes = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    return nodes, np.column_stack([first, first + n + 1, first + n + 2, first + 1])


def patches(kind, nodes, faces):
    points = nodes if kind == "nodes" else nodes[faces].mean(axis=1)
    ones = np.ones(len(points))
    return patches_of(ContactField(kind, points, ones, np.zeros((len(points), 2)), vertices=nodes, faces=[faces]),
                      lambda x: np.ones((len(x), 3)))


class Patches(unittest.TestCase):
    def test_areas_of_points_are_those_of_the_faces_between_them(self):
        nodes, _ = square(8)
        areas = areas_around(nodes)
        inside = np.abs(nodes).max(axis=1) < 1
        np.testing.assert_allclose(areas[inside], (2 / 8)**2, rtol=1e-12)
        self.assertAlmostEqual(areas.sum(), 4.0, 12)
        scattered = np.random.default_rng(1).uniform(-1, 1, (60, 2))
        hull = ConvexHull(scattered).volume
        self.assertLess(areas_around(scattered).sum(), hull * (1 + 1e-12))
        self.assertGreater(areas_around(scattered).sum(), 0.95 * hull)  # without slivers along the hull

    def test_a_table_of_the_rows_in_contact_gets_the_edge_of_the_mesh(self):
        nodes, _ = square(20)
        loaded = np.hypot(*nodes.T) < 0.7
        ones = np.ones(loaded.sum())
        field = with_edge(ContactField("nodes", nodes[loaded], ones, np.zeros((len(ones), 2)), slip=np.ones((len(ones), 2))))
        self.assertEqual((len(field.points) - field.added, field.slip.shape), (len(ones), field.points.shape))
        self.assertFalse(field.pressure[-field.added:].any())
        edge = field.points[-field.added:]
        self.assertGreater(np.hypot(*edge.T).min(), 0.7)
        distance = np.linalg.norm(edge[:, None] - nodes[loaded], axis=2).min(axis=1)
        np.testing.assert_array_less(abs(distance - 0.1), 0.05)  # a face away
        areas = areas_around(field.points)[:len(ones)]
        np.testing.assert_allclose(areas, 0.01, rtol=0.35)
        self.assertAlmostEqual(areas.mean(), 0.01, delta=2e-4)
        whole = ContactField("nodes", nodes, loaded.astype(float), np.zeros((len(nodes), 2)))
        self.assertIs(with_edge(whole), whole)

    def test_a_hole_of_the_contact_is_not_bridged(self):
        angle = 2 * np.pi * np.arange(40) / 40
        radii = np.linspace(0.3, 1, 15)
        points = (radii[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)).reshape(-1, 2)
        ones = np.ones(len(points))

        def ring(x):
            return np.repeat((np.hypot(*x.T) >= 0.299).astype(float)[:, None], 3, axis=1)

        on = patches_of(ContactField("nodes", points, ones, np.zeros((len(points), 2))), ring)
        polygon = 20 * np.sin(2 * np.pi / 40)  # area of the one with 40 corners on the unit circle
        self.assertAlmostEqual(on.areas.sum(), polygon * (1 - 0.3**2), delta=2e-3)
        self.assertAlmostEqual(on.weights.sum(), polygon * (1 - 0.3**2), delta=2e-3)

    def test_linear_fields_are_kept_by_every_way(self):
        nodes, quads = square(5)

        def linear(x):
            return np.column_stack([2 + x[:, 0], x[:, 1], 1 - x[:, 0] + 3 * x[:, 1]])

        for kind in ("nodes", "faces"):
            on = patches(kind, nodes, quads)
            self.assertAlmostEqual(on.weights.sum(), 4.0, 12)
            inside = np.abs(on.points).max(axis=1) < 1
            for name, values in put_on(on, linear).items():
                np.testing.assert_allclose(values[inside], linear(on.points)[inside], atol=1e-12, err_msg=name)

    def test_least_squares_keep_integrals(self):
        nodes, quads = square(6)
        on = patches("nodes", nodes, quads)

        def bump(x):
            return np.repeat(np.exp(-4 * np.sum(x**2, axis=1))[:, None], 3, axis=1)

        found = put_on(on, bump)
        self.assertAlmostEqual(on.weights @ found["least squares"][:, 0], on.weights @ found["means around nodes"][:, 0], 12)
        self.assertNotAlmostEqual(on.weights @ found["values at nodes"][:, 0], on.weights @ found["least squares"][:, 0], 4)


if __name__ == "__main__":
    unittest.main()
