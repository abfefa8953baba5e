"""The contact cells of a solution on their grid, and their maps."""

import numpy as np

from results import Columns, Unavailable

ARROWS_ALONG = 24  # the longer side of the contact's bounding rectangle


def least_distance(positions):
    """Between different positions along an axis, but for rounding."""
    steps = np.diff(np.sort(positions))
    if not np.any(steps):
        raise Unavailable("cells of unknown size on one line cannot be drawn")
    return steps[steps > 1e-6 * steps.sum()].min()


class Cells:
    """Lengths over `unit` metres; a cell size of None is taken to be the least distance of cells. Arrays over the contact's
    bounding rectangle have rows along x2, columns along x1.
    """

    def __init__(self, path, cell_size=None, unit=1.0):
        self.columns = Columns(path)
        positions = np.stack([self.columns["x1"], self.columns["x2"]]) / unit
        self.size = np.array(cell_size or [least_distance(x) for x in positions])
        low = positions.min(axis=1)
        steps = (positions - low[:, None]) / self.size[:, None]
        if not np.allclose(steps, np.round(steps), rtol=0, atol=1e-3):
            raise Unavailable(f"{path.name}: the cells stand on no grid of cells of {self.size} m")
        self.positions = positions
        self.i, self.j = np.round(steps).astype(int)
        self.shape = (self.j.max() + 1, self.i.max() + 1)
        high = low + self.size * self.shape[::-1]
        self.extent = np.array([low[0], high[0], low[1], high[1]]) - np.repeat(self.size / 2, 2)

    def grid(self, values):
        """One value for each contact cell, put on the grid; NaN outside the contact."""
        result = np.full(self.shape, np.nan)
        result[self.j, self.i] = values
        return result

    def outline(self):
        """The contact's edge as segments between cell corners: an array of (begin, end) points."""
        inside = np.zeros(np.add(self.shape, 2), dtype=bool)
        inside[self.j + 1, self.i + 1] = True
        segments = []
        for axis, along in ((0, (1, 0)), (1, (0, 1))):  # between two rows, along x1; between two columns, along x2
            j, i = np.nonzero(np.diff(inside, axis=axis))
            end = np.stack([i, j], axis=1)
            segments.append(np.stack([end - along, end], axis=1))
        corner = self.extent[[0, 2]]
        return corner + self.size * np.concatenate(segments)

    def longer_side(self):
        return max(self.extent[1] - self.extent[0], self.extent[3] - self.extent[2])

    def spacing(self):
        """The distance of arrows in metres: whole cells."""
        cell = self.size.max()
        return cell * np.ceil(self.longer_side() / cell / ARROWS_ALONG)

    def thinned(self, where):
        """Indices of those cells among `where` that stand nearest to the middle of a square of arrows."""
        squares = (self.positions[:, where] - self.extent[[0, 2], None]) / self.spacing()
        square = np.floor(squares)
        distance = np.hypot(*(squares - square - 0.5))
        order = np.lexsort((distance, square[1], square[0]))
        _, first = np.unique(square[:, order], axis=1, return_index=True)
        return np.flatnonzero(where)[order[first]]
