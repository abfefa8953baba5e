"""The figure of one solve, from made-up contacts of every shape: right where one can count, and complete."""

import io
import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree
from contextlib import redirect_stderr

import h5py
import numpy as np
from matplotlib.quiver import QuiverKey

from made_report import REPORTS, Folder

import solve_figure
from cells import ARROWS_ALONG, Cells
from results import Unavailable, load

CELL = (2e-6, 1e-6)


def result(**changes):
    return {"name": "made up", "status": "converged", "method": "coulomb", "cells": [8, 8], "cell_size": list(CELL),
            "normal_load": 3.0, "friction": 0.1, "moment": 2e-6, "moment_ratio": 0.4, "twist_angle": 1.5e-3,
            "certificate": {"gap": 4e-9}} | changes


def disc(n1, n2, x1=0.0, x2=0.0):
    """Cells (i, j) of the ellipse that fills a rectangle of cells, and their centres, off the origin."""
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n1), np.arange(n2)))
    inside = np.hypot((2 * i + 1) / n1 - 1, (2 * j + 1) / n2 - 1) < 1
    return x1 + CELL[0] * i[inside], x2 + CELL[1] * j[inside]


class Figure(Folder):
    def setUp(self):
        super().setUp()
        self.fields = self.folder / "fields.h5"

    def write(self, x1, x2, changes=None, **columns):
        """Slips where x1 is above its mean: (0, 1) nm, against a traction of 2 MPa under 50 MPa."""
        slips = x1 > x1.mean()
        values = {"x1": x1, "x2": x2, "pressure": np.full(x1.size, 5e7), "q1": np.zeros(x1.size),
                  "q2": np.full(x1.size, -2e6), "slip1": np.zeros(x1.size), "slip2": 1e-9 * slips,
                  "stick": 1.0 - slips} | columns
        with h5py.File(self.fields, "w") as file:
            for name, column in values.items():
                if column is not None:
                    file[name] = column
        (self.folder / "result.json").write_text(json.dumps(result(**(changes or {}))))

    def solved(self):
        content = load(self.folder / "result.json")
        return solve_figure.Solved(content, Cells(self.fields, content["cell_size"]))

    def arguments(self, name):
        return [str(self.folder / "result.json"), str(self.fields), "--output", str(self.folder / name)]

    def draw_without_file(self):
        """All but the layout and the file, which take most of the time."""
        figure = solve_figure.draw(self.solved())
        figure.set_layout_engine("none")
        figure.draw_without_rendering()

    def run_script(self, name="figure.svg"):
        """Exit code and output."""
        with redirect_stderr(io.StringIO()) as errors:
            exit_code = solve_figure.main(self.arguments(name))
        return exit_code, errors.getvalue()


class Maps(Figure):
    def test_have_their_rows_along_x2(self):
        with h5py.File(self.folder / "map.h5", "w") as file:
            for name, values in (("x1", [-2, 2, -2]), ("x2", [-2, -2, 0]), ("q1", [1, 2, 3])):
                file[name] = np.array(values, float)
        cells = Cells(self.folder / "map.h5", (1.0, 1.0), 2.0)
        np.testing.assert_array_equal(cells.grid(cells.columns["q1"]), [[1, np.nan, 2], [3, np.nan, np.nan]])
        np.testing.assert_array_equal(cells.extent, [-1.5, 1.5, -1.5, 0.5])


    def test_of_csv_are_those_of_hdf5(self):
        """A program without HDF5 writes CSV, which has every digit."""
        x1, x2 = disc(9, 5, 1 / 3, 1e-7)
        self.write(x1, x2)
        table = np.column_stack([x1, x2, x1 / 7])
        np.savetxt(self.folder / "map.csv", table, "%.17g", ",", header="x1,x2,q1", comments="")
        cells = Cells(self.folder / "map.csv", CELL)
        np.testing.assert_array_equal(cells.columns["q1"], x1 / 7)
        np.testing.assert_array_equal(cells.extent, Cells(self.fields, CELL).extent)
        (self.folder / "map.csv").write_text("x1,x2\n1,a\n")
        with self.assertRaisesRegex(Unavailable, "map.csv cannot be read"):
            Cells(self.folder / "map.csv", CELL)


