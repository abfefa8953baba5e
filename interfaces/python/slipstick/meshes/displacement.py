"""Displacements of a half-space's surface under tractions that are linear on triangles.

At a point of the surface each displacement is a sum of integrals of a traction f times a kernel h(theta)/r, where (r, theta) are
polar coordinates about that point (Boussinesq and Cerruti; K. L. Johnson, Contact Mechanics, 1985, section 3.6):

    name   kernel        name   kernel
    r      1/r           v1     x1/r^2
    t11    x1^2/r^3      v2     x2/r^2
    t12    x1 x2/r^3     even   |x1 x2|/r^3

x is the vector from the traction to the point. Near triangles are integrated in closed form: with R(theta), the distance of an edge,

    integral of f h/r dA = sum over edges of the integral of h(theta) (f0 R + (g . e(theta)) R^2/2) dtheta,   f = f0 + g . x,

which is elementary for every kernel but `even`, where Gauss' rule integrates along each edge. Far triangles are integrated by a
Gauss rule, too.
"""
from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from .field import Array, Indices

Single = npt.NDArray[np.float32]

KERNELS = ("r", "t11", "t12", "v1", "v2", "even")

#: A triangle is far from a point at this distance over its longest edge: Gauss' rule is then right to 1e-4 of the triangle's part.
_FAR = 3.0
#: Barycentric coordinates of Gauss' rule of degree 2.
_GAUSS = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6
#: Pairs of a place and a quadrature point in one block: 16 MB an array.
_BLOCK = 4_000_000


