"""Meshes, decks and files of the adapters for finite-element programs, without the programs."""

import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

import numpy as np

PROGRAMS = Path(__file__).resolve().parents[1]
SCENES = PROGRAMS.parents[1] / "convergence/scenes"
sys.path[:0] = [str(PROGRAMS), str(PROGRAMS / "calculix")]
import adapter as calculix  # noqa: E402
import elements  # noqa: E402

RADII = elements.spacing(0.1, 0.5, 3.0, 1.3)
PLANS = {"sector": elements.sector(RADII, sectors=12, facets=3), "O-grid": elements.o_grid(RADII, 2)}


def volumes(body):
    """The volumes of the elements by their Jacobian at Gauss points; wedges are hexahedra with a repeated corner."""
    gauss = np.array([-1, 1]) / np.sqrt(3)
    found = []
    for cells in body.elements:
        order = [0, 1, 2, 2, 3, 4, 5, 5] if cells.shape[1] == 6 else range(8)
        corners = body.nodes.reshape(-1, 3)[cells[:, order]]
        signs = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)])
        points = np.stack(np.meshgrid(gauss, gauss, gauss), -1).reshape(-1, 3)
        for at in points:
            factors = 1 + signs * at
            slopes = np.stack([signs[:, k] * np.prod(np.delete(factors, k, axis=1), axis=1) for k in range(3)], axis=1) / 8
            found.append(np.linalg.det(np.einsum("eci,cj->eij", corners, slopes)))
    return np.concatenate(found)


def applied(equations, displacement):
    """The sums of terms under displacements[node, degree of freedom], numbered from 1."""
    return [sum(factor * displacement[node - 1, freedom - 1] for node, freedom, factor in terms) for terms in equations]


class OfMeshes(unittest.TestCase):
    def test_grow_from_the_contact_to_the_end(self):
        steps = np.diff(RADII)
        np.testing.assert_allclose(steps[:5], 0.1)
        self.assertEqual(RADII[-1], 3.0)
        self.assertLess(np.max(steps[1:] / steps[:-1]), 1.3 + 1e-12)

    def test_fill_the_polygon_of_their_rim(self):
        for name, corners in (("sector", 36), ("O-grid", 16)):
            plan = PLANS[name]
            self.assertTrue(np.all(plan.areas() > 0), name)
            polygon = corners / 2 * 3.0**2 * np.sin(2 * np.pi / corners)
            self.assertAlmostEqual(plan.sectors * plan.areas().sum(), polygon, places=10, msg=name)

    def test_fill_both_bodies(self):
        depth = elements.spacing(0.1, 0.1, 2.0, 1.5)
        for name, plan in PLANS.items():
            bowl = 0.05 * np.sum(plan.points**2, axis=1)
            for surface, upper in ((0 * bowl, True), (0 * bowl, False), (bowl, True)):
                parts = volumes(elements.extruded(plan, depth, surface, upper))
                self.assertTrue(np.all(parts > 0), name)
                if not surface.any():
                    self.assertAlmostEqual(parts.sum() / (2.0 * plan.areas().sum()), 1, places=10, msg=name)

    def test_pair_the_cut_faces_by_a_turn(self):
        plan = PLANS["sector"]
        one, other = plan.points[plan.pairs.T]
        np.testing.assert_allclose(other, one @ elements.turning(plan.angle).T, atol=1e-14)
        self.assertEqual(len(np.unique(plan.pairs)), 2 * len(RADII) - 2)

    def test_turn_a_sector_into_the_circle(self):
        """A rotation field, given on one sector, is the rotation field of the circle."""
        plan = PLANS["sector"]
        turned = np.array([[0, 1], [-1, 0]])
        means = np.column_stack([plan.areas(), plan.centres() @ turned])
        whole = elements.ContactFaces(plan, means, {"CSHEAR": plan.points @ turned, "COPEN": np.hypot(*plan.points.T)}).all_round()
        self.assertEqual(len(whole.plan.points), 1 + 36 * (len(RADII) - 1))
        np.testing.assert_allclose(whole.means[:, 0], whole.plan.areas())
        np.testing.assert_allclose(whole.means[:, 1:], whole.plan.centres() @ turned, atol=1e-14)
        np.testing.assert_allclose(whole.nodal["CSHEAR"], whole.plan.points @ turned, atol=1e-14)
        np.testing.assert_allclose(whole.nodal["COPEN"], np.hypot(*whole.plan.points.T), atol=1e-14)

    def test_share_a_face_among_its_nodes(self):
        """The areas of nodes fill the mesh; that of an inner node of quadrilaterals is a quarter of those around it."""
        for name, plan in PLANS.items():
            whole = elements.ContactFaces(plan, None, {"COPEN": np.ones(len(plan.points))})
            whole = (whole if plan.sectors == 1 else whole.all_round()).over_nodal_areas()
            self.assertAlmostEqual((1 / whole.nodal["COPEN"]).sum(), plan.sectors * plan.areas().sum(), places=10, msg=name)
        inner = elements.ContactFaces(plan, None, {"CSHEAR": np.ones((len(plan.points), 2))}).over_nodal_areas()
        centre = np.argmin(np.hypot(*plan.points.T))
        around = plan.areas()[[centre in face for face in plan.faces[0]]].sum()
        np.testing.assert_allclose(inner.nodal["CSHEAR"][centre], 4 / around)


