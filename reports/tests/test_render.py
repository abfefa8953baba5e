"""The page from a small made-up data set: complete, the same each time, and honest about what is missing."""

import io
import json
import re
import subprocess
import sys
import tempfile
import unittest
import warnings
import xml.etree.ElementTree
from contextlib import redirect_stderr
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG

REPORTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPORTS))

import exact_figures  # noqa: E402
import figures  # noqa: E402
import gallery_figure  # noqa: E402
import hard_cases  # noqa: E402
import method_figures  # noqa: E402
import render  # noqa: E402
import results  # noqa: E402
import style  # noqa: E402
from test_study_figure import study, tolerance_study  # noqa: E402

RADIUS, PEAK, FRICTION = 2.0, 3.0, 0.5


def solve_result(load, cells, pressure="solved", method="paper"):
    error = 1.0 / cells**2
    return {
        "method": method, "pressure": pressure, "moment_ratio": load, "cells": [cells, cells], "friction": FRICTION,
        "stick_ratio": 1 - load, "twist": load, "twist_error": error, "stick_radius_error": -error,
        "traction_error": {"l1": error, "l2": 2 * error, "max": 3 * error},
        "exact": {"stick_ratio": 1 - load, "twist": load},
        "iterations": 7, "operator_applications": 14, "certificate": {"gap": 1e-5 * (1 + load)},
        "slip_direction": {"mean": 2.4 if method == "paper" else 1e-7},
        "seconds": {"setup": 0.1, "pressure": 0.2, "traction": 0.3, "total": 1e-4 * cells**2},
    }


def profile(load):
    points = [{"radius": r, "value": 1 + r, "printed": 2 * (1 + r)} for r in (0.0, 0.25, 0.5, 0.75, 1.0)]
    cells = [{"radius": r, "value": 1.01 + r, "exact": 1 + r, "error": 0.01} for r in (0.2, 0.6, 0.9)]
    return {"moment_ratio": load, "stick_ratio": 0.5, "exact": points, "computed": cells,
            "fields": f"fields-{load}.h5", "result": solve_result(load, 4)}


def approximation(load):
    """Errors that grow with the load, so that 1 % and 10 % are reached at known ones."""
    def law(error):
        return {"twist": load * (1 + error), "error": error}
    return {"moment_ratio": load, "moment": 0.5 * load, "twist": load, "equation_7": law(-0.2 * load),
            "small_moments": law(-0.25 * load), "no_slip": law(-0.5 * load), "dem": law(-0.5 * load),
            "dem_moment": {"moment": min(load, 0.6), "error": min(load, 0.6) / (0.5 * load) - 1 if load else 0.0}}


def body(profile, limit, full_stick):
    loads = (0.0, 0.5, 0.9, 0.999)
    return {"profile": profile, "moment_limit": limit, "full_stick": full_stick,
            "rows": [{"moment_ratio": x, "moment": limit * x, "stick_ratio": 1 - x, "twist": x} for x in loads]}


def gallery_row(scene, basis, reference, error, status="converged"):
    row = {"scene": scene, "title": f"<{scene}>", "shows": "so & so", "quantity": "twist", "unit": "rad",
           "value": 1.25e-3, "reference": reference, "basis": basis, "error": error, "status": status,
           "gap": 2e-9, "operator_applications": 20.4, "seconds": 0.25, "steps": 2, "cells": [256, 128],
           "cell_size": [RADIUS / 2, RADIUS / 2], "fields": f"gallery-{scene}.h5"}
    for key in ("reference", "error"):
        if row[key] is None:
            row[f"{key}_reason"] = "not known"
    return row


def gallery():
    return [gallery_row("sphere", "exact", 1.2e-3, -0.04), gallery_row("tube", "extrapolated", 1.26e-3, 2e-3),
            gallery_row("odd", "finest mesh", 1.25e-3, None) | {"uncertainty": 3e-4},
            gallery_row("rough", "none", None, None)]


def hard():
    def beside(**found):
        return {"methods": {"paper": found}}

    def row(case, verdict, **more):
        return {"family": "moment", "case": case, "verdict": verdict} | more

    return {
        "families": {"moment": {"why": "next to <nothing>"}},
        "rows": [
            row("0.1", "certified", operator_applications=10, **beside(verdict="agrees", operator_applications=30)),
            row("0.2", "certified", operator_applications=12,
                **beside(verdict="other_direction", reason="turned by 3 degrees", operator_applications=31)),
            row("0.3", "certified", operator_applications=14,
                **beside(verdict="other_answer", reason="it differs by 0.4", difference=0.4, operator_applications=32)),
            row("0.4", "certified", operator_applications=15, **beside(verdict="not_converged", reason="every cell slips")),
            row("2.0", "refused", reason="beyond \"the\" limit", **beside(verdict="refused", reason="beyond it")),
        ],
    }


