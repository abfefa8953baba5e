"""gates_test.py PROGRAM: outcomes of gates on made results, what their files may say, and the reports."""

import json
import os
import xml.etree.ElementTree
from pathlib import Path

from program_run import PROGRAM, SCENES, ProgramTest

PAPER = SCENES / "paper.toml"
MARKUP = ("![x](http://a.b/c) [y](javascript:z) <javascript:z> @user #12 www.a.b https://a.b &#64;user `code` **b** \x1b[31m "
          "\u009b31m \u202etxet\u2066 \u2028 \u061c")


def toml(keys):
    return "\n".join(f"{key} = {json.dumps(value)}" for key, value in keys.items()) + "\n"


def gate(quantity, head="gate", **keys):
    """A gate as TOML, on work.json unless it has another source; id: its quantity. A key that is None is left out."""
    keys = {"id": quantity, "quantity": quantity, "basis": "measured 1e-6", **keys}
    if not keys.keys() & {"result", "scene", "study", "source"}:
        keys["result"] = "work.json"
    return f"[[{head}]]\n" + toml({key: value for key, value in keys.items() if value is not None})


class MadeGates(ProgramTest):
    def judged(self, result, gates, *words, code):
        """The rows of gates, by id, on a made result; and the output."""
        Path("work.json").write_text(json.dumps(result))
        Path("gates.toml").write_text(gates)
        text = self.run_program("gate", "gates.toml", "--output", "points", "--json", "gates.json", *words, code=code)
        rows = json.loads(Path("gates.json").read_text())["gates"] if Path("gates.json").exists() else []
        return {row["id"]: row for row in rows}, text

    def assert_outcomes(self, result, *cases, **keys):
        """Cases: value, bounds, outcome, and perhaps words in the reason; keys: of all gates."""
        values = {f"v{i}": value for i, (value, *_) in enumerate(cases)}
        gates = "".join(gate(f"v{i}", **bounds, **keys) for i, (_, bounds, *_) in enumerate(cases))
        rows, _ = self.judged(result | values, gates, code=(0, 1, 2))
        for (name, row), (value, bounds, outcome, *says) in zip(rows.items(), cases):
            self.assertEqual(row["outcome"], outcome, (value, bounds, row["why"]))
            for words in says:
                self.assertIn(words, row["why"])
        return list(rows.values())


