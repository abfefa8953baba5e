#!/usr/bin/env python3
"""memory_test.py PROGRAM: the predicted memory of a solve against the memory that it used. The constants of the
prediction, in doubles a cell, are in solver/elasticity/elasticity.cpp and solver/model/memory_plan.cpp;
memory_test.py PROGRAM --measure prints measured ones."""

import itertools
import os
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))
from program_run import PROGRAM, SCENES, ProgramTest

# Sanitizers use extra memory.
SANITIZED = any(name in Path(PROGRAM).read_bytes() for name in (b"__asan_init", b"__tsan_init"))
MOST = 1.3  # largest ratio of the prediction to the memory used
FULL = "solver.model=full"
# Scenes that solve different parts of the grid, with other methods, histories and full coupling.
CASES = [("paper", 288), ("paper", 288, FULL), ("paper", 288, "contact.pressure=hertz"),
         ("paper", 160, FULL, "solver.method=paper"), ("paper", 288, "solver.method=paper"),
         ("paper", 288, FULL, "solver.threads=4"),
         ("paper", 288, FULL, "contact.friction=0", "load.moment_ratio=0"),
         ("rough_sphere", 512, "contact.friction=0", "load.moment_ratio=0"),
         ("paper", 24, FULL, "solver.operator=dense"), ("paper", 36, FULL, "solver.operator=dense"),
         ("paper", 48, FULL, "solver.operator=direct"), ("ellipse", 288), ("turned_ellipse", 288),
         ("torsion_and_force", 160), ("torsion_and_force", 288), ("fretting_torsion", 288), ("dissimilar", 288),
         ("dissimilar", 128, "contact.coupling=full"), ("off_centre", 200), ("patches", 288)]
# Contacts whose size is known only after the solve.
SPARSE = [("rough_sphere", 512, FULL), ("rough_sphere", 1024, FULL, "contact.friction=0", "load.moment_ratio=0")]


def words(scene, cells, *settings):
    assignments = [f"grid.cells=[{cells},{cells}]", "solver.tolerance=1e-3", *settings]
    return [str(SCENES / f"{scene}.toml"), *itertools.chain(*(("--set", each) for each in assignments))]


