"""program_gate_test.py PROGRAM: the exit codes and files of `slipstick gate`, with gates on a coarse grid."""

import json
import math
import os
import xml.etree.ElementTree
from datetime import datetime
from pathlib import Path

from program_run import SCENES, ProgramTest

PAPER = SCENES / "paper.toml"
LOOSE = "below = 1e-7"
TIGHT = "below = 1e-30"
COUNTED = """made_by = 'make counts'
[[gate]]
id = "counted"
result = "work.json"
quantity = "counts.some-case.applications"
above = 17
below = 21
basis = "counted 19"
"""


def gate(name, bound, more="", quantity="certificate.gap"):
    return (f"[[gate]]\nid = '{name}'\nscene = '{PAPER}'\nset = {{ 'grid.cells' = [16, 16] }}\n"
            f"quantity = '{quantity}'\n{bound}\nbasis = 'the tolerance'\n{more}\n")


def counts(number):
    return f'{{"counts": {{"some-case": {{"applications": {number}}}}}}}'


class GateProgram(ProgramTest):
    def gate(self, *words, code=0, says=()):
        return self.run_program("gate", "--output", "points", *words, code=code, says=says)

    def test_exit_codes_say_what_happened(self):
        self.write("good.toml", gate("good", LOOSE))
        self.write("bad.toml", gate("bad", TIGHT) + gate("known", TIGHT, "status = 'expected_failure'"))
        self.write("repaired.toml", gate("repaired", LOOSE, "status = 'expected_failure'"))
        self.write("refused.toml", gate("refused", LOOSE, "platform_spread = 1"))
        self.write("watched.toml", gate("watched", TIGHT, "status = 'report_only'"))
        self.write("empty.toml", "")
        self.gate("good.toml")
        self.gate("good.toml", "bad.toml", code=1)
        self.gate("bad.toml", "--only", "known")
        self.gate("good.toml", "watched.toml")
        self.gate("repaired.toml", code=1)
        self.gate("refused.toml", "bad.toml", code=2, says="platform spread")
        self.gate("empty.toml", code=2, says="no gate ran")
        self.gate("good.toml", "--only", "goood", code=2)
        self.gate(code=2)
        self.gate("missing.toml", code=2)

    def test_blames_the_file_for_a_wrong_key_of_its_own(self):
        self.write("gates.toml", gate("wrong", LOOSE).replace("'grid.cells'", "'grid.cels'"))
        said = self.gate("gates.toml", code=2, says=("gates.toml:1: grid.cels = ", "grid.cells"))
        self.assertNotIn("--set", said)

    def test_judges_exact_answers_of_scenes(self):
        def exact(scene, twist):
            return (f"[[gate]]\nid = 'exact'\nscene = '{SCENES / scene}.toml'\nquantity = 'twist'\nbasis = '16/3 G a^3'\n"
                    f"set = {{ 'solver.model' = 'exact', 'load.moment_ratio' = 0.5 }}\n"
                    f"above = {twist * (1 - 1e-14)!r}\nbelow = {twist * (1 + 1e-14)!r}\n")

        stuck = 3 / 16 * math.pi / 8  # a bonded punch's twist under pi/8 mu W a
        self.gate(self.write("right.toml", exact("flat_punch", stuck)))
        self.gate(self.write("wrong.toml", exact("flat_punch", stuck * (1 + 1e-9))), code=1)
        self.gate(self.write("none.toml", exact("ellipse", stuck)), code=1, says="solver.model")

    def test_shows_the_day_of_a_result_file(self):
        self.write("work.json", counts(19))
        self.write("counts.toml", COUNTED)
        noon = datetime.fromisoformat("2024-05-01T12:00:00+00:00").timestamp()
        os.utime(self.folder / "work.json", (noon, noon))
        self.gate("counts.toml", "--json", "gates.json", says=("work.json", "2024-05-01"))
        self.assertEqual(json.loads((self.folder / "gates.json").read_text())["gates"][0]["file_date"], "2024-05-01")

    def test_a_number_is_held_to_that_of_another_result(self):
        relative = COUNTED.replace("above = 17\nbelow = 21", 'of = "before.json"\nwithin = 0.1')
        self.write("relative.toml", relative)
        self.write("before.json", counts(20))
        for number, code in ((18.1, 0), (21.9, 0), (17.9, 1), (22.1, 1)):
            self.write("work.json", counts(number))
            self.gate("relative.toml", code=code, says="before.json")
        self.write("before.json", counts(-20))
        self.write("work.json", counts(-21))
        self.gate("relative.toml")
        for number in ("null", "0", '"many"'):
            self.write("before.json", counts(number))
            self.gate("relative.toml", code=2, says="before.json")
        (self.folder / "before.json").unlink()
        self.gate("relative.toml", code=2, says="before.json")
        for wrong, says in (("below = 3", "].below"), ("within = 0", "within"), ("equals = 3", "].equals")):
            self.write("wrong.toml", relative.replace("within = 0.1", "") + wrong if wrong.startswith("within")
                       else relative + wrong)
            self.gate("wrong.toml", code=2, says=says)
        self.write("lone.toml", relative.replace("within = 0.1", ""))
        self.gate("lone.toml", code=2, says="within")

    def test_a_number_is_held_to_that_of_another_scene(self):
        """At equal parts of their limits twists are as friction coefficients are."""
        self.write("rough.toml", PAPER.read_text().replace("friction = 0.1", "friction = 0.2"))
        for scene, within, code in ((PAPER, 1e-12, 0), ("rough.toml", 0.5001, 0), ("rough.toml", 0.4999, 1)):
            self.write("scenes.toml", gate("twists", f"of = '{scene}'\nwithin = {within}", quantity="twist_angle"))
            self.gate("scenes.toml", code=code, says=Path(scene).name)

    def test_writes_its_reports_whatever_else_is_wrong(self):
        self.write("good.toml", gate("good", LOOSE))
        self.write("bad.toml", gate("bad", TIGHT))
        self.write("broken.toml", "[[gate]]\nname = 'x'\n")
        self.write("lost.toml",
                   "[[gate]]\nid = 'lost'\nscene = 'nowhere.toml'\nquantity = 'x'\nbelow = 1\nbasis = 'none'\n")
        self.gate("broken.toml", "good.toml", "lost.toml", "bad.toml", "--junit", "junit.xml", "--summary",
                  "summary.md", "--json", "gates.json", code=2,
                  says=("certificate.gap is ", "nowhere.toml", "broken.toml"))
        suites = xml.etree.ElementTree.parse("junit.xml").getroot().iter()
        self.assertIn(("4", "1", "2"), [tuple(map(each.get, ("tests", "failures", "errors"))) for each in suites])
        self.assertIn("| passed | good | certificate.gap |", Path("summary.md").read_text())
        result = json.loads(Path("gates.json").read_text())
        self.assertEqual((result["counts"]["passed"], result["counts"]["refused"]), (1, 2))

    def test_junit_holds_every_outcome_and_any_name(self):
        name = 'bad <a> & "b" | c, d: 100 %'
        self.write("work.json", counts(19))
        self.write("all.toml", COUNTED + COUNTED.partition("\n")[2].replace("counted", name.replace('"', "''"), 1)
                   .replace("below = 21", "below = 18") + gate("known", TIGHT, "status = 'expected_failure'"))
        self.write("other.toml", gate("watched", TIGHT, "status = 'report_only'"))
        self.gate("all.toml", "other.toml", "--junit", "junit.xml", code=1)
        suites = xml.etree.ElementTree.parse("junit.xml").getroot()
        self.assertEqual([suites.get(key) for key in ("tests", "failures", "errors", "skipped")], ["4", "1", "0", "2"])
        self.assertEqual([suite.get("name") for suite in suites], ["all.toml", "other.toml"])
        cases = {case.get("name"): case for case in suites.iter("testcase")}
        failure = cases[name.replace('"', "''")].find("failure")
        self.assertEqual((failure.get("type"), failure.get("message")),
                         ("failed", "counts.some-case.applications is 19, must be between 17 and 18"))
        self.assertIn("counted 19", failure.text)
        self.assertIn("certificate.gap", cases["watched"].find("skipped").get("message"))

    def test_names_the_largest_part_of_the_error(self):
        self.write("coarse.toml", gate("coarse", "below = 1e-6", quantity="twist_error"))
        self.gate("coarse.toml", code=1, says=("error: discretisation", "--only coarse"))
        loose = gate("loose", "below = 1e-6", quantity="twist_error").replace("16] }", "16], 'solver.tolerance' = 0.1 }")
        self.gate(self.write("loose.toml", loose), code=1, says="error: iteration")

    def test_judges_studies(self):
        self.write("study.toml", f"scene = '{PAPER}'\ncells = [12, 16]\n")
        for study, equals, code, says in (("study.toml", 16, 0, ()), ("study.toml", 12, 1, ()),
                                          ("nowhere.toml", 16, 2, "nowhere.toml")):
            self.write("gates.toml", f"[[gate]]\nid = 'one'\nstudy = '{study}'\nset = {{ 'load.moment_ratio' = 0.5 }}\n"
                       f"quantity = 'series.paper.rows[1].cells[0]'\nequals = {equals}\nbasis = 'asked for'\n")
            self.gate("gates.toml", code=code, says=says)

    def test_judges_one_study_with_different_keys(self):
        self.write("study.toml", f"scene = '{PAPER}'\ncells = [12, 16]\n")
        self.write("gates.toml", "".join(
            f"[[gate]]\nid = 'to {tolerance}'\nstudy = 'study.toml'\nset = {{ 'solver.tolerance' = {tolerance} }}\n"
            f"quantity = 'series.paper.rows[1].requested'\nabove = {0.9 * tolerance}\nbelow = {1.1 * tolerance}\n"
            "basis = 'asked for'\n" for tolerance in (1e-6, 1e-4)))
        self.gate("gates.toml")

    def test_judges_result_files_of_any_program(self):
        self.write("gates.toml", COUNTED)
        self.gate("gates.toml", code=2, says=("work.json", "make counts"))
        for text, code in (("19", 0), ("16", 1), ("22", 1), ("null", 1), ('"19"', 1)):
            self.write("work.json", counts(text))
            self.gate("gates.toml", code=code)
        os.mkdir("results")
        self.write("results/work.json", counts("18"))
        self.gate("gates.toml", "--results", "results")
        for broken in ("{", "", '{"counts": NaN}', '{"counts": 1e400}'):
            self.write("work.json", broken)
            self.gate("gates.toml", code=2, says="work.json")

    def test_computes_equal_scenes_once(self):
        self.write("two.toml", gate("one", LOOSE) + gate("two", "below = 1e-6"))
        self.gate("two.toml", says="[1/1]")
        self.assertNotIn("[1/1]", self.gate("two.toml"))
