"""The numbers that a figure shows: as CSV, and as words on its points."""

import csv
import io
import re
from html import escape

import numpy as np
from matplotlib.container import BarContainer

MAX_POINTS = 80  # of a line, to get words at its points: more are a curve


def csv_of(figure):
    """Every line and bar of a figure, a row a point: panel, series, abscissa, ordinate; "" for a figure with maps only."""
    rows = [row for panel, axis in enumerate(figure.axes, 1) for row in _points(panel, axis)]
    if not rows:
        return ""
    written = io.StringIO()
    writer = csv.writer(written, lineterminator="\n")
    writer.writerow(["panel", "series", "abscissa", "x", "ordinate", "y"])
    writer.writerows(rows)
    return written.getvalue()


def with_words(figure, svg):
    """The SVG of a figure with a <title> on each marker, which browsers show under the pointer."""
    places = {}
    scale = 72 / figure.dpi
    height = figure.get_figheight() * 72
    for panel, axis in enumerate(figure.axes, 1):
        for line, name in _lines(axis):
            points = np.column_stack(line.get_data(orig=False)).astype(float)
            if line.get_marker() in ("None", None, "", " ") or len(points) > MAX_POINTS:
                continue
            words = _names(panel, axis)
            for (x, y), (right, up) in zip(points, axis.transData.transform(points)):
                place = _place(right * scale, height - up * scale)
                series = f"{name}: " if name else ""
                places[place] = f"{series}{words[1]} {x:.4g}, {words[2]} {y:.4g}"
    return re.sub(r'<use xlink:href="(#\w+)" x="([-\d.]+)" y="([-\d.]+)"([^>]*)/>',
                  lambda use: _titled(use, places.get(_place(float(use[2]), float(use[3])))), svg)


def _titled(use, words):
    return f"{use[0][:-2]}><title>{escape(words, quote=False)}</title></use>" if words else use[0]


def _place(x, y):
    return round(x, 1), round(y, 1)


def _lines(axis):
    """The lines in the coordinates of the data, with their labels."""
    for line in axis.lines:
        if line.get_transform() == axis.transData:
            label = line.get_label()
            yield line, "" if str(label).startswith("_") else plain_words(str(label))


def _names(panel, axis):
    """The labels of a panel's abscissa and ordinate; a label that axes share stands at one of them."""
    shared = axis.get_shared_x_axes().get_siblings(axis), axis.get_shared_y_axes().get_siblings(axis)
    x = next((other.get_xlabel() for other in (axis, *shared[0]) if other.get_xlabel()), "x")
    y = next((other.get_ylabel() for other in (axis, *shared[1]) if other.get_ylabel()), "y")
    title = axis.get_title()
    return tuple(map(plain_words, (title or str(panel), x, y)))


def _points(panel, axis):
    title, x_name, y_name = _names(panel, axis)
    for line, name in _lines(axis):
        for x, y in zip(*line.get_data(orig=False)):
            if np.isfinite(float(x)) and np.isfinite(float(y)):
                yield [title, name, x_name, f"{float(x):.9g}", y_name, f"{float(y):.9g}"]
    for bars in axis.containers:
        if isinstance(bars, BarContainer):
            label = str(bars.get_label())
            for bar in bars:
                if bar.get_width() and bar.get_height():
                    yield [title, "" if label.startswith("_") else plain_words(label), x_name,
                           f"{bar.get_width():.9g}", y_name, f"{bar.get_y() + bar.get_height() / 2:.9g}"]


def plain_words(text):
    """A label without the marks that matplotlib sets mathematics by."""
    text = re.sub(r"\\mathrm\{(\w+)\}", r"\1", text)
    text = re.sub(r"\\(\w+)", lambda name: {"phi": "φ", "mu": "μ"}.get(name[1], name[1]), text)
    return " ".join(re.sub(r"[${}]", "", text).split())
