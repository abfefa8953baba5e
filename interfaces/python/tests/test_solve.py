"""slipstick.solve: facts, fields without copies, progress, Ctrl-C, errors."""
import copy
import gc
import json
import importlib.util
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from unittest import mock

import numpy as np
import slipstick
from scenes import SPHERE
from slipstick._scene import toml_text


def solved_at(load):
    return slipstick.solve(SPHERE, load__normal=load)


# This uses only ctypes, since NumPy does not support trapped exceptions. Exact states at their ends, and solves on one thread and on two.
TRAPPED = """
import ctypes, sys
library, libm = ctypes.CDLL(sys.argv[1]), ctypes.CDLL("libm.so.6")
numbers = (ctypes.c_double * 5)(0, 1e-9, 0.3, 0.999, 1)
results = (ctypes.c_double * 5)()
traps = 1 | 4 | 8  # invalid, division by zero, overflow on x86
assert libm.feenableexcept(traps) >= 0
for profile in (b"hertz", b"cone", b"flat_punch", b"power:1.5", b"rounded_punch:0.5"):
    for given in range(5):
        for i in range(5):
            number = ctypes.byref(numbers, 8 * i)
            library.slipstick_exact(profile, given, ctypes.c_size_t(1), number, 4, ctypes.byref(results, 8 * i))
for threads in (b"solver.threads=1", b"solver.threads=2"):
    solution = ctypes.c_void_p()
    assert library.slipstick_solve(sys.argv[2].encode(), None, ctypes.c_size_t(1), (ctypes.c_char_p * 1)(threads),
                                   ctypes.c_double(0), None, None, ctypes.byref(solution)) == 0
    library.slipstick_solution_free(solution)
assert libm.fegetexcept() & 0x3f == traps, "the caller's traps are as they were"
"""

# FFTW stores plans; plans chosen under another rounding mode would change the digits of later solves.
SEEDED = """
import ctypes, re, slipstick
from scenes import SPHERE

def stop(iteration, change):
    raise ZeroDivisionError

def remembered():
    library = ctypes.CDLL(re.search(r"/\\S*/libfftw3[.-]\\S*", open("/proc/self/maps").read())[0])
    library.fftw_export_wisdom_to_string.restype = ctypes.c_char_p
    return library.fftw_export_wisdom_to_string()

nothing = remembered()
try:
    slipstick.solve(SPHERE, solver__rounding_seed=1, progress=stop)
except ZeroDivisionError:
    print("failed", remembered() == nothing)
slipstick.solve(SPHERE)
print("solved", remembered() == nothing)
"""

AT_EXIT = """
import atexit, slipstick
from scenes import SPHERE
atexit.register(lambda: print(solution.fields["pressure"].sum() * solution.cell_size[0] * solution.cell_size[1], traction.max()))
solution = slipstick.solve(SPHERE)
traction = solution.fields["q1"]
"""


def run_script(text, *words):
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([os.environ.get("PYTHONPATH", ""), str(Path(__file__).parent)])}
    return subprocess.run([sys.executable, "-B", "-c", text, *words], capture_output=True, text=True, env=environment)


class ProcessTest(unittest.TestCase):
    """The library in processes of other programs."""

    def test_a_process_that_forks_while_threads_solve(self):
        """Each new process solves too, to the same bits."""
        def twist():
            return slipstick.solve(SPHERE, grid__cells=[24, 24]).twist_angle

        expected, ended = twist(), threading.Event()

        def go_on():
            while not ended.is_set():
                twist()

        threads = [threading.Thread(target=go_on) for _ in range(4)]
        for thread in threads:
            thread.start()
        try:
            for _ in range(20):
                process = os.fork()
                if process == 0:
                    signal.alarm(120)  # a process that waits for the lock of a thread of its parent
                    same = False
                    try:
                        same = twist() == expected and slipstick.solve(SPHERE, solver__rounding_seed=1).converged
                    finally:
                        os._exit(0 if same else 1)
                self.assertEqual(os.waitpid(process, 0)[1], 0)
        finally:
            ended.set()
            for thread in threads:
                thread.join()

    @unittest.skipUnless(os.uname().machine == "x86_64", "the numbers of exceptions are those of x86")
    def test_trapped_exceptions_stay_the_callers(self):
        end = run_script(TRAPPED, str(slipstick._library._NATIVE / "libslipstick.so"), toml_text(SPHERE))
        self.assertEqual((end.returncode, end.stderr), (0, ""))

    def test_a_failed_solve_with_a_seed_leaves_no_digit(self):
        end = run_script(SEEDED)
        self.assertEqual((end.stdout.splitlines(), end.stderr), (["failed True", "solved False"], ""))