class Names(Figure):
    def test_are_text_whatever_they_look_like(self):
        """No mathematics, no markup, nothing that an SVG may not hold; a name may begin with a dash."""
        self.write(*disc(9, 5), changes={"name": "<script>$\\frac{$ & \x01\x1b", "steps": [{"name": "$^"}]})
        self.assertEqual(self.run_script("-x \"y'.svg"), (0, ""))
        content = (self.folder / "-x \"y'.svg").read_text(encoding="utf-8")
        xml.etree.ElementTree.fromstring(content)
        self.assertNotIn("<script", content)


    def test_the_last_step_is_called_the_last(self):
        for names, words in ((["1", "2"] * 3, "end of step 6 of 6"), (["a push", "and a push"], "end of step 2 of 2, “and a push”")):
            self.write(*disc(9, 5), changes={"steps": [{"name": name} for name in names]})
            parts = solve_figure.details(self.solved()).replace("\N{NO-BREAK SPACE}", " ").split("  ·  ")
            self.assertIn(words, parts)


class Histories(Figure):
    STEPS = [{"name": f"{k}", "moment": 1e-6 * m, "twist_angle": 1e-3 * m * abs(m), "moment_limit": 5e-6} for k, m in
             enumerate((1, 2, 1, -1))]

    def test_a_loop_is_drawn_next_to_the_last_step(self):
        self.write(*disc(9, 5), changes={"steps": self.STEPS})
        axis = solve_figure.draw(self.solved()).axes[-1]
        self.assertEqual((axis.get_xlabel(), axis.get_ylabel()), ("twist, mrad", "moment, µN m"))
        loop, shown = axis.lines
        np.testing.assert_allclose(loop.get_data(), ([1, 4, 1, -1], [1, 2, 1, -1]))
        np.testing.assert_allclose(shown.get_data(), ([-1], [-1]))

    def test_without_moments_force_is_drawn_against_displacement(self):
        steps = [{"name": f"{k}", "moment": 1e-22, "moment_limit": 5e-6, "force": (3 * f, 4 * f), "displacement": (3e-9 * f, 4e-9 * f)}
                 for k, f in enumerate((1.0, -0.5))]
        self.write(*disc(9, 5), changes={"steps": steps})
        axis = solve_figure.draw(self.solved()).axes[-1]
        self.assertEqual((axis.get_xlabel(), axis.get_ylabel()), ("displacement, nm", "force, N"))
        np.testing.assert_allclose(axis.lines[0].get_data(), ([5, -2.5], [5, -2.5]))

    def test_each_step_gets_a_file_of_its_own(self):
        self.write(*disc(9, 5), changes={"steps": self.STEPS[:2]})
        for step in (1, 2):
            shutil.copy(self.fields, self.folder / f"fields-{step}.h5")
        words = [str(self.folder / "result.json"), str(self.folder / "fields-{step}.h5"), "--output"]
        self.assertEqual(solve_figure.main([*words, str(self.folder / "slip-{step}.svg")]), 0)
        texts = [(self.folder / f"slip-{step}.svg").read_text(encoding="utf-8") for step in (1, 2)]
        self.assertNotEqual(*texts)


