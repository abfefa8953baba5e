"""work_counts_test.py PROGRAM: counts of work that are known beforehand, and the reader of callgrind's files."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import count_work

PROGRAM = sys.argv.pop(1)
CELLS = 64
# Rows go through in pairs; of the columns of a real field's spectrum one more than half are distinct, the padded field's
# 2 x 64. Each is transformed in two halves of 64 points.
TRANSFORMS_OF_A_FIELD = 2 * (CELLS // 2 + CELLS + 1)
# A call's line has the inclusive cost, which is repeated at the lines of the callee.
CALLGRIND = """# callgrind format
version: 1
events: Ir
summary: 1111

ob=(1) /somewhere/program
fl=(1) ???
fn=(1) main
10 100
+2 1
cob=(2) /lib/libm.so.6
cfi=(2) ???
cfn=(2) exp
calls=7 0
* 1000
ob=(2)
fl=(2)
fn=(2)
0 1000

ob=(1)
fn=(3) other
-3 10
"""


def counts(*cases):
    return json.loads(subprocess.run([PROGRAM, "--only", *cases], stdout=subprocess.PIPE, check=True).stdout)["counts"]


class WorkCountsTest(unittest.TestCase):
    def test_one_application_transforms_two_fields_there_and_back(self):
        found = counts("application-64")["application-64"]
        self.assertEqual(found["transforms"], 2 * 2 * TRANSFORMS_OF_A_FIELD)
        self.assertEqual(found["transformed_points"], CELLS * found["transforms"])
        self.assertEqual((found["allocations"], found["plans"], found["kernel_evaluations"]), (0, 0, 0))

    def test_set_up_integrates_one_side_of_the_diagonal(self):
        found = counts("setup-64")["setup-64"]
        rows_at_a_time = 8  # which begin where the first of them meets the diagonal
        self.assertEqual(found["kernel_evaluations"],
                         sum(CELLS - row // rows_at_a_time * rows_at_a_time for row in range(CELLS)))
        self.assertEqual(found["transforms"], 3 * TRANSFORMS_OF_A_FIELD)  # K11, K12, K22
        self.assertGreaterEqual(found["allocated_bytes"], 3 * CELLS * CELLS * 8)

    def test_are_the_same_again_and_after_others(self):
        both = counts("dense-16", "ellipse-64", "direct-16")
        for case in ("dense-16", "ellipse-64"):
            self.assertEqual(counts(case)[case], both[case])
        self.assertEqual(counts("dense-16", "ellipse-64", "direct-16"), both)

    def test_summation_transforms_nothing_but_its_preconditioner(self):
        direct, dense = counts("direct-16", "dense-16").values()
        self.assertEqual(direct["applications"], dense["applications"])
        self.assertEqual(direct["transforms"], dense["transforms"])
        self.assertGreater(direct["applications"], 1)


class CallgrindTest(unittest.TestCase):
    def read(self, text):
        with tempfile.NamedTemporaryFile("w") as file:
            file.write(text)
            file.flush()
            return count_work.read_callgrind(file.name)

    def test_is_read_by_object(self):
        self.assertEqual(self.read(CALLGRIND + "totals: 1111\n"), {"program": 111, "libm.so.6": 1000})

    def test_refuses_what_does_not_add_up(self):
        for text in (CALLGRIND + "totals: 1112\n", CALLGRIND, "", "events: Ir\ntotals: 0\n"):
            with self.assertRaisesRegex(ValueError, "not what callgrind writes"):
                self.read(text)