class Memory(ProgramTest):
    def taken(self, *case):
        """Includes the HDF5 library, which is loaded only for such a file and which the prediction counts."""
        result = self.result("solve", *words(*case), "--fields", "fields.h5")
        return result["predicted_bytes"], result["peak_bytes"]

    @unittest.skipIf(SANITIZED, "sanitizers take memory of their own")
    def test_predicted_is_an_upper_bound_and_not_much_more(self):
        for case in CASES + SPARSE:
            predicted, taken = self.taken(*case)
            self.assertGreaterEqual(predicted, taken, case)
            self.assertLessEqual(predicted, MOST * taken, case)

    @unittest.skipIf(SANITIZED, "sanitizers take memory of their own")
    def test_a_padded_cell_takes_ten_numbers_and_a_quadrant_a_third_of_that(self):
        def doubles(*settings):  # memory comes in pages of up to 2 MiB: fewer cells would measure these
            few, many = (self.taken("paper", cells, *settings)[1] for cells in (512, 1024))
            return (many - few) / (8 * 4 * (1024**2 - 512**2))

        self.assertLessEqual(doubles(FULL), 10)
        self.assertLessEqual(doubles(), 0.45 * doubles(FULL))

    @unittest.skipIf(SANITIZED, "sanitizers take memory of their own")
    def test_the_memory_of_the_program_that_starts_it_does_not_count(self):
        held = b"x" * (256 << 20)
        self.assertLess(self.taken("paper", 16)[1], len(held) / 4)

    @unittest.skipIf(SANITIZED, "sanitizers take memory of their own")
    def test_stresses_take_at_most_what_is_predicted(self):
        """The HDF5 library is counted."""
        for cells in ([128, 128], [256, 256], [420, 300]):
            for options in ((), ("--dang-van", "0.3", "--findley", "0.2")):
                solve = ["solve", *words("fretting_torsion", 8, f"grid.cells={cells}"), "--stresses", "{depth}.h5", "--depths", "50um,0.1mm",
                         *options]
                plan = self.result(*solve, "--plan")["plan"]
                started = subprocess.Popen([PROGRAM, *solve, "--quiet"], stdout=subprocess.DEVNULL)
                _, status, usage = os.wait4(started.pid, 0)
                started.returncode = os.waitstatus_to_exitcode(status)
                self.assertEqual(started.returncode, 0)
                self.assertLessEqual(plan["stresses"]["bytes"], plan["bytes"])
                self.assertGreaterEqual(plan["bytes"], 1024 * usage.ru_maxrss, solve)
                self.assertLessEqual(plan["bytes"], MOST * 1024 * usage.ru_maxrss, solve)
                self.run_program(*solve, "--memory-limit", f"{plan['stresses']['bytes'] - 2:.0f}", code=2, says="grid.cells")

    def test_limit_is_what_a_plan_may_need(self):
        solve = ["solve", *words("paper", 16)]
        plan = self.result(*solve, "--plan")["plan"]
        for limit in (f"{plan['bytes'] + 2:.0f}", "1GiB"):
            self.run_program(*solve, "--memory-limit", limit)
        self.run_program(*solve, "--memory-limit", f"{plan['least_bytes'] - 2:.0f}", code=2,
                         says=["paper.toml", "grid.cells = [16, 16]", "--memory-limit", "fewer cells"])
        self.run_program(*solve, "--memory-limit", "some", code=2)

    def test_a_sparse_contact_is_refused_by_what_it_fills_once_that_is_known(self):
        for case in SPARSE:
            solve = ["solve", *words(*case)]
            plan = self.result(*solve, "--plan")["plan"]
            needed = self.result(*solve)["predicted_bytes"]
            self.assertLess(plan["least_bytes"], needed, case)
            self.assertLess(needed, 0.8 * plan["bytes"], case)
            self.run_program(*solve, "--memory-limit", f"{needed + 2:.0f}")
            self.run_program(*solve, "--memory-limit", f"{needed - 2:.0f}", code=2,
                             says=["rough_sphere.toml", f"grid.cells = [{case[1]}, {case[1]}]", "this needs", "--memory-limit"])

    def test_a_table_that_does_not_fit_is_named(self):
        Path("heights.csv").touch()
        os.truncate("heights.csv", 512 << 20)  # takes no room on the disk
        text = (SCENES / "paper.toml").read_text().replace('shape = "sphere"\nradius = 0.018 ',
                                                           'shape = "height_map"\nfile = "heights.csv"\nspacing = [1e-5, 1e-5] ')
        self.write("map.toml", text.replace("[grid]\ncells = [128, 128]", ""))
        self.run_program("solve", "map.toml", "--memory-limit", "100MB", code=2, says=["heights.csv", "512 MiB", "95.4 MiB"])

    @unittest.skipIf(SANITIZED, "sanitizers take memory of their own")
    def test_what_is_refused_is_not_taken(self):
        # One field of this grid takes 7 GB; the limit is a tenth of that.
        end = subprocess.run(["sh", "-c", 'ulimit -v 700000; exec "$@"', "sh", PROGRAM, "solve", *words("paper", 30000),
                              "--memory-limit", "1GiB"], capture_output=True, text=True)
        self.assertEqual(end.returncode, 2, end.stderr)
        for part in ("grid.cells = [30000, 30000]", "1 GiB are allowed"):
            self.assertIn(part, end.stderr)

    def test_limit_holds_for_commands_of_many_solves(self):
        scene = f'scene = "{SCENES / "paper.toml"}"\n'
        study = self.write("study.toml", scene + "cells = [8, 12]\n")
        gate = f'[[gate]]\nid = "a"\n{scene}quantity = "twist_error"\nbelow = 1.0\nbasis = "b"\n'
        gates = self.write("gates.toml", gate + "set = { 'grid.cells' = [16, 16] }\n")
        for command in (["study", study], ["gate", gates]):
            self.run_program(*command, "--output", "runs", "--memory-limit", "1MB", code=2,
                             says=["paper.toml", "--memory-limit"])
        # Refusals are not kept: with more memory the same scene has an answer.
        self.run_program("gate", gates, "--output", "runs", "--memory-limit", "1GB")


def measure():
    for case in CASES + SPARSE:
        test = Memory()
        predicted, taken = test.taken(*case)
        _, least = test.taken(case[0], 16, *case[2:])
        cell = 8 * 4 * case[1]**2
        print(f"{(taken - least) / cell:6.2f} doubles a padded cell of the whole grid, {predicted / taken:.2f} of them "
              f"and the program predicted: {' '.join(map(str, case))}", flush=True)


if __name__ == "__main__":
    measure()