class OfFiles(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="slipstick-elements-")))

    def test_hold_the_field(self):
        plan = PLANS["sector"].within(0.25)
        means = np.arange(3.0 * len(plan.centres())).reshape(-1, 3)
        elements.ContactFaces(plan, means, {"CSHEAR": plan.points}).write(self.folder / "field.vtu")
        arrays = {each.get("Name"): np.array(each.text.split(), float)
                  for each in xml.etree.ElementTree.parse(self.folder / "field.vtu").iter("DataArray")}
        self.assertEqual(set(arrays), {"Points", "connectivity", "offsets", "types", "CSHEAR1", "CSHEAR2", "pressure", "q1", "q2"})
        points = arrays["Points"].reshape(-1, 3)
        np.testing.assert_allclose(np.column_stack([arrays["CSHEAR1"], arrays["CSHEAR2"]]), points[:, :2], atol=1e-9)
        ends = arrays["offsets"].astype(int)
        corners = np.split(arrays["connectivity"].astype(int), ends[:-1])
        np.testing.assert_allclose([points[each, :2].mean(axis=0) for each in corners], plan.centres(), atol=1e-9)
        np.testing.assert_array_equal(arrays["types"], [5 if len(each) == 3 else 9 for each in corners])
        np.testing.assert_allclose(arrays["q2"], means[:, 2])

    def test_are_for_a_sphere_on_its_own_material(self):
        sphere = elements.Sphere(SCENES / "paper.toml")
        self.assertAlmostEqual(sphere.contact_radius, 0.489097, places=6)  # the paper's, mm
        self.assertAlmostEqual(sphere.limit, 28.8102, places=4)  # N mm
        for scene in ("ellipse", "dissimilar"):
            with self.assertRaisesRegex(SystemExit, "allowed: one"):
                elements.Sphere(SCENES / f"{scene}.toml")


