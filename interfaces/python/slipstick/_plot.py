"""A figure of a solution's fields, for notebooks and scripts; `slipstick solve --figure` draws more."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

_ARROWS = 20  # along a side


def drawn(fields: Mapping[str, npt.NDArray[np.float64]], name: str) -> Any:
    """Pressure, traction with its direction, slip and stick, over the contact. The figure belongs to pyplot, except in notebooks,
    which show what a cell returns."""
    from matplotlib import pyplot
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure

    make: Any = Figure if "inline" in pyplot.get_backend() else pyplot.figure
    figure = make(figsize=(11, 3.6), layout="constrained")
    inside = fields["pressure"] != 0
    rows = tuple(slice(found.min(), found.max() + 1) for found in map(np.flatnonzero, (inside.any(axis=1), inside.any(axis=0))))
    cut = {key: np.where(inside, field, np.nan)[rows] for key, field in fields.items()}
    x1, x2 = (1e3 * fields[key][rows] for key in ("x1", "x2"))
    traction = np.hypot(cut["q1"], cut["q2"])
    panels = {"pressure (MPa)": 1e-6 * cut["pressure"], "traction |q| (MPa)": 1e-6 * traction, "stick": np.full_like(traction, np.nan)}
    if "slip1" in cut:  # an exact answer has none
        panels["slip (µm); blue: sticks"] = np.where(cut["stick"] != 0, np.nan, 1e6 * np.hypot(cut["slip1"], cut["slip2"]))
        del panels["stick"]
    axes = figure.subplots(1, len(panels), sharex=True, sharey=True)
    for axis, (title, values) in zip(axes, panels.items()):
        image = axis.pcolormesh(x1, x2, values, shading="nearest")
        if np.isfinite(values).any():
            figure.colorbar(image, ax=axis)
        axis.set(title=title, xlabel="x1 (mm)", aspect="equal")
    axes[2].pcolormesh(x1, x2, np.where(cut["stick"] == 1, 1.0, np.nan), shading="nearest", cmap=ListedColormap(["lightsteelblue"]))
    thin = tuple(slice(None, None, max(1, side // _ARROWS)) for side in x1.shape)
    size = np.where(traction > 0, traction, np.nan)[thin]
    axes[1].quiver(x1[thin], x2[thin], cut["q1"][thin] / size, cut["q2"][thin] / size, color="white", pivot="mid", scale=1.2 * _ARROWS)
    axes[0].set_ylabel("x2 (mm)")
    figure.suptitle(name)
    return figure