class Outcomes(MadeGates):
    def test_of_bounds(self):
        """below bounds the size, above and both the signed value; equals takes words and counts. The factor says how far from the
        bound."""
        below, both, negative, above = {"below": 2e-5}, {"above": 1, "below": 2}, {"above": -3e-3, "below": -1e-3}, {"above": 3}
        word, count = {"equals": "asymptotic"}, {"equals": 8}
        held = ((1.9e-5, below), (-1.9e-5, below), (1.5, both), (-2e-3, negative), (4, above), ("asymptotic", word), (8, count))
        broken = ((2e-5, below), (2.1e-5, below), (-2.1e-5, below), (0.9, both), (1, both), (2, both), (2.1, both), (-1.5, both),
                  (2e-3, negative), (0, negative), (3, above), (2, above), (-4, above), ("preasymptotic", word), (1, word),
                  (9, count), ("8", count))
        self.assert_outcomes({}, *((*case, "passed") for case in held), *((*case, "failed") for case in broken))
        rows = self.assert_outcomes({}, (-3, {"below": 2}, "failed"), (0.5, both, "failed"), (1.5, both, "passed"),
                                    (2, above, "failed"), (None, {"below": 2}, "failed"))
        self.assertEqual([row["factor"] for row in rows], [1.5, 2, 0, 1.5, None])

    def test_of_missing_numbers(self):
        """They fail with the reason that the result gives, or with the nearest name. A misspelt number is no expected failure."""
        result = {"twist_error": None, "twist_error_reason": "not axisymmetric", "traction": None,
                  "traction_reason": "no exact tractions", "moment": 1}
        rows, _ = self.judged(result, gate("twist_error", below=1) + gate("twist_error", id="word", equals="asymptotic")
                              + gate("traction.averaged.l2", below=1) + gate("momnt", below=1)
                              + gate("momnt", id="expected", below=1, status="expected_failure"), code=1)
        for name, words in (("twist_error", "not axisymmetric"), ("word", "not axisymmetric"),
                            ("traction.averaged.l2", "no exact tractions"), ("momnt", "the nearest is moment"), ("expected", "")):
            self.assertEqual(rows[name]["outcome"], "failed")
            self.assertIn(words, rows[name]["why"])

    def test_of_a_solve_that_did_not_converge(self):
        """Its numbers fail, whatever they are."""
        keys = {"scene": str(PAPER)}
        sets = 'set = {"grid.cells" = [16, 16], "solver.max_iterations" = 1}\n'
        rows, _ = self.judged({}, gate("twist_error", below=1e3, **keys) + sets
                              + gate("status", equals="not_converged", **keys) + sets, code=1)
        self.assertEqual([row["outcome"] for row in rows.values()], ["failed", "passed"])
        self.assertIn("did not reach its tolerance: ", rows["twist_error"]["why"])

    def test_of_gates_that_are_narrower_than_ten_times_reference_and_spread(self):
        """The reference counts for errors only, and where a result file states it; the nearest one counts."""
        small = {"below": 0.9e-6}
        result = {"exact": {"relative_uncertainty": 3e-8}, "x_error": 1e-9, "gap": 1e-9,
                  "unknown": {"reference_uncertainty": None, "y_error": 1e-9},
                  "steps": [{"exact": {"relative_uncertainty": 1e-9}, "x_error": 1e-9}],
                  "series": {"nu-0.3": {"reference_uncertainty": 2e-7, "order": {"x_error": {"value": 1e-9}}}}}
        cases = (("x_error", small, 5e-8, "passed"), ("x_error", small, 7e-8, "refused"), ("gap", {"below": 1e-7}, 0, "passed"),
                 ("x_error", {"above": 1e-10, "below": 0.9e-6}, 2e-8, "refused"),  # half as wide as below alone
                 ("x_error", {"above": -0.9e-6, "below": 0.9e-6}, 2e-8, "passed"), ("x_error", {"below": 1e-7}, 0, "refused"),
                 ("steps[0].x_error", {"below": 1.1e-8}, 0, "passed"), ("steps[0].x_error", {"below": 0.9e-8}, 0, "refused"),
                 ("series.nu-0.3.order.x_error.value", {"below": 2.1e-6}, 0, "passed"),
                 ("series.nu-0.3.order.x_error.value", {"below": 1.9e-6}, 0, "refused"), ("unknown.y_error", small, 0, "passed"))
        rows, _ = self.judged(result, "".join(gate(quantity, id=str(i), platform_spread=spread, **bounds)
                                              for i, (quantity, bounds, spread, _) in enumerate(cases)), code=2)
        for row, (*case, outcome) in zip(rows.values(), cases):
            self.assertEqual(row["outcome"], outcome, case)
        self.assertRegex(rows["1"]["why"], "9e-07.*1e-06")

    def test_of_expected_failures(self):
        """They must fail."""
        self.assert_outcomes({}, (2, {"below": 1}, "failed as expected"), (0.5, {"below": 1}, "passed unexpectedly", "remove"),
                             status="expected_failure")

    def test_of_studies_whose_runs_died(self):
        """They fail a gate of any status."""
        died = {"count": 1, "of": 35, "first": {"run": "paper", "message": "memory ran out"}}
        for status in ("active", "expected_failure", "report_only"):
            rows = self.assert_outcomes({"failed_runs": died}, (0.5, {"below": 1}, "failed", "1 of 35", "paper", "memory ran out"),
                                        status=status)
            self.assertEqual(rows[0]["value"], 0.5)
        self.assert_outcomes({"failed_runs": died | {"count": 0}}, (0.5, {"below": 1}, "passed"))


