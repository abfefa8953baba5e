"""The page from a small made-up data set: complete, the same each time, and honest about what is missing."""

import dataclasses
import json
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from collections import Counter
from pathlib import Path
from unittest.mock import patch

from made_report import REPORTS, Folder, run_render, save_nothing, save_quickly, small_page, write_data

import figures
import method_figures
import results
from test_study_figure import study, tolerance_study


def only(*names):
    """The lead figure and those named, of all that the page has."""
    sections = [dataclasses.replace(each, figures=[figure for figure in each.figures if figure.name in names])
                for each in figures.SECTIONS]
    return patch.object(figures, "SECTIONS", sections)


class WholePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.output = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        write_data(cls.output, small_page())
        cls.run_result = run_render(cls.output, save=save_quickly)
        cls.page = (cls.output / "index.html").read_text(encoding="utf-8")

    def test_render_succeeds_in_silence(self):
        self.assertEqual(self.run_result, (0, ""))

    def test_names_do_not_turn_the_text(self):
        """Characters that steer a terminal or turn the direction of text, in names of users, are shown, not obeyed."""
        file = self.output / "nasty.json"
        file.write_text(json.dumps({"name": "a\u202eb\u2066c\x1b[1m\u009b", "rows": [{"k\u202e": "é\n\t"}]}))
        self.assertEqual(results.load(file), {"name": r"a\u202eb\u2066c\x1b[1m\x9b", "rows": [{r"k\u202e": "é\n\t"}]})

    def test_every_figure_and_link_exists(self):
        targets = re.findall(r'(?:src|href)="([^"]+)"', self.page)
        anchors = set(re.findall(r'id="([^"]+)"', self.page))
        for target in targets:
            if target.startswith("#"):
                self.assertIn(target[1:], anchors)
            elif not target.endswith((".pdf", ".csv")) and not target.startswith("data:"):  # see AsAProgram
                self.assertGreater((self.output / target).stat().st_size, 0, target)
        for figure in figures.FIGURES:
            self.assertIn(f"figures/{figure.name}.svg", targets)
            self.assertIn(f"figures/{figure.name}.pdf", targets)
        self.assertIn("data/report.json", targets)
        self.assertNotIn("Not available", self.page)

    def test_provenance_names_every_file_scene_build_and_machine(self):
        entries = json.loads((self.output / "ro-crate-metadata.json").read_text())["@graph"]
        found = {entry["@id"]: entry for entry in entries}
        self.assertEqual(len(found), len(entries))
        page = json.loads((self.output / "data" / "report.json").read_text())
        files = {f"{folder}/{file.name}" for folder in ("data", "figures") for file in (self.output / folder).iterdir()}
        self.assertEqual({part["@id"] for part in found["./"]["hasPart"]}, files | {"index.html"})
        self.assertEqual(found["#scene"]["text"], page["scene"]["text"])
        self.assertEqual(found["#slipstick"]["version"], page["provenance"]["version"])
        self.assertEqual(found["#cpu"]["value"], page["provenance"]["cpu"])

        def referred(value):
            if isinstance(value, list):
                return [name for each in value for name in referred(each)]
            return [value["@id"]] if isinstance(value, dict) else []
        for entry in entries[1:]:
            self.assertLessEqual({name for value in entry.values() for name in referred(value)}, set(found))

    def test_without_studies_nothing_speaks_of_them(self):
        self.assertNotIn("Study:", self.page)

    def test_the_verdict_stands_first(self):
        first = self.page[self.page.index("<main"):self.page.index("<section")]
        for words in ("✓ All is well", "<strong>Gates:</strong> 1 of 1 pass", "a &lt; b", "page of commit 0123456789abcdef:",
                      "hard certified: 2 before, 1 now", "<dd>0.3\u00a0%</dd><dt>error of the twist",
                      "<dd>2\u00a0%</dd><dt>estimated error (mesh, steps) of the stick radius", "<dd>2.0×10⁻⁹</dd>", "<dd>0.125\u00a0s</dd>",
                      "16×16 cells, M/M<sub>lim</sub>&nbsp;=&nbsp;0.9", 'id="twist"'):
            self.assertIn(words, first)

    def test_a_bad_verdict_says_so(self):
        page = small_page()
        page["headline"].update(verdict="bad", since=None, changes=[], counts={"checks": {"Gates": "holds", "Hard": "fails"}})
        write_data(self.output / "bad", page)
        with only():
            run_render(self.output / "bad", save=save_nothing)
        page = (self.output / "bad" / "index.html").read_text(encoding="utf-8")
        self.assertIn("✗ Not all is well", page)
        self.assertNotIn("All is well</p>", page.replace("Not all is well", ""))
        self.assertIn("the first page in its folder", page)
        self.assertIn("✗ Hard:", page)

    def test_what_is_open_does_not_look_well(self):
        page = small_page()
        page["headline"].update(verdict="open", lines=[["Gates", "1 of 1"], ["Orders", "fitted with h^0.63 and h^2 > 0"]],
                                counts={"checks": {"Gates": "holds", "Orders": "open"}})
        write_data(self.output / "open", page)
        with only():
            run_render(self.output / "open", save=save_nothing)
        page = (self.output / "open" / "index.html").read_text(encoding="utf-8")
        self.assertNotIn("All is well", page)
        self.assertIn("○ Orders:</strong> fitted with h<sup>0.63</sup> and h² &gt; 0", page)

    def test_each_figure_stands_in_the_page_and_is_named(self):
        drawn = re.findall(r'<svg role="img" aria-label="([^"]+)" viewBox', self.page)
        self.assertEqual(len(drawn), len(figures.FIGURES))
        self.assertEqual(len(set(drawn)), len(drawn))
        self.assertEqual(re.findall(r"Figure (\d+)\.", self.page), [str(k) for k in range(1, len(drawn) + 1)])
        self.assertEqual([name for name, count in Counter(re.findall(r'<\w+ id="([\w-]+)"', re.sub(
            r"<svg.*?</svg>", "", self.page, flags=re.DOTALL))).items() if count > 1], [])

    def test_tables_of_gates_and_programs(self):
        self.assertEqual(self.rows("gates")[1:], [["a-gate", "passed", "twist_error", "1.0×10⁻⁵", "50\u00a0%",
                                                   "it &lt;matters&gt;"]])
        programs = self.page[self.page.index('<h3 id="fields"'):self.page.index('<section id="literature"')]
        cells = [re.findall("<td>(.*?)</td>", row) for row in re.findall("<tr>(.*?)</tr>", programs)][1:]
        self.assertEqual(cells, [
            [name, verdict, "8²", "1.0×10⁻³", twist, "5.0×10⁻¹", "1.5×10⁰", "1.0×10⁻⁵", f"it &lt;is&gt; {verdict}"]
            for name, verdict, twist in (("ONE", "good", "−1.0×10⁻³"), ("TWO", "bad", "−3.0×10⁻¹"))])

    def test_table_of_published_numbers(self):
        part = self.page[self.page.index('<section id="literature"'):self.page.index('<section id="beyond"')]
        cells = [re.findall("<td>(.*?)</td>", row) for row in re.findall("<tr>(.*?)</tr>", part)][1:]
        self.assertEqual(cells, [
            ["Someagreed (1900), Title: Table 1. Seen in: a later text.", "agreed", "1.10", "1.1002", "2.0×10⁻⁷", "agrees", ""],
            ["Someother (1900), Title: Table 1. Seen in: a later text.", "other", "2.0", "2.2", "2.0×10⁻⁷", "differs",
             "it &lt;differs&gt;"],
            ["Somecoarse (1900), Title: Table 1. Seen in: a later text.", "coarse", "2.0", "2.01", "1.0×10²",
             "cannot be compared at its digits", "a staircase"],
            ["Someleft (1900), Title: Table 1. Seen in: a later text.", "left", "3", "–", "–", "not compared", "not here"]])
        self.assertIn("1 of 4 published numbers agree within their printed digits, 1 differ for a known reason, 1 cannot be "
                      "compared at their digits, 1 not at all.", self.page)

    def test_map_of_hard_scenes(self):
        part = self.part("map")
        first, paper = re.findall("<td>(.*?)</td>", part)
        marks = re.compile(r'<span class="square (\w+)" title="([^"]*)">')
        self.assertEqual([verdict for verdict, _ in marks.findall(first)], ["right"] * 4 + ["refused"])
        self.assertEqual([verdict for verdict, _ in marks.findall(paper)],
                         ["right", "other_direction", "wrong", "not_converged", "refused"])
        self.assertEqual(marks.findall(first)[4][1], "moment; 2.0; refused; beyond &#34;the&#34; limit")
        self.assertEqual(marks.findall(paper)[2][1], "moment; 0.3; other answer; it differs by 0.4; 32 applications; "
                         "4.0e-01 of the certified answer away")
        self.assertIn("next to &lt;nothing&gt;", part)

    def rows(self, place):
        """The cells of the rows under a heading."""
        return [re.findall("<td>(.*?)</td>", row) for row in re.findall("<tr>(.*?)</tr>", self.part(place))]

    def part(self, place):
        """The text from a heading to the next one."""
        return re.split("<h[23]", self.page[self.page.index(f'<h3 id="{place}"') + 3:])[0]

    def test_each_table_stands_under_its_heading(self):
        loads, meshes = self.rows("loads")[1:], self.rows("meshes")[1:]
        self.assertEqual([row[:2] for row in loads], [["0.2", "paper"], ["0.5", "paper"], ["0.9", "paper"]])
        self.assertEqual([row[:3] for row in meshes],
                         [[pressure, load, f"{cells}²"] for pressure in ("solved", "hertz") for load in ("0.5", "0.9")
                          for cells in (4, 8, 16)])
        self.assertEqual([row[0] for row in self.rows("approximation-table")[1:]], ["0.2", "0.5", "0.9"])

    def test_table_of_errata(self):
        self.assertEqual(self.rows("errata"), [["(0)", "a &lt; b", "a &gt; b", "by example"]])
        self.assertEqual(re.findall('<th scope="col">(.*?)</th>', self.part("errata")),
                         ["Equation", "As printed", "What holds", "How it shows"])

    def test_what_the_data_call_things_is_no_markup(self):
        page = small_page()
        evil = "<script>alert(1)</script>$\\frac{$\n"
        page["answer"].update(name=evil)
        page["answer"]["program"].update(name=evil, version=evil)
        page["paper"]["bodies"][0]["profile"] = evil
        page["scene"].update(name=evil, text=f"# {evil}", summary=[[evil, evil]])
        page["provenance"] = {"version": evil, evil: evil}
        for row in page["numbers"]:
            row.update(words=evil, basis=evil)
        for row in page["programs"]:
            row.update(name=evil, version=evil)
        for point in page["cost"]["points"]:
            point["method"] = evil
        varied = study()
        varied["name"] = evil
        page["studies"] = [varied]
        folders = [self.output / "evil" / name for name in ("a", "b")]
        for folder in folders:
            write_data(folder, page)
        with only("bodies-and-cycles", "answer", "cost", "programs"):
            result = run_render(*folders, output=self.output / "evil", save=save_quickly)
        self.assertEqual(result, (0, ""))
        for file, least in ((folders[0] / "index.html", 12), (self.output / "evil" / "index.html", 2)):
            text = file.read_text(encoding="utf-8")
            self.assertEqual(text.count("<script"), 1)  # the page's own
            self.assertGreater(text.count("&lt;script&gt;"), least)
        for figure in (folders[0] / "figures").glob("*.svg"):
            xml.etree.ElementTree.parse(figure)
            self.assertNotIn("<script", figure.read_text(encoding="utf-8"))

    def test_tables_of_the_answer(self):
        self.assertEqual(self.rows("numbers")[1], ["twist", "1.25 mrad", "1.25 mrad", "0.3\u00a0%", "–", "–", "5\u00a0%", "exact"])
        self.assertEqual(self.rows("numbers")[2], ["moment", "2 µN m", "2 µN m", "–", "–", "–", "–", "no mesh"])
        self.assertEqual(self.rows("choices")[1:], [["1.0×10⁻²", "16 × 8, the mean of 4 grids", "1.0×10⁻³", "0.01", ""],
                                                    ["1.0×10⁻³", "–", "–", "–", "too &lt;fine&gt;"]])
        self.assertEqual(self.rows("digits")[1:], [["twist", "12.3", "11.9 to 12.7"]])
        self.assertEqual(self.rows("answers")[1][:5], ["slipstick", "1", "8", "converged", "1.2×10⁻¹"])
        self.assertEqual(self.rows("program")[1], ["version", "1.0", ""])