def small_report():
    loads = (0.2, 0.5, 0.9)
    return {
        "provenance": {"version": "0.0.0", "commit": "none", "cpu": "made <up>", "threads": 1},
        "scene": {"name": "made up", "text": "name = \"made up\"", "summary": [["Sphere radius", "18 mm"]]},
        "contact": {"radius": RADIUS, "peak_pressure": PEAK, "approach": 1.0, "moment_limit": 1.0},
        "loading_cells": 4,
        "curve": [{"moment_ratio": x, "stick_ratio": 1 - x, "stick_complement": x, "twist": x, "equation_7": 0.9 * x,
                   "equation_7_error": -0.1} for x in loads],
        "profiles": [profile(0.5), profile(0.9)],
        "loading": [solve_result(load, 4) for load in loads],
        "mesh": [solve_result(load, cells, pressure) for pressure in ("solved", "hertz") for load in (0.5, 0.9)
                 for cells in (4, 8, 16)],
        "methods": [solve_result(loads[-1], cells, method=method) for method in ("coulomb", "paper")
                    for cells in (4, 8)],
        "ellipse": [solve_result(loads[-1], cells, method=method) for method in ("coulomb", "paper")
                    for cells in (4, 8)],
        "equation_5_digits": [{"stick_complement": 10.0**-i, "relative_error": 10.0**(2 * i - 16)} for i in range(7)],
        "approximations": [approximation(x) for x in (0.0, *loads)],
        "approximation_table": [approximation(x) for x in loads],
        "bodies": [body("hertz", 0.6, 0.0), body("cone", 0.5, 0.0), body("flat_punch", 0.8, 0.85)],
        "loop": {"turning_points": [0.8, -0.8, 0.8],
                 "rows": [{"moment_ratio": x, "moment": 0.6 * x, "twist": twist, "dissipated": 0.1} for x, twist in
                          ((0.0, 0.0), (0.8, 0.4), (0.0, 0.1), (-0.8, -0.4), (0.0, -0.1), (0.8, 0.4))]},
        "cycle_energy": [{"moment_ratio": x, "energy": x**3 / (1 - x), "small_amplitude": x**3}
                         for x in (0.05, 0.1, 0.2, 0.5)],
        "gallery": gallery(),
        "hard": hard(),
        "errata": [{"equation": "(0)", "printed": "a < b", "holds": "a > b", "shown": "by example"}],
    }


def write_fields(path, q1_shift=0.02):
    """The twelve cells of a 4 x 4 grid that lie in the unit circle."""
    centre = RADIUS * np.array([-0.75, -0.25, 0.25, 0.75])
    x1, x2 = (x.ravel() for x in np.meshgrid(centre, centre))
    inside = np.hypot(x1, x2) < RADIUS
    x1, x2 = x1[inside], x2[inside]
    with h5py.File(path, "w") as file:
        for name, values in {"x1": x1, "x2": x2, "q1": -x2 + q1_shift, "q2": x1, "q1_exact": -x2,
                             "q2_exact": x1}.items():
            file[name] = values


def write_contact(path):
    """Two cells that stick beside one that slips."""
    with h5py.File(path, "w") as file:
        for name, values in {"x1": [0.0, 1.0, 2.0], "x2": [0.0, 0.0, 0.0], "stick": [1.0, 1.0, 0.0],
                             "slip1": [1e-9, 0.0, 3.0], "slip2": [0.0, 0.0, 4.0]}.items():
            file[name] = values


def write_data(folder, report):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "report.json").write_text(json.dumps(report))
    for entry in report["profiles"]:
        write_fields(folder / entry["fields"])
    for scene in report["gallery"]:
        write_contact(folder / scene["fields"])
    (folder / "scenes").mkdir(exist_ok=True)
    (folder / "scenes" / "sphere.toml").write_text("name = 'sphere'")


def run_render(data_dir, output, save=style.save):
    """Exit code, and what it says; `save` writes the figures. A warning is an error."""
    with redirect_stderr(io.StringIO()) as errors, patch.object(style, "save", save), warnings.catch_warnings():
        for kind in (UserWarning, RuntimeWarning):
            warnings.simplefilter("error", kind)
        exit_code = render.main([str(data_dir), "--output", str(output)])
    return exit_code, errors.getvalue()


def save_quickly(figure, stem):
    """Draws it once, as SVG, not laid out and without minor ticks: a quarter of the work."""
    figure.set_layout_engine("none")
    for axis in figure.axes:
        axis.minorticks_off()
    FigureCanvasSVG(figure).print_svg(stem.with_suffix(".svg"))


def save_nothing(figure, stem):
    """For tests of the page's text."""


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)


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


