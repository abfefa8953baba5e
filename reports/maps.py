"""Maps over the contact circle."""

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.patches import Circle

import style
from results import Unavailable

TICKS = (-1, -0.5, 0, 0.5, 1)


def error_scale(errors):
    """Four decades down from the largest error; what is smaller takes the lowest colour."""
    largest = np.nanmax(errors)
    if not largest > 0:
        raise Unavailable("the fields equal the exact ones in every digit: nothing to draw")
    return LogNorm(largest * 1e-4, largest, clip=True)


def draw(axis, fields, values, colours, scale, stick_ratio):
    image = axis.imshow(values, origin="lower", extent=fields.extent, cmap=colours, norm=scale,
                        interpolation="nearest")
    axis.add_patch(Circle((0, 0), stick_ratio, fill=False, edgecolor=style.BLACK, linewidth=0.8))
    axis.set(xlim=(-1.07, 1.07), ylim=(-1.07, 1.07), xticks=TICKS, yticks=TICKS)
    axis.grid(False)
    return image


def label(axes):
    for axis in axes[-1, :]:
        axis.set_xlabel("$x_1/a$")
    for axis in axes[:, 0]:
        axis.set_ylabel("$x_2/a$")