class OtherPages(Folder):
    def test_a_page_has_no_section_and_no_table_without_its_part(self):
        page = small_page()
        for part in ("paper", "cost", "operators", "programs", "hard", "digits", "uncertainty"):
            del page[part]
        del page["answer"]["program"]
        page["answer"]["steps"] = page["answer"]["steps"][:1]
        write_data(self.folder, page)
        self.assertEqual(run_render(self.folder, save=save_nothing), (0, ""))
        text = (self.folder / "index.html").read_text(encoding="utf-8")
        self.assertEqual(re.findall('<section id="([^"]+)"', text), ["what", "result", "errors", "run"])
        self.assertEqual(re.findall('<h3 id="([^"]+)"', text), ["numbers", "gaps", "provenance"])
        self.assertEqual([name for name in re.findall('<figure id="([^"]+)"', text)], ["answer", "bodies"])
        for words in ("paper", "Lubkin", "Not available"):
            self.assertNotIn(words, text)

    def test_an_index_has_a_row_for_each_page(self):
        exact, rough = small_page(), small_page()
        del exact["answer"]["history"], rough["answer"]["program"]
        rough["scene"].update(name="rough", text="name = 1")
        rough["headline"].update(verdict="bad", lines=[["Mesh", "it is 2e-1 off"], ["Hard", "fine"]],
                                 counts={"checks": {"Mesh": "fails", "Hard": "holds"}})
        for row in rough["numbers"]:
            row.update(error=None)
        folders = [self.folder / name for name in ("made up", "rough")]
        for folder, page in zip(folders, (exact, rough)):
            write_data(folder, page)
        with only("answer"):
            self.assertEqual(run_render(*folders, output=self.folder, save=save_quickly), (0, ""))
        text = (self.folder / "index.html").read_text(encoding="utf-8")
        rows = [re.findall("<td[^>]*>(.*?)</td>", row, re.DOTALL) for row in re.findall("<tr>(.*?)</tr>", text, re.DOTALL)][1:]
        self.assertIn('<td data-label="judged by">twist</td>', text)  # for narrow screens
        self.assertEqual(rows[0][0], '<a href="made up/index.html">made up</a>')
        self.assertTrue((self.folder / re.search('src="([^"]+)"', rows[0][1])[1]).is_file())
        self.assertEqual(rows[0][2:], ["So &amp; so", "✓ good", "twist", "1.25 mrad", "0.3\u00a0%", "1.9×10⁻⁵", "–", "3", "16×16", "0.0256"])
        self.assertEqual(rows[1][2:], ["", "✗ bad: Mesh: it is 2.0×10⁻¹ off", "–", "–", "–", "2.0×10⁻⁹", "20", "3", "16×16", "0.125"])


