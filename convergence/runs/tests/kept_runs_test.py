"""kept_runs_test.py PROGRAM: results that `slipstick run` keeps: they are those of solve, depend on nothing but their run, and are
computed again wherever something of them is damaged or has changed."""

import json
import os
import shutil
import subprocess
from pathlib import Path

from kills_test import without_times
from program_run import PROGRAM, SCENES, SHORT_SCENE, ProgramTest

CELLS = "grid.cells=[16,16]"
MAP = SHORT_SCENE[:SHORT_SCENE.index("[grid]")].replace(
    'shape = "sphere"\nradius = 0.018',
    'shape = "height_map"\nfile = "heights.csv"\nspacing = [1e-4, 1e-4]\nends_at_grid_edge = true')
HISTORY = SHORT_SCENE.replace("moment_ratio = 0.5\n", "") + "[[step]]\nmoment_ratio = 0.8\n[[step]]\nmoment_ratio = -0.8\n"
NO_CONTACT = "grid.extent=[1e-4,1e-4]"  # refused


def paths(value, path=""):
    """Names and places of all numbers and words."""
    if not isinstance(value, (dict, list)):
        return [path]
    pairs = value.items() if isinstance(value, dict) else enumerate(value)
    return [each for key, inner in pairs for each in paths(inner, f"{path}/{key}")]