def integrals(places: Array, corners: Array, densities: Array, kernels: Sequence[str] = KERNELS[:5]) -> Array:
    """The integrals of each density at each place.

    places (n, 2), m. corners (m, 3, 2), m, in any orientation. densities (m, 3, k): k linear densities by their values at the
    corners. Returns (kernels, n, k), in m times the density's unit. Far triangles are summed in single precision, about 1e-6 of the
    whole.
    """
    edge1, edge2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    double = edge1[:, 0] * edge2[:, 1] - edge1[:, 1] * edge2[:, 0]
    sizes = np.sqrt(np.max(np.sum((corners - np.roll(corners, 1, axis=1))**2, axis=2), axis=1))
    middles = corners.mean(axis=1)
    unit = np.abs(corners - middles.mean(axis=0)).max()  # keeps cubes within the range of single precision
    points = np.einsum("gc,mcd->mgd", _GAUSS, corners).reshape(-1, 2)
    weighted = (np.einsum("gc,mck->mgk", _GAUSS, densities) * np.abs(double)[:, None, None] / 6).reshape(len(points), -1)
    scale = np.maximum(np.abs(weighted).max(axis=0), np.finfo(float).tiny)
    weighted = (weighted / scale).astype(np.float32)
    scale = scale / unit
    result = np.empty((len(kernels), len(places), densities.shape[2]))
    step = max(1, _BLOCK // max(1, len(points)))
    for start in range(0, len(places), step):
        block = places[start:start + step]
        near = np.sum((block[:, None] - middles)**2, axis=2) < (_FAR * sizes)**2
        row, triangle = np.nonzero(near)
        closed = _near(block[row], corners[triangle], densities[triangle], np.sign(double)[triangle], kernels)
        x = [((block[:, d, None] - points[:, d]) / unit).astype(np.float32) for d in (0, 1)]
        part = result[:, start:start + step]
        for kernel, values in enumerate(_far(*x, kernels)):
            values.reshape(len(block), -1, len(_GAUSS))[near] = 0
            part[kernel] = (values @ weighted) * scale
            np.add.at(part[kernel], row, closed[kernel])
    return result


def _far(x1: Single, x2: Single, kernels: Sequence[str]) -> Iterator[Single]:
    """The kernels of vectors (x1, x2), one after another."""
    r2 = x1 * x1 + x2 * x2
    np.maximum(r2, np.float32(1e-12), out=r2)
    inverse = 1 / np.sqrt(r2)
    for kernel in kernels:
        if kernel == "r":
            yield inverse.copy()
        elif kernel in ("v1", "v2"):
            yield (x1 if kernel == "v1" else x2) / r2
        else:
            value = x1 * (x1 if kernel == "t11" else x2) / r2 * inverse
            yield np.abs(value) if kernel == "even" else value


def _near(places: Array, corners: Array, densities: Array, orientation: Array, kernels: Sequence[str]) -> Array:
    """The integrals of pairs of a place (n, 2) and a triangle (n, 3, 2) with densities (n, 3, k): (kernels, n, k)."""
    around = corners - places[:, None]
    at_place, gradient = _linear(around, densities)
    result = np.zeros((len(kernels), len(places), densities.shape[2]))
    for corner in range(3):
        result += _edge(around[:, corner], around[:, (corner + 1) % 3], at_place, gradient, kernels)
    result *= orientation[:, None]
    result[[kernel in ("v1", "v2") for kernel in kernels]] *= -1  # there x points from the traction to the place
    return result


def _linear(around: Array, densities: Array) -> tuple[Array, Array]:
    """The values (n, k) at the origin and gradients (n, 2, k) of linear densities on triangles."""
    edges = around[:, 1:] - around[:, :1]
    gradient = np.linalg.solve(edges, densities[:, 1:] - densities[:, :1])
    return densities[:, 0] - np.einsum("nd,ndk->nk", around[:, 0], gradient), gradient


def _frame(start: Array, end: Array) -> tuple[Array, Array, Array, Array]:
    """The frame of each edge from `start` to `end` (n, 2): the unit vector n from the origin to the edge's line, the vector t along
    it, the distance of the line and the positions of both ends along t. The distance of a line through the origin is zero."""
    along = end - start
    along /= np.hypot(along[:, 0], along[:, 1])[:, None]
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
    distance = np.sum(normal * start, axis=1)
    turned = np.where(distance < 0, -1.0, 1.0)[:, None]
    position = np.stack([np.sum(along * turned * start, axis=1), np.sum(along * turned * end, axis=1)])
    distance = np.abs(distance)
    distance[distance <= 1e-14 * np.abs(position).max(axis=0)] = 0.0
    return normal * turned, along * turned, distance, position


def _edge(start: Array, end: Array, at_origin: Array, gradient: Array, kernels: Sequence[str]) -> Array:
    """The part of one edge in the integrals, for polar coordinates about the origin: (kernels, n, k). In the edge's frame phi is the angle
    from n, and R = d/cos(phi)."""
    normal, tangent, distance, position = _frame(start, end)
    divisor = np.where(distance > 0, distance, 1.0)  # an edge whose line meets the origin sees no angle and gives nothing

    def between(value: Array) -> Array:
        return value[1] - value[0]

    tan = position / divisor
    secant = np.sqrt(1 + tan * tan)
    log, sin, cos = between(np.arcsinh(tan)), between(tan / secant), between(1 / secant)
    angle, log_cos, tan, secant = between(np.arctan(tan)), between(-np.log(secant)), between(tan), between(secant)
    n, t = normal.T, tangent.T
    g_n, g_t = np.einsum("dn,ndk->nk", n, gradient), np.einsum("dn,ndk->nk", t, gradient)

    def total(constant: Array, along_n: Array, along_t: Array) -> Array:
        linear = along_n[:, None] * g_n + along_t[:, None] * g_t
        return distance[:, None] * (constant[:, None] * at_origin + distance[:, None] / 2 * linear)

    nn, nt, tt = total(sin, sin, -cos), total(-cos, -cos, log - sin), total(log - sin, log - sin, secant + cos)
    one_n, one_t = total(angle, angle, -log_cos), total(-log_cos, -log_cos, tan - angle)

    def product(i: int, j: int) -> Array:
        return (n[i] * n[j])[:, None] * nn + (n[i] * t[j] + t[i] * n[j])[:, None] * nt + (t[i] * t[j])[:, None] * tt

    def integral(kernel: str) -> Array:
        if kernel == "r":
            return total(log, log, secant)
        if kernel == "even":
            return _even(normal, tangent, distance, position, at_origin, gradient)
        if kernel in ("v1", "v2"):
            axis = int(kernel[1]) - 1
            return n[axis][:, None] * one_n + t[axis][:, None] * one_t
        return product(int(kernel[1]) - 1, int(kernel[2]) - 1)

    return np.stack([integral(kernel) for kernel in kernels])


#: Abscissas and weights on [0, 1] of Gauss' rule along a part of an edge.
_NODES, _WEIGHTS = (lambda x, w: ((1 + x) / 2, w / 2))(*np.polynomial.legendre.leggauss(6))


def _even(normal: Array, tangent: Array, distance: Array, position: Array, at_origin: Array, gradient: Array) -> Array:
    """The kernel |x1 x2|/r^3 along edges. With t = d sinh(u) along an edge R d(theta) = d du; h bends where the edge meets an axis."""
    divisor = np.where(distance > 0, distance, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        axes = np.nan_to_num(-normal * distance[:, None] / tangent)
    low, high = np.sort(position, axis=0)
    ends = np.arcsinh(np.sort(np.column_stack([low, np.clip(axes, low[:, None], high[:, None]), high]), axis=1) / divisor[:, None])
    result = np.zeros_like(at_origin)
    for start, end in zip(ends.T, ends.T[1:]):
        for node, weight in zip(_NODES, _WEIGHTS):
            u = start + node * (end - start)
            x = normal * distance[:, None] + tangent * (distance * np.sinh(u))[:, None]
            h = np.abs(x[:, 0] * x[:, 1]) / np.maximum(np.sum(x * x, axis=1), np.finfo(float).tiny)
            linear = np.einsum("nd,ndk->nk", x, gradient) / 2
            result += (weight * (end - start) * distance * h)[:, None] * (at_origin + linear)
    return result * np.sign(position[1] - position[0])[:, None]


def triangles_of(faces: list[Indices]) -> tuple[Indices, Indices, Array, npt.NDArray[np.bool_]]:
    """Linear triangles (t, 3) over all faces, the face of each, its share, and a mask of triangles that cover each face once.
    Quadrilaterals are cut along both diagonals, with half a share each, so that no direction counts more; quadratic faces through all
    their nodes."""
    parts, rows, shares, first = [], [], [], 0
    for array in faces:
        cut = np.array(_CUTS[array.shape[1]])
        parts.append(array[:, cut].reshape(-1, 3))
        rows.append(np.repeat(np.arange(first, first + len(array)), len(cut)))
        twice = array.shape[1] == 4
        shares.append(np.tile([[0.5, cut < 2] if twice else [1.0, True] for cut in range(len(cut))], (len(array), 1)))
        first += len(array)
    share, once = np.concatenate(shares).T
    return np.concatenate(parts), np.concatenate(rows), share, once.astype(bool)


#: Triangles over the nodes of a face, by their number, in VTK's order: corners, then middles of edges, then the centre.
_CUTS = {
    3: [[0, 1, 2]],
    4: [[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]],
    6: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    8: [[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6], [4, 6, 7]],
    9: [[0, 4, 8], [0, 8, 7], [4, 1, 5], [4, 5, 8], [8, 5, 2], [8, 2, 6], [7, 8, 6], [7, 6, 3]],
}
