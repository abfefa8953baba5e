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

from made_report import REPORTS, Folder, run_render, save_nothing, save_quickly, small_report, write_data

import figures
import method_figures
import results
from test_study_figure import study, tolerance_study


def only(*names):
    """The lead figure and those named, of all that the page has."""
    sections = [dataclasses.replace(each, figures=[figure for figure in each.figures if figure[0] in names])
                for each in figures.SECTIONS]
    return patch.object(figures, "SECTIONS", sections)


class WholePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.output = Path(temporary.name)
        cls.data = cls.output / "data"
        write_data(cls.data, small_report())
        cls.run_result = run_render(cls.data, cls.output, save_quickly)
        cls.page = (cls.output / "index.html").read_text(encoding="utf-8")

    def test_render_succeeds_in_silence(self):
        self.assertEqual(self.run_result, (0, ""))

    def test_every_figure_and_link_exists(self):
        targets = re.findall(r'(?:src|href)="([^"]+)"', self.page)
        anchors = set(re.findall(r'id="([^"]+)"', self.page))
        for target in targets:
            if target.startswith("#"):
                self.assertIn(target[1:], anchors)
            elif not target.endswith((".pdf", ".csv")) and not target.startswith("data:"):  # see AsAProgram
                self.assertGreater((self.output / target).stat().st_size, 0, target)
        for name, _, _ in figures.FIGURES:
            self.assertIn(f"figures/{name}.svg", targets)
            self.assertIn(f"figures/{name}.pdf", targets)
        self.assertIn("data/report.json", targets)
        self.assertNotIn("Not available", self.page)

    def test_without_studies_nothing_speaks_of_them(self):
        self.assertNotIn("Study:", self.page)

    def test_the_verdict_stands_first(self):
        first = self.page[self.page.index("<main"):self.page.index("<section")]
        for words in ("✓ All is well", "<strong>Gates:</strong> 1 of 1 pass", "a &lt; b", "page of commit 0123456789abcdef:",
                      "hard certified: 2 before, 1 now", "3.0×10⁻³", "−2.0×10⁻³", "1.0×10⁻⁹", "0.125\u00a0s", 'id="twist"'):
            self.assertIn(words, first)

    def test_a_bad_verdict_says_so(self):
        report = small_report()
        report["headline"].update(verdict="bad", since=None, changes=[])
        write_data(self.output / "bad" / "data", report)
        with only():
            run_render(self.output / "bad" / "data", self.output / "bad", save_nothing)
        page = (self.output / "bad" / "index.html").read_text(encoding="utf-8")
        self.assertIn("✗ Not all is well", page)
        self.assertNotIn("All is well</p>", page.replace("Not all is well", ""))
        self.assertIn("the first page in its folder", page)

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
        programs = self.page[self.page.index('<figure id="known-fields"'):self.page.index('<section id="run"')]
        cells = [re.findall("<td>(.*?)</td>", row) for row in re.findall("<tr>(.*?)</tr>", programs)][1:]
        self.assertEqual(cells, [
            [name, verdict, "8²", "1.0×10⁻³", twist, "5.0×10⁻¹", "1.5×10⁰", "1.0×10⁻⁵", f"it &lt;is&gt; {verdict}"]
            for name, verdict, twist in (("ONE", "good", "−1.0×10⁻³"), ("TWO", "bad", "−3.0×10⁻¹"))])

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

    def test_text_of_the_data_is_escaped(self):
        self.assertIn("made &lt;up&gt;", self.page)
        self.assertIn("a &lt; b", self.page)

    def rows(self, place):
        """The cells of the rows under a heading."""
        return [re.findall("<td>(.*?)</td>", row) for row in re.findall("<tr>(.*?)</tr>", self.part(place))]

    def part(self, place):
        """What stands from a heading to the next one."""
        return re.split("<h[23]", self.page[self.page.index(f'<h3 id="{place}"') + 3:])[0]

    def test_each_table_stands_under_its_heading(self):
        loads, meshes = self.rows("loads")[1:], self.rows("mesh")[1:]
        self.assertEqual([row[:2] for row in loads], [["0.2", "paper"], ["0.5", "paper"], ["0.9", "paper"]])
        self.assertEqual([row[:3] for row in meshes],
                         [[pressure, load, f"{cells}²"] for pressure in ("solved", "hertz") for load in ("0.5", "0.9")
                          for cells in (4, 8, 16)])

    def test_table_of_errata(self):
        self.assertEqual(self.rows("errata"), [["(0)", "a &lt; b", "a &gt; b", "by example"]])
        self.assertEqual(re.findall('<th scope="col">(.*?)</th>', self.part("errata")),
                         ["Equation", "As printed", "What holds", "How it shows"])

    def test_what_the_data_call_things_is_no_markup(self):
        report = small_report()
        evil = "<script>alert(1)</script>$\\frac{$\n"
        for row in report["gallery"]:
            row.update(title=evil, shows=evil)
        report["bodies"][0]["profile"] = evil
        report["scene"] = {"name": evil, "text": evil, "summary": [[evil, evil]]}
        report["provenance"] = {"version": evil, evil: evil}
        varied = study()
        varied["name"] = evil
        report["studies"] = [varied]
        output = self.output / "evil"
        write_data(output / "data", report)
        with only("bodies-and-cycles", "gallery-maps"):
            result = run_render(output / "data", output, save_quickly)
        self.assertEqual(result, (0, ""))
        page = (output / "index.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("<script"), 1)  # the page's own
        self.assertGreater(page.count("&lt;script&gt;"), 8)
        for figure in (output / "figures").glob("*.svg"):
            xml.etree.ElementTree.parse(figure)
            self.assertNotIn("<script", figure.read_text(encoding="utf-8"))

    def test_table_of_approximations(self):
        cells = self.rows("approximation-table")
        self.assertEqual(cells[1:], [
            ["0.2", "0.2", "−4\u00a0%", "−5\u00a0%", "−10\u00a0%", "−10\u00a0%", "+100\u00a0%"],
            ["0.5", "0.5", "−10\u00a0%", "−12\u00a0%", "−25\u00a0%", "−25\u00a0%", "+100\u00a0%"],
            ["0.9", "0.9", "−18\u00a0%", "−22\u00a0%", "−45\u00a0%", "−45\u00a0%", "+33\u00a0%"]])

    def test_table_of_the_gallery(self):
        cells = self.rows("gallery")
        self.assertEqual(cells[1], ["<a href=\"data/scenes/paper.toml\">&lt;paper&gt;</a>", "so &amp; so", "twist",
                                    "1.25\u00a0mrad", "1.2\u00a0mrad exact", "−4.0×10⁻²", "2.0×10⁻⁹", "20", "2",
                                    "256", "0.25"])
        self.assertEqual([row[0] for row in cells[2:]], ["&lt;tube&gt;", "&lt;odd&gt;", "&lt;rough&gt;"])
        self.assertEqual([row[4:6] for row in cells[2:]], [
            ["1.26\u00a0mrad extrapolated", "2.0×10⁻³"], ["1.25\u00a0mrad finest mesh", "±3.0×10⁻⁴"], ["–", "–"]])



class AsAProgram(Folder):
    """Two figures: a line on log axes; maps with outlines that are pixels in the file."""

    def test_writes_every_format_and_equal_files_for_equal_data(self):
        report = {key: part for key, part in small_report().items()
                  if key in ("equation_5_digits", "gallery", "provenance", "scene")}
        names = {f"{figure}.{kind}" for figure in ("equation-5", "gallery-maps", "slip-maps") for kind in ("svg", "pdf")}
        names.add("equation-5.csv")
        data, one, two = (self.folder / name for name in ("data", "one", "two"))
        write_data(data, report | {"profiles": []})
        run = subprocess.run([sys.executable, "-B", str(REPORTS / "render.py"), str(data), "--output", str(one)],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0)
        self.assertEqual(run_render(data, two), (0, run.stderr))
        self.assertEqual(len(run.stderr.splitlines()), len(figures.FIGURES) - 3)
        for folder in (one, two):
            self.assertEqual({path.name for path in (folder / "figures").iterdir()}, names)
        for name in names:
            content = (one / "figures" / name).read_bytes()
            self.assertTrue(content.startswith({"pdf": b"%PDF", "svg": b"<?xml", "csv": b"panel,"}[name[-3:]]), name)
            self.assertEqual(content, (two / "figures" / name).read_bytes(), name)
        self.assertEqual((one / "index.html").read_bytes(), (two / "index.html").read_bytes())


class PageWithGaps(Folder):
    def test_gaps_are_named_with_their_reasons(self):
        report = small_report()
        report["loading"][1].update(stick_radius_error=None, stick_radius_error_reason="the front did not move")
        del report["mesh"]
        write_data(self.folder, report)
        with only("stick-radius", "convergence"):
            exit_code, errors = run_render(self.folder, self.folder / "page", save_nothing)
        page = (self.folder / "page" / "index.html").read_text(encoding="utf-8")
        self.assertEqual(exit_code, 0)
        self.assertIn("convergence is not available: “mesh” is missing from the data", errors)
        self.assertIn("Not available: “mesh” is missing from the data.", page)
        self.assertNotIn("figures/convergence.svg", page)
        self.assertIn("<code>loading[].stick_radius_error</code> – the front did not move", page)
        self.assertIn("figures/stick-radius.svg", page)

    def test_without_the_exact_curves_only_their_figures_are_missing(self):
        report = small_report()
        for key in ("approximations", "approximation_table", "bodies"):
            del report[key]
        write_data(self.folder, report)
        exit_code, _ = run_render(self.folder, self.folder / "page", save_nothing)
        page = (self.folder / "page" / "index.html").read_text(encoding="utf-8")
        self.assertEqual(exit_code, 0)
        missing = [name for name, _, _ in figures.FIGURES if f"figures/{name}.svg" not in page]
        self.assertEqual(missing, ["bodies-and-cycles", "approximations"])
        for key in ("approximations", "approximation_table", "bodies"):
            self.assertIn(f"Not available: “{key}” is missing from the data.", page)

    def test_studies_are_shown_where_there_are_some(self):
        report = small_report()
        report["studies"] = [study(), dict(tolerance_study(), name="made up: tolerance"), {"name": "broken"}]
        write_data(self.folder, report)
        written = []
        with only():
            exit_code, _ = run_render(self.folder, self.folder / "page", lambda figure, stem: written.append(stem.name))
        page = (self.folder / "page" / "index.html").read_text(encoding="utf-8")
        self.assertEqual(exit_code, 0)
        for words in ("figures/study-made_up.svg", "figures/study-made_up_tolerance.svg",
                      "<td>1.90 to 2.12</td>", "cells err by h².", "−9.0×10⁻⁴",
                      "Study: broken</h3>", "Not available: “series” is missing from the data"):
            self.assertIn(words, page)
        self.assertEqual(page.count("<h4>Orders</h4>"), 1)
        self.assertEqual(written, ["twist", "study-made_up", "study-made_up_tolerance"])
        self.assertNotIn("<code>studies", page)

    def test_the_methods_are_told_apart(self):
        entry = method_figures.methods(small_report(), self.folder)
        self.assertIn("the paper’s method leaves slip misaligned with traction by up to 2.4°", entry.message)
        self.assertIn(("ellipse, slip direction, Newton’s method for Coulomb’s law", "1.0×10⁻⁷ of a degree"), entry.numbers)
        report = small_report()
        del report["methods"][0]["operator_applications"]
        with self.assertRaises(results.Unavailable):
            method_figures.methods(report, self.folder)

    def test_data_that_cannot_be_read_are_refused(self):
        output = self.folder / "page"
        for content, words in ((json.dumps({"loading_cells": float("nan")}), "NaN"), ("{", "report.json"),
                               ("[]", "no JSON object")):
            (self.folder / "report.json").write_text(content)
            exit_code, errors = run_render(self.folder, output)
            self.assertEqual(exit_code, 2)
            self.assertIn(words, errors)
        exit_code, errors = run_render(self.folder / "nowhere", output)
        self.assertEqual(exit_code, 2)
        self.assertIn("No such file", errors)


if __name__ == "__main__":
    unittest.main()
