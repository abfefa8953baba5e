#!/usr/bin/env python3
"""shards_test.py PROGRAM GUIDE: shards of a study or of gates, solved separately and merged, give the result of one
command; missing, killed and misspelt shards are reported. The guide's commands are run from its text if their programs
are installed."""

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
# The first gate fails: the largest part of its error is found after all shards are merged.
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


class ShardsTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slipstick-shards-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "study.toml").write_text(STUDY)
        (self.folder / "few.toml").write_text(f'scene = "{SCENE}"\ncells = [8, 12]\nquantities = ["twist_error"]\n')
        (self.folder / "gates.toml").write_text(GATES)

    def run_program(self, *words, code=0):
        end = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(end.returncode, code, f"{words}\n{end.stdout}{end.stderr}")
        return end.stdout + end.stderr

    def result(self, name):
        return without_times(json.loads((self.folder / name).read_text()))

    def kept(self, folder):
        return {path.name: path.stat().st_mtime_ns for path in (self.folder / folder).glob("*.json")}

    def solve_shards(self, command, file, count):
        """The folders of the shards; no run is solved twice."""
        folders, seen = [], set()
        for i in range(1, count + 1):
            folders.append(f"{command}-{count}-{i}")
            self.run_program(command, file, "--shard", f"{i}/{count}", "--output", folders[-1])
            names = set(self.kept(folders[-1]))
            self.assertFalse(seen & names)
            seen |= names
        return folders

    def test_any_split_of_a_study_gives_the_same_result(self):
        self.run_program("study", "study.toml", "--output", "whole", "--json", "whole.json")
        for count in (1, 3):
            folders = self.solve_shards("study", "study.toml", count)
            self.run_program("study", "study.toml", "--output", "joined", "--json", "joined.json", "--merge", *folders)
            self.assertEqual(json.dumps(self.result("joined.json")), json.dumps(self.result("whole.json")))
            self.assertEqual(self.kept("joined").keys(), self.kept("whole").keys())
            shutil.rmtree(self.folder / "joined")
        self.copy_of_the_program_goes_on(folders)

    def test_any_split_of_gates_gives_the_same_verdicts(self):
        self.run_program("gate", "gates.toml", "--output", "whole", "--json", "whole.json", code=1)
        folders = self.solve_shards("gate", "gates.toml", 2)
        self.run_program("gate", "gates.toml", "--output", "joined", "--json", "joined.json", "--merge", *folders, code=1)
        self.assertEqual(self.result("joined.json"), self.result("whole.json"))

    def test_what_is_missing_is_named_and_solved_by_whom_one_asks(self):
        folders = self.solve_shards("study", "study.toml", 2)
        gone = sorted(self.kept(folders[1]))[0]
        (self.folder / folders[1] / gone).unlink()
        merge = ("study", "study.toml", "--output", "joined", "--merge", *folders)
        said = self.run_program(*merge, code=2)
        self.assertRegex(said, r"--merge: 1 of \d+ runs are in none of the folders")
        self.assertRegex(said, r"Missing:\n  paper, .*grid\.cells=\[\d+,\d+\]")
        self.run_program("study", "study.toml", "--shard", "2/2", "--output", folders[1])
        self.assertIn(gone, self.kept(folders[1]))
        self.run_program(*merge)
        (self.folder / "joined" / gone).unlink()
        self.run_program("study", "study.toml", "--output", "joined")
        self.assertIn(gone, self.kept("joined"))

    def copy_of_the_program_goes_on(self, folders):
        """A copied folder counts as the original, with any file times, as from another machine."""
        copied = shutil.copy(PROGRAM, self.folder / "copied")
        os.utime(copied, (1, 1))
        words = [copied, "study", "study.toml", "--output", "whole", "--merge", *folders]
        before = self.kept("whole")
        end = subprocess.run(words, cwd=self.folder, capture_output=True)
        self.assertEqual(end.returncode, 0, end.stderr)
        self.assertEqual(self.kept("whole"), before)

    def test_a_killed_shard_loses_its_current_run_alone(self):
        words = [PROGRAM, "study", "study.toml", "--shard", "1/1", "--output", "killed", "--jobs", "1"]
        hold = Hold(self.folder, "*killed/*.json", 4)
        child = subprocess.Popen(words, cwd=self.folder, stderr=subprocess.DEVNULL, start_new_session=True,
                                 env=hold.environment)
        hold.process(child)
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        before = self.kept("killed")
        self.assertEqual(len(before), 3)
        self.run_program(*words[1:])
        after = self.kept("killed")
        self.assertEqual({name: after[name] for name in before}, before)
        self.run_program("study", "study.toml", "--merge", "killed")

    def test_what_is_no_shard_is_refused(self):
        for word in ("0/3", "4/3", "x", "1/3/3"):
            said = self.run_program("study", "study.toml", "--shard", word, code=2)
            self.assertIn(f"--shard {word}: allowed: I/N", said)
            self.run_program("gate", "gates.toml", "--shard", word, code=2)
        self.assertIn("is no folder", self.run_program("study", "study.toml", "--merge", "nowhere", code=2))
        for words in (("--merge", "."), ("--figure", "a.svg")):
            self.assertIn("excludes", self.run_program("study", "study.toml", "--shard", "1/2", *words, code=2))
        for words in (("--junit", "a.xml"), ("--summary", "a.md")):
            self.assertIn("excludes", self.run_program("gate", "gates.toml", "--shard", "1/2", *words, code=2))


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

    def assert_judged(self, said):
        self.assertRegex(said, r"\n +12 x 12 +-?\+?\d.*\n +16 x 16 ")  # the error budget

    def test_gnu_parallel(self):
        self.need("parallel")
        self.assert_judged(self.shell(self.block("parallel ")))

    def test_snakemake(self):
        self.need("snakemake")
        (self.folder / "Snakefile").write_text(self.block("rule "))
        self.assert_judged(self.shell(self.block("snakemake ")))

    def test_slurm(self):
        """Checks the syntax, by Slurm if it is installed, and runs the tasks of the array."""
        script = self.folder / "shards.sh"
        script.write_text(self.block("#SBATCH"))
        subprocess.run(["bash", "-n", script], check=True)
        if shutil.which("sbatch"):
            subprocess.run(["sbatch", "--test-only", script], check=True)
        count = re.search(r"--array=1-(\d+)", script.read_text())[1]
        for task in range(1, int(count) + 1):
            self.shell(". ./shards.sh", SLURM_ARRAY_TASK_ID=str(task), SLURM_ARRAY_TASK_COUNT=count, SLURM_CPUS_PER_TASK="1")
        self.assert_judged(self.shell(self.block("build/slipstick study mesh.toml --merge")))

    def test_ci_matrix(self):
        workflow = self.block("matrix:")
        shards = re.search(r"shard: \[([\d, ]+)\]", workflow)[1].split(", ")
        commands = re.findall(r"run: (\./slipstick .*)", workflow)
        self.assertEqual(len(commands), 2)
        (self.folder / "slipstick").symlink_to(PROGRAM)
        for shard in shards:
            self.shell(commands[0].replace("${{ matrix.shard }}", shard))
        self.assertIn("2 gates: 2 passed", self.shell(commands[1], GITHUB_STEP_SUMMARY="summary.md"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
