"""board_test.py: the board merges simulators, solvers and finite-element programs, names changes, and the published page is its own."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
DOCS = SOURCE.parents[1] / "docs"
sys.path.insert(0, str(SOURCE))
import board  # noqa: E402


def field(name, error, number="twist_angle", status="converged"):
    return {"name": name, "cells": 32, "status": status, "version": f"{name} 1.0", "message": "FILE: no torsion", "number": number,
            "cpu_seconds": 0.5, "error": error}


def case(verdict):
    return {"kind": "case", "on": "memory", "program": "P", "version": "1", "variant": "own", "verdict": verdict, "measure": "deviation",
            "number": 0.4, "shown": "40 %", "cause": None if verdict == "green" else "elastic", "why": "memory: no slip",
            "missed": 0.0, "cpu_seconds": 1.5}


def stress(name, error, cells=32):
    return {"program": name, "version": "1", "cells": cells, "moment_ratio": 0.5, "cpu_seconds": 0.5, "verdict": "bad", "why": "s33 is off",
            "errors": {"s11": 0.001, "s33": error}}


class Board(unittest.TestCase):
    def made(self, folder, verdict, programs):
        (folder / "loops.json").write_text(json.dumps({"rows": [case(verdict)]}))
        (folder / "fields.json").write_text(json.dumps({"pages": [{"scene": {"name": "s"}, "programs": programs}]}))
        (folder / "peers.txt").write_text("model name : M\nLEFT OUT: Q, since there is no q\n")
        subprocess.run([sys.executable, "-B", SOURCE / "board.py", folder, folder / "docs"], check=True)
        return (folder / "board.md").read_text(), json.loads((folder / "board.json").read_text())

    def test_merges_and_names_changes(self):
        programs = [field("slipstick", 0.03), field("same", 0.03), field("worse", 0.04), field("right", 0.001),
                    field("without", None, status="refused")]
        with tempfile.TemporaryDirectory() as folder:
            text, result = self.made(Path(folder), "green", programs)
            found = {row["program"]: (row["verdict"], row["cause"]) for row in result["rows"]}
            self.assertEqual(found, {"P": ("green", None), "slipstick": ("amber", "mesh"), "same": ("amber", "mesh"),
                                     "right": ("green", None), "worse": ("amber", "unknown"), "without": ("none", "refused")})
            self.assertIn("There is no earlier run.", text)
            self.assertIn("- Q, since there is no q", text)
            self.assertIn("| same 1.0, 32 cells | A 3 % | 0.5 |", text)
            text, result = self.made(Path(folder), "red", programs)
            self.assertEqual([(each["before"], each["now"]) for each in result["changes"]["verdicts"]], [("green", "red")])
            self.assertIn("- P, own, `memory`: red, before green.", text)
            self.assertEqual(result["changes"]["new"], 0)

    def test_stresses_are_judged_by_their_worst_component(self):
        rows = list(board.of_stresses([stress("slipstick", 0.025), stress("same", 0.0251), stress("off", 0.4), stress("none", float("nan")),
                                       stress("slipstick", 0.004, 64), stress("same", 0.02, 64)]))
        self.assertEqual([(row["verdict"], row["cause"]) for row in rows], [
            ("amber", "mesh"), ("amber", "mesh"), ("red", "unknown"), ("red", "unknown"), ("green", None), ("amber", "unknown")])

    def test_seconds_of_a_mesh_are_shared_by_its_answers(self):
        given = [{"program": "K 1", "faces": 4, "moment_ratio": ratio, "cpu_seconds": seconds, "check": {"verdict": "bad", "why": "", "judged": []}}
                 for ratio, seconds in ((0.5, 100.0), (0.9, None))]
        self.assertEqual([row["cpu_seconds"] for row in board.of_meshes(given)], [100.0, None])

    def test_no_number_is_red(self):
        self.assertEqual([board.color(error) for error in (0.01, 0.05, 0.0501, float("nan"))], ["green", "amber", "red", "red"])

    def test_published_page_and_guide_follow_from_the_json(self):
        result = json.loads((DOCS / "board.json").read_text())
        self.assertEqual((DOCS / "board.md").read_text(), board.page(result))
        table = board.grid([row for row in result["rows"] if row["kind"] == "case"], numbers=False)
        self.assertEqual(board.MARKS.search((DOCS / "guides/test-your-simulator.md").read_text()).group(), table)


if __name__ == "__main__":
    unittest.main()
