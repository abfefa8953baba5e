#!/usr/bin/env python3
"""pictures.py SCENE FIELD OUTPUT NAME=FIELD...: two pictures for the guide on finite elements. OUTPUT/mesh.svg: the contact faces of
FIELD, coloured by friction used. OUTPUT/mistakes.svg: shear around the axis and along the radius of each named field over the radius,
at half of the limit moment, with the exact one. Needs the Python package."""

import sys
from pathlib import Path

import numpy as np
from slipstick import exact
from slipstick.meshes.read import read

sys.path.insert(0, str(Path(__file__).resolve().parent))
from elements import Sphere  # noqa: E402

COLOURS = ("#1f4e79", "#c0392b", "#d68910", "#5b7f3a")
SHADES = 12
LOW, HIGH, END = -0.6, 0.65, 1.2  # of the curves


def shade(part):
    """From white (no friction used) over blue to dark blue; red: it slips."""
    if part >= 0.98:
        return "#c0392b"
    step = round(part * SHADES) / SHADES
    return "#" + "".join(f"{round(a + step * (b - a)):02x}" for a, b in zip((245, 248, 252), (31, 78, 121)))


def text(x, y, words, more=""):
    return f'<text x="{x:.0f}" y="{y:.0f}" font-family="sans-serif" font-size="13" {more}>{words}</text>'


def svg(width, height, parts):
    body = "\n".join(parts)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}">\n'
            f'<rect width="{width}" height="{height}" fill="white"/>\n{body}\n</svg>\n')


def mesh_picture(sphere, field):
    size, radius = 360, 1e-3 * sphere.contact_radius
    used = np.hypot(*field.traction.T) / np.maximum(sphere.friction * field.pressure, 1e-30)
    used[field.pressure <= 0] = np.nan
    paths, row = {}, 0
    for faces in field.faces:
        for face in faces:
            corners = size / 2 + field.vertices[face] / radius * 150 * [1, -1]
            colour = "#ffffff" if np.isnan(used[row]) else shade(used[row])
            paths.setdefault(colour, []).append("M" + "L".join(f"{x:.0f} {y:.0f}" for x, y in corners) + "Z")
            row += 1
    parts = [f'<path d="{"".join(each)}" fill="{colour}" stroke="#888" stroke-width="0.3"/>' for colour, each in paths.items()]
    parts += [f'<circle cx="{size / 2}" cy="{size / 2}" r="150" fill="none" stroke="black"/>',
              f'<rect x="{size + 10}" y="40" width="16" height="16" fill="#c0392b"/>', text(size + 32, 53, "slips: |q| = μp"),
              *(f'<rect x="{size + 10}" y="{70 + 16 * k}" width="16" height="16" fill="{shade(1 - 0.25 * k - 0.03)}"/>'
                + text(size + 32, 83 + 16 * k, f"|q| = {1 - 0.25 * k:g} μp" if k else "sticks: |q| below μp") for k in range(5)),
              text(size + 10, 180, "circle: Hertz’s radius")]
    return svg(size + 190, size, parts)


def profile(sphere, field):
    """Radii over the contact's, shear around the axis and along the radius over mu p0: means of 24 rings."""
    radius = 1e-3 * sphere.contact_radius
    r = np.hypot(*field.points.T)
    x, y = (field.points / np.maximum(r, 1e-30)[:, None]).T
    q1, q2 = field.traction.T
    ring = np.minimum((24 * r / (END * radius)).astype(int), 24)
    count = np.bincount(ring, minlength=25)[:24]
    unit = sphere.friction * 1.5e6 * sphere.load / (np.pi * sphere.contact_radius**2)
    quantities = (r / radius, (x * q2 - y * q1) / unit, (x * q1 + y * q2) / unit)
    return np.array([np.bincount(ring, each, minlength=25)[:24][count > 0] / count[count > 0] for each in quantities])


def mistakes_picture(sphere, named):
    width, height, left, top = 300, 220, 50, 30
    parts = []

    def line(panel, r, values, style):
        points = " ".join(f"{left + panel * (width + 40) + width * a / END:.1f},{top + height * (1 - (b - LOW) / (HIGH - LOW)):.1f}" 
                          for a, b in zip(r, values) if a <= END)
        parts.append(f'<polyline points="{points}" fill="none" {style}/>')

    radii = np.linspace(0, 1, 121)
    for panel, title in enumerate(("shear around the axis, over μp₀", "shear along the radius, over μp₀")):
        start = left + panel * (width + 40)
        parts.append(f'<rect x="{start}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#888"/>')
        parts.append(text(start, top - 10, title))
        for value in (-0.4, -0.2, 0, 0.2, 0.4, 0.6):
            parts.append(text(start - 8, top + 4 + height * (1 - (value - LOW) / (HIGH - LOW)), f"{value:g}", 'text-anchor="end"'))
        for value in (0, 0.5, 1):
            parts.append(text(start + width * value / END, top + height + 17, f"{value:g}", 'text-anchor="middle"'))
        parts.append(text(start + width, top + height + 17, "r/a", 'text-anchor="end"'))
        line(panel, radii, exact.traction(radii, 0.5) if panel == 0 else 0 * radii, 'stroke="black" stroke-width="4" opacity="0.25"')
        for colour, field in zip(COLOURS, named.values()):
            r, *shears = profile(sphere, field)
            line(panel, r, shears[panel], f'stroke="{colour}" stroke-width="1.6"')
    for k, (colour, name) in enumerate(zip(("#bbbbbb", *COLOURS), ("exact", *named))):
        x, y = left + 230 * (k % 3), top + height + 42 + 20 * (k // 3)
        parts.append(f'<rect x="{x}" y="{y - 8}" width="18" height="4" fill="{colour}"/>' + text(x + 24, y, name))
    return svg(2 * width + 2 * left + 20, top + height + 76, parts)


def main(scene, field, output, *named):
    sphere, output = Sphere(scene), Path(output)
    fields = {name: read(file, kind="faces", units="mm,MPa") for name, file in (each.split("=", 1) for each in named)}
    (output / "mesh.svg").write_text(mesh_picture(sphere, read(field, kind="faces", units="mm,MPa")))
    (output / "mistakes.svg").write_text(mistakes_picture(sphere, fields))


if __name__ == "__main__":
    main(*sys.argv[1:])
