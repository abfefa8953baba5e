"""The page of times and errors, from made-up timings: right where one can count, and complete."""

import io
import json
import tempfile
import unittest
from contextlib import redirect_stderr
from pathlib import Path
from unittest.mock import patch

from matplotlib.text import Text

from made_report import save_nothing, save_quickly

import plane_figure
import render
import scaling_figure
import speed_page
import style
from results import Unavailable

DENSE, DCFFT = "application/dense", "application/dcfft"


def family(name, law, theory, exponent):
    """Ten nanoseconds times the law at 4 to 64 cells."""
    return {"name": name,
            "rows": [{"cells": n, "seconds": 1e-8 * law(n), "low": 0.9e-8 * law(n), "high": 1.1e-8 * law(n),
                      "error": 1e-15, "counters": {}} for n in (4, 8, 16, 32, 64)],
            "power_law": {"exponent": exponent, "low": exponent - 0.1, "high": exponent + 0.1, "constant": 1e-8,
                          "theory": theory, "expected": exponent, "cells": [16, 32, 64]}}


def scaling(**changes):
    return {"families": [family(DENSE, lambda n: n**4, "N^4", 4.0), family(DCFFT, lambda n: 64 * n**2, "N^2", 2.0),
                         family("setup/dense", lambda n: 10 * n**4, "N^4", 4.0)],
            "crossovers": [{"slow": DENSE, "quick": DCFFT, "cells": 8.0, "low": 7.5, "high": 8.5, "remark": ""}]} | changes


def point(seconds, error, **choice):
    choice = {"method": "coulomb", "operator": "dcfft", "model": "auto", "pressure": "solved",
              "cells": 64, "tolerance": 1e-4} | choice
    time = None if seconds is None else {"median": seconds, "low": seconds, "high": seconds, "repetitions": 9}
    return choice | {"seconds": time, "error": {"twist": error, "traction_l2": 10 * error, "stick_radius": error}}


POINTS = [point(1e-3, 1e-2, cells=16), point(1e-2, 1e-4), point(0.1, 1e-4, model="full"), point(None, 0.5, method="paper")]


def scene(**changes):
    def reached(error, place):
        return {"quantity": "twist", "error": error, "method": "any", "point": place,
                "seconds": None if place is None else POINTS[place]["seconds"]["median"]}

    times = [reached(1e-2, 0), reached(1e-4, 1), reached(1e-5, None)]
    return {"name": "paper-0.9", "moment_ratio": 0.9, "points": POINTS,
            "exact": {"seconds": {"median": 5e-4}, "error": 2e-14, "cells": 128},
            "envelope": {name: [0, 1] for name in ("twist", "traction_l2", "stick_radius")},
            "time_to": times + [row | {"method": "coulomb"} for row in times]} | changes


def plane(**changes):
    return {"scenes": [scene()],
            "not_timed": [{"scene": "paper-0.9", "choice": {"method": "paper"}, "reason": "twist error 0.5 above 0.1"}],
            "provenance": {"cpu": "made up"}} | changes


