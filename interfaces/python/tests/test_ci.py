"""slipstick.ci: lines of a history, badges, files for trackers, and the figure; slipstick.verdict_files."""
import json
import os
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path
from unittest import mock

from slipstick import ci, verdict_files
from slipstick.errors import InputError


def gate(name, value=1.0, outcome="passed", **bound):
    bound = bound or {"below": 2.0}
    return {"id": name, "file": "g.toml", "line": 1, "outcome": outcome, "quantity": "twist_error", "value": value,
            "factor": abs(value) / 2 if isinstance(value, float) else None, "basis": "b", "reason": "", "rerun": "", "why": "", **bound}


def result(*gates, exit_code=0):
    return {"exit_code": exit_code, "counts": {}, "gates": list(gates)}


TIMES = json.dumps({"context": {}, "benchmarks": [{"name": "solve", "real_time": t, "cpu_time": t, "time_unit": "ms"} for t in (3, 1, 2)]})


class CiTest(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder)
        Path("times.json").write_text(TIMES)

    def answer(self, gates, *options, times=""):
        files = {option: option[2:] for option in options}
        return ci.answer({"files": files, "times": times, "result": gates})["texts"]

    def test_a_line_has_commit_values_and_bounds(self):
        with mock.patch.dict(os.environ, {"GITHUB_SHA": "abc"}):
            text = self.answer(result(gate("a"), gate("w", "asymptotic", equals="asymptotic")), "--history", times="times.json")
        self.assertEqual(text["--history"].count("\n"), 1)
        run = json.loads(text["--history"])
        self.assertEqual((run["commit"], run["modified"], run["exit_code"]), ("abc", False, 0))
        self.assertRegex(run["date"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertEqual(run["gates"][0], {"id": "a", "quantity": "twist_error", "value": 1.0, "below": 2.0, "factor": 0.5,
                                           "outcome": "passed"})
        time, = run["times"]
        self.assertEqual((time["name"], time["repetitions"]), ("solve", 3))
        self.assertAlmostEqual(time["seconds"], 2e-3)

    def test_the_commit_is_that_of_the_working_folder(self):
        with mock.patch.dict(os.environ, {"GITHUB_SHA": "", "CI_COMMIT_SHA": ""}):
            self.assertEqual(ci.run_of(result(), "")["commit"], None)
        git = ("git", "-c", "user.name=a", "-c", "user.email=b")
        for words in (("init", "-q"), ("add", "times.json"), ("commit", "-qm", "one")):
            subprocess.run((*git, *words), check=True)
        head = subprocess.run(("git", "rev-parse", "HEAD"), capture_output=True, text=True, check=True).stdout.strip()
        for modified in (False, True):
            with mock.patch.dict(os.environ, {"GITHUB_SHA": "abc"}):
                run = ci.run_of(result(), "")
            self.assertEqual((run["commit"], run["modified"]), (head, modified))
            Path("times.json").write_text(TIMES + " ")

    def test_a_badge_says_the_worst(self):
        failed, refused = gate("f", outcome="failed"), gate("r", outcome="refused")
        for gates, message, color in (([gate("a"), gate("b")], "2 gates", "brightgreen"),
                                      ([gate("a"), failed, refused], "1 of 3 gates failed", "red"),
                                      ([gate("a"), refused], "1 of 2 gates not judged", "yellow"), ([], "0 gates", "yellow")):
            badge = json.loads(self.answer(result(*gates), "--badge")["--badge"])
            self.assertEqual(badge, {"schemaVersion": 1, "label": "slipstick", "message": message, "color": color})

    def test_trackers_get_numbers_in_which_smaller_is_better(self):
        gates = result(gate("a", -1.0), gate("w", "asymptotic", equals="asymptotic"), gate("none", None, "failed"))
        texts = self.answer(gates, "--benchmark-action", "--bencher", times="times.json")
        rows = {row["name"]: row for row in json.loads(texts["--benchmark-action"])}
        self.assertEqual(rows.keys(), {"a", "solve"})
        self.assertEqual((rows["a"]["unit"], rows["a"]["value"]), ("times the bound", 0.5))
        self.assertEqual((rows["solve"]["unit"], rows["solve"]["range"]), ("s", "0.001 to 0.003"))
        metrics = json.loads(texts["--bencher"])
        self.assertEqual(metrics["a"], {"value": {"value": -1.0}, "times-the-bound": {"value": 0.5}})
        for key, value in (("value", 2e6), ("lower_value", 1e6), ("upper_value", 3e6)):
            self.assertAlmostEqual(metrics["solve"]["latency"][key], value, delta=1e-6)

    def test_the_figure_shows_values_bounds_and_failures(self):
        for value, outcome in ((1.0, "passed"), (3.0, "failed"), (-1.5, "passed")):
            texts = self.answer(result(gate("a <$b$>", value, outcome), gate("order", 1.1, above=0.9, below=1.2)), "--history", "--figure",
                                times="times.json")
            with open("history", "a") as history:
                history.write(texts["--history"])
        drawn = xml.etree.ElementTree.fromstring(texts["--figure"])
        self.assertTrue(drawn.tag.endswith("svg"))
        panels = [part for part in drawn.iter() if part.get("id", "").startswith("axes_")]
        self.assertEqual(len(panels), 3)
        for panel, lines in zip(panels, (5, 4, 3)):  # values, failures, bounds that the gate has, two axes
            self.assertGreaterEqual(sum(part.get("id", "").startswith("line2d_") for part in panel.iter()), lines)
        self.assertEqual(texts["--figure"], ci.figure(ci.read_history("history")))  # the same input, the same bits

    def test_what_is_no_history_is_refused_with_its_line(self):
        Path("history").write_text('{"gates": [], "times": []}\nhello\n')
        with self.assertRaisesRegex(InputError, "history:2: is no run"):
            self.answer(result(), "--history")


class VerdictFilesTest(unittest.TestCase):
    def test_what_a_stranger_wrote_stays_text(self):
        """No image, link, mention, sequence of a terminal or turned direction, and XML that can be read."""
        wild = ("![x](http://a.b/c) <javascript:z> @user #12 www.a.b &#64;user `code` **b** \x1b[31m \u009b31m \u202etxet \u2066 \u2028 "
                "\u061c \ud800 \uffff ]]> \"q\" a | b\nc")
        markdown = verdict_files.markdown_table("", ["a"], [[verdict_files.markdown_text(wild)]], "rows")
        for markup in ("[x](", "http://", "@user", "#12", "www.", "&#64;", " <", " `code", " **"):
            self.assertNotIn(markup, markdown)
        self.assertEqual(markdown.count("\n"), 3)
        case = {"name": wild, "verdict": "failure", "type": wild, "message": wild, "details": wild, "shown": wild}
        text = verdict_files.junit("slipstick compare", wild, [case])
        for report in (markdown, text):
            for steers in "\x1b\u009b\u202e\u2066\u2028\u061c":
                self.assertNotIn(steers, report)
            self.assertIn("u202etxet", report)
        read, = xml.etree.ElementTree.fromstring(text.encode()).iter("testcase")
        self.assertIn("a | b\nc", read.get("name"))
        self.assertEqual(read.find("failure").text, read.get("name"))
