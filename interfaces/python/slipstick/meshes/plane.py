"""The plane of a contact in space and its axes."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from ..errors import InputError
from .field import Array

Axis = Union[None, str, Sequence[float]]


@dataclass(frozen=True)
class Frame:
    """Unit vectors in the file's axes; x3 points from the lower body into the upper one."""

    x1: Array
    x2: Array
    x3: Array

    def in_plane(self, vectors: Array) -> Array:
        """(n, 2): the components along x1 and x2."""
        return np.asarray(np.stack([vectors @ self.x1, vectors @ self.x2], axis=1))

    def tangents(self, of_upper: bool) -> Array:
        """(2, 2): the components along x1 and x2 of t1, the x axis projected on the surface, and of t2 = n x t1; n is the outward
        normal of the lower or of the upper body. Along x the z axis takes the place of the x axis."""
        first = _projected(self.x3)
        second = np.cross(-self.x3 if of_upper else self.x3, first)
        return self.in_plane(np.stack([first, second]))

    def said(self) -> str:
        return (f"Axes: the contact's normal is {_axis_text(self.x3)}, from the lower body to the upper one; x1 is "
                f"{_axis_text(self.x1)}, x2 is {_axis_text(self.x2)}.")


def _axis_text(vector: Array) -> str:
    if abs(vector).max() == 1.0:
        return ("-" if vector.sum() < 0 else "") + "xyz"[int(abs(vector).argmax())]
    return "(" + ", ".join(f"{component:.4g}" for component in vector) + ")"


def _projected(normal: Array) -> Array:
    """The x axis projected on a plane; the z axis if x is within 0.1 degrees of the normal, as in CalculiX and Abaqus."""
    axis = np.eye(3)[2 if 1 - abs(normal[0]) < 1.5231e-6 else 0]
    along = axis - (axis @ normal) * normal
    return np.asarray(along / np.linalg.norm(along))


def given_normal(axis: Axis) -> Optional[Array]:
    """The unit vector of a word or of three components; None: none is given."""
    if axis is None:
        return None
    if isinstance(axis, str) and axis.lstrip("+-") in ("x", "y", "z"):
        return np.eye(3)["xyz".index(axis[-1])] * (-1 if axis.startswith("-") else 1)
    try:
        normal = np.array([float(part) for part in (axis.split(",") if isinstance(axis, str) else axis)])
    except ValueError:
        normal = np.empty(0)
    if normal.shape != (3,) or not np.linalg.norm(normal) > 0:
        raise InputError(f'axis = "{axis}"; allowed: x, y, z, -x, -y, -z, or three components "nx,ny,nz"')
    return np.asarray(normal / np.linalg.norm(normal))


def frame_of(contact: Array, normal: Optional[Array], source: str) -> Frame:
    """The frame of points (n, 3) in contact: with a given normal, or else in the plane nearest to them."""
    if normal is None:
        if len(contact) < 3:
            raise InputError(f"{source}: {len(contact)} points have a pressure; allowed: 3 or more, to find the contact's plane")
        normal = np.linalg.svd(contact - contact.mean(axis=0), full_matrices=False)[2][2]
        normal = normal * np.sign(normal[abs(normal).argmax()])
        if abs(normal).max() > 1 - 2e-4:  # 1 degree
            normal = np.round(normal)
    if abs(normal).max() == 1.0:
        k = int(abs(normal).argmax())
        return Frame(np.eye(3)[(k + 1) % 3], np.eye(3)[(k + 2) % 3] * normal[k], normal)
    first = _projected(normal)
    return Frame(first, np.cross(normal, first), normal)


def check_flat(contact: Array, frame: Frame, source: str) -> None:
    """Refuses a contact whose points (n, 3) leave their plane by more than a tenth of its size."""
    height, size = np.ptp(contact @ frame.x3), np.ptp(frame.in_plane(contact), axis=0).max()
    if not height <= 0.1 * size:
        raise InputError(f"{source}: the contact's surface is curved: its heights along {_axis_text(frame.x3)} differ by "
                         f"{height:.3g} over a size of {size:.3g}; allowed: at most a tenth of the size, or another normal "
                         "as --read-as axis=NX,NY,NZ")
