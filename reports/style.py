"""One look for every figure, and the same bytes for the same numbers."""

import io
import unicodedata

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.colors import LinearSegmentedColormap, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

import figure_data
from results import InputError
from whole_file import write_whole

# Okabe and Ito (2008): distinguished with any colour vision.
BLUE, SKY, VERMILION = "#0072B2", "#56B4E9", "#D55E00"
GREEN, PURPLE = "#009E73", "#CC79A7"
BLACK, GREY = "#000000", "#8a8a8a"

DIVERGING, SEQUENTIAL, ERRORS = "RdBu_r", "viridis", "magma_r"
SLIP = LinearSegmentedColormap.from_list("slip", ["#fdf0e7", VERMILION])
STICK = ListedColormap([SKY])

HALO = [withStroke(linewidth=2.5, foreground="white")]  # keeps text readable over lines

WIDTH = 7.2  # inches

matplotlib.rcdefaults()  # no matplotlibrc that lies about
matplotlib.rcParams.update({
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.5,
    "axes.linewidth": 0.7,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.6,
    "savefig.dpi": 220,
    "svg.hashsalt": "slipstick",
})


def verbatim(text):
    """A text of the data, as matplotlib takes it to mean itself: no mathematics, nothing that an SVG may not hold."""
    return "".join(" " if unicodedata.category(c) in ("Cc", "Cs") else c for c in text).replace("$", r"\$")


def panels(rows, columns, height, **options):
    """A figure as wide as the page and its axes."""
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


def with_error_panel(columns=1, height=5.4):
    """The quantity above, its error on a log scale below, over the same abscissa."""
    figure, axes = panels(2, columns, height, sharex=True, sharey="row", height_ratios=[3, 2], squeeze=False)
    for axis in axes[1]:
        axis.set_yscale("log")
    return figure, axes


def legend_on_top(figure, handles, columns):
    """Above all axes, where it covers no data; call it when the figure is otherwise complete."""
    lines = -(-len(handles) // columns)
    space = (0.19 * lines + 0.06) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - space))
    figure.legend(handles=handles, loc="upper center", ncol=columns, handlelength=2.6, columnspacing=1.8,
                  borderaxespad=0.1)


def whole_decades(axis):
    """Stretches a log scale that would show fewer than two powers of ten to the next ones outside."""
    low, high = np.log10(axis.get_ylim())
    if np.floor(high) - np.ceil(low) < 1:
        axis.set_ylim(10 ** np.floor(low), 10 ** np.ceil(high))


# The metadata to omit from each kind of file, so that equal numbers give equal files: the date.
FORMATS = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {}}
CANVASES = {".svg": FigureCanvasSVG, ".pdf": FigureCanvasPdf, ".png": FigureCanvasAgg}


def draw(figure, kind):
    """The bytes of a file of a kind, one of FORMATS. By the canvas itself, which lays out while it draws: Figure.savefig
    draws all of it once more before."""
    drawn = io.BytesIO()
    figure.set_dpi(matplotlib.rcParams["savefig.dpi"])
    getattr(CANVASES[kind](figure), f"print_{kind[1:]}")(drawn, metadata=FORMATS[kind])
    return drawn.getvalue()


def write(figure, path):
    """Writes one file, of the kind that its ending says. Throws InputError for an ending that is not one of FORMATS."""
    if path.suffix not in FORMATS:
        raise InputError(f"{path}: allowed endings: {', '.join(FORMATS)}")
    write_whole(path, draw(figure, path.suffix))


def save(figure, stem):
    """Writes stem.svg, stem.pdf and, except for maps, the numbers drawn as stem.csv; returns the SVG. The figure is laid out
    once for all files, since that takes as long as the rest."""
    svg = figure_data.with_words(figure, draw(figure, ".svg").decode())
    write_whole(stem.with_suffix(".svg"), svg.encode())
    figure.set_layout_engine("none")
    write(figure, stem.with_suffix(".pdf"))
    numbers = figure_data.csv_of(figure)
    if numbers:
        write_whole(stem.with_suffix(".csv"), numbers.encode())
    return svg
