"""The judge of fields on meshes: right tractions are good on every mesh and in every kind, mistakes are bad and named."""
import functools
import tempfile
import unittest
from pathlib import Path

import drawn_meshes as drawn
import numpy as np
import slipstick
from loop_requests import SCENES, request_of
from slipstick import exact
from slipstick.meshes import answer, measures
from slipstick.meshes.curvature import of_sphere
from slipstick.meshes.read import read

measures._PLACES = 40  # at which displacements are summed, for speed
PAPER = slipstick.solve(SCENES / "paper.toml", solver__model="exact")
RADIUS, PEAK, FRICTION = PAPER.contact_radius, PAPER.peak_pressure, 0.1
MESHES = {"polar": drawn.polar(rings=18, angles=44), "graded": drawn.polar(outer=1.0, power=0.7), "squares": drawn.squares(),
          "jittered": drawn.jittered()}
ELLIPSE = drawn.solved(SCENES / "ellipse.toml", grid__cells=[192, 96])
AXES = (5.73e-4, 2.85e-4)  # of the ellipse, m


def sphere(ratio=0.9, radius=RADIUS, friction=FRICTION, **more):
    """The paper's contact under its load, with another radius or friction at one moment ratio."""
    return drawn.circular(radius, PEAK * (RADIUS / radius)**2, friction, ratio, **more)


@functools.lru_cache(maxsize=None)
def request(scene, *options):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "field.contact"
        on_mesh(sphere()).save(file)
        return request_of(scene, file, *options)


