"""resume_test.py PROGRAM: a history killed between steps or in a step resumes from its checkpoint and ends with the
digits of an uninterrupted one; a checkpoint of another scene or program is refused."""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from hold import Hold
from kills_test import SCENE, without_times
from program_run import SHORT_SCENE

PROGRAM = Path(sys.argv[1]).resolve()
SCENES = SCENE.parent
# Loads that use all of a history's state: more and less normal load, the same twice, turns back, and forces.
STEPS = "".join(f"[[step]]\n{keys}\n" for keys in (
    "moment_ratio = 0.5", "moment_ratio = 0.7", "normal = 1300", "moment_ratio = -0.4", "force = [20, 10]", "normal = 900"))


class ResumeTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slipstick-resume-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        aside = tempfile.TemporaryDirectory()
        self.addCleanup(aside.cleanup)
        self.aside = Path(aside.name)
        self.checkpoint = self.folder / "history.h5"

    def words(self, scene, *words, program=PROGRAM):
        return list(map(str, [program, "solve", SCENES / f"{scene}.toml", "--json", "result.json", "--fields",
                              "step{step}.h5", *words]))

    def run_program(self, *arguments, code=0, **options):
        end = subprocess.run(self.words(*arguments, **options), cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(end.returncode, code, end.stdout + end.stderr)
        return end.stderr

    def kill(self, words, between):
        """Kills the solve after it has written its next checkpoint, or at the end of the next step."""
        hold = Hold(self.aside, "*history.h5" if between else "*step*.h5", 1 if between else 2, between)
        child = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                 env=hold.environment)
        os.kill(hold.process(child), signal.SIGKILL)
        self.assertEqual(child.wait(), -signal.SIGKILL)

    def answer(self):
        fields = {path.name: path.read_bytes() for path in self.folder.glob("step*.h5")}
        return json.dumps(without_times(json.loads((self.folder / "result.json").read_text()))), fields

    def clear(self):
        for path in self.folder.iterdir():
            path.unlink()

    def assert_resumes(self, scene, *options, kills=2):
        """Kills between two steps, and at the end of a step; each time one step further."""
        self.run_program(scene, *options)
        whole = self.answer()
        words = (scene, *options, "--checkpoint", self.checkpoint, "--resume")
        for between in (True, False):
            self.clear()
            for _ in range(kills):
                self.kill(self.words(*words), between)
            said = self.run_program(*words)
            self.assertEqual(self.answer(), whole)
            self.assertRegex(said, r"after step \d+, from .*history\.h5")
            self.assertEqual(list(self.folder.glob("*.part*")), [])

    def test_growing_load(self):
        self.assert_resumes("growing_load", "--set", "grid.cells=[48,48]")

    def test_full_coupling(self):
        self.assert_resumes("spence_sphere", "--set", "grid.cells=[32,32]")

    def test_slip_over_several_steps(self):
        self.assert_resumes("torsion_loop", "--set", "grid.cells=[16,16]")

    def test_all_of_the_state(self):
        for head, options, kills in (("cycles = 2\n", (), 11), ("", ("full", "lower.poisson_ratio=0.1"), 5),
                                     ("", ("pressure", "lower.poisson_ratio=0.1"), 5)):
            (self.aside / "all.toml").write_text(head + SHORT_SCENE.replace("[32, 32]", "[16, 16]") + STEPS)
            self.clear()
            sets = (word for key in options for word in ("--set", key if "=" in key else f"contact.coupling={key}"))
            self.assert_resumes(self.aside / "all", *sets, kills=kills)

    def test_other_and_damaged_checkpoints_are_refused(self):
        small = ("growing_load", "--set", "grid.cells=[16,16]")
        keep = ("--checkpoint", self.checkpoint)
        self.run_program(*small, *keep)
        good = self.checkpoint.read_bytes()
        self.assertIn("allowed: --resume", self.run_program(*small, *keep, code=2))
        resume = (*keep, "--resume")
        other = "is the checkpoint of another scene, or of this one with other keys"
        self.assertIn(other, self.run_program(*small, "--set", "contact.friction=0.2", *resume, code=2))
        self.assertIn(other, self.run_program("fretting_torsion", *resume, code=2))
        program = shutil.copy(PROGRAM, self.folder / "other")
        (self.folder / "lib").symlink_to(PROGRAM.parent / "lib")  # the HDF5 library is searched there
        with open(program, "ab") as file:
            file.write(b"x")
        self.assertIn("another build of slipstick", self.run_program(*small, *resume, program=program, code=2))
        for place in range(2048, len(good), len(good) // 8):  # a damaged byte is detected, or lies outside the data
            self.checkpoint.write_bytes(good[:place] + bytes([good[place] ^ 0x10]) + good[place + 1:])
            end = subprocess.run(self.words(*small, *resume), cwd=self.folder, capture_output=True, text=True)
            self.assertIn(end.returncode, (0, 2), end.stderr)
            if end.returncode == 0:
                self.assertEqual(self.result_of(small), self.answer()[0])
        for damaged in (b"", b"no HDF5", good[: len(good) // 2]):
            self.checkpoint.write_bytes(damaged)
            self.assertIn("history.h5", self.run_program(*small, *resume, code=2))
        self.checkpoint.write_bytes(good)
        self.run_program(*small, *resume)

    def result_of(self, small):
        self.run_program(*small)
        return self.answer()[0]

    def test_options(self):
        small = ("growing_load", "--set", "grid.cells=[16,16]")
        self.assertIn("requires", self.run_program(*small, "--resume", code=2))
        self.assertIn("excludes", self.run_program(*small, "--checkpoint", "a.h5", "--accuracy", 0.1, code=2))
        self.assertIn("would overwrite", self.run_program(*small, "--checkpoint", SCENES / "growing_load.toml", code=2))
        self.assertIn("cannot be written", self.run_program(*small, "--checkpoint", "no/where.h5", code=2))
        drawn = ("--set", "solver.rounding_seed=1", "--checkpoint", "a.h5")
        self.assertIn("solver.rounding_seed = 1", self.run_program(*small, *drawn, code=2))