class WhatItShows(Figure):
    def test_cells_stand_where_they_are(self):
        self.write(*disc(9, 5, x1=1e-3, x2=-4e-3), pressure=1e6 * (1.0 + np.arange(disc(9, 5)[0].size)))
        image = solve_figure.draw(self.solved()).axes[2].images[0]
        self.assertEqual(image.origin, "lower")
        values, (left, right, low, high) = image.get_array(), image.get_extent()
        self.assertEqual(values.shape, (5, 9))
        np.testing.assert_allclose([left, right, low, high], [999, 1017, -4000.5, -3995.5])  # micrometres
        x1, x2 = disc(9, 5)
        for k in range(x1.size):
            self.assertAlmostEqual(values[round(x2[k] / CELL[1]), round(x1[k] / CELL[0])], 1.0 + k)  # MPa
        self.assertEqual(np.count_nonzero(~np.ma.getmaskarray(values)), x1.size)

    def test_outline_encloses_the_contact_with_its_holes(self):
        x1, x2 = disc(7, 7)
        hole = (np.round(x1 / CELL[0]) == 3) & (np.round(x2 / CELL[1]) == 3)
        self.write(x1[~hole], x2[~hole])
        segments = self.solved().cells.outline()
        begin, end = segments[:, 0], segments[:, 1]
        cells = {(round(a / CELL[0]), round(b / CELL[1])) for a, b in zip(x1[~hole], x2[~hole])}
        sides = sum((i + di, j + dj) not in cells for i, j in cells for di, dj in ((1, 0), (-1, 0), (0, 1), (0, -1)))
        self.assertEqual(len(segments), sides)
        lengths = np.abs(end - begin)
        self.assertTrue(np.all(np.isclose(lengths, (CELL[0], 0), atol=1e-12).all(axis=1)
                               | np.isclose(lengths, (0, CELL[1]), atol=1e-12).all(axis=1)))
        middles = {tuple(np.round(2 * (m - segments.min(axis=(0, 1))) / CELL).astype(int)) for m in (begin + end) / 2}
        self.assertTrue({(6, 7), (8, 7), (7, 6), (7, 8)} <= middles)  # the hole's own sides, in half cells

    def test_arrows_point_along_the_slip_and_its_key_is_no_longer_than_the_longest(self):
        self.write(*disc(64, 64))
        arrows = solve_figure.draw(self.solved()).axes[0].collections[0]
        self.assertTrue(np.all(arrows.U == 0) and np.all(arrows.V == 1e-9))
        self.assertTrue(np.all(arrows.X > np.mean(disc(64, 64)[0]) * 1e6))
        self.assertLessEqual(len(arrows.U), ARROWS_ALONG**2)
        self.assertEqual([solve_figure.round_down(x) for x in (1e-9, 1.9, 3.0, 0.07)], [1e-9, 1.0, 2.0, 0.05])

    def test_key_of_the_arrows_stands_above_their_panel(self):
        self.write(*disc(9, 5), slip2=3e-9 * (disc(9, 5)[0] > disc(9, 5)[0].mean()))
        solved = self.solved()
        keys = [child for child in solve_figure.draw(solved).axes[0].get_children() if isinstance(child, QuiverKey)]
        self.assertEqual([(key.U, key.text.get_text()) for key in keys], [(2e-9, "2 nm")])
        self.assertTrue(0 < (keys[0].Y - 1) * solved.panel_height < 0.2)  # inches

    def test_traction_however_small(self):
        x1, x2 = disc(8, 8)
        self.write(x1, x2, q2=np.full(x1.size, -0.5))
        self.assertEqual([bar.get_ylabel() for bar in solve_figure.draw(self.solved()).axes[3:]],
                         ["slip, nm", "|q|, Pa", "p, MPa"])
        self.write(x1, x2, q2=np.zeros(x1.size))
        axes = solve_figure.draw(self.solved()).axes
        self.assertEqual([bar.get_ylabel() for bar in axes[3:]], ["slip, nm", "p, MPa"])
        self.assertEqual([text.get_text() for text in axes[1].texts], ["no tangential traction"])

    def test_words_stand_above_the_panels_one_below_the_other(self):
        self.write(*disc(9, 5))
        figure = solve_figure.draw(self.solved())
        (_, _, _, panels), height = figure.get_layout_engine().get()["rect"], figure.get_figheight()
        message, details = figure.texts
        self.assertIn("of the contact sticks", message.get_text())
        self.assertIn("gap/energy", details.get_text())
        for words in figure.texts:
            self.assertTrue(0 < words.get_position()[0] < 0.1)
        top, below = (words.get_position()[1] for words in figure.texts)
        self.assertTrue(panels < below < top < 1)
        self.assertGreater((top - below) * height, message.get_size() / 72)  # inches

    def test_message_and_details(self):
        self.write(*disc(8, 8))
        self.assertEqual(solve_figure.message(self.solved()),
                         "50\N{NO-BREAK SPACE}% of the contact sticks, the rest slips by up to 1 nm")
        details = solve_figure.details(self.solved()).replace("\N{NO-BREAK SPACE}", " ")
        for words in ("made up", "8 × 8 cells", "normal load 3 N", "2e−06 N m = 0.4 of the limit", "twist 1.5 mrad",
                      "gap/energy = 4.0×10⁻⁹"):
            self.assertIn(words, details)

    def test_message_of_the_extremes(self):
        x1, x2 = disc(8, 8)
        all_of, none = np.ones(x1.size), np.zeros(x1.size)
        for changes, columns, words in (
                ({}, {"stick": all_of}, "All of the contact sticks"),
                ({}, {"stick": none, "slip2": 3e-6 * all_of}, "All of the contact slips by up to 3 µm"),
                ({"friction": 0.0}, {"q2": none, "stick": none}, "No friction"),
                ({"moment": 0.0}, {"q2": none, "stick": all_of}, "No tangential traction"),
                ({"status": "not_converged"}, {"stick": all_of}, "NOT CONVERGED: All of the contact sticks")):
            self.write(x1, x2, changes, **columns)
            self.assertEqual(solve_figure.message(self.solved()), words)
            self.draw_without_file()


