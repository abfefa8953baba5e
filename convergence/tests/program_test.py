"""program_test.py PROGRAM: output, files and exit codes of the commands."""

import itertools
import json
import math
import os
import subprocess
import sys
import xml.etree.ElementTree
from pathlib import Path
from unittest.mock import patch

from program_run import PROGRAM, SCENES, SOURCE, ProgramTest

sys.path.insert(0, str(SOURCE / "cmake/tests"))
try:
    import schemas
except ImportError:  # without jsonschema
    schemas = None

SMALL = ("--set", "grid.cells=[24,24]")
# Scenes with an exact answer: the profile, the size of its body, and the normal load.
EXACT = (("paper", "hertz", "0.018", "1000"), ("cone", "cone", "0.01", "200"), ("flat_punch", "flat_punch", "0.0005", "1000"))
LOADS = {"hertz": 2 * math.pi / 3, "cone": math.pi, "flat_punch": 2 * math.pi}  # over p0 a^2
# Over p0; r: over a.
PRESSURES = {"hertz": lambda r: math.sqrt((1 - r) * (1 + r)), "cone": lambda r: math.acosh(1 / r),
             "flat_punch": lambda r: 1 / math.sqrt((1 - r) * (1 + r))}


def solve(scene, *words):
    return "solve", str(SCENES / f"{scene}.toml"), *SMALL, *words


def check(field, *words):
    return "check", str(SCENES / "paper.toml"), str(SOURCE / "convergence/check/fields" / field), *words