class PublishedNumbers(MadeGates):
    def compared(self, *cases):
        """Cases: keys of the gate, our number, its relative error (None: 1e-14), outcome."""
        result = {f"v{i}": {"ours": ours, "relative_uncertainty": error or 1e-14} for i, (_, ours, error, _) in enumerate(cases)}
        rows, text = self.judged(result, "".join(
            gate(f"v{i}.ours", published_in="Author (1900)", **{"published": "1.0760", **keys})
            for i, (keys, *_) in enumerate(cases)), code=(0, 1, 2))
        for row, (*case, outcome) in zip(rows.values(), cases):
            self.assertEqual(row["outcome"], outcome, (case, row["why"]))
        return list(rows.values()), text

    def test_agree_within_half_a_unit_of_the_last_digit(self):
        """Our error and the argument's error widen this interval. The published number may be a factor or the inverse of ours. A fraction is
        exact."""
        rows, _ = self.compared(
            *(({"published": text}, value, None, "passed" if off == 0.9 else "failed") for text, half, number in (
                ("1.0760", 5e-5, 1.076), ("1.076", 5e-4, 1.076), ("-8.155e-3", 5e-7, -8.155e-3), ("10", 0.5, 10),
                ("2.36E+03", 5, 2360), ("2/3", 1e-12 / 3, 2 / 3)) for off in (0.9, 1.1)
              for value in (number + off * half, number - off * half)),
            ({}, 1.07609, 3e-5, "failed"), ({}, 1.07609, 4e-5, "passed"), ({"argument_error": 2e-4}, 1.0762, None, "passed"),
            ({"argument_error": 2e-4}, 1.0763, None, "failed"), ({"published": "8.3", "times": 2}, 4.17, None, "passed"),
            ({"published": "8.3", "times": 2}, 4.18, None, "failed"),
            ({"published": "8.3", "times": 2, "inverse": True}, 2 / 8.36, None, "failed"),
            ({"published": "8.3", "times": 2, "inverse": True}, 2 / 8.34, 1e-3, "passed"), ({}, None, None, "failed"))
        self.assertAlmostEqual(rows[0]["published"]["deviation"], 0.9, delta=1e-9)
        self.assertAlmostEqual(rows[-2]["published"]["ours"], 8.34, delta=1e-12)
        self.assertAlmostEqual(rows[-2]["published"]["own_error"], 8.34e-3, delta=1e-12)

    def test_nothing_is_decided_by_an_own_error_beyond_the_digits(self):
        """It never makes a number agree; the number may still differ."""
        open_, known = {"undecided": "a coarse study"}, {"differs": "misprint"}
        rows, text = self.compared(
            *(({}, ours, 1e-3, "refused") for ours in (1.0760, 1.0761, 1.0765)), ({}, 1.0775, 1e-3, "failed"),
            (open_, 1.0761, 1e-3, "reported"), (open_, 1.0775, 1e-3, "failed"), (open_, 1.07601, None, "passed unexpectedly"),
            (known, 1.0761, 1e-3, "refused"), (known, 1.0775, 1e-3, "failed as expected"),
            (known | {"argument_error": 2e-3}, 1.0761, 1e-3, "passed unexpectedly"))  # the argument leaves more open
        for row in rows[:3]:
            self.assertIn("21.5", row["why"])
            self.assertEqual(row["published"]["comparison"], "")
        self.assertEqual(rows[4]["published"]["comparison"], "undecided")
        self.assertAlmostEqual(rows[4]["published"]["own_error_half_units"], 21.5, delta=0.1)
        self.assertIn("undecided", rows[6]["why"])
        self.assertIn("0 agree, 1 differ for a known reason, 1 ", text)

    def test_known_differences_must_be_there(self):
        """A missing number is none."""
        rows, _ = self.compared(*(({"published": "0.9429", "differs": "misprint"}, ours, None, outcome) for ours, outcome in (
            (0.943198, "failed as expected"), (0.94291, "passed unexpectedly"), (None, "failed"))))
        self.assertIn("differs", rows[1]["why"])

    def test_a_number_without_a_stated_error_is_not_compared(self):
        published = {"published": "1.0", "published_in": "Author"}
        rows, _ = self.judged(
            {"approach": 1, "exact": {"relative_uncertainty": 1e-14}, "limit": {"value": 1.04, "uncertainty": 0.01}},
            gate("approach", **published) + gate("approach", id="stated", own_error=0.01, **published)
            + gate("limit.value", **published), code=2)
        self.assertEqual([row["outcome"] for row in rows.values()], ["refused", "passed", "passed"])
        self.assertIn("approach", rows["approach"]["why"])


