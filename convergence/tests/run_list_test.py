"""run_list_test.py PROGRAM GUIDE: listed runs of a study, of gates and of hard scenes, solved one by one, give the result
of one command; missing and killed runs are listed again. The guide's commands are run from its text if their programs are
installed."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from hold import Hold
from kills_test import SCENE, without_times

PROGRAM, GUIDE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
PATIENCE = 120  # seconds; everything here is faster on any machine
STUDY = f"""
name = "small"
scene = "{SCENE}"
cells = [8, 12, 16]
quantities = ["twist_error"]
tolerances = [1e-2, 1e-4]
[[vary]]
key = "contact.pressure"
values = ["solved", "hertz"]
"""
# The first gate fails: the runs for the largest part of its error are listed after its own.
GATES = f"""
[[gate]]
id = "tight"
scene = "{SCENE}"
set = {{ "grid.cells" = [16, 16] }}
quantity = "twist_error"
below = 1e-7
basis = "made up"
[[gate]]
id = "loose"
scene = "{SCENE}"
set = {{ "grid.cells" = [24, 24] }}
quantity = "twist_error"
below = 1.0
basis = "made up"
[[gate]]
id = "of-study"
study = "few.toml"
quantity = "series.paper.meshes[0].twist_error.mean"
below = 1.0
basis = "made up"
"""


HARD = f"""
[[family]]
name = "small"
why = "made up"
scene = "{SCENE}"
set = {{ "grid.cells" = [12, 12] }}
[[family.vary]]
key = "contact.friction"
values = [0.1, 0.2]
"""


class RunListTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slipstick-lists-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "study.toml").write_text(STUDY)
        (self.folder / "few.toml").write_text(f'scene = "{SCENE}"\ncells = [8, 12]\nquantities = ["twist_error"]\n')
        (self.folder / "gates.toml").write_text(GATES)
        (self.folder / "hard.toml").write_text(HARD)

    def run_program(self, *words, code=0, program=PROGRAM):
        end = subprocess.run([program, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(end.returncode, code, f"{words}\n{end.stdout}{end.stderr}")
        return end.stdout + end.stderr

    def result(self, name):
        return without_times(json.loads((self.folder / name).read_text()))

    def kept(self, folder):
        return {path.name: path.stat().st_mtime_ns for path in (self.folder / folder).glob("*.json")}

    def listed(self, *words, program=PROGRAM):
        """The lines of the list."""
        self.run_program(*words, "--list-runs", "runs.jsonl", program=program)
        return [json.loads(line) for line in (self.folder / "runs.jsonl").read_text().splitlines()]

    def test_listed_runs_give_the_result_of_one_command(self):
        for command, file, code, most_lists in (("study", "study.toml", 0, 1), ("gate", "gates.toml", 1, 2),
                                                ("hard", "hard.toml", 0, 2)):
            with self.subTest(command=command):
                self.run_program(command, file, "--output", f"{command}-whole", "--json", "whole.json", code=code)
                words = (command, file, "--output", command)
                lists = 0
                while lines := self.listed(*words):
                    lists += 1
                    self.assertFalse({f"{line['name']}.json" for line in lines} & set(self.kept(command)))
                    self.run_program("run", "runs.jsonl", "--only", len(lines))
                    self.assertIn(f"{lines[-1]['name']}.json", self.kept(command))
                    self.run_program("run", "runs.jsonl")
                self.assertEqual(lists, most_lists)
                before = self.kept(command)
                self.run_program(*words, "--json", "result.json", code=code)
                self.assertEqual(json.dumps(self.result("result.json")), json.dumps(self.result("whole.json")))
                self.assertEqual(self.kept(command), before)
                self.assertEqual(before.keys(), self.kept(f"{command}-whole").keys())

    def test_a_copied_folder_counts_as_the_original(self):
        """With any file times, and for a copy of the program, as on another machine."""
        self.run_program("study", "study.toml", "--output", "whole")
        shutil.copytree(self.folder / "whole", self.folder / "copy", copy_function=shutil.copyfile)
        copied = shutil.copy(PROGRAM, self.folder / "copied")
        os.utime(copied, (1, 1))
        self.assertEqual(self.listed("study", "study.toml", "--output", "copy", program=copied), [])
        gone = sorted(self.kept("copy"))[0]
        (self.folder / "copy" / gone).unlink()
        self.assertEqual([f"{line['name']}.json" for line in self.listed("study", "study.toml", "--output", "copy")], [gone])
        self.run_program("run", "runs.jsonl", "--output", "elsewhere")
        self.assertEqual(list(self.kept("elsewhere")), [gone])

    def test_a_kill_loses_the_current_run_only(self):
        lines = self.listed("study", "study.toml", "--output", "killed")
        words = ["run", "runs.jsonl", "--jobs", "1"]
        hold = Hold(self.folder, "*killed/*.json", 4)
        child = subprocess.Popen([PROGRAM, *words], cwd=self.folder, stderr=subprocess.DEVNULL, start_new_session=True,
                                 env=hold.environment)
        hold.process(child)
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        before = self.kept("killed")
        self.assertEqual(len(before), 3)
        self.assertEqual(len(self.listed("study", "study.toml", "--output", "killed")), len(lines) - 3)
        self.run_program(*words)
        after = self.kept("killed")
        self.assertEqual({name: after[name] for name in before}, before)
        self.assertEqual(self.listed("study", "study.toml", "--output", "killed"), [])

    def test_a_run_that_fails_is_marked_and_listed_again(self):
        self.listed("gate", "gates.toml", "--only", "loose")
        said = self.run_program("run", "runs.jsonl", "--memory-limit", "1kB", code=1)
        self.assertIn("1  paper, grid.cells=[24, 24]: refused: ", said)
        self.assertEqual(len(self.listed("gate", "gates.toml", "--only", "loose")), 1)

    def test_what_cannot_be_listed_or_run_is_refused(self):
        for words in (("study", "study.toml", "--figure", "a.svg"), ("gate", "gates.toml", "--junit", "a.xml"),
                      ("gate", "gates.toml", "--summary", "a.md")):
            self.assertIn("excludes", self.run_program(*words, "--list-runs", "runs.jsonl", code=2))
        self.assertIn("would overwrite", self.run_program("study", "study.toml", "--list-runs", "study.toml", code=2))
        lines = self.listed("study", "study.toml")
        self.assertIn(f"has {len(lines)} lines", self.run_program("run", "runs.jsonl", "--only", len(lines) + 1, code=2))
        scene = shutil.copy(SCENE, self.folder / "scene.toml")
        (self.folder / "few.toml").write_text('scene = "scene.toml"\ncells = [8, 12]\n')
        self.listed("study", "few.toml")
        Path(scene).write_text(SCENE.read_text().replace("0.9", "0.8"))
        self.assertRegex(self.run_program("run", "runs.jsonl", code=2), r"runs\.jsonl:1: name = .* has changed")


class OneLinersTest(unittest.TestCase):
    """The commands of the guide, on a study that takes a second."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slipstick-engines-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "build").mkdir()
        (self.folder / "build/slipstick").symlink_to(PROGRAM)
        (self.folder / "mesh.toml").write_text(f'scene = "{SCENE}"\ncells = [8, 12, 16]\nquantities = ["twist_error"]\n')
        (self.folder / "gates.toml").write_text(GATES.replace("below = 1e-7", "below = 1.0").split('[[gate]]\nid = "of')[0])
        self.text = GUIDE.read_text()

    def block(self, first_words):
        """The fenced block of the guide that has these words."""
        for block in re.findall(r"^```\w*\n(.*?)^```", self.text, re.S | re.M):
            if first_words in block:
                return block
        self.fail(f"{GUIDE.name} has no block with “{first_words}”")

    def shell(self, script, **environment):
        end = subprocess.run(["bash", "-e", "-c", script], cwd=self.folder, capture_output=True, text=True,
                             env={**os.environ, **environment}, timeout=PATIENCE)
        self.assertEqual(end.returncode, 0, f"{script}\n{end.stdout}{end.stderr}")
        print(end.stdout.rstrip())
        return end.stdout

    def need(self, program):
        if not shutil.which(program):
            self.skipTest(f"{program} is not installed")

    def judged(self):
        """Every run is finished, and the study has its error budget."""
        self.assertIn("0 runs without", self.shell("build/slipstick study mesh.toml --list-runs rest.jsonl"))
        self.assertRegex(self.shell("build/slipstick study mesh.toml"), r"\n +12 x 12 +-?\+?\d.*\n +16 x 16 ")

    def test_by_hand_and_xargs(self):
        self.assertIn(": converged\n", self.shell(self.block("study mesh.toml --list-runs runs.jsonl  ")))
        shutil.rmtree(self.folder / "build/studies")
        self.shell(self.block("xargs"))
        self.judged()

    def test_gnu_parallel(self):
        self.need("parallel")
        self.shell("build/slipstick study mesh.toml --list-runs runs.jsonl")
        self.shell(self.block("parallel "))
        self.judged()

    def test_snakemake(self):
        self.need("snakemake")
        (self.folder / "Snakefile").write_text(self.block("rule "))
        self.shell("build/slipstick study mesh.toml --list-runs runs.jsonl")
        self.shell(self.block("snakemake "))
        self.judged()

    def test_slurm(self):
        """Runs what the tasks of the array do; an sbatch of a machine without Slurm is given its words."""
        self.shell("build/slipstick study mesh.toml --list-runs runs.jsonl")
        stand_in = self.folder / "bin/sbatch"
        stand_in.parent.mkdir()
        stand_in.write_text('#!/bin/sh\nfor word; do echo "$word"; done\n')
        stand_in.chmod(0o755)
        words = self.shell(self.block("sbatch "), PATH=f"{stand_in.parent}:{os.environ['PATH']}").splitlines()
        count = int(re.search(r"--array=1-(\d+)", words[0])[1])
        for task in range(1, count + 1):
            self.shell(words[-1].removeprefix("--wrap="), SLURM_ARRAY_TASK_ID=str(task))
        self.judged()

    def test_ci_matrix(self):
        workflow = self.block("matrix:")
        parts = re.search(r"part: \[([\d, ]+)\]", workflow)[1].split(", ")
        *solve, judge = re.findall(r"run: ((?:\./slipstick|seq) .*)", workflow)
        (self.folder / "slipstick").symlink_to(PROGRAM)
        for part in parts:
            self.shell("\n".join(solve).replace("${{ matrix.part }}", part))
            (self.folder / "kept").rename(self.folder / f"kept-{part}")
        for part in parts:
            shutil.copytree(self.folder / f"kept-{part}", self.folder / "kept", dirs_exist_ok=True)
        before = {path: path.stat().st_mtime_ns for path in self.folder.glob("kept/*")}
        self.assertEqual(len(before), 2)
        self.assertIn("2 gates: 2 passed", self.shell(judge, GITHUB_STEP_SUMMARY="summary.md"))
        self.assertEqual({path: path.stat().st_mtime_ns for path in self.folder.glob("kept/*")}, before)
