"""How much further a sphere turns under a moment than the half-space in its place.

The surface of a sphere of radius R lies h = r^2/(2 R) inside the half-space. The lack of this layer changes the strain energy under
given tractions t by the integral of h (sigma^2 - t^2)/(2 G) over the plane, where sigma is the half-space's shear stress
sigma_r_theta there (Hadamard's formula; of first order in h). The half-space that sticks on a circle of radius c has

    t = (4 G phi/pi) r/sqrt(c^2 - r^2) inside,   sigma = (4 G phi/pi) (c/r)^2 c/sqrt(r^2 - c^2) outside,

whose squares together have a principal value: the twist grows by the part 9/(4 pi) c/R = 0.716 c/R. With slip the part is smaller,
as moments near the limit turn a small circle that sticks. Then it is known from the axisymmetric problem of torsion, in which the
displacement around the axis is the only unknown (test_mesh_curvature.py solves it by finite elements, on a flat and a curved body).

This is the sphere of linear elasticity, which carries its loads in its undeformed shape. A program that follows the deformed shape
sees no curvature in the contact and a smaller one around it, and finds less.
"""
from __future__ import annotations

import numpy as np

#: Growth of the body's own twist over a/R, for parts of the limit moment.
_MOMENTS = [0.0, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99]
_GROWTH = [9 / (4 * np.pi), 0.713, 0.706, 0.699, 0.690, 0.678, 0.659, 0.622, 0.586, 0.505]


def of_sphere(contact_radius: float, moment_ratio: float) -> float:
    """The growth of a sphere's own twist, relative to it. contact_radius: over the sphere's radius; moment_ratio: over the limit, of a
    first loading."""
    return float(contact_radius * np.interp(abs(moment_ratio), _MOMENTS, _GROWTH))