class Figures(unittest.TestCase):
    def test_crossover_is_told_with_its_interval(self):
        self.assertIn("from 8 (7.5 to 8.5) cells", scaling_figure.growth(scaling()).message)

    def test_no_crossover_says_why(self):
        missing = [{"slow": DENSE, "quick": DCFFT, "cells": None, "low": None, "high": None, "remark": "not within 4 to 64"}]
        self.assertIn("not within 4 to 64", scaling_figure.growth(scaling(crossovers=missing)).message)

    def test_setup_is_told_in_applications(self):
        self.assertIn("10 by dense matrix, 64² cells", scaling_figure.setting_up(scaling()).message)

    def test_plane_says_what_reaches_an_error(self):
        message = plane_figure.draw(scene()).message
        self.assertIn("10⁻² takes 1 ms (Newton, 16² cells, tolerance 10⁻⁴)", message)
        self.assertNotIn("10⁻⁵", message)

    def test_plane_speaks_of_the_twist_by_the_best_of_all(self):
        best = scene()["time_to"][:3]
        others = [best[1] | {"method": "coulomb", "seconds": 0.5}, best[1] | {"quantity": "stick_radius", "seconds": 0.25}]
        self.assertEqual(plane_figure.draw(scene(time_to=best + others)).message,
                         "At M/M<sub>lim</sub>&nbsp;=&nbsp;0.9 a twist right to 10⁻² takes 1 ms (Newton, 16² cells, tolerance "
                         "10⁻⁴); 10⁻⁴ takes 10 ms (Newton, 64² cells, tolerance 10⁻⁴).")

    def test_plane_has_errors_against_times(self):
        figure = plane_figure.draw(scene()).figure
        self.assertEqual([axis.get_ylabel() for axis in figure.axes], ["relative error", "", ""])
        self.assertIn("time of a whole solve, s (one thread)", [text.get_text() for text in figure.findobj(Text)])
        self.assertEqual([axis.get_title() for axis in figure.axes], [title for _, title in plane_figure.PANELS])
        for axis, times in zip(figure.axes, (1, 10, 1)):
            self.assertEqual((axis.get_xscale(), axis.get_yscale()), ("log", "log"))
            points = {(*line.get_xdata(), *line.get_ydata()) for line in axis.lines[:-1]}
            self.assertEqual(points, {(1e-3, times * 1e-2), (1e-2, times * 1e-4), (0.1, times * 1e-4)})
            self.assertEqual(list(axis.lines[-1].get_xdata()), [1e-3, 1e-2])  # the envelope
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()], [
            "Newton’s method for Coulomb’s law", "full model", "envelope: nothing is quicker and as good"])

    def test_plane_points_at_the_exact_answer(self):
        for axis in plane_figure.draw(scene()).figure.axes:
            arrow, words = axis.texts[-2:]
            self.assertEqual(words.get_text(), "exact: 2.0×10⁻¹⁴")
            self.assertEqual(arrow.xy, (5e-4, axis.get_ylim()[0]))
            self.assertLess(axis.get_xlim()[0], 5e-4)
        for axis in plane_figure.draw(scene(exact=None)).figure.axes:
            self.assertEqual([note.get_text() for note in axis.texts], ["16²", "64²"])

    def test_wrong_points_are_counted_and_not_drawn(self):
        self.assertIn("their results are wrong: 1.", plane_figure.draw(scene()).details)
        with self.assertRaises(Unavailable):
            plane_figure.draw(scene(points=[POINTS[3]]))


class Page(unittest.TestCase):
    def test_stands_without_the_timings_of_parts(self):
        """An installation without a program of Google Benchmark times whole solves only."""
        for parts in (True, False):
            with tempfile.TemporaryDirectory() as name, patch.object(style, "save", save_nothing):
                folder = Path(name)
                (folder / "plane.json").write_text(json.dumps(plane()))
                if parts:
                    (folder / "scaling.json").write_text(json.dumps(scaling()))
                speed_page.render(folder, folder)
                page = (folder / "index.html").read_text()
            self.assertEqual([word in page for word in ("Time to an error", "Laws of growth", "only whole solves")], [True, parts, not parts])


class OnThePageOfAll(unittest.TestCase):
    def test_stands_there_where_it_was_measured(self):
        with tempfile.TemporaryDirectory() as name, patch.object(style, "save", save_nothing):
            folder = Path(name)
            self.assertEqual(render.show_speed(None, folder), [])
            (folder / "plane.json").write_text(json.dumps(plane()))
            self.assertEqual(render.show_speed(folder, folder), [])
            (folder / "scaling.json").write_text(json.dumps(scaling()))
            growth, one = render.show_speed(folder, folder)
        self.assertIn("Convolution overtakes", growth["message"])
        self.assertIn("a twist right to 10⁻² takes 1 ms", one["message"])


class Page(unittest.TestCase):
    def render(self, save, **parts):
        with (tempfile.TemporaryDirectory() as folder, redirect_stderr(io.StringIO()),
              patch.object(style, "save", save)):
            data = Path(folder) / "data"
            data.mkdir()
            for name, content in parts.items():
                (data / f"{name}.json").write_text(json.dumps(content))
            speed_page.render(data, Path(folder))
            return (Path(folder) / "index.html").read_text(encoding="utf-8")

    def test_is_whole(self):
        page = self.render(save_quickly, scaling=scaling(), plane=plane())
        for words in ("Convolution overtakes", "10\N{NO-BREAK SPACE}ms: 64² cells", "twist error 0.5 above 0.1", "made up", "figure-3.svg"):
            self.assertIn(words, page)
        self.assertNotIn("Not available", page)
        self.assertIn('<p class="see">Convolution overtakes', page)  # above its figure
        self.assertIn("<th scope=\"col\"><button", page)
        self.assertIn("aria-sort", page[page.index("<script>"):])  # what the buttons do

    def test_stands_where_a_part_is_missing(self):
        page = self.render(save_nothing, scaling=scaling(families=[], crossovers=[]), plane=plane())
        self.assertIn("Not available", page)
        self.assertIn("10\N{NO-BREAK SPACE}ms: 64² cells", page)