class CopyTest(unittest.TestCase):
    """A solution outlives the one that it was copied from, and its process."""

    def test_copies_carry_their_values(self):
        for how in (copy.copy, copy.deepcopy, lambda solution: pickle.loads(pickle.dumps(solution))):
            solution = solved_at(900.0)
            said = solution.to_dict(), solution.text, solution.message
            fields = {name: field.copy() for name, field in solution.fields.items()}
            copied = how(solution)
            del solution
            gc.collect()
            others = [solved_at(700.0 + i) for i in range(3)]  # would reuse the memory
            self.assertEqual((copied.to_dict(), copied.text, copied.message), said)
            self.assertEqual(list(copied.fields), list(fields))
            for name, field in fields.items():
                np.testing.assert_array_equal(copied.fields[name], field)
            self.assertEqual(len(others), 3)

    def test_a_pool_returns_each_its_own(self):
        loads = [500.0, 700.0, 900.0]
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            for load, solution in zip(loads, pool.map(solved_at, loads), strict=True):
                self.assertAlmostEqual(solution.fields["pressure"].sum() * np.prod(solution.cell_size), load, places=6)
                with self.assertRaisesRegex(slipstick.InputError, "in its process"):
                    solution.write("fields.csv")

    def test_a_reader_at_exit_finds_it(self):
        end = run_script(AT_EXIT)
        self.assertEqual((end.returncode, end.stderr), (0, ""))
        load, traction = map(float, end.stdout.split())
        self.assertAlmostEqual(load, 1000.0, places=6)
        self.assertGreater(traction, 0)