class KeptRuns(ProgramTest):
    def setUp(self):
        super().setUp()
        shutil.copy(SCENES / "paper.toml", "paper.toml")
        self.write("history.toml", HISTORY)

    def run_all(self, *runs, output="runs", code=0, program=PROGRAM):
        """The rows of the runs. A run is its settings, or its keys."""
        keys = [{"scene": "paper.toml", **(run if isinstance(run, dict) else {"set": [CELLS, *run]})} for run in runs]
        self.write("runs.jsonl", "".join(json.dumps({**each, "output": output}) + "\n" for each in keys))
        end = subprocess.run([program, "run", "runs.jsonl", "--jobs", "1", "--json", "rows.json"], capture_output=True, text=True)
        self.assertEqual(end.returncode, code, end.stderr)
        self.said = end.stderr
        return json.loads(Path("rows.json").read_text())["runs"]

    def seconds(self, *runs, **options):
        """No two solves take the same time."""
        return [row["seconds"] for row in self.run_all(*runs, **options)]

    def kept(self, row, output="runs"):
        return Path(output) / f"{row['name']}.json"

    def answer(self, row, output="runs"):
        return json.loads(self.kept(row, output).read_text())["result"]

    def test_are_those_of_solve(self):
        """The steps of a scene decide whether its result has steps, whether the solve reached them or not."""
        for scene, most, status in (("paper", 5000, "converged"), ("history", 5000, "converged"), ("history", 1, "not_converged")):
            settings = [CELLS, f"solver.max_iterations={most}"]
            row, = self.run_all({"scene": f"{scene}.toml", "set": settings})
            words = (word for each in settings for word in ("--set", each))
            solved = self.result("solve", f"{scene}.toml", *words, code=(0, 1))
            found = self.answer(row)
            self.assertEqual(sorted(paths(found)), sorted(paths(solved)))
            self.assertEqual((found["status"], found["twist_angle"]), (status, solved["twist_angle"]))
            self.assertEqual("steps" in found, scene == "history")
            if most == 1:
                self.assertEqual(found["history"]["steps"], 1)

    def test_do_not_depend_on_runs_before_them(self):
        """One worker solves many runs. Equal ones are solved once."""
        large = ["grid.cells=[96,96]", "load.moment_ratio=0.5"]
        runs = [[], {"set": [CELLS], "rounding": "upward"}, ["load.moment_ratio=0.3"], [NO_CONTACT],
                {"set": [CELLS, "load.moment_ratio=0.3"], "variant": "mirrored"}, ["solver.cell_traction='smooth'"],
                {"scene": "history.toml"}, {"set": [CELLS, "load.moment_ratio=0.9"], "rounding": "downward"},
                ["load.moment_ratio=0.4"], {"set": large}, {"set": large, "rounding": "downward"}, ["solver.rounding_seed=7"]]
        together = self.run_all(*runs, runs[0])
        self.assertEqual(len(list(Path("runs").iterdir())), len(runs))
        for i, (run, row) in enumerate(zip(runs, together)):
            apart, = self.run_all(run, output=f"apart-{i}")
            self.assertEqual(without_times(self.answer(row)), without_times(self.answer(apart, f"apart-{i}")), run)

    def test_are_of_all_that_an_answer_depends_on(self):
        heights = "1,2,1\n2,0,2\n1,2,1\n"
        self.write("heights.csv", heights)
        self.write("map.toml", MAP)
        runs = [{"scene": "map.toml", **more} for more in (
            {}, {"set": ["contact.friction=0.2"]}, {"rounding": "upward"}, {"variant": "exchanged"}, {"fields": "fields.csv"},
            {"profile": True})]
        first = self.run_all(*runs)
        self.assertEqual(len({row["name"] for row in first}), len(runs))
        for file, text in (("heights.csv", heights.replace("0", "0.001")), ("map.toml", MAP + "# another text\n")):
            before = Path(file).read_text()
            self.write(file, text)
            self.assertFalse({row["name"] for row in self.run_all(*runs)} & {row["name"] for row in first}, file)
            self.write(file, before)
        self.assertEqual(self.run_all(*runs[:4]), first[:4])

    def test_are_computed_again_where_they_are_damaged(self):
        row, = self.run_all([])
        file = self.kept(row)
        good = file.read_text()
        whole = json.loads(good)
        wrong = (("program", 3), ("cache_key", None), ("result", None), ("result", "text"), ("result", {}), ("checksum", 3))
        twist = repr(whole["result"]["twist_angle"])
        damages = ["", good[:len(good) // 2], "\x7f\0\xff", good.replace(twist, "0.2"), "[1, 2]", "3", 100000 * "[",
                   *(good.replace('"result": {', f'"result": {{"x": {levels * "[" + levels * "]"}, ') for levels in (201, 200000)),
                   *(json.dumps({**whole, key: value}) for key, value in wrong)]
        others = (file.mkdir, lambda: os.mkfifo(file), lambda: file.symlink_to("/dev/null"), lambda: file.symlink_to("nowhere"))
        for damage in (*((lambda text=text: file.write_text(text)) for text in damages), *others):
            file.unlink()
            damage()
            again, = self.run_all([])
            self.assertNotEqual(again["seconds"], row["seconds"])
            self.assertEqual(self.run_all([]), [again])
            self.assertTrue(file.is_file() and not file.is_symlink())
            self.assertEqual(list(Path("runs").iterdir()), [file])
            self.assertEqual(self.answer(again)["twist_angle"], whole["result"]["twist_angle"])
            row = again
        for mine in (1, 2):  # a folder with something in it is put aside
            file.unlink()
            file.mkdir()
            (file / "mine").touch()
            self.run_all([])
            self.assertEqual((file.is_file(), len(list(Path("runs").glob("*/mine")))), (True, mine))

    def test_are_computed_again_by_another_program(self):
        before = self.seconds([])
        other = shutil.copy(PROGRAM, self.folder / "other")
        self.assertEqual(self.seconds([], program=other), before)
        with open(other, "ab") as file:
            file.write(b"x")
        self.assertNotEqual(self.seconds([], program=other), before)

    def test_are_not_finished_without_their_fields(self):
        run = {"set": [CELLS], "fields": "fields.h5", "profile": True}
        file = Path("fields.h5")
        row, = self.run_all(run)
        self.assertTrue(self.answer(row)["profile"])
        whole, before = file.read_bytes(), row["seconds"]
        for damage in (whole[:len(whole) // 2], b"", whole[:-1] + b"x", None):
            self.assertEqual(self.seconds(run), [before])
            file.unlink() if damage is None else file.write_bytes(damage)
            again, = self.seconds(run)
            self.assertNotEqual(again, before)
            self.assertEqual(file.read_bytes(), whole)
            before = again
        self.assertNotIn("profile", self.answer(*self.run_all({**run, "profile": False})))

    def test_say_why_there_is_no_answer(self):
        row, = self.run_all({"set": [CELLS, NO_CONTACT], "fields": "none.csv"})
        self.assertEqual(row["status"], "refused")
        self.assertIn("grid.extent", row["message"])
        self.assertFalse(Path("none.csv").exists())
        before = self.seconds([])
        for run, *says in (({"set": ["load.moment_ration=0.5"]}, "load.moment_ration", "load.moment_ratio"),
                           ({"set": [CELLS], "fields": "no/such/folder/f.h5"}, "no/such/folder/f.h5: cannot be written",
                            "the same command goes on from there")):
            Path("rows.json").write_text('{"runs": []}')
            self.run_all(run, code=2)
            for part in says:
                self.assertIn(part, self.said)
        self.assertEqual(self.seconds([]), before)