def judged(field, twist=None, scene="paper", ratio=0.9):
    """The verdict on a field."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "field.contact"
        field.save(file)
        return answer({**request(scene, "--set", f"load.moment_ratio={ratio}"), "field": str(file), "twist": twist})["result"]


def twist_of(ratio):
    return PAPER.twist_angle * exact.twist(ratio) / exact.twist(0.9)


def on_mesh(contact, mesh="polar", kind="faces", axes=(RADIUS, RADIUS)):
    return drawn.put(contact, MESHES[mesh], kind, axes)


def table_of_forces(field, folder):
    """A table of the nodes with a force; nothing says how large their areas are."""
    loaded = field.pressure > 0
    rows = np.column_stack([field.points, field.area[:, None] * np.column_stack([field.traction, field.pressure])])[loaded]
    file = folder / "forces.csv"
    np.savetxt(file, rows, delimiter=",", header="x1 [m],x2 [m],f1 [N],f2 [N],fn [N]", comments="")
    return file


class RightFields(unittest.TestCase):
    def good(self, field, **options):
        result = judged(field, **options)
        self.assertEqual(result["verdict"], "good", result["why"])

    def test_exact_tractions(self):
        for k, mesh in enumerate(MESHES):
            for j, kind in enumerate(("nodes", "faces", "points", "forces")):
                ratio = (0.6, 0.9)[(k + j) % 2]
                with self.subTest(mesh=mesh, kind=kind, ratio=ratio):
                    self.good(on_mesh(sphere(ratio), mesh, kind), twist=twist_of(ratio), ratio=ratio)

    def test_rows_in_contact_without_a_mesh(self):
        field = on_mesh(sphere(), "jittered", "nodes")
        loaded = field.pressure > 0
        self.good(field.replaced(points=field.points[loaded], pressure=field.pressure[loaded], traction=field.traction[loaded],
                                 vertices=None, faces=[]))

    def test_a_sphere_turns_further_than_a_half_space(self):
        field, growth = on_mesh(sphere(), "polar", "nodes"), of_sphere(RADIUS / 0.018, 0.9) / 2
        self.assertAlmostEqual(growth, 0.0085, 4)
        for part, off in ((1.0, 0.0), (0.5, 0.0), (3.0, 2 * growth), (-1.0, -growth)):
            with self.subTest(part):
                judgement = judged(field, twist=(1 + part * growth) * twist_of(0.9))
                twist = next(each for each in judgement["judged"] if each["quantity"] == "twist")
                self.assertAlmostEqual(twist["value"], off, 4)

    def test_nodal_forces_without_areas(self):
        for mesh in ("polar", "jittered"):
            with self.subTest(mesh=mesh), tempfile.TemporaryDirectory() as folder:
                self.good(read(table_of_forces(on_mesh(sphere(), mesh, "forces"), Path(folder))), twist=twist_of(0.9))

    def test_solved_tractions(self):
        contact, twist = ELLIPSE
        for mesh, kind in (("polar", "nodes"), ("squares", "faces"), ("jittered", "forces")):
            with self.subTest(mesh=mesh):
                self.good(on_mesh(contact, mesh, kind, AXES), twist=twist, scene="ellipse")


class WrongFields(unittest.TestCase):
    def bad(self, field, words, **options):
        """Bad, and these words name what is wrong."""
        result = judged(field, **options)
        self.assertEqual(result["verdict"], "bad")
        self.assertIn(words, result["why"])

    def test_loads(self):
        for name, contact, words, ratio in (
                ("half", sphere(0.45), "half the moment: that of one body", 0.9),
                ("twice", sphere(0.9), "the moment is twice the scene's", 0.45),
                ("late step", sphere(0.81), "those of step 9 of 10", 0.9),
                ("lost history", sphere(0.5, history=[0.9, 0.5]), "another history: the tractions are those after", 0.5),
                ("no friction", sphere(0.0), "friction was zero", 0.9),
                ("more friction", sphere(0.9 / 1.03, friction=0.103), "the friction coefficient is 0.10", 0.9),
                ("larger contact", sphere(0.9 / 1.05, radius=1.05 * RADIUS), "another modulus or radius of the body", 0.9)):
            with self.subTest(name):
                self.bad(on_mesh(contact, "squares"), words, ratio=ratio)

    def test_twists(self):
        field = on_mesh(sphere(), "polar", "nodes")
        for factor, words in ((0.5, "it reports the twist of the upper body only"), (180 / np.pi, "a twist in degrees"),
                              (1.03, "the twist is 2.2 % too high after the 0.85 % that a sphere turns further")):
            with self.subTest(factor):
                self.bad(field, words, twist=factor * twist_of(0.9))

    def test_nodal_forces_without_areas(self):
        forces = on_mesh(sphere(), "jittered", "forces")
        kept = np.random.default_rng(3).random(len(forces.points)) > 0.1
        lost = forces.replaced(points=forces.points[kept], pressure=forces.pressure[kept], traction=forces.traction[kept],
                               area=forces.area[kept], vertices=None, faces=[])
        with tempfile.TemporaryDirectory() as folder:
            self.bad(read(table_of_forces(lost, Path(folder))), "most rows have the right pressure")
            self.bad(read(table_of_forces(forces, Path(folder))), "the twist is 3 % too low", twist=0.97 * twist_of(0.9))

    def test_changed_fields(self):
        field = on_mesh(sphere(), "polar", "nodes")
        x, p, q = field.points, field.pressure, field.traction
        r = np.hypot(*x.T)
        weak = 0.3 * (FRICTION * p - np.hypot(*q.T)) / np.maximum(r, 1e-12)
        waves = 0.2 * np.hypot(*q.T).max() * np.stack([np.cos(7 * x[:, 0] / RADIUS), np.sin(8 * x[:, 1] / RADIUS + 1)], axis=1)
        leftovers = 0.1 * np.hypot(*q.T).max() * np.sin(x / RADIUS * [14, 15])  # without a force or a moment
        left = x[:, 0] < 0.6 * RADIUS
        for name, changes, words in (
                ("mirrored", {"traction": q * [-1, 1]}, "q1 has the wrong sign"),
                ("exchanged", {"traction": q[:, ::-1]}, "tangential basis"),
                ("pressed with friction", {"traction": q + weak[:, None] * x}, "friction was on while pressing"),
                ("other centre", {"points": x + [0.1 * RADIUS, 0], "vertices": x + [0.1 * RADIUS, 0]}, "name the body's axis"),
                ("no second component", {"traction": q * [1, 0]}, "q2 is missing"),
                ("unit of a component", {"traction": q * [1, 1e-3]}, "q2 is in another unit than q1: it is 0.001 times as large"),
                ("mean pressure", {"traction": 0.7 * q / np.maximum(p, 1e7)[:, None] * 1.3e9 * (r > 0.3 * RADIUS)[:, None]
                                   + 0.7 * q * (r <= 0.3 * RADIUS)[:, None]}, "friction is the same everywhere"),
                ("units", {"pressure": 1e-3 * p}, "the normal load is 100 % too low"),
                ("not converged", {"traction": q + waves * (p > 0)[:, None]}, "the tractions are"),
                ("leftovers", {"traction": q + leftovers * (p > 0)[:, None]}, "an iteration that ended early"),
                ("rows lost", {"pressure": p * left, "traction": q * left[:, None]}, "rows are missing")):
            with self.subTest(name):
                self.bad(field.replaced(**changes), words)

    def test_solvers(self):
        compliance = 0.2 * RADIUS * 2.6 / 210e9  # a tenth of the bodies' own, the sum of both a/G
        soft, twist = drawn.solved(SCENES / "paper.toml", layer__kind="winkler", layer__normal_compliance=0.0,
                                   layer__tangential_compliance=compliance, grid__cells=[96, 96],
                                   grid__extent=[2.4 * RADIUS, 2.4 * RADIUS])
        self.bad(on_mesh(soft), "stick slope is about", twist=twist)
        frozen, _ = drawn.solved(SCENES / "ellipse.toml", solver__method="paper")
        self.bad(on_mesh(frozen, "graded", "nodes", AXES), "a direction that does not oppose their slip", scene="ellipse")


if __name__ == "__main__":
    unittest.main()