class SolveTest(unittest.TestCase):
    def test_numbers_and_fields_agree(self):
        solution = slipstick.solve(SPHERE)
        self.assertTrue(solution.converged)
        fields, area = solution.fields, np.prod(solution.cell_size)
        self.assertEqual(fields["pressure"].shape, (48, 48))
        self.assertAlmostEqual(fields["pressure"].sum() * area, 1000.0, places=6)
        moment = (fields["x1"] * fields["q2"] - fields["x2"] * fields["q1"]).sum() * area
        self.assertAlmostEqual(moment / solution.moment, 1, places=9)
        self.assertLess(abs(solution.twist_error), 1e-3)
        self.assertLessEqual(solution.certificate.gap, 1e-8)
        self.assertTrue((np.diff(fields["x1"][:, 0]) > 0).all() and (np.diff(fields["x2"][0]) > 0).all())
        exact = slipstick.exact.twist(0.9)
        self.assertAlmostEqual(solution.twist / exact, 1, delta=1e-3)

    def test_x2_runs_along_a_row_and_each_side_is_that_of_its_axis(self):
        solution = slipstick.solve(SPHERE, grid__cells=[48, 32], grid__extent=[1.2e-3, 1.4e-3])
        np.testing.assert_allclose(solution.cell_size, [1.2e-3 / 48, 1.4e-3 / 32], rtol=1e-12)
        for axis, name in enumerate(("x1", "x2")):
            self.assertEqual(solution.fields[name].shape, (48, 32))
            np.testing.assert_allclose(np.diff(solution.fields[name], axis=axis), solution.cell_size[axis], rtol=1e-9)
            self.assertEqual(np.ptp(solution.fields[name], axis=1 - axis).max(), 0)

    def test_scene_as_dict_text_and_file_is_one_scene(self):
        from slipstick._scene import toml_text
        text = toml_text(SPHERE)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "mine.toml"
            file.write_text(text)
            twists = {slipstick.solve(scene, load__moment_ratio=0.4).twist_angle
                      for scene in (SPHERE, text, file, str(file))}
        self.assertEqual(len(twists), 1)

    def test_texts_arrive_as_they_are(self):
        for name in ('in "quotes"', "back\\slash", "two\nlines\ttab", "µ\x7f", "a = [b]"):
            self.assertEqual(slipstick.solve(SPHERE | {"name": name}).name, name)
        self.assertEqual(slipstick.solve(SPHERE, name="[1, 2]").name, "[1, 2]")

    def test_overrides(self):
        scene = copy.deepcopy(SPHERE)
        scene["load"]["moment_ratio"] = 0.3
        scene["grid"]["cells"] = [24, 24]
        self.assertEqual(slipstick.solve(scene).twist_angle,
                         slipstick.solve(SPHERE, load__moment_ratio=np.float64(0.3), grid__cells=np.array([24, 24])).twist_angle)
        self.assertEqual(slipstick.solve(scene).twist_angle,
                         slipstick.solve(SPHERE, **{"load.moment_ratio": 0.3, "grid.cells": (24, 24)}).twist_angle)

    def test_exact_model_and_accuracy(self):
        exact = slipstick.solve(SPHERE, solver__model="exact")
        self.assertEqual(exact.method, "exact")
        self.assertEqual(sorted(exact.fields), ["pressure", "q1", "q2", "stick", "x1", "x2"])
        self.assertAlmostEqual(exact.twist, slipstick.exact.twist(0.9), delta=1e-14)
        self.assertIsNone(exact.twist_error)
        self.assertIn("exact", exact.reason("twist_error"))
        close = slipstick.solve(SPHERE, accuracy=1e-3, solver__model="auto")
        self.assertLessEqual(close.accuracy.reached, 1e-3)
        self.assertLessEqual(abs(close.twist_angle / exact.twist_angle - 1), 1e-3)

    def test_history(self):
        scene = {name: part for name, part in SPHERE.items() if name != "load"}
        scene["step"] = [{"name": "on", "normal": 1000.0, "moment_ratio": 0.8}, {"name": "back", "moment_ratio": -0.8}]
        solution = slipstick.solve(scene)
        self.assertEqual([step.name for step in solution.steps], ["on", "back"])
        self.assertAlmostEqual(solution.steps[1].twist_angle / solution.steps[0].twist_angle, -1, delta=1e-6)
        area = np.prod(solution.cell_size)
        for copied in (solution, pickle.loads(pickle.dumps(solution))):
            for step in copied.steps:  # the fields of each step carry its own moment
                fields = step.fields
                self.assertAlmostEqual((fields.x1 * fields.q2 - fields.x2 * fields.q1).sum() * area / step.moment, 1, places=9)
            np.testing.assert_array_equal(copied.steps[-1].fields.q1, solution.fields.q1)
        self.assertEqual(repr(solution.steps[1])[:12], "Step('back':")
        exact = slipstick.solve(scene, solver__model="exact")
        self.assertEqual([step.twist_angle for step in exact.steps], [exact.twist_angle])

    def test_a_history_too_long_to_keep_its_fields_says_so(self):
        scene = {name: part for name, part in SPHERE.items() if name != "load"}
        scene["step"] = [{"normal": 1000.0, "moment_ratio": sign * 0.5} for sign in (1, -1) * 4]
        scene["grid"] = {"cells": [1024, 1024], "extent": [0.04, 0.04]}  # 8 steps of 9 fields take 576 MiB
        solution = slipstick.solve(scene)
        with self.assertRaisesRegex(slipstick.InputError, "at most 512 MiB; slipstick solve --fields"):
            solution.steps[0].fields

    def test_one_load_is_one_step(self):
        solution = slipstick.solve(SPHERE)
        self.assertIs(solution.steps[0].fields, solution.fields)

    def test_height_maps_may_be_arrays(self):
        """A paraboloid as an array is the sphere, in a scene and as an override."""
        spacing, cells = 2e-5, 64
        at = spacing * (np.arange(cells) - (cells - 1) / 2)
        heights = (at[:, None]**2 + at**2) / (2 * 0.018)
        scene = SPHERE | {"grid": {"cells": [cells, cells]}}
        scene["upper"] = {"shape": "height_map", "file": heights, "spacing": [spacing, spacing], "young_modulus": 210e9,
                          "poisson_ratio": 0.3}
        sphere = slipstick.solve(SPHERE, grid__cells=[cells, cells], grid__extent=[cells * spacing] * 2)
        mapped = slipstick.solve(scene)
        self.assertAlmostEqual(mapped.twist_angle / sphere.twist_angle, 1, delta=1e-9)
        halved = slipstick.solve(scene, upper__file=heights / 2)  # twice the radius
        self.assertAlmostEqual(halved.contact_radius / mapped.contact_radius, 2**(1 / 3), delta=0.01)

    def test_scenes_of_the_package(self):
        """Each is a file with a line about it, and solve takes it."""
        listed = slipstick.scenes()
        self.assertIn("paper", listed)
        self.assertEqual(len(repr(listed).splitlines()), len(listed))
        for name, line in listed.items():
            self.assertTrue(slipstick.scene(name).is_file() and 10 < len(line) < 180, f"{name}: {line}")
        self.assertAlmostEqual(slipstick.solve(slipstick.scene("paper"), solver__model="exact").twist, slipstick.exact.twist(0.9), 12)
        with self.assertRaisesRegex(slipstick.InputError, "no scene papre; the nearest name is paper"):
            slipstick.scene("papre")

    def test_fields_outlive_the_solution_and_are_no_copies(self):
        solution = slipstick.solve(SPHERE)
        pressure = solution.fields["pressure"]
        self.assertEqual(pressure.ctypes.data, solution.fields["pressure"].ctypes.data)
        self.assertFalse(pressure.flags.owndata or pressure.flags.writeable)
        total = pressure.sum()
        del solution
        gc.collect()
        others = [slipstick.solve(SPHERE, load__normal=500.0 + i) for i in range(3)]  # would reuse the memory
        self.assertEqual(pressure.sum(), total)
        self.assertEqual(len(others), 3)

    def test_result(self):
        solution = slipstick.solve(SPHERE)
        plain = solution.to_dict()
        json.dumps(plain)
        plain["certificate"]["gap"] = 7
        self.assertLess(solution.certificate.gap, 1)
        self.assertIn("converged", solution.text)
        html = solution._repr_html_()
        self.assertIn("<th>twist_angle</th>", html)
        self.assertNotIn("_reason", html)
        named = slipstick.solve(SPHERE | {"name": "<script>"})
        self.assertIn("&lt;script&gt;", named._repr_html_())
        self.assertIn("twist_angle", dir(solution))
        self.assertEqual(len(repr(solution).splitlines()), 5)
        with self.assertRaisesRegex(AttributeError, "no twist_angel; the nearest name is twist_angle"):
            solution.twist_angel
        with self.assertRaisesRegex(KeyError, "no field presure; the nearest name is pressure"):
            solution.fields["presure"]
        with self.assertRaisesRegex(AttributeError, "no field presure; the nearest name is pressure"):
            solution.fields.presure
        self.assertIs(solution.fields.q1, solution.fields["q1"])

    def test_write(self):
        with tempfile.TemporaryDirectory() as folder:
            solution = slipstick.solve(SPHERE)
            solution.write(Path(folder) / "fields.csv")
            header = (Path(folder) / "fields.csv").read_text().splitlines()[0].split(",")
            self.assertEqual(header, list(solution.fields))
            solution.write(Path(folder) / "fields.npz")
            with np.load(Path(folder) / "fields.npz") as stored:
                self.assertEqual(stored["q1"].size, np.count_nonzero(solution.fields.pressure))
            solution.write(Path(folder) / "fields.h5")
            self.assertTrue((Path(folder) / "fields.h5").read_bytes().startswith(b"\x89HDF"))
            with self.assertRaisesRegex(slipstick.InputError, "allowed: .h5"):
                solution.write(Path(folder) / "fields.doc")

    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib is not installed")
    def test_plot(self):
        import matplotlib
        matplotlib.use("agg")
        for model in ("auto", "exact"):
            solution = slipstick.solve(SPHERE, solver__model=model)
            figure = solution.plot()
            titles = [axis.get_title() for axis in figure.axes if axis.get_title()]
            self.assertEqual(titles[:2], ["pressure (MPa)", "traction |q| (MPa)"])
            self.assertIn("stick", titles[2])
            drawn = figure.axes[0].collections[0].get_array()
            self.assertAlmostEqual(np.nanmax(drawn) * 1e6 / solution.fields.pressure.max(), 1, places=12)

    @unittest.skipUnless(importlib.util.find_spec("pandas"), "pandas is not installed")
    def test_frames(self):
        frame = slipstick.solve(SPHERE).fields_frame()
        self.assertTrue((frame.pressure > 0).all())


