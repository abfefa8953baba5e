"""Cases of slipstick.conformance: an independent superposition of springs with sliders passes each; drawn mistakes turn red, with their
cause. The superposition takes Lubkin's law from drawn_loops, nothing of the program's."""

import csv
import importlib.util
import json
import math
import re
import subprocess
import sys
import tempfile
import unittest
from dataclasses import replace
from functools import partial
from pathlib import Path

import drawn_loops
import numpy as np
import slipstick
from drawn_loops import HERTZ
from slipstick import InputError, conformance
from slipstick.conformance import Sphere, cases, judge

SPHERE = Sphere()
DRAWS = 5  # of each mistake


class Elements:
    """Jenkins elements, one for each radius c: dk = 16 G c^2 dc of a rigid punch, which slips at the twist at which first loading under
    the current normal load sticks inside c. Elements outside of the contact carry nothing, and new ones start without load."""

    def __init__(self, sphere, count=6000):
        self.sphere = sphere
        largest = self.radius(4 * sphere.normal_load)
        ends = largest * np.linspace(0, 1, count + 1)
        self.c, self.each = 0.5 * (ends[1:] + ends[:-1]), 16 / 3 * self.shear * np.diff(ends**3)
        points = len(HERTZ[0])
        x = np.concatenate([[0.0], np.geomspace(1e-9, 0.02, 3000), np.linspace(0.02, 1 - 1e-5, 12000)[1:]])
        assert len(x) == points
        self.complement, self.slips = x, HERTZ[0]

    @property
    def shear(self):
        return self.sphere.young_modulus / (4 * (1 + self.sphere.poisson_ratio))

    def radius(self, load):
        return (3 * load * self.sphere.radius * (1 - self.sphere.poisson_ratio**2) / (2 * self.sphere.young_modulus))**(1 / 3)

    def thresholds(self, load):
        a = self.radius(load)
        unit = self.sphere.friction * load / (self.shear * a**2)
        return np.where(self.c < a, unit * np.interp(np.maximum(0, 1 - self.c / a), self.complement, self.slips), 0.0)

    def follow(self, load, motion, solve=False):
        """Moments at these twists; with solve the twists at these moments. One run, from rest."""
        slid, before, found, allowed = np.zeros_like(self.c), 0.0, [], {}
        for w, x in zip(load, motion):
            if w not in allowed:
                allowed = {w: self.thresholds(w)}
            y, twist = allowed[w], x
            if solve:  # the moment rises with the twist
                low, high = before - 0.1, before + 0.1
                for _ in range(60):
                    twist = 0.5 * (low + high)
                    if self.each @ np.clip(twist - slid, -y, y) < x:
                        low = twist
                    else:
                        high = twist
            slid, before = twist - np.clip(twist - slid, -y, y), twist
            found.append(twist if solve else self.each @ (twist - slid))
        return np.array(found)


def by_run(case, one):
    """A response, run by run; one(rows) gives that of a run."""
    return np.concatenate([one(case.run == run) for run in np.unique(case.run)])


def named(name):
    return next(case for case in cases() if case.id == name)


def sliding(case, draw_surface):
    """Force and moment of a surface that gives the ratios of both for a motion in their plane."""
    load = SPHERE.normal_load
    units = SPHERE.friction * load, SPHERE.limit(load)
    motion = np.column_stack([case.displacement * units[0], case.twist * units[1]])
    pairs = np.array([draw_surface(*(one / np.hypot(*one))) for one in motion])
    return {"force": pairs[:, 0] * units[0], "moment": pairs[:, 1] * units[1]}