class AsAProgram(Folder):
    """Two figures: a line on log axes; maps that are pixels in the file."""

    def test_writes_every_format_and_equal_files_for_equal_data(self):
        page = small_page()
        page["paper"] = {key: page["paper"][key] for key in ("equation_5_digits", "contact")} | {"profiles": []}
        for part in ("cost", "operators", "programs", "hard"):
            del page[part]
        page["answer"]["steps"] = []
        names = {f"{figure}.{kind}" for figure in ("equation-5", "answer", "bodies") for kind in ("svg", "pdf")}
        names |= {"equation-5.csv", "bodies.csv"}
        one, two = (self.folder / name for name in ("one", "two"))
        for folder in (one, two):
            write_data(folder, page)
        run = subprocess.run([sys.executable, "-B", str(REPORTS / "render.py"), str(one), "--output", str(one)],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0)
        self.assertEqual(run_render(two), (0, run.stderr))
        missing = [figure for figure in figures.FIGURES if figure.part == "paper" and figure.name != "equation-5"]
        self.assertEqual(len(run.stderr.splitlines()), len(missing))
        for folder in (one, two):
            self.assertEqual({path.name for path in (folder / "figures").iterdir()}, names)
        for name in names:
            content = (one / "figures" / name).read_bytes()
            self.assertTrue(content.startswith({"pdf": b"%PDF", "svg": b"<?xml", "csv": b"panel,"}[name[-3:]]), name)
            self.assertEqual(content, (two / "figures" / name).read_bytes(), name)
        self.assertEqual((one / "index.html").read_bytes(), (two / "index.html").read_bytes())


