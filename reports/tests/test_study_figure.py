"""The figure of a study, from made-up series: right where one can count, and complete."""

import io
import json
import subprocess
import sys
import unittest
from contextlib import redirect_stderr

import numpy as np

from made_report import REPORTS, Folder

import study_figure
import study_result
import style
import tables
from results import Unavailable
from wording import typeset

CELLS = (8, 16, 32, 64)
QUANTITIES = ("twist_error", "traction_error.l2", "peak_pressure_error")


def order(**changes):
    return {"value": 2.0, "low": 1.9, "high": 2.125, "constant": -64.0, "verdict": "asymptotic",
            "why": "order 2.00 (1.90 to 2.13) agrees with the expected 2 over 3 meshes", "expected": 2.0,
            "expected_why": "cells err by h^2", "sizes": [1 / 16, 1 / 32, 1 / 64]} | changes


def mesh(cells):
    """Errors of 1 and 2 times the cell size squared, the coarsest off by ten."""
    error = (10.0 if cells == CELLS[0] else 1.0) / cells**2
    return {"cells": [cells, cells // 2], "h": 1 / cells, "grids": 3,
            **{path: {"mean": -(k + 1) * error, "spread": 0.1 * error, "noise": 1e-12}
               for k, path in enumerate(QUANTITIES)}}


def budget(quantity, cells):
    return {"quantity": quantity, "cells": [cells, cells // 2], "h": 1 / cells, "observed": -1e-3 + 1e-8,
            "discretisation": -1e-3, "iteration": 1e-8, "reference": 1e-12, "rounding": 1e-12, "trend": -9e-4,
            "staircase": -1e-4}


def series(method, pressure, **changes):
    return {"set": {"solver.method": method, "contact.pressure": pressure}, "basis": "exact",
            "meshes": [mesh(cells) for cells in CELLS], "order": {path: order() for path in QUANTITIES},
            "budget": [budget(path, cells) for path in QUANTITIES for cells in CELLS]} | changes


def study(**changes):
    return {"name": "made_up", "scene": "scene.toml",
            "series": {f"{method}-{pressure}": series(method, pressure) for method in ("coulomb", "paper")
                       for pressure in ("solved", "hertz")}} | changes


def tolerance_row(requested, gap):
    return {"requested": requested, "certificate.gap": gap, "change": requested, "twist_error": 1e-3,
            "traction_error.l2": 1e-2, "iteration": {"twist_error": requested, "traction_error.l2": None}}


def tolerance_study():
    """The second method's gap stays at 1e-4."""
    def one(method, least):
        return series(method, "solved", set={"solver.method": method}, meshes=[mesh(CELLS[-1])],
                      tolerances=[tolerance_row(asked, max(asked, least)) for asked in (1e-2, 1e-4, 1e-6)])
    return study(series={"coulomb": one("coulomb", 0.0), "paper": one("paper", 1e-4)})


def changed(change, content=None):
    """The content, or a study, with a change of each of its series."""
    content = content or study()
    for one in content["series"].values():
        change(one)
    return content


def said(by, content):
    series = study_result.read(content)
    return by(series, study_result.main_quantities(series))


def axes_of(figure):
    return [axis for axis in figure.get_axes() if axis.axison]


class Errors(unittest.TestCase):
    def panel(self, content=None):
        axis = style.Figure().subplots()
        study_figure.errors_panel(axis, study_result.read(content or study()), "twist_error")
        return axis

    def test_points_are_the_sizes_of_the_errors(self):
        solved = [line for line in self.panel().lines if line.get_color() == style.BLUE and line.get_marker() == "o"]
        points = {round(1 / x): y for line in solved for x, y in zip(*line.get_data())}
        self.assertEqual(set(points), set(CELLS))
        for cells, error in points.items():
            self.assertAlmostEqual(error, (10 if cells == 8 else 1) / cells**2)

    def test_meshes_that_the_fit_leaves_out_are_pale(self):
        pale = [line for line in self.panel().lines if line.get_alpha() == 0.3 and line.get_marker() == "o"]
        self.assertEqual({tuple(line.get_xdata()) for line in pale}, {(1 / 8,)})

    def test_fitted_line_spans_its_meshes(self):
        lines = [line for line in self.panel().lines if line.get_marker() == "None" and line.get_linestyle() == "-"]
        self.assertEqual(len(lines), 2)  # the other method’s are dashed
        np.testing.assert_allclose(lines[0].get_xdata(), [1 / 64, 1 / 16])
        np.testing.assert_allclose(lines[0].get_ydata(), [64 / 64**2, 64 / 16**2])

    def test_no_line_through_what_turns(self):
        content = changed(lambda one: one["order"]["twist_error"].update(verdict="oscillatory"))
        self.assertEqual([line for line in self.panel(content).lines
                          if line.get_marker() == "None" and line.get_linestyle() in ("-", "--")], [])

    def test_finer_meshes_stand_to_the_right(self):
        left, right = self.panel().get_xlim()
        self.assertGreater(left, right)
        self.assertEqual([label.get_text() for label in self.panel().get_xticklabels()], ["8", "16", "32", "64"])

    def test_legend_has_order_interval_and_verdict(self):
        texts = [entry.get_text() for entry in self.panel().get_legend().get_texts()]
        self.assertEqual(texts, ["2.00 (1.90 to 2.12) asymptotic"] * 4)

    def test_title_says_where_no_exact_answer_is_behind_the_error(self):
        self.assertEqual(self.panel().get_title(), "twist")
        content = changed(lambda one: one["order"].update(twist_error=order(basis="extrapolated")))
        self.assertEqual(self.panel(content).get_title(), "twist, from the extrapolated value")

    def test_no_order(self):
        content = study()
        content["series"]["paper-hertz"]["order"]["twist_error"] = order(
            value=None, low=None, high=None, constant=None, verdict="too_few", sizes=[])
        texts = [entry.get_text() for entry in self.panel(content).get_legend().get_texts()]
        self.assertEqual(texts[-1], "no order: too few")
        self.assertIn("8 orders: 7 are asymptotic, 1 of too few meshes.", study_figure.draw(content).message)

    def test_spread_that_reaches_zero_leaves_the_panel(self):
        content = study()
        content["series"]["coulomb-solved"]["meshes"][3]["twist_error"]["spread"] = 1.0
        with_bar, without = self.panel(content).get_ylim(), self.panel().get_ylim()
        self.assertEqual(with_bar, without)

    def test_every_bar_ends_above_zero(self):
        content = study(series={"one": series("coulomb", "solved")})
        for mesh, times in zip(content["series"]["one"]["meshes"], (0.1, 0.5, 1.0, 2.0)):
            mesh["twist_error"]["spread"] = times * abs(mesh["twist_error"]["mean"])
        ends = [segment[:, 1] for bars in self.panel(content).containers for bar in bars.lines[2]
                for segment in bar.get_segments()]
        self.assertEqual(len(ends), len(CELLS))
        for low, high in ends:
            self.assertTrue(0 < low < high)

    def test_the_size_of_the_errors_does_not_move_their_points(self):
        def heights(scale):
            axis = self.panel(changed(lambda one: [mesh["twist_error"].update(mean=scale * mesh["twist_error"]["mean"])
                                                   for mesh in one["meshes"]]))
            return np.log(10 * scale / np.array([8**2, 16**2]) / axis.get_ylim()[0]) / np.log(np.divide(*axis.get_ylim()))

        np.testing.assert_allclose(heights(1e-6), heights(1.0))

    def test_points_and_guides_take_most_of_their_panel(self):
        low, high = np.log(self.panel().get_ylim())
        least, most = np.log([1 / 64**2, 10 / 8**2])
        self.assertLess(most + np.log(4), high)  # the guides begin at four times the largest error
        self.assertGreater(least - low, 0.5 * 4 * 0.055 * (high - low))  # half of a legend of four entries
        self.assertGreater(most - least, 0.5 * (high - low))

    def test_more_entries_of_the_legend_have_more_room_below_the_points(self):
        few = study(series=dict(list(study()["series"].items())[:2]))
        (low_of_few, high_of_few), (low, high) = self.panel(few).get_ylim(), self.panel().get_ylim()
        self.assertLess(low, low_of_few)
        self.assertEqual(high, high_of_few)

    def test_a_spread_that_is_not_known_has_no_bar(self):
        content = changed(lambda one: [mesh["twist_error"].update(spread=None) for mesh in one["meshes"]])
        for container in self.panel(content).containers:
            for bar in container.lines[2]:
                for low, high in (segment[:, 1] for segment in bar.get_segments()):
                    self.assertEqual(low, high)

    def test_failed_runs_are_named_first(self):
        failed = {"count": 2, "of": 40, "first": {"run": "paper, rounded upward", "message": "killed by signal 9"}}
        text = study_figure.draw(study(failed_runs=failed)).message
        self.assertTrue(text.startswith("2 of 40 runs failed; the first (paper, rounded upward): killed by signal 9. "))
        self.assertTrue(study_figure.draw(study(failed_runs={"count": 0, "of": 40})).message.startswith("8 orders: "))

    def test_values_that_are_null_have_no_point(self):
        content = study()
        content["series"]["coulomb-solved"]["meshes"][0]["twist_error"]["mean"] = None
        self.panel(content)

    def test_nothing_to_show(self):
        for content in (study(series={}), {"name": "empty"}):
            with self.assertRaises(Unavailable):
                study_figure.draw(content)
        content = changed(lambda one: one.pop("tolerances"), tolerance_study())
        with self.assertRaisesRegex(Unavailable, "nothing to compare"):
            study_figure.draw(content)


class Budget(unittest.TestCase):
    def test_bars_are_the_parts(self):
        axis = axes_of(study_figure.draw(study()).figure)[-1]
        heights = [[bar.get_height() for bar in bars] for bars in axis.containers]
        self.assertEqual(heights, [[1e-3] * 4, [1e-8] * 4, [1e-12] * 4, [1e-12] * 4])
        self.assertIn("twist", axis.get_title())

    def test_message_says_what_dominates(self):
        self.assertIn("The mesh error of the twist is at least 1.0×10⁵ times", study_figure.draw(study()).message)

    def test_message_says_what_is_too_large(self):
        content = changed(lambda one: one["budget"][2].update(iteration=2e-4))
        self.assertIn("On 1 of 4 meshes other parts of the error of the twist are above a tenth of the mesh’s, most of "
                      "all the iteration.", study_figure.draw(content).message)

    def test_a_tenth_is_not_above_a_tenth(self):
        for iteration, words in ((0.1, "The mesh error of the twist is at least 1.0×10¹ times"),
                                 (0.095, "The mesh error of the twist is at least"), (0.11, "On 4 of 4 meshes")):
            content = changed(lambda one: [row.update(discretisation=1.0, iteration=iteration, reference=0.0, rounding=0.0)
                                           for row in one["budget"]])
            self.assertIn(words, said(study_figure.message, content))

    def test_details_say_how_many_grids_a_mesh_has_at_most(self):
        details = said(study_figure.details, changed(lambda one: one["meshes"][-1].update(grids=1)))
        self.assertIn("Points are means over 3 grids", details)
        self.assertIn("Cells of 15.6 to 125 mm.", details)

    def test_table_adds_up(self):
        label, table = tables.study_budget(study())
        self.assertEqual(label, "Newton’s method for Coulomb’s law, pressure solved on the same grid")
        self.assertEqual([row[0] for row in table.body], ["twist"] * 4 + ["traction, L2"])
        self.assertEqual(table.body[0][1:6], ["8×4", "−1.0×10⁻³", "−1.0×10⁻³", "−9.0×10⁻⁴", "−1.0×10⁻⁴"])

    def test_columns_without_numbers_are_left_out(self):
        content = changed(lambda one: [row.update(trend=None, staircase=None) for row in one["budget"]])
        self.assertEqual(len(tables.study_budget(content)[1].head), 7)


class Tolerances(unittest.TestCase):
    def test_reached_against_asked_for(self):
        panels = axes_of(study_figure.draw(tolerance_study()).figure)
        self.assertEqual([axis.get_title() for axis in panels],
                         ["gap / energy reached", "error: twist", "error: traction, L2"])
        gaps = [list(line.get_ydata()) for line in panels[0].lines if line.get_marker() not in ("None", "")]
        self.assertEqual(gaps, [[1e-2, 1e-4, 1e-6], [1e-2, 1e-4, 1e-4]])

    def test_a_value_is_not_shown_as_an_error(self):
        """The twist has an exact answer, the stick radius has none: metres are on no axis."""
        content = tolerance_study()
        for one in content["series"].values():
            one["order"]["stick_radius"] = order(basis="extrapolated")
            for row in one["tolerances"]:
                row["stick_radius"] = 4e-4
                row["iteration"]["stick_radius"] = -row["requested"]
        entry = study_figure.draw(content)
        panel = axes_of(entry.figure)[3]
        self.assertEqual(panel.get_title(), "stick radius, from the tightest run")
        self.assertEqual([list(line.get_ydata()) for line in panel.lines], [[1e-2, 1e-4, 1e-6]] * 2)
        self.assertEqual([entry.get_text() for entry in panel.get_legend().get_texts()],
                         ["relative difference from the tightest run"])
        self.assertIn("the relative difference from the tightest run", entry.details)

    def test_what_no_tolerance_changes_has_no_panel(self):
        content = tolerance_study()
        for one in content["series"].values():
            one["order"]["stick_radius"] = order(basis="extrapolated")
            for row in one["tolerances"]:
                row["iteration"]["stick_radius"] = 0.0
        entry = study_figure.draw(content)
        self.assertEqual(len(axes_of(entry.figure)), 3)
        self.assertIn("The same at each tolerance: stick radius.", entry.details)

    def test_the_finest_mesh_is_shown_alone(self):
        content = tolerance_study()
        for one in content["series"].values():
            coarse = [row | {"cells": [8, 4], "certificate.gap": 1.0} for row in one["tolerances"]]
            one["tolerances"] = coarse + [row | {"cells": [64, 32]} for row in one["tolerances"]]
        gaps = axes_of(study_figure.draw(content).figure)[0].lines[1].get_ydata()
        self.assertEqual(list(gaps), [1e-2, 1e-4, 1e-6])

    def test_a_gap_that_stays_is_named(self):
        message = study_figure.draw(tolerance_study()).message
        self.assertEqual(message, "With the paper’s method, the law of friction holds to a gap of 1.0×10⁻⁴ at best, though its "
                                  "own test reads 1.0×10⁻⁶.")
        content = tolerance_study()
        del content["series"]["paper"]
        self.assertEqual(study_figure.draw(content).message, "Every requested tolerance is reached.")

    def test_details_name_the_mesh(self):
        self.assertEqual(said(study_figure.details, tolerance_study()), "Tolerances on a mesh of 64 cells across. The part "
                         "left by stopping there is the change of the error when the iteration continues.")

    def test_one_mesh_has_no_table_of_orders(self):
        self.assertIsNone(tables.study_orders(tolerance_study()))


class Words(unittest.TestCase):
    def test_orders_table(self):
        table = tables.study_orders(study())
        self.assertEqual(table.head[:3], ["quantity", "method", "pressure"])
        self.assertEqual(table.body[0][:-1], ["twist", "coulomb", "solved", "2.00", "1.90 to 2.12", "2", "asymptotic"])
        self.assertEqual([row[0] for row in table.body], ["twist", "", "", "", "traction, L2", "", "", ""])

    def test_reasons_stand_once(self):
        self.assertEqual(tables.study_expectations(study()), [
            ("twist, solved; twist, hertz; traction, L2, solved; traction, L2, hertz", "2", "cells err by h²")])

    def test_what_looks_say(self):
        colours, markers = study_result.told_by(study_result.read(study()))
        self.assertEqual(colours, [("pressure solved on the same grid", style.BLUE),
                                   ("Hertz pressure at cell centres", style.VERMILION)])
        self.assertEqual([(words, look["marker"]) for words, look in markers],
                         [("Newton’s method for Coulomb’s law", "o"), ("the paper’s method", "s")])

    def test_any_key_can_vary(self):
        content = study(series={str(nu): series("", "", set={"lower.poisson_ratio": nu}) for nu in (0.0, 0.25, 0.5)})
        colours, markers = study_result.told_by(study_result.read(content))
        self.assertEqual(colours, [])
        self.assertEqual([words for words, _ in markers], [f"lower.poisson_ratio = {nu}" for nu in (0.0, 0.25, 0.5)])
        self.assertEqual(len({(look["color"], look["marker"]) for _, look in markers}), 3)
        study_figure.draw(content)

    def test_nothing_varies(self):
        self.assertEqual(study_result.told_by(study_result.read(study(series={"one": series("", "", set={})}))), ([], []))
        study_figure.draw(study(series={"one": series("", "", set={})}))

    def test_typeset(self):
        self.assertEqual(typeset("off by h^(1/2), then h^2, like d^(-1/2); it's 8.4e-06"),
                         "off by √h, then h², like 1/√d; it’s 8.4×10⁻⁶")
        self.assertEqual(typeset("h^0.63 & h^-1.5 and h^12"), "h<sup>0.63</sup> &amp; h<sup>-1.5</sup> and h¹²")

    def test_an_empty_program_is_named(self):
        words = [study_result.word("solver.program", chosen) for chosen in ("", "folder/mine.toml")]
        self.assertEqual(words[1], "mine")
        self.assertNotIn("=", words[0])


class Script(Folder):
    def run_script(self, content, name):
        (self.folder / "study.json").write_text(content)
        with redirect_stderr(io.StringIO()) as errors:
            return study_figure.main([str(self.folder / "study.json"), str(self.folder / name)]), errors.getvalue()

    def test_every_format_and_the_same_bytes(self):
        for name in ("a.svg", "b.svg", "a.png", "a.pdf"):
            self.assertEqual(self.run_script(json.dumps(study()), name), (0, ""))
        self.assertEqual((self.folder / "a.svg").read_bytes(), (self.folder / "b.svg").read_bytes())

    def test_message_stands_in_the_figure(self):
        words = " ".join(text.get_text().replace("\n", " ") for text in study_figure.standalone(study()).texts)
        entry = study_figure.draw(study())
        self.assertIn(entry.message, words)
        self.assertIn("made_up. " + entry.details, words)

    def test_what_cannot_be_drawn_is_refused(self):
        for content, name, words in (("{", "a.svg", "study.json"), (json.dumps(study()), "a.gif", "allowed endings"),
                                     (json.dumps(study(series={})), "a.svg", "no series"),
                                     (json.dumps(study()), "nowhere/a.svg", "No such file")):
            code, errors = self.run_script(content, name)
            self.assertEqual(code, 2)
            self.assertIn(words, errors)

    def test_runs_as_a_program(self):
        run = subprocess.run([sys.executable, "-B", REPORTS / "study_figure.py", "--help"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0)
        self.assertIn("RESULT", run.stdout.upper())
