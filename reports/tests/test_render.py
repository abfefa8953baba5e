"""The page from a small made-up data set: complete, the same each time, and honest about what is missing."""

import json
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path
from unittest.mock import patch

from made_report import REPORTS, Folder, run_render, save_nothing, save_quickly, small_report, write_data

import figures
import method_figures
import results
from test_study_figure import study, tolerance_study


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
            elif not target.endswith(".pdf"):  # see AsAProgram
                self.assertGreater((self.output / target).stat().st_size, 0, target)
        for name, _, _ in figures.FIGURES:
            self.assertIn(f"figures/{name}.svg", targets)
            self.assertIn(f"figures/{name}.pdf", targets)
        self.assertIn("data/report.json", targets)
        self.assertNotIn("Not available", self.page)

    def test_without_studies_nothing_speaks_of_them(self):
        self.assertNotIn("studies", self.page)

    def test_map_of_hard_scenes(self):
        part = self.page[self.page.index('id="hard"'):self.page.index('id="errata"')]
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

    def rows(self, begin, end):
        """The cells of the rows between two places."""
        table = self.page[self.page.index(f'id="{begin}"'):self.page.index(f'id="{end}"')]
        return [re.findall("<td>(.*?)</td>", row) for row in re.findall("<tr>(.*?)</tr>", table)]

    def test_each_table_stands_under_its_heading(self):
        loads, meshes = self.rows("loads", "mesh")[1:], self.rows("mesh", "gaps")[1:]
        self.assertEqual([row[:2] for row in loads], [["0.2", "paper"], ["0.5", "paper"], ["0.9", "paper"]])
        self.assertEqual([row[:3] for row in meshes],
                         [[pressure, load, f"{cells}²"] for pressure in ("solved", "hertz") for load in ("0.5", "0.9")
                          for cells in (4, 8, 16)])

    def test_table_of_errata(self):
        self.assertEqual(self.rows("errata", "scene"), [["(0)", "a &lt; b", "a &gt; b", "by example"]])
        head = self.page[self.page.index('id="errata"'):self.page.index('id="scene"')]
        self.assertEqual(re.findall('<th scope="col">(.*?)</th>', head),
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
        drawn = [entry for entry in figures.FIGURES if entry[0] in ("figure-12", "figure-13")]
        with patch.object(figures, "FIGURES", drawn):
            result = run_render(output / "data", output, save_quickly)
        self.assertEqual(result, (0, ""))
        page = (output / "index.html").read_text(encoding="utf-8")
        self.assertNotIn("<script", page)
        self.assertGreater(page.count("&lt;script&gt;"), 8)
        for figure in (output / "figures").glob("*.svg"):
            xml.etree.ElementTree.parse(figure)
            self.assertNotIn("<script", figure.read_text(encoding="utf-8"))

    def test_table_of_approximations(self):
        cells = self.rows("approximations", "loads")
        self.assertEqual(cells[1:], [
            ["0.2", "0.2", "−4\u00a0%", "−5\u00a0%", "−10\u00a0%", "−10\u00a0%", "+100\u00a0%"],
            ["0.5", "0.5", "−10\u00a0%", "−12\u00a0%", "−25\u00a0%", "−25\u00a0%", "+100\u00a0%"],
            ["0.9", "0.9", "−18\u00a0%", "−22\u00a0%", "−45\u00a0%", "−45\u00a0%", "+33\u00a0%"]])

    def test_table_of_the_gallery(self):
        cells = self.rows("gallery", "hard")
        self.assertEqual(cells[1], ["<a href=\"data/scenes/sphere.toml\">&lt;sphere&gt;</a>", "so &amp; so", "twist",
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
        names = {f"{figure}.{kind}" for figure in ("figure-8", "figure-13") for kind in ("svg", "pdf")}
        data, one, two = (self.folder / name for name in ("data", "one", "two"))
        write_data(data, report | {"profiles": []})
        run = subprocess.run([sys.executable, "-B", str(REPORTS / "render.py"), str(data), "--output", str(one)],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0)
        self.assertEqual(run_render(data, two), (0, run.stderr))
        self.assertEqual(len(run.stderr.splitlines()), len(figures.FIGURES) - 2)
        for folder in (one, two):
            self.assertEqual({path.name for path in (folder / "figures").iterdir()}, names)
        for name in names:
            content = (one / "figures" / name).read_bytes()
            self.assertTrue(content.startswith(b"%PDF" if name.endswith("pdf") else b"<?xml"), name)
            self.assertEqual(content, (two / "figures" / name).read_bytes(), name)
        self.assertEqual((one / "index.html").read_bytes(), (two / "index.html").read_bytes())


class PageWithGaps(Folder):
    def test_gaps_are_named_with_their_reasons(self):
        report = small_report()
        report["loading"][1].update(stick_radius_error=None, stick_radius_error_reason="the front did not move")
        del report["mesh"]
        write_data(self.folder, report)
        drawn = [entry for entry in figures.FIGURES if entry[0] in ("figure-4", "figure-6")]
        with patch.object(figures, "FIGURES", drawn):
            exit_code, errors = run_render(self.folder, self.folder / "page", save_nothing)
        page = (self.folder / "page" / "index.html").read_text(encoding="utf-8")
        self.assertEqual(exit_code, 0)
        self.assertIn("figure-6 is not available: “mesh” is missing from the data", errors)
        self.assertIn("Not available: “mesh” is missing from the data.", page)
        self.assertNotIn("figures/figure-6.svg", page)
        self.assertIn("<code>loading[].stick_radius_error</code> – the front did not move", page)
        self.assertIn("figures/figure-4.svg", page)

    def test_without_the_exact_curves_only_their_figures_are_missing(self):
        report = small_report()
        for key in ("approximations", "approximation_table", "bodies"):
            del report[key]
        write_data(self.folder, report)
        exit_code, _ = run_render(self.folder, self.folder / "page", save_nothing)
        page = (self.folder / "page" / "index.html").read_text(encoding="utf-8")
        self.assertEqual(exit_code, 0)
        missing = [name for name, _, _ in figures.FIGURES if f"figures/{name}.svg" not in page]
        self.assertEqual(missing, ["figure-11", "figure-12"])
        for key in ("approximations", "approximation_table", "bodies"):
            self.assertIn(f"Not available: “{key}” is missing from the data.", page)

    def test_studies_are_shown_where_there_are_some(self):
        report = small_report()
        report["studies"] = [study(), dict(tolerance_study(), name="made up: tolerance"), {"name": "broken"}]
        write_data(self.folder, report)
        written = []
        with patch.object(figures, "FIGURES", []):
            exit_code, _ = run_render(self.folder, self.folder / "page", lambda figure, stem: written.append(stem.name))
        page = (self.folder / "page" / "index.html").read_text(encoding="utf-8")
        self.assertEqual(exit_code, 0)
        for words in ('<h2 id="studies">', "figures/study-made_up.svg", "figures/study-made_up_tolerance.svg",
                      "<td>1.90 to 2.12</td>", "cells err by h².", "−9.0×10⁻⁴",
                      "Study “broken”</a>:\nnot available: “series” is missing from the data"):
            self.assertIn(words, page)
        self.assertEqual(page.count("<h4>Orders</h4>"), 1)
        self.assertEqual(written, ["study-made_up", "study-made_up_tolerance"])
        self.assertNotIn("<code>studies", page)

    def test_the_methods_are_told_apart(self):
        entry = method_figures.methods(small_report(), self.folder)
        self.assertIn("2.4° by the paper’s method", entry.message)
        self.assertIn("1.0×10⁻⁷ of a degree by Newton’s method", entry.message)
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