class OneFigure(Folder):
    def setUp(self):
        super().setUp()
        self.report = small_report()
        write_data(self.folder, self.report)

    def assert_unavailable(self, draw, words):
        with self.assertRaisesRegex(results.Unavailable, words):
            draw(self.report, self.folder)

    def test_missing_key(self):
        del self.report["loading"][2]["twist_error"]
        self.assert_unavailable(figures.twist, "twist_error.*missing")

    def test_only_nulls(self):
        for row in self.report["loading"]:
            row.update(certificate=None, certificate_reason="not asked for")
        self.assert_unavailable(method_figures.certificate, "certificate.gap.*null in every row: not asked for")

    def test_null_where_the_message_quotes_it(self):
        self.report["loading"][2].update(twist_error=None, twist_error_reason="no exact answer")
        self.assertIn("the computed twist is not available", figures.twist(self.report, self.folder).message)

    def test_field_with_nan(self):
        write_fields(self.folder / "fields-0.9.h5", q1_shift=np.nan)
        self.assert_unavailable(figures.shear_components, "fields-0.9.h5: “q1”.*not numbers")

    def test_field_file_missing_or_damaged(self):
        (self.folder / "fields-0.9.h5").unlink()
        self.assert_unavailable(figures.traction_norm, "fields-0.9.h5 cannot be read")
        (self.folder / "fields-0.9.h5").write_text("no HDF5")
        self.assert_unavailable(figures.traction_norm, "fields-0.9.h5 cannot be read")

    def test_missing_cycles(self):
        for key in ("loop", "cycle_energy"):
            self.report = small_report()
            del self.report[key]
            self.assert_unavailable(exact_figures.bodies_and_cycles, f"{key}.*missing")

    def test_how_far_each_law_holds(self):
        message = exact_figures.approximations(self.report, self.folder).message
        self.assertIn("Eq. (7) 0.050 (0.50), small moments 0.040 (0.40), no slip 0.020 (0.20)", message)
        self.assertIn("off by over 100&nbsp;%", message)

    def test_hard_scenes_in_numbers(self):
        entry = hard_cases.methods(small_report(), self.folder)
        self.assertEqual(entry.message, "Of 5 hard scenes Newton’s method for Coulomb’s law certifies 4 and refuses 1 with a "
                         "reason; 0 do not converge or are wrong. By the paper’s method 1 of 4 agree, 1 do not converge, in "
                         "1 slip does not oppose traction, 1 have another answer.")
        bars = [[bar.get_width() for bar in entry.figure.axes[0].patches[5 * i:5 * i + 5]] for i in (0, 1)]
        self.assertEqual(bars, [[4, 1, 0, 0, 0], [1, 1, 1, 1, 1]])

    def test_law_that_holds_everywhere(self):
        for row in self.report["approximations"]:
            row["equation_7"]["error"] = 0.001 * row["moment_ratio"]
        self.assertIn("Eq. (7) 0.90 (0.90)", exact_figures.approximations(self.report, self.folder).message)

    def test_bodies_and_cycles_in_numbers(self):
        message = exact_figures.bodies_and_cycles(self.report, self.folder).message
        for words in ("0.600&nbsp;μWa under a sphere", "flat punch, which sticks everywhere up to 0.850 of that",
                      "keeps 25\u00a0% of its twist", "amplitude of 0.10&nbsp;M", "2 times as large"):
            self.assertIn(words, message)

    def test_what_the_gallery_says(self):
        entry = gallery_figure.gallery(self.report, self.folder)
        self.assertIn("4 scenes, in all of which Coulomb’s law holds to gap / energy = 2.0×10⁻⁹.", entry.message)
        self.assertIn("Of the 1 with an exact answer, half are within 4.0×10⁻² of it", entry.message)
        panel = entry.figure.axes[0]
        self.assertEqual([text.get_text() for text in panel.texts], ["67\u00a0% sticks"])
        slip, sticks = (image.get_array() for image in panel.images)
        self.assertEqual(slip.filled(-1).tolist(), [[-1, -1, 1]])  # of its largest value
        self.assertEqual(sticks.filled(0).tolist(), [[1, 1, 0]])

    def test_gallery_draws_slip_over_its_largest_value(self):
        entry = gallery_figure.gallery(self.report, self.folder)
        self.assertEqual(np.nanmax(entry.figure.axes[0].images[0].get_array()), 1.0)

    def test_gallery_owns_up_to_what_did_not_converge(self):
        self.report["gallery"][1]["status"] = "not_converged"
        self.assertIn("3 scenes, in all of which", gallery_figure.gallery(self.report, self.folder).message)
        self.assertIn("1 more did not converge", gallery_figure.gallery(self.report, self.folder).message)

    def test_gallery_without_its_fields(self):
        (self.folder / "gallery-tube.h5").unlink()
        self.assert_unavailable(gallery_figure.gallery, "gallery-tube.h5 cannot be read")

    def test_error_map_is_the_difference_from_exact(self):
        entry = figures.shear_components(self.report, self.folder)
        error = entry.figure.axes[2].images[0].get_array()
        self.assertAlmostEqual(float(error.max()), 0.02 / (FRICTION * PEAK), places=12)


if __name__ == "__main__":
    unittest.main()
