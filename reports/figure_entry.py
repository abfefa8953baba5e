"""A finished figure, and the labels that several have."""

from dataclasses import dataclass

from matplotlib.figure import Figure

LOAD_LABEL = "moment $M/M_\\mathrm{lim}$"
TWIST_LABEL = "twist $G a^2\\phi/(\\mu W)$"
LIMIT = "M/M<sub>lim</sub>&nbsp;=&nbsp;"


@dataclass
class FigureEntry:
    """A finished figure and what stands beside it. The texts are HTML, but for the plain `alt`."""
    message: str
    details: str
    alt: str
    figure: Figure
