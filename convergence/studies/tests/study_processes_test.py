"""study_processes_test.py PROGRAM SCENES: slipstick study as users run it: interrupted, continued, killed, and with bad
input. Its processes are found in /proc, on Linux only."""

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
from kills_test import MARKER, comes_true, processes_of

PROGRAM, SCENE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve() / "paper.toml"
ON_LINUX = unittest.skipUnless(sys.platform == "linux", "only Linux shows which processes are the study's")

signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it, and so would a study


class Study(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.addCleanup(lambda: [os.kill(process, signal.SIGKILL) for process in self.processes()])
        self.write("cells = [16, 24, 32, 48, 64, 96, 128]\nshifts = 2\nquantities = [\"twist_error\"]\n")

    def write(self, text, scene=SCENE):
        (self.folder / "study.toml").write_text(f'scene = "{scene}"\n{text}')

    def start(self, name, jobs=0, environment=os.environ, **options):
        """With its result and its messages in files of a name; in a group of its own, as from a terminal."""
        with open(self.folder / f"{name}.txt", "w") as out, open(self.folder / f"{name}.log", "w") as log:
            return subprocess.Popen(
                [PROGRAM, "study", self.folder / "study.toml", "--output", self.folder / "points", "--json",
                 self.folder / f"{name}.json", "--jobs", str(jobs)],
                stdout=out, stderr=log, env=environment | {MARKER: str(self.folder)}, start_new_session=True, **options)

    def start_held(self, name, run, **options):
        """A study that is about to keep this run, counted from 1, among its points; what holds it; and its worker."""
        hold = Hold(self.folder, "*/points/*.json", run)
        study = self.start(name, 1, hold.environment, **options)
        return study, hold, hold.process(study)

    def run_study(self, name, code=0):
        self.assertEqual(self.start(name).wait(), code, self.text(f"{name}.log"))

    def text(self, file):
        return (self.folder / file).read_text()

    def finished(self):
        return sorted((self.folder / "points").glob("*.json"))

    def processes(self):
        """The running processes of the study and its workers."""
        return processes_of(self.folder)

    def test_goes_on_after_an_interrupt(self):
        """The finished results are complete, and the same command continues to the same result."""
        first, _, _ = self.start_held("first", 3)
        os.killpg(first.pid, signal.SIGINT)
        self.assertEqual(first.wait(), 2)
        self.assertIn("the same command goes on from there", self.text("first.log"))
        left = {file: file.stat().st_mtime_ns for file in self.finished()}
        self.assertEqual(len(left), 2)
        for file in left:
            self.assertIsInstance(json.loads(file.read_text()), dict)
        self.run_study("second")
        self.assertGreater(len(self.finished()), len(left))
        self.assertEqual({file: file.stat().st_mtime_ns for file in left}, left)
        self.assertNotIn("failed", self.text("second.txt"))
        self.assertEqual(json.loads(self.text("second.json"))["failed_runs"]["count"], 0)
        shutil.rmtree(self.folder / "points")
        self.run_study("third")
        second, third = (json.loads(self.text(f"{name}.json"))["series"]["paper"]["order"] for name in ("second", "third"))
        self.assertEqual(second, third)

    @ON_LINUX
    def test_a_killed_worker_is_named_and_the_others_are_judged(self):
        """The study names any killed worker in its text and its result, and exits with 1. Unknown numbers are null with
        a reason, not zero."""
        self.write('cells = [32, 48]\nquantities = ["twist_error"]\n')
        # The workers of the larger mesh first: the solve itself, the tightened one; then the smaller mesh.
        for before in range(6):
            with self.subTest(before=before):
                shutil.rmtree(self.folder / "points", ignore_errors=True)
                study, _, worker = self.start_held("killed", before + 1)
                os.kill(worker, signal.SIGKILL)
                self.assertEqual(study.wait(), 1, self.text("killed.log"))
                result = json.loads(self.text("killed.json"))
                self.assertEqual(result["failed_runs"]["count"], 1)
                self.assertIn("killed by signal 9", result["failed_runs"]["first"]["message"])
                self.assertIn(" runs failed; the first (paper, grid.cells=", self.text("killed.txt"))
                for file in ("killed.txt", "killed.log"):
                    self.assertIn("killed by signal 9", self.text(file))
                series = result["series"]["paper"]
                self.assertIn("1 of 6 runs failed", series["order"]["twist_error"]["why"])
                for row in series["rows"]:
                    self.assertTrue(row["twist_error"] is not None or (row["status"] == "failed" and row["twist_error_reason"]))
                noises = [mesh["twist_error"] for mesh in series["meshes"]]
                self.assertIn(None, [at["noise"] for at in noises])
                for at in noises:
                    self.assertTrue(at["noise_reason"] if at["noise"] is None else at["noise"] > 0)

    @ON_LINUX
    def test_workers_end_with_their_parent(self):
        """No worker continues after the end of its parent, and none has finished."""
        self.write('cells = [256, 288]\nset = { "solver.operator" = "direct" }\n')  # minutes each
        for number in (signal.SIGKILL, signal.SIGHUP, signal.SIGTERM, signal.SIGINT):
            with self.subTest(number):
                study = self.start("parent", jobs=2)
                self.assertTrue(comes_true(lambda: len(self.processes()) == 3), self.text("parent.log"))
                study.send_signal(number)
                study.wait()
                self.assertTrue(comes_true(lambda: not self.processes()))
                self.assertEqual(self.finished(), [])
                shutil.rmtree(self.folder / "points", ignore_errors=True)

    def test_an_ignored_hang_up_stays_ignored(self):
        """nohup: what is ignored when the study starts stays so."""
        before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
        study, hold, _ = self.start_held("nohup", 2, restore_signals=False)
        signal.signal(signal.SIGHUP, before)
        os.killpg(study.pid, signal.SIGHUP)
        hold.release()
        self.assertEqual(study.wait(), 0, self.text("nohup.log"))

    def test_several_at_once_share_a_folder(self):
        """Each finds what the others have kept, however slow the removal of files is, and all have the same result."""
        self.write('cells = [12, 16, 20, 24]\nquantities = ["twist_error"]\n')
        environment = Hold(self.folder, "", 0).environment | {"HOLD_REMOVALS": "yes"}
        for again in range(4):
            with self.subTest(again):
                shutil.rmtree(self.folder / "points", ignore_errors=True)
                studies = [self.start(f"one-of-four-{k}", 1, environment) for k in range(4)]
                self.assertEqual([study.wait() for study in studies], [0] * 4, self.text("one-of-four-0.log"))
                orders = [json.loads(self.text(f"one-of-four-{k}.json"))["series"]["paper"]["order"] for k in range(4)]
                self.assertEqual(orders, orders[:1] * 4)

    def test_bad_input_is_exit_code_2(self):
        self.write('cells = [16, "32"]\n')
        self.run_study("bad", 2)
        self.assertIn("study.toml:2: cells[1]", self.text("bad.log"))
        for key, values in (("load.momnt_ratio", "[0.5]"), ("load.moment_ratio", "[0.5, 1.5]")):  # no --set gave them
            self.write(f'cells = [16, 32]\n[[vary]]\nkey = "{key}"\nvalues = {values}\n')
            self.run_study("varied", 2)
            self.assertIn(f"study.toml: {key} = ", self.text("varied.log"))
            self.assertNotIn("--set", self.text("varied.log"))
        self.write("cells = [16, 32]\n", "nowhere.toml")
        self.run_study("missing", 2)
        self.assertIn("nowhere.toml", self.text("missing.log"))