class Files(MadeGates):
    def test_gates_of_a_group_share_its_keys(self):
        """A gate's own keys count before its group's, `set` is both together, and gates come in the order of lines."""
        group = ("[[group]]\n" + toml({"scene": str(PAPER), "basis": "measured", "platform_spread": 1e-9})
                 + 'set = {"grid.cells" = [12, 12], "load.moment_ratio" = 0.5}\n')
        own = gate("moment_ratio", "group.gate", id="own", basis="asked for", above=0.899, below=0.901, source=None)
        own = own.replace("[[group.gate]]\n", '[[group.gate]]\nset = {"load.moment_ratio" = 0.9}\n')
        shared = gate("moment_ratio", "group.gate", id="shared", basis=None, above=0.499, below=0.501, source=None)
        alone = gate("x", id="alone", below=1)
        rows, _ = self.judged({"x": 0}, alone + group + shared + own + gate("x", id="last", below=1), code=0)
        self.assertEqual([*rows], ["alone", "shared", "own", "last"])
        self.assertEqual([row["line"] for row in rows.values()], [1, 12, 17, 24])
        self.assertEqual([row["basis"] for row in rows.values()], ["measured 1e-6", "measured", "asked for", "measured 1e-6"])
        for more, says in (('study = "a.toml"\n', "gate[1].scene"), ('[[group]]\nscene = "a.toml"\nbelow = 1.0\n', "below")):
            self.assertIn(says, self.judged({}, group + shared + own + more, code=2)[1])

    def test_complaints_name_the_key(self):
        """A gate that only reports needs no basis, a result excludes scene, study and set."""
        printed = {"published": "1.1", "published_in": "Author"}
        for keys, more, *says in (
                ({"below": 1}, 'scene = "a.toml"', "gate[0].scene"), ({"below": 1}, 'study = "a.toml"', "gate[0].scene"),
                ({"below": 1}, "set = {'grid.cells' = [8, 8]}", "gate[0].set", "result"), ({"below": 1, "basis": None}, "", "basis"),
                ({"published": "1.1"}, "", "published_in"), (printed | {"published": "one"}, "", "published", "one"),
                (printed | {"published": 1.1}, "", "published"), (printed | {"below": 2}, "", "below", "published"),
                (printed | {"status": "active"}, "", "status"), (printed | {"times": 0}, "", "times"),
                (printed | {"argument_error": -1}, "", "argument_error"),
                (printed | {"own_error": 0.1, "basis": None}, "", "basis", "own_error"),
                (printed | {"differs": "a", "not_compared": "b"}, "", "not_compared", "differs"),
                (printed | {"differs": "a", "undecided": "b"}, "", "undecided", "differs"),
                *((printed | {"published": text}, "", "published")
                  for text in ("", "1,5", "about 2", "0x10", "1e9999", "nan", "1.2 m", ".5", "1/0", "1.5/2"))):
            _, text = self.judged({"x": 0}, gate("x", **keys) + more, code=2)
            for words in ("gates.toml", *says):
                self.assertIn(words, text)
        self.judged({"x": 0}, gate("x", below=1, basis=None, status="report_only"), code=0)

    def test_literature_shares_its_source(self):
        group = "[[group]]\n" + toml({"published_in": "Author (1900), Table 2", "seen_in": "a later text", "times": 2})
        rows, _ = self.judged({"a": 0.55, "relative_uncertainty": 1e-9}, group
                              + gate("a", "group.gate", published="1.10") + gate("a", "group.gate", id="b", published="3",
                                                                                 inverse=True, differs="misprint")
                              + gate("rough punch", "group.gate", published="7", not_compared="periodic there", source=None), code=0)
        self.assertEqual([row["outcome"] for row in rows.values()], ["passed", "failed as expected", "reported"])
        printed = rows["a"]["published"]
        self.assertEqual([printed[key] for key in ("text", "source", "seen", "ours")],
                         ["1.10", "Author (1900), Table 2", "a later text", 1.1])

    def test_a_bad_one_spares_the_others(self):
        Path("broken.toml").write_text("[[gate]]\nid = 3\n")
        Path("again.toml").write_text("\n" + gate("x", below=1))
        rows, _ = self.judged({"x": 0}, gate("x", below=1), "broken.toml", "missing.toml", "again.toml", code=2)
        self.assertEqual(rows["x"]["outcome"], "passed")
        for name, words in (("broken.toml", "broken.toml:2"), ("missing.toml", "missing.toml"),
                            ("again.toml", r"again.toml:2: id = x: .*gates.toml:1")):
            self.assertRegex(rows[name]["why"], words)
        text = self.judged({"x": 0}, gate("x", below=1), "--only", "x", "y", code=2)[1]
        self.assertIn("--only y: no gate has this id; the nearest is x", text)
        self.judged({"x": 0}, gate("x", below=1), "--only", "x", "x", code=0)

    def test_patterns_select_as_in_a_shell(self):
        """An id is itself first, whatever it looks like."""
        gates = "".join(gate("x", id=name, below=1) for name in ("paper-1", "paper-2", "ellipse-1", "paper-[1]"))
        for patterns, selected in ((["paper-?"], ["paper-1", "paper-2"]), (["paper-[1]"], ["paper-[1]"]),
                                   (["*-1", "paper-1"], ["paper-1", "ellipse-1"]), (["*"], ["paper-1", "paper-2", "ellipse-1", "paper-[1]"]),
                                   (["paper-[!1]"], ["paper-2"])):
            rows, _ = self.judged({"x": 0}, gates, "--only", *patterns, code=0)
            self.assertEqual(list(rows), selected, patterns)
        text = self.judged({"x": 0}, gates, "--only", "papper-*", code=2)[1]
        self.assertIn("--only papper-*: no gate has this id; the nearest is paper-", text)

    def test_are_listed_without_a_run(self):
        gates = (gate("x", id="size", below=2e-5) + gate("y", id="scene", above=1, below=2, scene="no.toml")
                 + "set = { 'a.b' = 3, \"load.force\" = [1e-8, 2.0], load.name = \"a b\", on = true }\n"
                 + gate("z", id="other", of="before.json", within=0.1))
        Path("gates.toml").write_text(gates)
        text = self.run_program("gate", "gates.toml", "--output", "points", "--list")
        self.assertRegex(text, r"size +work.json +x, below 2e-05 in size\n +scene +no.toml +y, between 1 and 2\n +other ")
        self.assertTrue(text.endswith("3 gates\n"))
        self.assertFalse(Path("points").exists())
        Path("broken.toml").write_text("[[gate]]\nid = 3\n")
        self.run_program("gate", "gates.toml", "broken.toml", "--only", "s*", "--list", "--json", "list.json", code=2,
                         says="broken.toml:2")
        broken, size, scene = json.loads(Path("list.json").read_text())["listed"]
        self.assertIn("broken.toml:2", broken["why"])
        self.assertEqual([size[key] for key in ("id", "result", "quantity", "below", "basis")],
                         ["size", "work.json", "x", 2e-5, "measured 1e-6"])
        self.assertEqual([scene[key] for key in ("scene", "above", "line")], ["no.toml", 1, 7])
        self.assertCountEqual(scene["set"], ["a.b=3", "load.force=[1e-08, 2]", "load.name='a b'", "on=true"])
        self.assertFalse({"value", "outcome", "factor"} & scene.keys())

    def test_many_on_one_large_result_share_it(self):
        """2,000 copies of a result of 2,000 numbers would take 300 MB."""
        self.judged({f"q{i}": 1.0 * i for i in range(2000)}, "".join(gate(f"q{i}", below=9999) for i in range(2000)), code=0)
        arguments = [PROGRAM, "gate", "gates.toml", "--quiet"]
        child = os.posix_spawn(PROGRAM, arguments, os.environ)
        _, status, used = os.wait4(child, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), 0)
        if not any(name in Path(PROGRAM).read_bytes() for name in (b"__asan_init", b"__tsan_init")):
            self.assertLess(used.ru_maxrss, 100_000)  # kB


