"""schema_test.py PROGRAM: the program's output follows docs/schema, and each null has a reason."""

import copy
import json
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import jsonschema

from program_run import made_benchmarks
from schemas import ROOT, SCHEMAS, parse, problem, unexplained, validator

PROGRAM = Path(sys.argv[1]).resolve()
PACKAGE = PROGRAM.parent / "python/slipstick/_native"
SCENES, FIELDS = ROOT / "convergence/scenes", ROOT / "convergence/check/fields"

STUDY = f"""
name = "small"
scene = "{SCENES}/paper.toml"
cells = [8, 12, 16]
shifts = 2
tolerances = [1e-2, 1e-4]
"""
GATE = f"""
[[gate]]
id = "{{}}"
scene = "{SCENES}/paper.toml"
set = {{{{ "grid.cells" = [32, 32] }}}}
quantity = "{{}}"
basis = "made up"
{{}}
"""


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)

    def file(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def follows(self, result, name, part=None):
        self.assertEqual(problem(result, name, part), "")

    def run_program(self, *words, code=0):
        """The output of the command; None: it wrote nothing."""
        out = self.folder / "result.json"
        out.unlink(missing_ok=True)
        words = [str(word) for word in words]
        run = subprocess.run([PROGRAM, *words, "--json", out], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(run.returncode, code, f"{' '.join(words)}: {run.stderr}")
        return parse(out.read_text()) if out.exists() else None

    def run_and_check(self, *words, code=0, schema=""):
        result = self.run_program(*words, code=code)
        with self.subTest(command=" ".join(map(str, words))):
            self.assertIsNotNone(result, "nothing was written")
            self.follows(result, schema or words[0])
        return result

    def solve(self, scene, *words, cells="[32,32]", code=0):
        return self.run_and_check("solve", SCENES / f"{scene}.toml", "--set", f"grid.cells={cells}", *words, code=code)

    def test_exact(self):
        units = ["--normal-load", 1000, "--effective-modulus", 1e11, "--friction", 0.1, "--shear-modulus", 4e10]
        self.run_and_check("exact", "--moment-ratio", 0.9, "--radius", "0,0.5,1", *units, "--shape", 0.018, "--at", "0.5,0.2",
                           "--at", "largest", "--yield-stress", 3e8)
        self.run_and_check("exact", "--profile", "flat_punch", "--stick-ratio", 0.5, "--radius", 1,
                           "--unload-to", 0.2, "--at", "0.5,0.2")
        self.run_and_check("exact", "--profile", "cone", "--history", "0.8,-0.8", "--points", 3, "--radius", "0,0.5",
                           "--at", "0.5,0.2")
        rows = "".join(f"{i / 20},{1 - (i / 20)**2}\n" for i in range(21))
        table = self.file("pressure.csv", "radius,pressure\n" + rows)
        self.run_and_check("exact", "--profile", f"file:{table}", "--twist", 0.1, "--radius", 0.5)

    def test_certified(self):
        words = ["exact", "--certified", 20, "--moment-ratio", 0.5, "--radius", 0.5]
        if "FLINT" in subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True).stderr:
            self.skipTest("no proven digits without FLINT")
        self.run_and_check(*words)

    def test_solve(self):
        for scene in ("paper", "ellipse", "flat_punch", "rough_sphere", "mindlin", "off_centre", "spence", "goodman"):
            self.solve(scene)
        self.solve("paper", "--set", "solver.method=paper")
        self.solve("paper", "--set", "load.moment_ratio=0")
        for plan in ((), ("--plan",)):
            self.solve("paper", "--stresses", self.folder / "stress.csv", "--depths", "1e-4", *plan)
        self.solve("fretting_torsion", "--stresses", self.folder / "{body}.csv", "--depths", "1e-4", "--dang-van", "0.3", "--findley", "0.2")
        self.solve("paper", "--set", "contact.friction=0", "--set", "load.moment_ratio=0")
        self.solve("torsion_and_force", "--set", "solver.substeps=4", "--set", "solver.max_iterations=3", code=1)
        self.run_and_check("solve", SCENES / "honed_surface.toml")

    def test_histories(self):
        for scene in ("fretting_torsion", "growing_load"):
            self.assertGreater(len(self.solve(scene)["steps"]), 1)

    def test_solve_without_grid(self):
        for scene in ("paper", "flat_punch", "fretting_torsion"):
            self.run_and_check("solve", SCENES / f"{scene}.toml", "--model", "exact")

    def test_accuracy_and_plan(self):
        words = ["solve", SCENES / "paper.toml", "--accuracy", 0.01]
        self.run_and_check(*words)
        self.run_and_check(*words, "--model", "auto")
        self.run_and_check("solve", SCENES / "ellipse.toml", "--accuracy", 0.05)
        self.run_and_check(*words, "--plan")
        self.run_and_check("solve", SCENES / "paper.toml", "--plan")

    def test_uncertainty(self):
        words = ["--uncertain", "friction=5%", "young_modulus=2%"]
        for more in ([], ["--model", "exact"]):
            self.assertEqual(len(self.solve("paper", *more, *words)["uncertainty"]["inputs"]), 3)

    def test_failures(self):
        self.assertEqual(self.solve("paper", "--set", "solver.max_iterations=1", code=1)["status"], "not_converged")
        self.assertIsNone(self.run_program("solve", SCENES / "paper.toml", "--set", "load.moment_ratio=1.5", code=2))
        self.assertIsNone(self.run_program("solve", "nothing.toml", code=2))
        steps = "".join(f'[[step]]\nname = "{moment} N m"\nmoment = {moment}\n' for moment in (0.01, 1.0))
        scene = (SCENES / "paper.toml").read_text().replace("moment_ratio = 0.9", "")
        broken_off = self.run_and_check("solve", self.file("broken_off.toml", scene + steps), code=2)
        self.assertEqual(len(broken_off["steps"]), 1)

    def test_check(self):
        words = ["--set", "load.moment_ratio=0.9", "--twist"]
        for file, twist, code in (("contact", 2.361048651456917e-3, 0), ("cgcontact", 2.21775472e-3, 1)):
            self.run_and_check("check", SCENES / "paper.toml", FIELDS / f"{file}-64-0.9.csv", *words, twist, code=code)

    def test_check_of_a_field_on_a_mesh(self):
        rows = "0,2e9,0,0\n" + "".join(f"{0.05e-3 * k},{2e9 * (1 - (k / 10)**2)**0.5},{2e8 * (1 - (k / 10)**2)**0.5},0\n"
                                      for k in range(1, 10))
        table = self.file("radii.csv", "r,pressure,q_theta,q_r\n" + rows)
        self.follows(self.run_program("check", SCENES / "paper.toml", table, code=1), "mesh")

    def test_check_of_stresses(self):
        for columns, force in (("s11,s22,s33,s12,s13,s23", 0), ("s33,s13", 1)):
            numbers = ",".join("1" * len(columns.split(",")))
            table = self.file("stresses.csv", f"x1,x2,x3,{columns}\n1e-4,0,2e-4,{numbers}\n0,1e-4,3e-4,{numbers}\n")
            self.follows(self.run_program("check", SCENES / "paper.toml", table, "--set", "grid.cells=[32,32]",
                                          "--set", f"load.force=[{force},0]", code=1), "stresses")

    def test_check_of_a_loop(self):
        curve = self.run_program("exact", "--history", "0.8,-0.8,0.8")["curve"]
        units = self.run_program("law", SCENES / "paper.toml", "--limit-loads", 3)["units"]
        for factor, code in ((1.0, 0), (1.3, 1)):
            rows = "".join(f"{factor * point['moment'] * units['moment_unit']},{point['twist'] * units['rotation_unit']}\n"
                           for point in curve)
            loop = self.file("loop.csv", "moment,rotation\n" + rows)
            self.follows(self.run_program("check", SCENES / "paper.toml", loop, code=code), "loop")
        line = "".join(f"{1e-3 * i},{1e-5 * i}\n" for i in range(30))  # nothing turns back
        loop = self.file("line.csv", "moment,rotation\n" + line)
        self.follows(self.run_program("check", SCENES / "paper.toml", loop, code=1), "loop")

    def test_law(self):
        self.run_and_check("law", SCENES / "paper.toml", "--limit-loads", 3)
        self.run_and_check("law", "--profile", "flat_punch", "--elements", 3)

    def test_hard(self):
        family = (
            '[[family]]\nname = "small"\nwhy = "made up"\nscene = "{}"\n[family.set]\ngrid.cells = [12, 12]\n'
            '[[family.vary]]\nkey = "solver.max_iterations"\nvalues = [1, 1000]\n'
            '[[family.vary]]\nkey = "load.moment_ratio"\nvalues = [0.5, 2.0]\n'
        )
        scenes = [SCENES / "paper.toml", SCENES / "spence.toml", SCENES / "rough_sphere.toml"]
        files = [self.file(f"{scene.stem}-hard.toml", family.format(scene)) for scene in scenes]
        self.run_and_check("hard", *files, "--output", self.folder / "hard", code=1)
        self.run_and_check("hard", *files, "--once", "--beside", "paper", "--output", self.folder / "hard", code=1)
        self.run_and_check("hard", files[0], "--once", "--fields", self.folder / "fields", code=1)

    def test_digits(self):
        words = ("--set", "grid.cells=[12,12]", "--samples", 3, "--output", self.folder / "digits")
        self.run_and_check("digits", SCENES / "paper.toml", *words)
        self.run_and_check("digits", SCENES / "paper.toml", *words, "--set", "solver.max_iterations=1", code=1)
        self.run_and_check("digits", SCENES / "paper.toml", *words, "--set", "load.moment_ratio=-0.0")

    def test_study(self):
        self.run_and_check("study", self.file("study.toml", STUDY), "--output", self.folder / "study")
        scene = STUDY.replace("paper.toml", "ellipse.toml").replace("[8, 12, 16]", "[8, 12]")
        self.run_and_check("study", self.file("extrapolated.toml", scene), "--output", self.folder / "study")

    def test_study_with_failed_runs(self):
        paper = (SCENES / "paper.toml").read_text()
        scene = self.file("moment.toml", paper.replace("moment_ratio = 0.9", "moment = 0.01"))
        study = f'name = "far"\nscene = "{scene}"\ncells = [8]\n[[vary]]\nkey = "load.moment"\nvalues = [0.01, 1.0]\n'
        result = self.run_and_check("study", self.file("far.toml", study), "--output", self.folder / "far", code=1)
        self.assertGreater(result["failed_runs"]["count"], 0)

    def test_list_and_run(self):
        listed = self.run_and_check("study", self.file("study.toml", STUDY), "--output", self.folder / "listed", "--list-runs",
                                    self.folder / "runs.jsonl", schema="list")
        run = self.run_and_check("run", self.folder / "runs.jsonl", "--only", listed["listed"])
        self.assertEqual(run["runs"][0]["line"], listed["listed"])

    def test_gate(self):
        gates = [("passes", "twist_error", "below = 1e-2"), ("fails", "twist_error", "below = 1e-6"),
                 ("word", "status", 'equals = "converged"'), ("missing", "displacement_error", "below = 1")]
        text = "".join(GATE.format(*gate) for gate in gates)
        self.run_and_check("gate", self.file("gates.toml", text), "--output", self.folder / "gates", code=1)
        refused = text + GATE.format("refused", "status", "equals = 1").replace("paper.toml", "nothing.toml")
        files = [self.file("refused.toml", refused), self.file("unreadable.toml", "[[gate]]\nid =")]
        self.run_and_check("gate", *files, "--output", self.folder / "gates", code=2)
        self.run_and_check("gate", *files, "--list", code=2)
        if PACKAGE.exists():
            history = self.folder / "history.jsonl"
            self.run_program("gate", *files, "--output", self.folder / "gates", "--history", history, code=2)
            self.follows(parse(history.read_text()), "history")

    def test_programs(self):
        kept = self.folder / "exchange.json"
        (self.folder / "copies.py").write_text(f"import shutil, sys\nshutil.copy(sys.argv[1], {str(kept)!r})\nsys.exit(3)\n")
        program = self.file("copies.toml", f'command = ["{sys.executable}", "copies.py", "{{scene}}", "{{field}}"]\n')
        for scene in ("paper", "dissimilar", "imposed_displacement", "honed_surface"):
            subprocess.run([PROGRAM, "solve", SCENES / f"{scene}.toml", "--program", program], capture_output=True)
            self.assertTrue(validator("exchange").is_valid(parse(kept.read_text())))
        self.run_and_check("solve", SCENES / "paper.toml", "--set", "grid.cells=[12,12]", "--program",
                           SCENES.parents[1] / "interfaces/programs/numpy/program.toml")

    def test_the_papers_page(self):
        """Every part that a page can have; program_test.py has a page of few parts."""
        self.run_and_check("report", "--quick", "--output", self.folder / "page")

    def test_costs(self):
        self.run_and_check("bench", SCENES / "ellipse.toml", "--quick", "--output", self.folder / "costs", schema="costs")

    def made_benchmarks(self, milliseconds=1.0, cells="8"):
        names = "".join(f"application/direct/cells:{n}\napplication/dcfft/cells:{n}\n" for n in cells.split())
        return made_benchmarks(self.folder / f"benchmarks-{milliseconds}", names, milliseconds)

    @unittest.skipUnless(PACKAGE.exists(), "without the Python package")
    def test_comparison(self):
        base, slower, data = self.made_benchmarks(), self.made_benchmarks(1.2), self.folder / "ab"
        self.run_and_check("bench", "--program", slower, "--against", base, "--rounds", 10, "--output", data, code=1)
        self.follows(parse((data / "comparison.json").read_text()), "compare")
        self.run_and_check("compare", data / "base.json", data / "new.json", code=1)
        self.run_and_check("compare", data / "base.json", data / "base.json", code=2)

    @unittest.skipUnless(PACKAGE.exists(), "without the Python package")
    def test_survey(self):
        """Up to the first point of the plane: all take a minute."""
        data = self.folder / "survey/data"
        survey = subprocess.Popen([PROGRAM, "bench", "--quick", "--program", self.made_benchmarks(cells="8 16 32"), "--output",
                                   self.folder / "survey"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while survey.poll() is None and not list(data.glob("finished/plane-*.json")):
            time.sleep(0.05)
        survey.terminate()
        survey.wait()
        for name, schema in (("timings", "bench"), ("scaling", "scaling")):
            self.follows(parse((data / f"{name}.json").read_text()), schema)
        self.assertEqual(len(parse((data / "scaling.json").read_text())["crossovers"]), 1)
        points = list(data.glob("finished/plane-*.json"))
        self.assertGreater(len(points), 0)
        for path in points:
            point = parse(path.read_text())["result"]  # with each repetition's seconds, which the judgement makes a median
            self.assertGreater(min(point["seconds"]), 0.0)
            self.follows({**point, "seconds": {"median": 1.0, "low": 1.0, "high": 1.0, "repetitions": 3}}, "plane", "point")


class Schemas(unittest.TestCase):
    def test_are_schemas(self):
        for name, schema in SCHEMAS.items():
            with self.subTest(schema=name):
                jsonschema.Draft202012Validator.check_schema(schema)

    def test_all_references_lead_somewhere(self):
        def references(value):
            for key, each in value.items() if isinstance(value, dict) else enumerate(value):
                if key == "$ref":
                    yield each
                elif isinstance(each, (dict, list)):
                    yield from references(each)
        for name, schema in SCHEMAS.items():
            for reference in references(schema):
                file, _, path = reference.partition("#")
                at = SCHEMAS[file.split(".")[0]] if file else schema
                for key in path.strip("/").split("/") if path else []:
                    self.assertIn(key, at, f"{name}: {reference}")
                    at = at[key]

    def test_refuse_what_is_wrong(self):
        words = [PROGRAM, "solve", SCENES / "fretting_torsion.toml", "--set", "grid.cells=[16,16]", "--json", "-"]
        right = parse(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
        self.assertTrue(validator("solve").is_valid(right))

        def rename(at, key):
            at[f"{key}s"] = at.pop(key)
        for spoil in (lambda r: rename(r, "twist_angle"), lambda r: rename(r["steps"][1], "moment"),
                      lambda r: rename(r["certificate"], "gap"), lambda r: rename(r["exact"], "twist"),
                      lambda r: r.update(moment="0.02"), lambda r: r.update(cells=[16.5, 16]),
                      lambda r: r.update(status="done"), lambda r: r.update(twist_error_reason=""),
                      lambda r: r["steps"].append({})):
            wrong = copy.deepcopy(right)
            spoil(wrong)
            self.assertFalse(validator("solve").is_valid(wrong), "a spoilt result is valid")
        self.assertEqual(unexplained({"a": None, "b": 1, "b_reason": "none"}), ["$.a", "$.b_reason"])
        with self.assertRaises(ValueError):
            parse(json.dumps({"moment": float("nan")}))