class OfCalculiX(unittest.TestCase):
    def setUp(self):
        self.sphere = elements.Sphere(SCENES / "paper.toml")
        self.plan = elements.sector(elements.spacing(0.2, 0.6, 2.0, 1.5), sectors=12)
        self.deck = calculix.Deck(self.sphere, self.plan, elements.spacing(0.2, 0.2, 2.0, 1.5))

    def test_lets_the_faces_near_the_axis_touch(self):
        """The nodes of surfaces S1 of the upper body and S2 of the lower one, by their coordinates."""
        text = "\n".join(self.deck.mesh())
        rows = [line.split(",") for line in text.split("*NODE, NSET=MOTION")[0].splitlines()[1:]]
        points = {int(number): np.array(at, float) for number, *at in rows}
        cells = {}
        for part in text.split("*ELEMENT")[1:]:
            cells |= {int(number): list(map(int, nodes)) for number, *nodes in
                      (line.split(",") for line in part.split("*")[0].splitlines()[1:])}
        for name, height in (("UPPER", lambda r: 18 - np.sqrt(18**2 - r**2)), ("LOWER", lambda r: 0 * r)):
            near = list(map(int, text.split(f"ELSET={name}_CONTACT\n")[1].split("*")[0].split()))
            self.assertEqual(len(near), len(self.deck.contact.centres()))
            for cell, centre in zip(near, self.deck.contact.centres()):
                half = len(cells[cell]) // 2
                face = np.array([points[node] for node in (cells[cell][:half] if name == "UPPER" else cells[cell][half:])])
                np.testing.assert_allclose(face[:, 2], height(np.hypot(*face[:, :2].T)), atol=1e-9)
                np.testing.assert_allclose(face[:, :2].mean(axis=0), centre, atol=1e-9)

    def test_drives_the_end_as_a_rigid_body_and_ties_the_cut_faces(self):
        """The equations hold for a rigid rotation with an approach, and for any displacement that has the sector's symmetry."""
        nodes = np.vstack([body.nodes.reshape(-1, 3) for body in self.deck.bodies.values()] + [np.zeros((1, 3))])
        x, y, z = nodes.T
        rotation, approach = 0.3, -0.2
        rigid = np.column_stack([-rotation * y, rotation * x, np.full(len(x), approach)])
        wave = np.cos(12 * np.arctan2(y, x)) * (x**2 + y**2) + z
        other = np.column_stack([wave * x - z * y, wave * y + z * x, wave])
        driven = self.deck.bodies["UPPER"].driven
        other[driven] = rigid[driven]
        for displacement in (rigid, other):
            displacement[-1] = rotation, 0, approach
            np.testing.assert_allclose(applied(self.deck.equations(), displacement), 0, atol=1e-12)
        wrong = rigid + 0.1 * np.column_stack([x > 1, y * 0, y * 0])  # not that of a turned sector
        self.assertGreater(np.abs(applied(self.deck.equations(), wrong)).max(), 0.01)

    def test_removes_each_freedom_once(self):
        first = [terms[0][:2] for terms in self.deck.equations()]
        self.assertEqual(len(first), len(set(first)))
        held = {node for node in self.deck.bodies["LOWER"].driven + self.deck.first["LOWER"]} | set(self.deck.axis())
        self.assertFalse(held & {node for node, _ in first})

    def test_loads_a_sector_with_its_share_after_the_friction(self):
        text = self.deck.text([0.5 * self.sphere.limit, 0.9 * self.sphere.limit])
        steps = text.split("*STEP")[1:]
        self.assertEqual(len(steps), 4)
        motion = self.deck.motion
        self.assertIn(f"\n{motion},3,{-1000 / 12:.12g}\n", steps[1])
        for step, ratio in zip(steps[2:], (0.5, 0.9)):
            self.assertIn(f"\n{motion},1,{ratio * self.sphere.limit / 12:.12g}\n", step)
        self.assertEqual([step.count("*CHANGE FRICTION") for step in steps], [0, 0, 1, 0])
        self.assertIn("*FRICTION\n0.1,100000000.0\n", steps[2])
        self.assertNotIn("*FRICTION\n0.1,", text.split("*STEP")[0])

    def test_reads_forces_from_pressures_and_energies(self):
        """A point's springs store p^2/2K + q^2/L on its area, friction's counted twice."""
        element, area = self.deck.touching("UPPER")[2], self.deck.contact.areas()[2]
        points = [(300.0, 20.0, -10.0, 0.25 * area), (100.0, 0.0, 10.0, 0.75 * area)]
        stress = [f"{element:10d}          1  {p:.6E} {q1:.6E} {q2:.6E}" for p, q1, q2, _ in points]
        energy = [f"{element:10d}          1  {(p**2 / 2e8 + (q1**2 + q2**2) / 1e8) * part:.6E}" for p, q1, q2, part in points]
        dat = "".join(f"\n {title} for all contact elements and time  0.1000000E+01\n\n" + "\n".join(rows) + "\n\n"
                      for title, rows in (("contact stress (slave element+face,press,tang1,tang2)", stress),
                                          ("contact print energy (slave element+face,energy)", energy)))
        stress, energy = (calculix.tables(dat, title)[0] for title in ("contact stress", "contact print energy"))
        means = calculix.face_means(self.deck, stress, energy)
        np.testing.assert_allclose(means[2], [150, 5, 5], rtol=1e-5)
        self.assertEqual(np.count_nonzero(means), 3)

    def test_reads_nodes_of_each_step(self):
        row = " -1         2" + "".join(f"{each:12.5E}" for each in (-1e-5, 2e-6, -3e-6, 1e3, 40, -50)) + "\n"
        frd = 2 * (" -4  CONTACT     6    1\n -5  COPEN       1    4    1    1\n" + row + " -3\n")
        first, second = calculix.nodal_values(frd, 3)
        np.testing.assert_allclose(second["CSHEAR"], [[0, 0], [40, -50], [0, 0]])
        np.testing.assert_allclose(first["CPRESS"], [0, 1e3, 0])


if __name__ == "__main__":
    unittest.main()