class WrongTest(unittest.TestCase):
    def test_messages_are_those_of_the_program(self):
        for words, overrides in [("contact.friction = -1", {"contact__friction": -1.0}),
                                 ("the nearest known one is contact.friction", {"contact__frictoin": 0.1}),
                                 ("load.moment_ratio = 1.5", {"load__moment_ratio": 1.5})]:
            with self.assertRaises(slipstick.InputError) as caught:
                slipstick.solve(SPHERE, **overrides)
            self.assertIn(words, str(caught.exception))
        with self.assertRaisesRegex(slipstick.InputError, "nowhere.toml: cannot be read"):
            slipstick.solve("nowhere.toml")
        with self.assertRaisesRegex(slipstick.InputError, "scene:2: upper.shape"):
            slipstick.solve('[upper]\nshape = "shpere"\n')
        with self.assertRaisesRegex(slipstick.InputError, "allowed: numbers, texts"):
            slipstick.solve({"upper": {"shape": object()}})

    def test_not_converged_is_a_warning(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            solution = slipstick.solve(SPHERE, solver__max_iterations=1)
        self.assertFalse(solution.converged)
        self.assertEqual([(each.category, str(each.message)) for each in caught],
                         [(slipstick.NotConvergedWarning, solution.message)])
        self.assertGreater(len(solution.message), 10)


class ProgressTest(unittest.TestCase):
    def test_progress_is_told(self):
        seen = []
        slipstick.solve(SPHERE, progress=lambda iteration, change: seen.append((iteration, change)))
        self.assertGreater(len(seen), 1)
        self.assertLess(seen[-1][1], seen[0][1])

    def test_the_pressure_is_part_of_it(self):
        def calls(**overrides):
            seen = []
            slipstick.solve(SPHERE, progress=lambda *at: seen.append(at), **overrides)
            return len(seen)

        self.assertGreater(calls(), calls(contact__pressure="hertz"))

    def test_what_progress_raises_ends_the_solve(self):
        def stop(iteration, change):
            raise ZeroDivisionError("mine")

        called, watched = slipstick.solution._Progress._called, []
        watch = mock.patch.object(slipstick.solution._Progress, "_called",
                                  lambda self, *at: watched.append(at) or called(self, *at))
        with watch, self.assertRaisesRegex(ZeroDivisionError, "mine"):
            slipstick.solve(SPHERE, progress=stop)
        self.assertEqual(len(watched), 1)  # the library stops solving
        self.assertTrue(slipstick.solve(SPHERE).converged)

    def test_ctrl_c(self):
        before = signal.getsignal(signal.SIGINT)
        started = threading.Event()

        def strike():
            started.wait()
            os.kill(os.getpid(), signal.SIGINT)

        striker = threading.Thread(target=strike)
        striker.start()

        def seen(iteration, change):
            started.set()
            striker.join()

        with self.assertRaises(KeyboardInterrupt):
            slipstick.solve(SPHERE, progress=seen)
        self.assertIs(signal.getsignal(signal.SIGINT), before)

    def test_ctrl_c_while_nothing_is_watched(self):
        """The signal ends a long history without a progress function, long before its end."""
        scene = {name: part for name, part in SPHERE.items() if name != "load"}
        scene["step"] = [{"normal": 1000.0, "moment_ratio": 0.8}, {"moment_ratio": -0.8}]
        scene["cycles"] = 2000
        before = signal.getsignal(signal.SIGINT)

        def strike():
            while signal.getsignal(signal.SIGINT) is before:  # until the solve has started
                time.sleep(0.01)
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=strike).start()
        with self.assertRaises(KeyboardInterrupt):
            slipstick.solve(scene)

    def test_threads(self):
        loads = [0.1 * i for i in range(1, 9)]
        alone = [slipstick.solve(SPHERE, load__moment_ratio=load).twist_angle for load in loads]
        with ThreadPoolExecutor(4) as pool:
            together = list(pool.map(lambda load: slipstick.solve(SPHERE, load__moment_ratio=load).twist_angle, loads))
        self.assertEqual(alone, together)