class AnyContact(Figure):
    def assert_drawn(self, name="figure.svg"):
        self.assertEqual(self.run_script(name), (0, ""))
        self.assertLess((self.folder / name).stat().st_size, 3_000_000)

    def test_as_a_program_in_every_format_and_equal_files_for_equal_results(self):
        self.write(*disc(9, 9))
        run = subprocess.run([sys.executable, "-B", str(REPORTS / "solve_figure.py"), *self.arguments("one.svg")],
                             capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))
        for name, magic in (("figure.pdf", b"%PDF"), ("figure.png", b"\x89PNG"), ("figure.svg", b"<?xml")):
            self.assert_drawn(name)
            self.assertTrue((self.folder / name).read_bytes().startswith(magic))
        self.assertEqual((self.folder / "one.svg").read_bytes(), (self.folder / "figure.svg").read_bytes())

    def test_shapes(self):
        for n1, n2 in ((1, 1), (2, 1), (3, 90), (200, 4)):
            with self.subTest(cells=(n1, n2)):
                self.write(*disc(n1, n2, x1=5e-4))
                self.draw_without_file()

    def test_many_spots(self):
        spots = np.random.default_rng(1).random((256, 256)) < 0.3  # 55,000 segments: 8 MB, were they not pixels
        j, i = np.nonzero(spots)
        self.write(CELL[0] * i, CELL[1] * j)
        self.assert_drawn()

    def test_exact_solution_has_no_slip_and_no_grid(self):
        self.write(*disc(9, 9), {"method": "exact", "certificate": None, "cells": None, "cell_size": None}, slip1=None,
                   slip2=None)
        np.testing.assert_allclose(self.solved().cells.size, CELL)
        self.assertEqual(solve_figure.message(self.solved()).split()[-1], "slips")
        self.assert_drawn()


class Refusals(Figure):
    def assert_refused(self, words, name="figure.svg"):
        exit_code, errors = self.run_script(name)
        self.assertEqual(exit_code, 2)
        self.assertIn(words, errors)

    def test_what_cannot_be_drawn(self):
        self.write(*disc(9, 9))
        self.assert_refused("allowed endings: .svg, .pdf, .png", "figure.jpg")
        self.assert_refused("No such file", "nowhere/figure.svg")
        self.write(*disc(9, 9), {"cell_size": [3e-6, 1e-6]})
        self.assert_refused("no grid of cells")
        self.write(*disc(9, 9), pressure=None)
        self.assert_refused("no dataset “pressure”")
        self.write(*disc(9, 9), pressure=np.full(disc(9, 9)[0].size, np.nan))
        self.assert_refused("not numbers")
        self.fields.unlink()
        self.assert_refused("fields.h5 cannot be read")
        (self.folder / "result.json").write_text("{")
        self.assert_refused("result.json")

    def test_one_cell_of_unknown_size(self):
        self.write(*disc(1, 1), {"cell_size": None})
        self.assert_refused("unknown size")

    def test_unknown_grid(self):
        self.write(np.array([0.0, 1.0, 2.5]), np.zeros(3), {"cell_size": [1.0, 1.0]})
        with self.assertRaises(Unavailable):
            self.solved()