class Right(unittest.TestCase):
    def test_exact_responses_pass(self):
        for sphere in (SPHERE, Sphere(radius=2.0, normal_load=5.0, friction=0.9, young_modulus=1e6, poisson_ratio=0.49)):
            for case in cases(sphere):
                for column in case.responses:
                    with self.subTest(case=case.id, column=column, sphere=sphere):
                        self.assertTrue(judge(case, {column: getattr(case, column)}).passed)

    def test_superposition_passes(self):
        elements = Elements(SPHERE)
        for case in cases():
            if case.id.startswith("hold-force") or case.id == "limit-surface":
                continue
            column = case.responses[0]
            given = case.moment if column == "twist" else case.twist
            found = by_run(case, lambda rows: elements.follow(case.normal_load[rows], given[rows], column == "twist"))
            with self.subTest(case=case.id):
                verdict = judge(case, {column: found})
                self.assertTrue(verdict.passed, (verdict, verdict.numbers))
                self.assertLess(np.abs(found - getattr(case, column)).max(), 1e-3 * np.abs(getattr(case, column)).max())

    def test_limit_surface_by_a_sum_over_the_contact(self):
        case, (r, angle) = named("limit-surface"), np.meshgrid((np.arange(2000) + 0.5) / 2000, math.pi * (np.arange(400) + 0.5) / 400)
        weight = r * np.sqrt(1 - r * r)
        arm = 3 * math.pi / 16

        def surface(force, moment):  # a motion in the plane of F/(mu W) and M/M_lim
            speed, turning = force, moment / arm  # F v + M omega
            vx, vy = speed - turning * r * np.sin(angle), turning * r * np.cos(angle)
            size = np.hypot(vx, vy)
            return (weight * vx / size).sum() / weight.sum(), (weight * r * (np.cos(angle) * vy - np.sin(angle) * vx) / size).sum() / (
                weight.sum() * arm)

        def both(force, moment):  # the half circle of angles, and its mirror image
            one, other = surface(force, moment), surface(-force, moment)
            return 0.5 * (one[0] - other[0]), 0.5 * (one[1] + other[1])
        verdict = judge(case, self.last_rows(case, both))
        self.assertTrue(verdict.passed, verdict)
        self.assertLess(max(map(abs, verdict.numbers.values())), 2e-3)

    @staticmethod
    def last_rows(case, surface):
        """As sliding, with one pair for each run."""
        found = {"force": np.empty_like(case.time), "moment": np.empty_like(case.time)}
        for run in np.unique(case.run):
            rows = case.run == run
            part = replace(case, twist=case.twist[rows][-1:], displacement=case.displacement[rows][-1:])
            for name, value in sliding(part, surface).items():
                found[name][rows] = value[0]
        return found

    def test_normal_load_on_a_grid(self):
        case, loads = named("normal-load"), (1000, 2000, 1000, 800, 650)
        steps = "".join(f"[[step]]\nnormal = {load}\nmoment = {case.moment[-1]}\n" for load in loads)
        body = f"young_modulus = {SPHERE.young_modulus}\npoisson_ratio = {SPHERE.poisson_ratio}\n"
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.toml"
            scene.write_text(f'name = "held"\n[upper]\nshape = "sphere"\nradius = {SPHERE.radius}\n{body}[lower]\n{body}[contact]\n'
                             f'friction = {SPHERE.friction}\n[load]\nnormal = 1000\nmoment = {case.moment[-1]}\n{steps}'
                             '[grid]\ncells = [64, 64]\n')
            found = [step.twist_angle for step in slipstick.solve(scene).steps]
        loaded, back, fallen = case.marks["phases"]
        fall = [np.interp(-load, -case.normal_load[back:], case.twist[back:]) for load in loads[3:]]
        np.testing.assert_allclose(found, [case.twist[loaded], case.twist[(loaded + back) // 2], case.twist[back], *fall], rtol=5e-4)

    def test_powers_of_the_load(self):
        self.assertAlmostEqual(SPHERE.stiffness(8.0) / SPHERE.stiffness(1.0), 8.0, places=9)
        self.assertAlmostEqual(SPHERE.limit(8.0) / SPHERE.limit(1.0), 16.0, places=9)


class Wrong(unittest.TestCase):
    def setUp(self):
        self.draw = np.random.default_rng(11)

    def turns(self, color, case, response, *causes):
        verdict = judge(case, response)
        self.assertEqual(verdict.verdict, color, verdict)
        self.assertIn(verdict.cause, causes, verdict)

    def test_nan_never_passes(self):
        for case in cases():
            for column in case.responses:
                for value in (math.nan, math.inf):
                    wrong = getattr(case, column).copy()
                    wrong[self.draw.integers(len(wrong))] = value
                    self.turns("red", case, {column: wrong}, "not_a_number")

    def test_zeros_do_not_pass(self):
        for case in cases():
            for column in case.responses:  # a rigid contact does not creep
                with self.subTest(case=case.id, column=column):
                    self.assertEqual(judge(case, {column: 0 * case.time}).verdict, "green" if case.id.startswith("hold") else "red")

    def test_regularised_friction_creeps(self):
        for _ in range(DRAWS):
            for case in cases():
                if case.id.startswith("hold"):
                    motion, part = case.responses[0], float(case.id.split("-")[2])
                    slow = case.marks["rate"] * 10**self.draw.uniform(-3, 1)  # the rate of tanh
                    self.turns("red", case, {motion: getattr(case, motion) + slow * math.atanh(part) * case.time}, "creeps")
            case = named("first-loading")
            rate = np.gradient(case.twist, case.time)
            shape = np.tanh(rate / (self.draw.uniform(0.05, 0.8) * rate.max())) * SPHERE.limit(SPHERE.normal_load)
            self.turns("red", case, {"moment": shape}, "regularised")

    def test_least_creep(self):
        case = named("hold-moment-0.9")
        for part, color in ((0.9e-6, "green"), (1.1e-6, "amber"), (1.1e-4, "red")):
            self.assertEqual(judge(case, {"twist": case.twist + part * case.marks["rate"] * case.time}).verdict, color)

    def test_powers(self):
        case = named("load-powers")
        ratio = case.normal_load / SPHERE.normal_load
        for power, cause in ((0, "normal_load_ignored"), (1, "constant_radius"), (5 / 4, "hydroelastic_radius"), (3 / 2, "wrong_power")):
            limit = self.draw.uniform(0.5, 2) * ratio**(power - 4 / 3)
            self.turns("red", case, {"moment": case.moment * limit}, cause)
        for power, cause in ((0, "constant_stiffness"), (1 / 3, "tangential_stiffness"), (2 / 3, "stiffness_like_a2")):
            spring = SPHERE.stiffness(SPHERE.normal_load) * self.draw.uniform(0.8, 1.2) * ratio**power * case.twist
            limit = np.array([SPHERE.limit(load) for load in case.normal_load])
            self.turns("red", case, {"moment": limit * np.tanh(spring / limit)}, cause)

    def test_memory(self):
        case, unit, limit = named("memory"), SPHERE.rotation(SPHERE.normal_load), SPHERE.limit(SPHERE.normal_load)
        t = case.twist / unit
        for moment, *causes in ((drawn_loops.without_masing(t, drawn_loops.exact), "not_enlarged"),
                                (drawn_loops.isotropic(t, drawn_loops.exact), "unloads_without_slip"),
                                (drawn_loops.by_moment(t, lambda m: 1 - m), "dahl"),
                                (drawn_loops.line(t), "elastic"),
                                (drawn_loops.masing(t, drawn_loops.spring), "spring_and_cap")):
            self.turns("red", case, {"moment": np.asarray(moment) * limit}, *causes)

    def test_loops(self):
        case, unit, limit = named("loops"), SPHERE.rotation(SPHERE.normal_load), SPHERE.limit(SPHERE.normal_load)
        t = case.twist / unit
        for moment, cause in ((drawn_loops.exact(t), "elastic"), (drawn_loops.masing(t, drawn_loops.exponential), "exponential"),
                              (drawn_loops.masing(t, drawn_loops.spring), "spring_and_cap")):
            self.turns("red", case, {"moment": moment * limit}, cause)

    def test_rates(self):
        case = named("rates")
        for _ in range(DRAWS):
            rate = by_run(case, lambda rows: np.gradient(case.twist[rows], case.time[rows]))
            part = self.draw.uniform(0.06, 0.5) * np.abs(case.moment).max() * rate / np.abs(rate).max()
            self.turns("red", case, {"moment": case.moment + part}, "grows_with_rate")
            stribeck = 1 + self.draw.uniform(0.1, 0.5) * np.exp(-np.abs(rate) / np.abs(rate).max() * 10)
            self.turns("red", case, {"moment": case.moment * stribeck}, "falls_with_rate")
            creep = by_run(case, lambda rows: np.cumsum(np.abs(case.moment[rows]) * np.gradient(case.time[rows])))
            creep *= self.draw.uniform(1, 9) * np.abs(case.twist).max() / creep.max()
            self.turns("red", case, {"twist": case.twist + creep}, "creeps")

    def test_limit_surfaces(self):
        case = named("limit-surface")

        def box(f, m):
            return float(f > 1e-12), float(m > 1e-12)
        self.turns("red", case, sliding(case, box), "box")
        self.turns("red", case, sliding(case, lambda f, m: (f, m)), "ellipsoid")
        self.turns("red", case, sliding(case, lambda f, m: (1.0, 0.0) if f > m else (0.0, 1.0)), "diamond")
        for _ in range(DRAWS):
            high = self.draw.uniform(1.11, 2)
            self.turns("red", case, {"force": case.force, "moment": high * case.moment}, "limits")
        for weak, cause in ((0.0, "moment_off"), (0.04, "moment_off"), (0.3, "limits")):
            self.turns("red", case, {"force": case.force, "moment": weak * case.moment}, cause)

    def test_free_bodies_neither_creep_nor_slide(self):
        for case in cases():
            motion, load = (case.responses[-1], "force" if case.responses[-1] == "displacement" else "moment")
            if motion not in ("twist", "displacement"):
                continue
            inertia = 10**self.draw.uniform(-9, -5) * np.abs(getattr(case, load)).max() / np.abs(getattr(case, motion)).max()

            def stepped(rows, bound, load=load, inertia=inertia):  # in small steps, as simulators take them
                ends = np.rint(1e4 * case.time[rows]).astype(int)
                loads = np.interp(1e-4 * np.arange(ends[-1] + 1), case.time[rows], getattr(case, load)[rows])
                speed = np.cumsum(1e-4 * loads / inertia)
                return np.cumsum(1e-4 * np.clip(speed, -bound * np.abs(speed).max(), bound * np.abs(speed).max()))[ends]
            for bound in (1.0, 0.2):  # some programs bound the rate
                self.turns("red", case, {motion: by_run(case, partial(stepped, bound=bound))}, "free")
            size = np.abs(getattr(case, motion)).max()
            self.assertNotEqual(judge(case, {motion: drag(case, motion, load)}).cause, "free", case.id)
            for wrong in (1e3 * size * case.time, 1e3 * size * np.maximum(0, case.time - 0.8)**2):  # creeps, or slides late
                self.assertNotEqual(judge(case, {motion: getattr(case, motion) + wrong}).cause, "free")

    def test_weak_moments_have_no_power(self):
        case = named("load-powers")
        for factor in (0.0, 1e-3, 0.04):
            verdict = judge(case, {"moment": factor * case.moment * (case.normal_load / SPHERE.normal_load)**(1 / 6)})
            self.assertEqual((verdict.verdict, verdict.cause), ("red", "moment_off"))
            self.assertIn(f"the moment is {factor:.2g} times", verdict.why)
        self.turns("red", case, {"moment": -case.moment}, "unknown")  # drives; it is not rigid

    def test_normal_load(self):
        case = named("normal-load")
        loaded = case.marks["phases"][0]
        for _ in range(DRAWS):
            stiff = self.draw.uniform(0.3, 3)
            self.turns("red", case, {"twist": stiff * np.where(case.time < 1, case.twist, case.twist[loaded])}, "normal_load_ignored")
            follows = case.moment / np.array([SPHERE.stiffness(load) for load in case.normal_load])
            self.turns("red", case, {"twist": stiff * follows}, "no_memory_of_load")
            creep = self.draw.uniform(0.1, 5) * case.twist[loaded] * np.maximum(0, case.time - 1)
            self.turns("red", case, {"twist": stiff * case.twist + creep}, "creeps")
        self.turns("red", case, {"twist": 0 * case.twist}, "rigid")
        exact = Elements(SPHERE).follow(np.full(len(case.time), SPHERE.normal_load), case.moment, True)
        self.turns("red", case, {"twist": exact}, "normal_load_ignored")


def drag(case, motion, load):
    """A body with an inertia and a viscous drag that bounds its rate after half a second, in steps of 1e-3 s."""
    def one(rows):
        ends, rate, at, found = np.rint(1e3 * case.time[rows]).astype(int), 0.0, 0.0, [0.0]
        for pushed in np.interp(1e-3 * np.arange(1, ends[-1] + 1), case.time[rows], getattr(case, load)[rows]):
            rate += 1e-3 * (pushed - rate / 0.5)
            at += 1e-3 * rate
            found.append(at)
        return np.array(found)[ends]
    response = by_run(case, one)
    return response * 1e3 * np.abs(getattr(case, motion)).max() / np.abs(response).max()


class Files(unittest.TestCase):
    def test_arguments(self):
        case = named("first-loading")
        for response in ({}, {"force": case.force}, {"moment": case.moment[1:]}, {"Moment": case.moment}):
            self.assertRaises(InputError, judge, case, response)
        self.assertTrue(judge(case, case.moment).passed)

    def test_written_cases_are_the_cases(self):
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
            conformance.write(one)
            for file in conformance.write(other):
                self.assertEqual(file.read_bytes(), (Path(one) / file.name).read_bytes())
            listed = json.loads((Path(one) / "cases.json").read_text())["cases"]
            self.assertEqual([entry["id"] for entry in listed], [case.id for case in cases()])
            for entry, case in zip(listed, cases()):
                with open(Path(one) / entry["file"], newline="") as file:
                    rows = list(csv.DictReader(file))
                response = {name: [float(row[name]) for row in rows] for name in entry["responses"]}
                self.assertTrue(judge(case, response).passed)

    def test_board(self):
        def row(factor, **other):
            judged = {case.id: judge(case, {name: factor * getattr(case, name) for name in case.responses[:1]}) for case in cases()}
            return {"program": "P", "version": "1", "friction": "own", "seconds": 1.0, "cases": {**judged, **other}}
        text, result = conformance.board([row(1.0, memory="no twisting moment")])
        self.assertIn("| memory | P 1 | own | none |  | no twisting moment |", text)
        cells = result["programs"][0]["cases"]
        self.assertEqual({cells[name]["verdict"] for name in cells if name != "memory"}, {"green"})
        later, changed = conformance.board([row(1.2)], json.loads(json.dumps(result)))
        # Stiffness and deviation are equal but for rounding.
        self.assertRegex(later, r"\| first-loading \| P 1 \| own \| red \(before: green\) \| (stiffness|deviation) 20 % \| factor \|")
        self.assertEqual(changed["programs"][0]["cases"]["first-loading"]["cause"], "factor")

    @unittest.skipUnless(importlib.util.find_spec("pytest"), "pytest is not installed")
    def test_example_of_the_guide(self):
        guide = Path(__file__).resolve().parents[3] / "docs/guides/test-your-simulator.md"
        example = next(block for block in re.findall(r"```python\n(.*?)```", guide.read_text(), re.S) if "parametrize" in block)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "test_friction.py"
            for factor, code in ((1.0, 0), (2.0, 1)):
                (Path(folder) / "my_simulator.py").write_text(
                    f"def respond(case):\n    return {{name: {factor} * getattr(case, name) for name in case.responses[:1]}}\n")
                file.write_text(example)
                words = [sys.executable, "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", file]
                self.assertEqual(subprocess.run(words, cwd=folder, capture_output=True).returncode, code)


if __name__ == "__main__":
    unittest.main()
