"""The data of a figure as CSV and as words on its points."""

import csv
import re
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import figure_data  # noqa: E402
import style  # noqa: E402


def one_figure():
    figure, (left, right) = style.panels(1, 2, 3.0)
    left.plot([1, 10, 100], [0.5, float("nan"), 0.25], "s-", label="one & two")
    left.axhline(0.3)
    left.set(xscale="log", xlabel="moment $M/M_\\mathrm{lim}$", ylabel="twist $G a^2\\phi/(\\mu W)$")
    right.barh([0, 1], [3, 0], label="bars")
    right.plot(range(200), range(200), ".", label="many")
    right.set(title="panel", xlabel="scenes")
    return figure


class Csv(unittest.TestCase):
    def test_has_every_point_and_bar(self):
        table = list(csv.reader(figure_data.csv_of(one_figure()).splitlines()))
        self.assertEqual(table[0], ["panel", "series", "abscissa", "x", "ordinate", "y"])
        self.assertEqual(table[1:3], [["1", "one & two", "moment M/M_lim", x, "twist G a^2φ/(μ W)", y]
                                      for x, y in (("1", "0.5"), ("100", "0.25"))])
        self.assertEqual(sum(row[1] == "many" for row in table), 200)
        self.assertEqual([row for row in table if row[1] == "bars"], [["panel", "bars", "scenes", "3", "y", "0"]])
        self.assertEqual(len(table), 1 + 2 + 200 + 1)

    def test_of_maps_there_is_none(self):
        figure, axis = style.panels(1, 1, 3.0)
        axis.imshow([[1.0, 2.0]])
        self.assertEqual(figure_data.csv_of(figure), "")


class Words(unittest.TestCase):
    def test_stand_on_their_points(self):
        figure = one_figure()
        svg = figure_data.with_words(figure, style.draw(figure, ".svg").decode())
        found = re.findall(r'<use xlink:href="#\w+" x="([\d.]+)" y="([\d.]+)"[^>]*><title>(.*?)</title></use>', svg)
        self.assertEqual([words for _, _, words in found], [
            "one &amp; two: moment M/M_lim 1, twist G a^2φ/(μ W) 0.5", "one &amp; two: moment M/M_lim 100, twist G a^2φ/(μ W) 0.25"])
        (x1, y1, _), (x2, y2, _) = found
        self.assertLess(float(x1), float(x2))
        self.assertLess(float(y1), float(y2))  # downwards: 0.5 stands above 0.25
