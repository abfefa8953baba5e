"""The gallery: a small map of each scene, and what its table says."""

import numpy as np
from markupsafe import escape
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize

import style
from cells import Cells
from figure_entry import FigureEntry
from results import Unavailable, number, rows, text, value
from wording import percent, sci

ACROSS = 6  # panels in a row
PANEL_HEIGHT = 1.42  # inches, with its two lines of text
ARROWS = 18  # along the longer side of a contact
MARGIN = 0.06  # around the contact, of its longer side


def gallery(report, data_dir):
    scenes = rows(report, "gallery")
    down = -(-len(scenes) // ACROSS)
    figure, axes = style.panels(down, ACROSS, PANEL_HEIGHT * down + 0.5, squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, scene in zip(axes.flat, scenes):
        draw_scene(axis, scene, data_dir)
    draw_key(figure, axes)
    return FigureEntry(
        message(scenes),
        "Each panel shows the contact at the end of the scene’s last step, with the share of it that sticks; "
        "panels are not to one scale.",
        f"{len(scenes)} small maps of contacts, one a scene: what sticks in blue, slip in shades of orange.", figure,
        sources=[text(scene, "fields") for scene in scenes])


SHOWN = ("paper", "ellipse", "unequal_patches", "rough_sphere")


def slip_maps(report, data_dir):
    """Stick and slip of four contacts with an arrow where a cell slips."""
    scenes = {value(scene, "scene"): scene for scene in rows(report, "gallery")}
    shown = [scenes[name] for name in SHOWN if name in scenes]
    if not shown:
        raise Unavailable("the gallery has none of the scenes that are shown here")
    figure, axes = style.panels(-(-len(shown) // 2), 2, 3.4 * -(-len(shown) // 2) + 0.5, squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, scene in zip(axes.flat, shown):
        draw_arrows(axis, draw_scene(axis, scene, data_dir))
    draw_key(figure, axes)
    return FigureEntry(
        "The middle sticks, the rest slips around the point about which the contact turns; a rough contact sticks in spots.",
        "Blue sticks, orange slips, darker where it slips further. Arrows show how the half-space’s surface slips relative to "
        "the indenter’s, which turns counterclockwise: friction on the half-space opposes them. Panels are not to one scale.",
        f"{len(shown)} maps of contacts ({', '.join(text(scene, 'title') for scene in shown)}): stick areas in blue and "
        "arrows of slip around them.", figure, [(escape(text(scene, "title")), _turn(scene)) for scene in shown],
        [text(scene, "fields") for scene in shown])


def _turn(scene):
    return f"{escape(text(scene, 'quantity'))} {number(scene, 'value'):.4g} {escape(text(scene, 'unit'))}"


def draw_arrows(axis, cells):
    slip = np.stack([cells.columns["slip1"], cells.columns["slip2"]])
    length = np.hypot(*slip)
    slips = (cells.columns["stick"] == 0) & (length > 1e-3 * length.max())
    if not slips.any():
        return
    shown = cells.thinned(slips, ARROWS)
    along = slip[:, shown] / length[shown] * cells.spacing(ARROWS) * 0.9
    axis.quiver(*cells.positions[:, shown], *along, angles="xy", scale_units="xy", scale=1, pivot="mid", width=0.004,
                headwidth=4, color=style.BLACK)


def draw_key(figure, axes):
    """What the colours of the maps say, below them."""
    figure.colorbar(ScalarMappable(Normalize(0, 1), style.SLIP), ax=axes, location="bottom", shrink=0.5, aspect=40,
                    pad=0.01, label="slip in the last step, over its largest value; blue: sticks")


def draw_scene(axis, scene, data_dir):
    cells = Cells(data_dir / text(scene, "fields"), value(scene, "cell_size"))
    sticks = cells.columns["stick"] != 0
    slip = np.where(sticks, 0, np.hypot(cells.columns["slip1"], cells.columns["slip2"]))
    largest = slip.max() or 1
    where = dict(origin="lower", extent=cells.extent, interpolation="nearest")
    axis.imshow(cells.grid(np.where(sticks, np.nan, slip / largest)), cmap=style.SLIP, norm=Normalize(0, 1), **where)
    axis.imshow(cells.grid(np.where(sticks, 1.0, np.nan)), cmap=style.STICK, **where)
    axis.add_collection(LineCollection(cells.outline(), colors=style.BLACK, linewidths=0.4, capstyle="projecting",
                                       rasterized=True))
    low, high = cells.extent[[0, 2]], cells.extent[[1, 3]]
    middle, half = 0.5 * (low + high), (0.5 + MARGIN) * max(high - low)
    (left, bottom), (right, top) = middle - half, middle + half
    axis.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    axis.set_title(style.verbatim(text(scene, "title")), fontsize=7, pad=2)
    axis.text(0.5, 0, f"{percent(np.mean(sticks))} sticks", transform=axis.transAxes, ha="center", va="top", fontsize=6,
              color=style.GREY)
    return cells


def message(scenes):
    judged = [scene for scene in scenes if value(scene, "basis") == "exact"]
    errors = np.array([abs(number(scene, "error")) for scene in judged])
    done = [scene for scene in scenes if text(scene, "status") == "converged"]
    undone = len(scenes) - len(done)
    gap = max((number(scene, "gap") for scene in done), default=np.nan)
    sentence = (f"Coulomb’s law holds in all {len(done)} scenes to gap / energy = {sci(gap)}"
                + (f"; {undone} more did not converge" if undone else ""))
    if not judged:
        return sentence + "."
    worst = judged[int(np.argmax(errors))]
    return (f"{sentence}. Half of the {len(judged)} with an exact answer are within {sci(np.median(errors))} of it; "
            f"{escape(text(worst, 'title'))} is furthest off, by {percent(errors.max())}.")