class Program(ProgramTest):
    def test_every_command_has_help_with_an_example(self):
        for command in ("bench", "check", "compare", "exact", "gate", "report", "solve", "study"):
            self.run_program(command, "--help", says=("Example", f"slipstick {command}", "--json", "--quiet"))

    def test_bad_command_line_is_exit_code_2(self):
        for words in ((), ("frobnicate",), ("solve",), ("solve", "--no-such-option")):
            self.run_program(*words, code=2)
        self.run_program("slove", "scene.toml", code=2, says=("slove", "the nearest is solve"))
        self.run_program("help", code=2, says="the nearest is --help")

    def test_unknown_options_are_named_before_anything_is_missing(self):
        for words, *says in ((("solve", "--halp"), "--halp", "the nearest is --help"),
                             (("exact", "--momentratio", "0.5"), "--momentratio", "the nearest is --moment-ratio"),
                             (("solve", "--jsn", "x", "--field=a.csv"), "--jsn", "--json", "--field:", "--fields"),
                             (("--verson",), "--verson", "the nearest is --version")):
            text = self.run_program(*words, code=2, says=says)
            self.assertNotIn("required", text)
        self.run_program("exact", "--twist", "-0.5", "--profile", code=2, says="--profile")

    def test_a_converged_answer_carries_its_moment(self):
        result = self.result(*solve("paper"))
        self.assertEqual(result["status"], "converged")
        self.assertAlmostEqual(result["moment_ratio"], 0.9, delta=4e-16)

    def test_every_scene_in_the_repository_solves(self):
        scenes = sorted(SCENES.glob("*.toml"))
        self.assertGreaterEqual(len(scenes), 16)
        for scene in scenes:
            # The samples of a height map fix its grid.
            self.run_program("solve", str(scene), *(() if scene.stem == "honed_surface" else SMALL))

    def test_gross_slip_is_refused_with_its_limit(self):
        self.run_program(*solve("paper", "--set", "load.moment_ratio=1.0"), code=2,
                         says=("load.moment_ratio", "gross slip"))
        self.run_program(*solve("paper", "--set", "load.moment=0.05"), code=2,
                         says=("load.moment = 0.05 N m", "below 0.0287", "paper.toml"))

    def test_a_twist_that_was_hardly_meant_in_rad_is_warned_of(self):
        """`twist` of a result is normalised, load.twist is in rad."""
        meant = self.result(*solve("paper"))
        self.assertNotIn("load_warning", meant)
        for twist, warned in ((meant["twist"], True), (meant["twist_angle"], False), (-4 * meant["twist_angle"], False)):
            words = solve("paper", "--set", f"load.twist={twist}")
            result = self.result(*words)
            self.assertEqual("load_warning" in result, warned)
            if warned:  # the warning has the twist in rad
                self.assertIn(f"{meant['twist_angle']:.4g}"[:-1], result["load_warning"])
                self.run_program(*words, says=("warning", "in rad"))

    def test_a_solve_that_misses_its_tolerance_is_exit_code_1_and_still_written(self):
        self.run_program(*solve("paper", "--set", "solver.max_iterations=3", "--json", "missed.json"), code=1,
                         says="within 3 operator applications")
        result = json.loads(Path("missed.json").read_text())
        self.assertEqual(result["status"], "not_converged")
        self.assertGreater(result["certificate"]["gap"], 1e-8)

    def test_result_is_not_lost_when_fields_or_figure_cannot_be_written(self):
        for option, name in (("--fields", "full.csv"), ("--figure", "full.svg")):
            os.symlink("/dev/full", name)  # writing fails only after the solve
            says = (name,) if option == "--fields" else ("moment", "the result is complete, but")
            self.run_program(*solve("paper", option, name, "--json", "kept.json"), code=2, says=says)
            self.assertEqual(json.loads(Path("kept.json").read_text())["status"], "converged")

    def test_what_has_no_place_or_kind_is_refused_before_the_solve(self):
        for option, file, *says in (("--figure", "f.jpg", "--figure", "f.jpg", ".svg, .pdf, .png"),
                                    ("--figure", "f-{step}.png", "--model=exact", "{step}", "last step"),
                                    ("--loop", "loop.svg", "--loop", ".csv"),
                                    *(("--fields", name, name, ".h5, .hdf5, .csv, .vti")
                                      for name in ("fields.txt", "fields", "fields.CSV", "fields.vtk", ".csv"))):
            options = [says.pop(0)] if says[0].startswith("--model") else []
            self.run_program(*solve("paper", option, file, *options, "--json", "refused.json"), code=2, says=says)
            self.assertFalse(Path("refused.json").exists(), option)

    def test_what_an_environment_lacks_is_named(self):
        with patch.dict(os.environ, TMPDIR="/no/such/folder"):
            self.run_program(*solve("paper", "--figure", "f.svg"), code=2, says=("TMPDIR", "no folder", "allowed"))
        for files in (6, 7, 8):
            end = subprocess.run(["sh", "-c", f'ulimit -n {files} && exec "$0" "$@"', PROGRAM,
                                  *solve("paper", "--figure", "f.svg")], capture_output=True, text=True)
            self.assertIn(end.returncode, (0, 2), end.stderr)
            self.assertNotIn("make its folder", end.stderr)
        for option in ("--json", "--fields", "--figure"):
            self.run_program(*solve("paper", option, ""), code=2, says=(option, "names no file"))

    def test_no_name_steers_a_terminal(self):
        name = "a\u202eb\u2066c\x1b[31md\u009be\x7ff"
        words = solve("paper", "--set", f"name={json.dumps(name)}")
        for said in (self.run_program(*words), self.run_program(*words, "--json", "-")):
            self.assertTrue(said.isascii() and said.replace("\n", "").isprintable(), said[:200])
        self.assertEqual(json.loads(said)["name"], name)

    def test_figures_obey_no_environment_of_python(self):
        for module in ("numpy", "runpy", "style", "sitecustomize"):
            self.write(f"{module}.py", "raise SystemExit('a stranger was imported')")
        for variables in ({"PYTHONPATH": str(self.folder)}, {"PYTHONHOME": "/no/such/folder"}):
            with patch.dict(os.environ, variables):
                self.run_program(*solve("paper", "--figure", "figure.svg"))
            self.assertGreater(Path("figure.svg").stat().st_size, 10000)
            Path("figure.svg").unlink()

    def test_figure_is_written_beside_the_result(self):
        for scene in (solve("ellipse"), solve("cone", "--model", "exact")):
            Path("figure.svg").unlink(missing_ok=True)
            self.run_program(*scene, "--figure", "figure.svg")
            self.assertGreater(Path("figure.svg").stat().st_size, 10000)

    def test_solves_exactly_with_the_numbers_of_exact(self):
        for (name, profile, shape, load), ratio in itertools.product(EXACT, ("0.1", "0.5", "0.9", "0.99")):
            solved = self.result(*solve(name, "--model", "exact", "--set", f"load.moment_ratio={ratio}"))
            # 210 GPa and nu = 0.3 on both sides.
            exact = self.result("exact", "--profile", profile, "--moment-ratio", ratio, "--normal-load", load, "--shape", shape,
                                "--friction", "0.1", "--effective-modulus", "115384615384.61538",
                                "--shear-modulus", "40384615384.615385")
            self.assertEqual((solved["method"], solved["model"]["left_out"][0]["what"]), ("exact", "the grid"))
            for key in ("moment_ratio", "stick_ratio", "twist"):
                self.assertEqual(solved[key], exact[key])
            for key in ("contact_radius", "approach", "stick_radius", "moment_limit", "moment", "twist_angle"):
                self.assertAlmostEqual(solved[key] / exact["units"][key], 1, delta=1e-14, msg=key)
        uncoupled = self.result(*solve("dissimilar", "--model", "exact", "--set", "contact.coupling=none"))
        self.assertEqual([each["what"] for each in uncoupled["model"]["left_out"]], ["the grid", "K13, K23"])
        self.assertEqual(self.run_program(*solve("cone", "--set", "solver.model=exact", "--quiet")), "")
        self.run_program(*solve("cone", "--model", "exact"), says="exact solution")
        self.run_program(*solve("cone", "--set", "solver.model=exact", "--model", "auto"), says="24 x 24 cells")

    def test_fields_hold_the_columns_of_the_contract(self):
        self.run_program(*solve("paper", "--fields", "fields.csv"))
        header = Path("fields.csv").read_text().splitlines()[0]
        self.assertTrue(header.startswith("x1,x2,pressure,q1,q2,slip1,slip2,stick"), header)

    def test_exact_fields_are_those_of_exact_at_the_cells_in_contact(self):
        for name, profile, *_ in EXACT:
            result = self.result(*solve(name, "--model", "exact", "--set", "grid.cells=[24,20]", "--fields", "exact.csv"))
            header, *lines = Path("exact.csv").read_text().splitlines()
            self.assertEqual(header, "x1,x2,pressure,q1,q2,stick")
            rows = [tuple(map(float, line.split(","))) for line in lines]
            self.assertGreater(len(rows), 200)  # of 480
            radii = [math.hypot(*row[:2]) / result["contact_radius"] for row in rows]
            exact = self.result("exact", "--profile", profile, "--moment-ratio", str(result["moment_ratio"]), "--radius",
                                ",".join(map(repr, radii)))
            p0 = result["normal_load"] / (LOADS[profile] * result["contact_radius"]**2)
            for (x1, x2, p, q1, q2, stick), r, traction in zip(rows, radii, exact["traction"], strict=True):
                within = 1e-12 * (1 + 1 / (1 - r))  # by rounding of r
                self.assertAlmostEqual(p / (p0 * PRESSURES[profile](r)), 1, delta=within)
                q = 0.1 * p0 * traction["value"]
                self.assertAlmostEqual(q1 / q, -x2 / math.hypot(x1, x2), delta=within)
                self.assertAlmostEqual(q2 / q, x1 / math.hypot(x1, x2), delta=within)
                self.assertEqual(stick, float(r < result["stick_ratio"]))

    def test_errors_beside_an_infinite_peak_are_null(self):
        result = self.result(*solve("cone"))
        for number in (result["twist_error"], result["exact"]["twist"], result["peak_pressure"]):
            self.assertIsInstance(number, float)
        self.assertIsNone(result["peak_pressure_error"])
        self.assertIsNone(result["exact"]["peak_pressure"])
        self.assertIn("no finite peak", result["peak_pressure_error_reason"])

    def test_check_writes_reports_for_ci(self):
        """A field that is good, bad, or cannot be read; a summary is added to what the file has."""
        Path("summary.md").write_text("# Earlier step")
        field = "contact-64-0.9.csv"
        for words, code, verdict, tag in ((("--set", "load.moment_ratio=0.9"), 0, "good", None),
                                          (("--set", "load.moment_ratio=0.8"), 1, "bad", "failure"),
                                          (("--set", "load.moment_ratio=2"), 2, "not judged", "error")):
            self.run_program(*check(field, *words, "--junit", "check.xml", "--summary", "summary.md"), code=code)
            case, = xml.etree.ElementTree.parse("check.xml").getroot().iter("testcase")
            self.assertTrue(case.get("name").endswith(field))
            self.assertEqual([child.tag for child in case if child.tag != "system-out"], [tag] if tag else [])
            if tag:
                self.assertEqual(case.find(tag).get("type"), verdict)
                self.assertIn("moment", case.find(tag).get("message"))
            self.assertIn(f"\n### {verdict}: ", Path("summary.md").read_text())
        self.assertTrue(Path("summary.md").read_text().startswith("# Earlier step\n### good: "))
        self.assertIn("\n      FAILS            moment_error ", Path("summary.md").read_text())
        self.run_program(*check(field, "--junit", "no/folder/x.xml"), code=2, says="--junit no/folder/x.xml")

    def test_report_draws_a_page_for_each_scene(self):
        scenes = [str(SCENES / "mindlin.toml"), str(SCENES / "honed_surface.toml")]
        out = self.run_program("report", *scenes, "--quick", "--output", "pages", "--junit", "out.xml", "--summary", "out.md",
                               "--json", "pages.json")
        self.assertNotIn("NOT all is well", out)
        if schemas:
            self.assertEqual(schemas.problem(schemas.parse(Path("pages.json").read_text()), "report"), "")
        index = Path("pages/index.html").read_text()
        for name, has, lacks in (("mindlin", "costs", "history"), ("honed_surface", "result", "costs")):
            self.assertIn(f'href="{name}/index.html"', index)
            page = Path(f"pages/{name}/index.html").read_text()
            self.assertIn(f"<h1>{name}</h1>", page)
            self.assertIn(f'id="{has}"', page)
            self.assertNotIn(f'id="{lacks}"', page)
            self.assertNotIn("Not available", page)
            self.assertNotIn("paper’s sphere", page)
            self.assertTrue(Path(f"pages/{name}/figures/answer.svg").exists())
        self.assertEqual(Path("out.xml").read_text().count("<testcase"), 8)
        self.assertRegex(Path("out.md").read_text(), r"\| mindlin \| (good|open) \|")
        self.run_program("report", scenes[0], "--quick", "--output", "pages/mindlin", "--want", "displacement=1e-15", code=1)
        self.run_program("report", scenes[0], scenes[0], "--output", "twice", code=2, says=("mindlin.toml", "one page"))
        self.run_program("report", scenes[0], "--want", "displacement", code=2, says=("--want", "twist=1e-3"))

    def test_quiet_prints_nothing(self):
        self.assertEqual(self.run_program(*solve("paper", "--quiet")), "")

    def test_pressure_from_a_file_gives_the_same_answer(self):
        scene = solve("paper", "--set", "grid.extent=[1.1e-3,1.1e-3]")
        first = self.result(*scene, "--fields", "pressure.h5")
        second = self.result(*scene, "--set", "contact.pressure=file", "--set", "contact.pressure_file=" + str(self.folder / "pressure.h5"))
        self.assertAlmostEqual(second["twist_angle"] / first["twist_angle"], 1, delta=1e-12)

    def test_exact_writes_every_key_of_the_contract(self):
        result = self.result("exact", "--stick-ratio", "0.5", "--radius", "0.25,0.75")
        self.assertLessEqual({"moment_ratio", "moment_deficit", "stick_ratio", "stick_complement", "twist", "moment",
                              "tangent_stiffness", "traction", "printed"}, set(result))
        self.assertEqual(len(result["traction"]), 2)
        self.assertAlmostEqual(result["traction"][1]["value"], math.sqrt(1 - 0.75**2), delta=4e-16)  # slip: mu p
        self.assertAlmostEqual(result["tangent_stiffness"], 16 / 3 / 8, delta=4e-16)

    def test_check_tells_a_good_field_from_a_bad_one(self):
        good = self.run_program(*check("contact-64-0.9.csv", "--twist", "2.361048651456917e-3"))
        self.assertTrue(good.startswith("good: "), good)
        bad = self.run_program(*check("cgcontact-64-0.9.csv", "--twist", "2.21775472e-3"), code=1,
                               says=("6.1 % too low", "FAILS"))
        self.assertTrue(bad.startswith("bad: the twist is"), bad)

    def test_check_asks_for_more_where_it_is_told(self):
        """The exact answer at cell centres is within the mesh's error; it is no solution of the grid's problem."""
        scene = (str(SCENES / "paper.toml"), "--set", "grid.cells=[48,48]")
        self.run_program("solve", *scene, "--set", "solver.model=exact", "--fields", "sampled.csv")
        for code, *options in ((0,), (0, "--strict"), (1, "--discrete"), (0, "--tolerance", "0.02"),
                               (1, "--tolerance", "1e-6"), (2, "--tolerance", "0")):
            self.run_program("check", scene[0], "sampled.csv", *scene[1:], *options, code=code)
        self.run_program(*check("contact-64-0.9.csv", "--discrete", "--strict"))