class Reports(MadeGates):
    def reports(self, result, gates, code):
        rows, text = self.judged(result, gates, "--summary", "summary.md", "--junit", "junit.xml", code=code)
        return rows, text, Path("summary.md").read_text(), Path("junit.xml").read_text()

    def test_have_every_kind_of_gate(self):
        """The worst first in Markdown, with all that it takes for markup."""
        bad = 'bad <a> & "b" | c, d: 100 %'
        rows, text, markdown, _ = self.reports({"x": 4, "y": 0.5}, "".join((
            gate("y", id="good", below=1), gate("x", id=bad, below=1, reason="users read this number"),
            gate("x", id="known", below=3, status="expected_failure"), gate("y", id="repaired", below=1, status="expected_failure"),
            gate("x", id="watched", below=1, status="report_only"),
            gate("x", id="unreadable", below=1, scene="no\nsuch \x01 scene <here>"))), 2)
        for words in ("x is 4, must be below 1 in size: 4 times the bound", "users read this number", "measured 1e-6",
                      f"slipstick gate gates.toml --only '{bad}'", "slipstick gate gates.toml --only repaired",
                      "6 gates: 1 passed, 1 failed as expected, 1 reported, 1 refused, 1 passed unexpectedly, 1 failed\n"):
            self.assertIn(words, text)
        self.assertNotIn("--only good", text)
        places = [markdown.index(name) for name in ("bad &lt;a>", "repaired", "unreadable", "watched", "known", "| good |")]
        self.assertEqual(places, sorted(places))
        for line in markdown.splitlines():
            if line.startswith("|"):
                self.assertEqual(line.count("|"), 8 + (2 if r"\|" in line else 0))  # in the id, and again to rerun it
        self.assertNotIn("more gates", markdown)
        self.assertEqual(rows[bad]["factor"], 4)
        self.assertIsNone(rows["unreadable"]["value"])
        self.assertIn("scene", rows["unreadable"]["value_reason"])

    def test_a_summary_is_added_to_its_file(self):
        """As a later command of one step writes $GITHUB_STEP_SUMMARY."""
        Path("summary.md").write_text("before\n")
        for _ in range(2):
            _, _, markdown, _ = self.reports({"x": 0}, gate("x", below=1), 0)
        self.assertTrue(markdown.startswith("before\n### 1 gate: 1 passed\n"))
        self.assertEqual(markdown.count("### 1 gate: 1 passed"), 2)

    def test_markdown_stays_below_64_kb_with_the_worst_first(self):
        """Gates that fail by the factor 2 + i, in an order that hides the worst."""
        order = [i * 7919 % 1000 for i in range(1000)]
        result = {f"gate-{i}": 2 + i for i in order}
        _, _, markdown, _ = self.reports(result, "".join(gate(name, below=1, basis="b" * 40) for name in result), 1)
        self.assertTrue(60000 < len(markdown.encode()) < 64000, len(markdown.encode()))
        found = [line.split(" | ")[1] for line in markdown.splitlines() if line.startswith("| failed | ")]
        self.assertEqual(found, [f"gate-{999 - i}" for i in range(len(found))])
        self.assertIn(f"{1000 - len(found)} more gates", markdown)
        self.assertIn("1000 gates: 1000 failed", markdown)

    def test_what_a_stranger_wrote_stays_text(self):
        """No image, link, mention, sequence of a terminal or turned direction comes out of any file."""
        _, text, markdown, junit = self.reports({"x": 4}, gate("x", id=MARKUP, reason=MARKUP, below=1), 1)
        for markup in ("[x](", "http://", "https://", "@user", "#12", "www.", "&#64;", " <", " `code", " **"):
            self.assertNotIn(markup, markdown)
        self.assertIn(r"\[y\](javascript:z)", markdown)
        for report in (text, markdown, junit):
            for steers in "\x1b\u009b\u202e\u2066\u2028\u061c":
                self.assertNotIn(steers, report)
            self.assertIn("u202etxet", report)
        self.assertEqual(len(list(xml.etree.ElementTree.parse("junit.xml").iter("testcase"))), 1)

    def test_bounds_have_every_digit(self):
        _, text = self.judged({"x": 1}, gate("x", id="count", equals=1535605) + gate("x", id="word", equals="asymptotic")
                              + gate("x", id="both", above=1535605, below=1535607) + gate("x", id="size", below=2e-5), code=1)
        for words in ("equal to 1535605\n", 'equal to "asymptotic"', "between 1535605 and 1535607", "below 2e-05 in size"):
            self.assertIn(words, text)
