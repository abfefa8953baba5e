"""Other programs as solvers: the NumPy solver of the guide, with and without mistakes, and programs that are killed, hang, report
a wrong status or print text. `--pages` draws the page of every mistake (minutes); without it their fields are checked."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree
from pathlib import Path

HERE = Path(__file__).resolve().parent
NUMPY = HERE.parent / "numpy"
SCENES = HERE.parents[2] / "convergence" / "scenes"
PROGRAM = sys.argv[1]
PAGES = "--pages" in sys.argv

CIRCLES = """    def turning(q):  # only along the circles about the axis
        around = motions[2] / np.hypot(*motions[2])
        return around * np.sum(around * q, axis=0)

    def apply(q):
        q = turning(q)
"""
# Planted mistakes, and words of the reason.
MISTAKES = {
    "K12 even": ([("/ g)\n    x1, x2", "/ g)\n    k12 = np.fft.rfft2(abs(np.fft.irfft2(k12)))\n    x1, x2")], "K12"),
    "one body's modulus": ([('scene["combined"]["shear_modulus"]',
                             'scene["lower"]["young_modulus"] / (2 + 2 * scene["lower"]["poisson_ratio"])')], "one body"),
    "frozen directions": ([("    def apply(q):\n", CIRCLES), ("return shrink * moved", "return turning(shrink * moved)")], ""),
    "no padding": ([("(2 * n1, 2 * n2)", "(n1, n2)"), ("fftfreq(2 * n1, 1 / (2 * n1))", "fftfreq(n1, 1 / n1)"),
                    ("fftfreq(2 * n2, 1 / (2 * n2))", "fftfreq(n2, 1 / n2)")], ""),
    "half a cell off": ([("formula(x + a * h1 / 2,", "formula(x + (a + 0.98) * h1 / 2,")], ""),
    "stopped early": ([('0.1 * scene["tolerance"])', '0.1 * scene["tolerance"], 12)'), ("iteration < most", "True")], "")}


def run(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)


class WithFolder(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slipstick-program-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def program(self, script, **keys):
        """The file of a program that is this Python script."""
        (self.folder / "solver.py").write_text(script)
        keys = {"command": [sys.executable, "solver.py", "{scene}", "{field}", "{numbers}"], "arrays": "npy"} | keys
        file = self.folder / "made.toml"
        file.write_text("".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items()))
        return file

    def solve(self, program, *words):
        result = self.folder / "result.json"
        result.unlink(missing_ok=True)
        done = run("solve", SCENES / "paper.toml", "--set", "grid.cells=[16,16]", "--program", program, "--json", result, *words)
        return done, json.loads(result.read_text()) if result.exists() else None


class OfTheGuide(WithFolder):
    """The NumPy solver."""

    def setUp(self):
        super().setUp()
        self.file = self.program((NUMPY / "solver.py").read_text(), name="numpy")

    def test_solves_what_the_project_solves(self):
        for scene in ("paper", "ellipse", "mindlin", "torsion_and_force"):
            numbers = {}
            for words in ([], ["--program", self.file]):
                result = self.folder / "result.json"
                done = run("solve", SCENES / f"{scene}.toml", "--set", "grid.cells=[24,24]", "--json", result, *words)
                if scene == "torsion_and_force" and words:  # a history
                    self.assertEqual(done.returncode, 2)
                    self.assertIn("one load", done.stderr)
                    break
                self.assertEqual(done.returncode, 0, done.stderr)
                numbers[bool(words)] = json.loads(result.read_text())
            else:
                for key in ("twist_angle", "moment", "elastic_energy", "approach", "moment_limit"):
                    one, other = numbers[False][key], numbers[True][key]
                    self.assertAlmostEqual(other, one, delta=1e-5 * abs(one) + 1e-12, msg=f"{scene} {key}")
                self.assertLess(numbers[True]["certificate"]["gap"], 1e-7)

    def test_refuses_what_it_does_not_solve(self):
        done = run("solve", SCENES / "dissimilar.toml", "--set", "grid.cells=[16,16]", "--program", self.file)
        self.assertEqual(done.returncode, 2)
        self.assertIn("does not solve this scene", done.stderr)

    def test_runs_in_studies_gates_hard_cases_and_pages(self):
        study = self.folder / "study.toml"
        study.write_text(f'name = "own"\nscene = "{SCENES / "paper.toml"}"\ncells = [8, 12, 16]\n[[vary]]\n'
                         f'key = "solver.program"\nvalues = ["{self.file}"]\n')
        output = ("--output", self.folder / "points")
        refused = run("study", study, *output)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--allow-programs", refused.stderr)
        done = run("study", study, "--allow-programs", "--json", self.folder / "study.json", *output)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = json.loads((self.folder / "study.json").read_text())["series"]
        rows = next(iter(rows.values() if isinstance(rows, dict) else rows))["rows"]
        self.assertTrue(all(row["status"] == "converged" for row in rows), rows)

        gates = self.folder / "gates.toml"
        gates.write_text(f'[[gate]]\nid = "own"\nscene = "{SCENES / "paper.toml"}"\nset = {{ "grid.cells" = [16, 16] }}\n'
                         'quantity = "twist_error"\nbelow = 1e-2\nbasis = "the mesh"\n')
        done = run("gate", gates, "--program", self.file, *output)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

        cases = self.folder / "hard.toml"  # a tenth of what there is of loads
        cases.write_text(f'[[family]]\nname = "loads"\nwhy = "next to nothing, next to all"\nscene = "{SCENES / "paper.toml"}"\n'
                         'set = { "grid.cells" = [12, 12] }\n[[family.vary]]\nkey = "load.moment_ratio"\n'
                         "values = [1e-6, 0.5, 0.99, 0.9999]\n")
        done = run("hard", cases, "--once", "--beside", self.file, "--json", self.folder / "hard.json", *output)
        self.assertEqual(done.returncode, 0, done.stderr)
        counts = json.loads((self.folder / "hard.json").read_text())["methods"]["numpy"]
        self.assertEqual(counts["other_answer"] + counts["other_direction"], 0, counts)
        self.assertGreaterEqual(counts["agrees"], 3, counts)

        page, junit = self.folder / "page", self.folder / "page.xml"
        done = run("report", SCENES / "paper.toml", "--quick", "--program", self.file, "--output", page, "--junit", junit)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("good: right within its mesh", done.stdout)
        html = (page / "index.html").read_text()
        self.assertIn("numpy", html)
        self.assertNotIn("Digits that survive", html)
        self.assertEqual(xml.etree.ElementTree.parse(junit).getroot().get("failures", "0"), "0")

    def test_is_bad_with_each_planted_mistake(self):
        right = (NUMPY / "solver.py").read_text()
        for name, (changes, reason) in MISTAKES.items():
            wrong = right
            for before, after in changes:
                wrong = wrong.replace(before, after)
            self.assertNotEqual(wrong, right, name)
            program = self.program(wrong, name="wrong")
            scene = SCENES / ("ellipse.toml" if name == "frozen directions" else "paper.toml")
            if PAGES:
                done = run("report", scene, "--quick", "--program", program, "--output", self.folder / f"page of {name}")
            else:
                field = self.folder / "field.csv"
                cells, result = ("--set", "grid.cells=[32,32]"), self.folder / "result.json"
                solved = run("solve", scene, *cells, "--program", program, "--fields", field, "--json", result)
                self.assertIn(solved.returncode, (0, 1), solved.stderr)
                twist = json.loads(result.read_text())["program"]["own"]["twist_angle"]
                done = run("check", scene, field, *cells, "--twist", twist)
            with self.subTest(mistake=name):
                self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
                self.assertIn("bad", done.stdout)
                self.assertIn(reason, done.stdout)


# Failures of programs, and words of the message.
FIELD = "x1,x2,pressure,q1,q2\\n"
BROKEN = {
    "killed": ("import os; os.kill(os.getpid(), 9)", "killed by signal 9"),
    "fails": ("import sys; print('no licence'); sys.exit(1)", "ended with code 1; it says: no licence"),
    "writes nothing": ("", "wrote no field"),
    "half a file": ("open(sys.argv[2], 'w').write('x1,x2,pressure,q1,q2\\n0,0,1')", "3 values"),
    "NaN": (f"open(sys.argv[2], 'w').write('{FIELD}' + f'{{x[8]}},{{y[8]}},nan,0,0')", "finite"),
    "another grid": (f"open(sys.argv[2], 'w').write('{FIELD}' + '1,1,1,0,0')", "not a cell"),
    "a cell twice": (f"open(sys.argv[2], 'w').write('{FIELD}' + 2 * f'{{x[8]}},{{y[8]}},1,0,0\\n')", "second time"),
    "negative": (f"open(sys.argv[2], 'w').write('{FIELD}' + f'{{x[8]}},{{y[8]}},-1,0,0')", "zero or positive"),
    "another load": (f"open(sys.argv[2], 'w').write('{FIELD}' + f'{{x[8]}},{{y[8]}},1,0,0')", "of 1000 N"),
    "no numbers": (f"open(sys.argv[2], 'w').write('{FIELD}' + f'{{x[8]}},{{y[8]}},1e13,0,0'); open(sys.argv[3], 'w').write('{{')",
                   "1000 N")}
READ = "import json, sys, time\nscene = json.load(open(sys.argv[1]))\nx, y = scene['x1'], scene['x2']\n"


class ThatBreak(WithFolder):
    def test_is_named_with_what_went_wrong(self):
        for name, (script, words) in BROKEN.items():
            with self.subTest(program=name):
                done, result = self.solve(self.program(READ + script, name="broken"))
                self.assertEqual(done.returncode, 2, done.stdout)
                self.assertIn("broken", done.stderr)
                self.assertIn(words, done.stderr)

    def test_is_stopped_with_all_that_it_started(self):
        marker = f"slipstick-{os.getpid()}-hangs"
        script = f"import subprocess; subprocess.Popen(['sleep', '1000'], env={{'MARK': '{marker}'}})\nprint('x' * 10**7)\ntime.sleep(1000)"
        start = time.monotonic()
        done, _ = self.solve(self.program(READ + script, time_limit=2))
        self.assertEqual(done.returncode, 2)
        self.assertIn("took longer than 2 s", done.stderr)
        self.assertLess(len(done.stderr), 10_000)
        self.assertLess(time.monotonic() - start, 100)
        left = [each for each in Path("/proc").glob("[0-9]*/environ") if marker in read(each)]
        self.assertEqual(left, [])

    def test_leaves_no_process_behind(self):
        """A process that has left the program's group, session and parent, and ignores SIGTERM, is ended too: when the program ends, takes
        too long or is killed, and when slipstick is killed."""
        daemon = ("import os, signal\nif os.fork() == 0:\n    os.setsid()\n    if os.fork() == 0:\n"
                  "        for each in (signal.SIGTERM, signal.SIGHUP): signal.signal(each, signal.SIG_IGN)\n"
                  "        os.close(1), os.close(2)\n        open(os.environ['STARTED'], 'w').close()\n        time.sleep(1000)\n"
                  "    os._exit(0)\nwhile not os.path.exists(os.environ['STARTED']): time.sleep(0.01)\n")
        for end in ("", "time.sleep(1000)", "os.kill(os.getpid(), 9)", "open('hangs', 'w').close(); time.sleep(999)"):
            with self.subTest(end=end):
                started = self.folder / "started"
                started.unlink(missing_ok=True)
                program = self.program(READ + daemon + end, time_limit=2 if "1000" in end else 600)
                words = [PROGRAM, "solve", SCENES / "paper.toml", "--set", "grid.cells=[16,16]", "--program", program]
                solve = subprocess.Popen(words, env=os.environ | {"STARTED": str(started)}, stdout=subprocess.DEVNULL,
                                         stderr=subprocess.DEVNULL)
                if "hangs" in end:
                    while not (self.folder / "hangs").exists():
                        time.sleep(0.01)
                    solve.kill()
                self.assertNotEqual(solve.wait(), 0)
                self.assertTrue(started.exists())
                patience = time.monotonic() + 100
                while (left := [each for each in Path("/proc").glob("[0-9]*/environ") if str(started) in read(each)]):
                    if time.monotonic() > patience or "hangs" not in end:
                        break
                    time.sleep(0.01)
                for each in left:
                    os.kill(int(each.parent.name), 9)
                self.assertEqual(left, [])

    def test_says_its_twist_in_rad(self):
        """The twist in rad has the name twist_angle, as in results; if it is missing, `twist` is read in rad."""
        right = (NUMPY / "solver.py").read_text()
        for numbers, said in (('"twist_angle": motion[2] / size', {"twist_angle"}),
                              ('"twist": motion[2] / size', {"twist_angle", "twist"}),
                              ('"twist_angle": motion[2] / size, "twist": 0.2', {"twist_angle"})):
            changed = right.replace('"twist_angle": motion[2] / size', numbers)
            self.assertIn(numbers, changed)
            done, result = self.solve(self.program(changed))
            self.assertEqual(done.returncode, 0, done.stderr)
            own = result["program"]["own"]
            self.assertEqual({key for key in own if key.startswith("twist")}, said)
            for key in said:
                self.assertAlmostEqual(own[key] / result["twist_angle"], 1, delta=1e-6)
        self.assertNotIn("operator", done.stdout)  # none of this program's own made the answer
        self.assertIn("made", done.stdout)

    def test_is_part_of_what_a_kept_result_depends_on(self):
        right = (NUMPY / "solver.py").read_text()
        study = self.folder / "study.toml"
        study.write_text(f'name = "own"\nscene = "{SCENES / "paper.toml"}"\ncells = [8, 12]\n')
        points = self.folder / "points"

        def kept():
            done = run("study", study, "--program", self.folder / "made.toml", "--output", points)
            self.assertNotEqual(done.returncode, 2, done.stderr)
            return sum(b"\"program\"" in each.read_bytes() for each in points.glob("*.json"))

        self.program(right, version=["echo", "1"])
        first = kept()
        self.assertEqual(kept(), first)
        stamps = {each: each.stat().st_mtime_ns for each in points.glob("*.json")}
        self.program(right, version=["echo", "2"])
        kept()
        self.assertTrue(any(each.stat().st_mtime_ns != stamps.get(each) for each in points.glob("*.json")))

    def test_says_what_its_file_lacks(self):
        for text, words in (("command = []", "command"), ("command = ['a', '{scene}']", "{field}"), ("", "command"),
                            ("command = ['{scene}', '{field}']\ntime_limit = -1", "time_limit"),
                            ("command = ['{scene}', '{field}']\narrays = 'hdf5'", "arrays"),
                            ("command = ['{scene}', '{field}']\nversoin = ['a']", "version"),
                            ("command = ['no-such-program', '{scene}', '{field}']", "not started")):
            file = self.folder / "made.toml"
            file.write_text(text)
            done, _ = self.solve(file)
            self.assertEqual(done.returncode, 2, text)
            self.assertIn(words, done.stderr)

    def test_runs_for_nobody_who_did_not_ask(self):
        trace = self.folder / "ran"
        program = self.program(f"open({str(trace)!r}, 'w')", version=["touch", str(trace)])
        scene = self.folder / "scene.toml"
        text = (SCENES / "paper.toml").read_text()
        scene.write_text(text + ("" if "[solver]" in text else "\n[solver]\n") + f'\nprogram = "{program}"\n')
        for words in (("solve", scene), ("report", scene, "--quick", "--output", self.folder / "page"),
                      ("check", scene, SCENES / "honed_surface.csv"), ("digits", scene, "--output", self.folder / "digits")):
            done = run(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertFalse(trace.exists(), words)
        self.assertIn("--allow-programs", run("solve", scene).stderr)
        # A program from the command line does not permit programs that a file names.
        study = self.folder / "study.toml"
        study.write_text(f'name = "a"\nscene = "{SCENES / "paper.toml"}"\ncells = [8, 12]\n[[vary]]\nkey = "solver"\n'
                         f"values = ['{{program = \"{program}\"}}']\n")
        named = ("--program", NUMPY / "program.toml", "--output", self.folder / "points")
        for text in (study.read_text(), study.read_text().replace('"solver"', '"solver.program"').replace(
                f"'{{program = \"{program}\"}}'", f'"{program}"'), study.read_text().replace("'{", "{").replace("}'", "}")):
            study.write_text(text)
            self.assertEqual(run("study", study, *named).returncode, 2, text)
            self.assertFalse(trace.exists(), text)

    def test_may_find_the_pressure_alone(self):
        script = (NUMPY / "solver.py").read_text().replace("(x1, x2, pressure, q[0], q[1])", "(x1, x2, pressure)").replace(
            "x1,x2,pressure,q1,q2", "x1,x2,pressure")
        done, result = self.solve(self.program(script))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(result["program"]["fields"], "pressure")
        self.assertLess(abs(result["contact_radius_error"]), 1e-2)
        self.assertLess(abs(result["peak_pressure_error"]), 1e-2)
        self.assertLess(result["pressure_complementarity"], 1e-8)
        self.assertEqual(result["moment"], 0)


def read(file):
    try:
        return file.read_text(errors="replace")
    except OSError:
        return ""
