"""geometry.py FILE: draws the contact as the pages describe it: a section through sphere and half-space, and the contact
area seen from the sphere, with axes, signs, stick area and slip ring. The proportions are not true: a real contact is far
smaller than its sphere. The picture in README.md is docs/geometry.svg."""
import pathlib
import sys

import numpy as np
from matplotlib.patches import Circle, FancyArrowPatch, Polygon

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "reports"))
import style

SPHERE, HALF_SPACE, STICK, SLIP = "#e9edf1", "#d7dde3", "#9bcdec", "#f6c9a8"
DARK = "#444444"
STICK_RATIO = 0.55  # a_s/a, at 0.86 of the limit moment


def arrow(axes, begin, end, colour=style.BLACK, width=1.4, both=False, bend=0.0):
    axes.add_patch(FancyArrowPatch(begin, end, arrowstyle="<|-|>" if both else "-|>", mutation_scale=10, color=colour,
                                   linewidth=width, shrinkA=0, shrinkB=0, connectionstyle=f"arc3,rad={bend}", zorder=5))


def label(axes, x, y, text, colour=style.BLACK, **where):
    axes.text(x, y, text, color=colour, fontsize=9.5, zorder=6, **{"ha": "center", "va": "center", **where})


def polar(radius, degrees):
    return radius * np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])


def section(axes):
    radius, contact, edge, floor, layer = 1.7, 0.85, 2.7, -1.5, 0.07
    centre = np.sqrt(radius**2 - contact**2)
    top = centre + radius
    flat = np.degrees(np.arcsin(contact / radius))
    outline = [polar(radius, angle) + [0, centre] for angle in np.linspace(-90 + flat, 270 - flat, 200)]
    axes.add_patch(Polygon(outline, facecolor=SPHERE, edgecolor=style.BLACK, linewidth=1.2))
    axes.add_patch(Polygon([(-edge, 0), (edge, 0), (edge, floor), (-edge, floor)], facecolor=HALF_SPACE))
    axes.plot([-edge, edge], [0, 0], color=style.BLACK, linewidth=1.2)
    stuck = STICK_RATIO * contact
    for begin, end, colour in [(-contact, -stuck, SLIP), (-stuck, stuck, STICK), (stuck, contact, SLIP)]:
        axes.add_patch(Polygon([(begin, -layer), (end, -layer), (end, layer), (begin, layer)],
                               facecolor=colour, edgecolor=style.BLACK, linewidth=0.7, zorder=4))
    for x in (-contact, contact):
        axes.plot([x, x], [-0.14, -0.5], color=DARK, linewidth=0.7)
    arrow(axes, (-contact, -0.4), (contact, -0.4), DARK, 0.9, both=True)
    label(axes, 0, -0.68, "contact, $2a$", DARK)
    arrow(axes, (0, 0), (edge - 0.1, 0))
    label(axes, edge - 0.2, 0.24, "$x_1$")
    arrow(axes, (0, 0), (0, 1.15))
    label(axes, 0.14, 1.0, "$x_3$", ha="left")
    arrow(axes, (0, centre), polar(radius, 25) + [0, centre], DARK, 0.9)
    axes.plot(0, centre, "o", color=DARK, markersize=3)
    label(axes, 0.68, centre + 0.53, "$R$", DARK)
    arrow(axes, (0, top + 1.05), (0, top), style.VERMILION, 2)
    label(axes, 0, top + 1.22, "load $W$", style.VERMILION)
    ring = [polar(1, angle) * [0.55, 0.15] + [0, top + 0.5] for angle in np.linspace(-205, 20, 80)]
    axes.plot(*np.transpose(ring[:-5]), color=style.BLUE, linewidth=2, zorder=6)
    arrow(axes, ring[-12], ring[-1], style.BLUE, 2, bend=0.1)
    label(axes, 0.75, top + 0.5, "moment $M$", style.BLUE, ha="left")
    label(axes, -0.85, centre + 0.1, "sphere\n(upper)")
    label(axes, 0, floor + 0.28, "half-space (lower)")
    axes.set(xlim=(-edge, edge), ylim=(floor, top + 1.35))


def contact_area(axes):
    axes.add_patch(Circle((0, 0), 1, facecolor=SLIP, edgecolor=style.BLACK, linewidth=1.2))
    axes.add_patch(Circle((0, 0), STICK_RATIO, facecolor=STICK, edgecolor=style.BLACK, linewidth=1.0, linestyle="--"))
    arrow(axes, (0, 0), (1.4, 0))
    label(axes, 1.38, -0.13, "$x_1$")
    arrow(axes, (0, 0), (0, 1.4))
    label(axes, -0.14, 1.33, "$x_2$")
    for distance, length, angles in [(0.37, 0.18, range(45, 360, 90)), (0.76, 0.36, np.arange(22.5, 360, 45))]:
        for angle in angles:  # the sphere drags the half-space along (-x2, x1)
            half = length / 2 * polar(1, angle + 90)
            arrow(axes, polar(distance, angle) - half, polar(distance, angle) + half, DARK, 0.9)
    arrow(axes, polar(1.2, 20), polar(1.2, 65), style.BLUE, 2, bend=0.2)
    label(axes, 1.0, 1.2, "$M > 0$: the sphere\nturns from $x_1$ to $x_2$", style.BLUE, ha="left")
    for degrees, length, text, aside in [(-90, 1, "$a$", 0.66), (180, STICK_RATIO, "$a_s$", 0.5)]:
        arrow(axes, (0, 0), polar(length, degrees), DARK, 0.9)
        label(axes, *(aside * polar(length, degrees) + 0.1 * polar(1, degrees + 90)), text)
    for tip, y, text in [(polar(0.9, -12), -0.4, "slip ring: $|q| = \\mu p$"),
                         (polar(0.5, -45), -0.72, "stick area: $|q| < \\mu p$")]:
        axes.plot([tip[0], 1.17], [tip[1], y], color=DARK, linewidth=0.7, zorder=5)
        label(axes, 1.2, y, text, ha="left")
    label(axes, 1.2, -1.1, "arrows: traction $q$ on\nthe half-space", DARK, ha="left")
    axes.set(xlim=(-1.05, 2.75), ylim=(-1.4, 1.5))


def sketch():
    figure, (left, right) = style.panels(1, 2, 3.1, width_ratios=[1, 1.22])
    figure.set_figwidth(5.6)  # so that the letters are legible on a telephone
    for axes, draw, title in [(left, section, "Section"), (right, contact_area, "Contact area, seen from the sphere")]:
        draw(axes)
        axes.set_title(title)
        axes.set_aspect("equal")
        axes.set_axis_off()
    return figure


if __name__ == "__main__":
    style.write(sketch(), pathlib.Path(sys.argv[1]))
