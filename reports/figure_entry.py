"""A finished figure, and the labels that several have."""

from dataclasses import dataclass, field

from matplotlib.figure import Figure

LOAD_LABEL = "moment $M/M_\\mathrm{lim}$"
TWIST_LABEL = "twist $G a^2\\phi/(\\mu W)$"
LIMIT_WORDS = "M/M<sub>lim</sub>"
LIMIT = LIMIT_WORDS + "&nbsp;=&nbsp;"


@dataclass
class FigureEntry:
    """A finished figure and its texts, which are HTML except for the plain `alt`.

    message: one short sentence, what to see; numbers: (words, number) in the order of their weight; details: how it is
    made; sources: files of the data folder that it shows in addition to its CSV.
    """
    message: str
    details: str
    alt: str
    figure: Figure
    numbers: list = field(default_factory=list)
    sources: list = field(default_factory=list)
