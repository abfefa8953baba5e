#!/usr/bin/env python3
"""program_memory_test.py PROGRAM: what a solve will take is known before it is taken: --plan, --memory-limit and the
process itself agree."""

import resource
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))
from program_run import PROGRAM, SCENES, ProgramTest, main

PAPER = str(SCENES / "paper.toml")
SMALL = ("solve", PAPER, "--set", "grid.cells=[16,16]")


def no_more_than(size):
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size))


class Memory(ProgramTest):
    def setUp(self):
        super().setUp()
        self.sanitized = "-fsanitize" in self.result(*SMALL)["provenance"]["flags"]  # takes memory of its own

    def test_predicted_is_an_upper_bound_of_what_is_taken_and_not_much_more(self):
        if self.sanitized:
            self.skipTest("sanitized")
        for scene, *words in (("paper", "--set", "grid.cells=[320,320]"),
                              ("paper", "--set", "grid.cells=[256,256]", "--model", "full"),
                              ("paper", "--set", "grid.cells=[36,36]", "--set", "solver.operator=dense", "--model", "full"),
                              ("torsion_and_force", "--set", "grid.cells=[160,160]"),
                              ("dissimilar", "--set", "grid.cells=[128,128]", "--set", "contact.coupling=full")):
            result = self.result("solve", str(SCENES / f"{scene}.toml"), *words, "--set", "solver.tolerance=1e-3")
            self.assertGreaterEqual(result["predicted_bytes"], result["peak_bytes"], (scene, words))
            self.assertLessEqual(result["predicted_bytes"], 1.7 * result["peak_bytes"], (scene, words))

    def test_limit_is_what_a_plan_may_need(self):
        planned = self.result(*SMALL, "--plan")["plan"]["bytes"]
        for limit, code, *says in ((f"{planned + 2:.0f}", 0), ("1GiB", 0), ("some", 2), ("-1", 2, "--memory-limit"),
                                   (f"{planned - 2:.0f}", 2, "paper.toml", "grid.cells = [16, 16]", "--memory-limit",
                                    "fewer cells")):
            self.run_program(*SMALL, "--quiet", "--memory-limit", limit, code=code, says=says)

    def test_is_not_taken_by_what_is_refused(self):
        """One field of this grid takes 7 GB. What may be taken at all is a tenth of that."""
        if self.sanitized:
            self.skipTest("sanitized")
        end = subprocess.run([PROGRAM, "solve", PAPER, "--set", "grid.cells=[30000,30000]", "--memory-limit", "1GiB"],
                             stderr=subprocess.PIPE, preexec_fn=no_more_than(700000 << 10))
        self.assertEqual(end.returncode, 2)
        for part in ("grid.cells = [30000, 30000]", "1 GiB are allowed"):
            self.assertIn(part, end.stderr.decode())

    def test_limit_holds_for_commands_of_many_solves_and_refusals_are_not_kept(self):
        scene = f'scene = "{PAPER}"\n'
        self.write("study.toml", scene + "cells = [8, 12]\n")
        self.write("gates.toml", f'[[gate]]\nid = "a"\n{scene}quantity = "twist_error"\nbelow = 1.0\nbasis = "b"\n')
        for words in (("study", "study.toml"), ("gate", "gates.toml")):
            self.run_program(*words, "--output", "runs", "--memory-limit", "1MB", code=2,
                             says=("paper.toml", "--memory-limit"))
            self.run_program(*words, "--output", "runs")


if __name__ == "__main__":
    main()