class PageWithGaps(Folder):
    def draw(self, page, *names, save=save_nothing):
        """The text of the page, drawn only with the lead figure and the named ones, and the program's output."""
        write_data(self.folder, page)
        with only(*names):
            exit_code, errors = run_render(self.folder, save=save)
        self.assertEqual(exit_code, 0)
        return (self.folder / "index.html").read_text(encoding="utf-8"), errors

    def test_gaps_are_named_with_their_reasons(self):
        page = small_page()
        page["paper"]["loading"][1].update(stick_radius_error=None, stick_radius_error_reason="the front did not move")
        del page["paper"]["mesh"]
        text, errors = self.draw(page, "stick-radius", "convergence")
        self.assertIn("convergence is not available: “mesh” is missing from the data", errors)
        self.assertIn("Not available: “mesh” is missing from the data.", text)
        self.assertNotIn("figures/convergence.svg", text)
        self.assertIn("<code>paper.loading[].stick_radius_error</code> – the front did not move", text)
        self.assertIn("figures/stick-radius.svg", text)

    def test_without_the_exact_curves_only_their_figures_are_missing(self):
        page = small_page()
        for key in ("approximations", "approximation_table", "bodies"):
            del page["paper"][key]
        text, _ = self.draw(page, *(figure.name for figure in figures.FIGURES))
        missing = [figure.name for figure in figures.FIGURES if f"figures/{figure.name}.svg" not in text]
        self.assertEqual(missing, ["bodies-and-cycles", "approximations"])
        for key in ("approximations", "approximation_table", "bodies"):
            self.assertIn(f"Not available: “{key}” is missing from the data.", text)

    def test_studies_are_shown_where_there_are_some(self):
        page = small_page()
        page["studies"] = [study(), dict(tolerance_study(), name="made up: tolerance"), {"name": "broken"}]
        written = []
        text, _ = self.draw(page, save=lambda figure, stem: written.append(stem.name))
        for words in ("figures/study-made_up.svg", "figures/study-made_up_tolerance.svg",
                      "<td>1.90 to 2.12</td>", "cells err by h².", "−9.0×10⁻⁴",
                      "Study: broken</h3>", "Not available: “series” is missing from the data"):
            self.assertIn(words, text)
        self.assertEqual(text.count("<h4>Orders</h4>"), 1)
        self.assertEqual(written, ["twist", "study-made_up", "study-made_up_tolerance"])
        self.assertNotIn("<code>studies", text)

    def test_the_methods_are_told_apart(self):
        entry = method_figures.methods(small_page()["paper"], self.folder)
        self.assertIn("the paper’s method leaves slip misaligned with traction by up to 2.4°", entry.message)
        self.assertIn(("ellipse, slip direction, Newton’s method for Coulomb’s law", "1.0×10⁻⁷ of a degree"), entry.numbers)
        report = small_page()["paper"]
        del report["methods"][0]["operator_applications"]
        with self.assertRaises(results.Unavailable):
            method_figures.methods(report, self.folder)

    def test_data_that_cannot_be_read_are_refused(self):
        (self.folder / "data").mkdir()
        for content, words in ((json.dumps({"loading_cells": float("nan")}), "NaN"), ("{", "report.json"),
                               ("[]", "no JSON object")):
            (self.folder / "data" / "report.json").write_text(content)
            exit_code, errors = run_render(self.folder)
            self.assertEqual(exit_code, 2)
            self.assertIn(words, errors)
        exit_code, errors = run_render(self.folder / "nowhere")
        self.assertEqual(exit_code, 2)
        self.assertIn("No such file", errors)
