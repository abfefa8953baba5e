#!/usr/bin/env python3
"""Draws the stresses below the surface that `slipstick solve --stresses FILE.vtr` wrote: two planes through the largest one."""

import argparse
import re
import sys
from pathlib import Path

import script

script.require("numpy", "matplotlib")

import numpy as np  # noqa: E402
from matplotlib.ticker import MaxNLocator  # noqa: E402

import style  # noqa: E402
from results import InputError  # noqa: E402
from wording import LENGTHS, STRESSES, quantity, unit_for  # noqa: E402


def read_volume(file):
    """x1, x2 and depths in m, and fields in Pa by depth, x2 and x1, of a rectilinear grid as `solve --stresses` writes it."""
    data = Path(file).read_bytes()
    mark = re.search(rb"<AppendedData[^>]*>\s*_", data)
    if mark is None:
        raise InputError(f"{file}: no volume of stresses; allowed: a .vtr file of slipstick solve --stresses")
    header = data[:mark.start()].decode()
    axes = [np.array(re.search(f'Name="{name}"[^>]*>([^<]*)<', header)[1].split(), float) for name in ("x1", "x2", "x3")]
    shape = [len(axis) for axis in reversed(axes)]
    fields = {}
    for name, offset in re.findall(r'Name="(\w+)" format="appended" offset="(\d+)"', header):
        fields[name] = np.frombuffer(data, np.float32, int(np.prod(shape)), mark.end() + int(offset) + 8).reshape(shape)
    return *axes, fields


def largest_shear(stress):
    """Half the difference of the extreme principal stresses, of components by name."""
    tensor = np.empty((*stress["s11"].shape, 3, 3))
    for name in ("s11", "s22", "s33", "s12", "s13", "s23"):
        i, j = int(name[1]) - 1, int(name[2]) - 1
        tensor[..., i, j] = tensor[..., j, i] = stress[name]
    principal = np.linalg.eigvalsh(tensor)
    return (principal[..., 2] - principal[..., 0]) / 2


def draw(file):
    x1, x2, depths, fields = read_volume(file)
    at = np.unravel_index(fields["von_mises"].argmax(), fields["von_mises"].shape)
    most = float(fields["von_mises"][at])
    length_name, length = unit_for(max(np.ptp(x1), np.ptp(x2), depths[-1]), LENGTHS)
    pressure_name, pressure = unit_for(most, STRESSES)
    planes = [({name: field[:, at[1], :] for name, field in fields.items()}, x1, x1[at[2]], "$x_1$"),
              ({name: field[:, :, at[2]] for name, field in fields.items()}, x2, x2[at[1]], "$x_2$")]
    figure, axes = style.panels(2, 2, 6.2)
    for row, (name, of) in zip(axes, (("von Mises stress", lambda plane: plane["von_mises"]), ("largest shear stress", largest_shear))):
        drawn = [of(plane) / pressure for plane, *_ in planes]
        levels = MaxNLocator(12).tick_values(0, max(values.max() for values in drawn))
        for axis, values, (_, along, there, label) in zip(row, drawn, planes):
            filled = axis.contourf(along / length, depths / length, values, levels, cmap="viridis")
            axis.plot(there / length, depths[at[0]] / length, "*", color=style.VERMILION, markersize=13, markeredgecolor="white",
                      clip_on=False)
            axis.set(ylim=(depths[-1] / length, 0), xlabel=f"{label}, {length_name}", ylabel=f"depth $x_3$, {length_name}")
            axis.grid(False)
        figure.colorbar(filled, ax=list(row), label=f"{name}, {pressure_name}")
    figure.suptitle(f"The largest von Mises stress is {quantity(most, STRESSES, 4)}, {quantity(depths[at[0]], LENGTHS)} "
                    f"below the surface (star)", weight="bold", x=0.01, ha="left")
    return figure


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("volume", type=Path, help="volume of `slipstick solve --stresses FILE.vtr`")
    parser.add_argument("--output", type=Path, required=True, help="figure to write: " + ", ".join(style.FORMATS))
    arguments = parser.parse_args(words)
    return script.run(lambda: style.write(draw(arguments.volume), arguments.output), (InputError,), arguments.output)


if __name__ == "__main__":
    sys.exit(main())
