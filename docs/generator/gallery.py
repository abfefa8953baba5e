"""gallery.py GALLERY DOCS: writes the table and the pictures of DOCS/gallery.md from the pages that `make gallery` made in
GALLERY. It leaves out times, which depend on the machine."""
import pathlib
import re
import sys

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "reports"))
import page_tables
import results
import style
from cells import Cells

HEAD = "| | scene | answer | work |\n|---|---|---|---|\n"
SCENES = ROOT / "convergence/scenes"
SIDE = 0.7  # inches, 154 pixels


def picture(answer, fields):
    """Blue: sticks; orange: slips. Darker where the pressure is higher, white outside of the contact."""
    cells = Cells(fields, answer["cell_size"])
    pressure = cells.columns["pressure"]
    depth = 0.25 + 0.75 * np.sqrt(pressure / pressure.max())[:, None]
    colours = np.where((cells.columns["stick"] != 0)[:, None], to_rgb(style.BLUE), to_rgb(style.VERMILION))
    shown = [cells.grid(channel) for channel in (1 - depth * (1 - colours)).T]
    figure = Figure(figsize=(SIDE, SIDE))
    axes = figure.add_axes((0, 0, 1, 1), frame_on=False, xticks=[], yticks=[])
    axes.imshow(np.nan_to_num(np.dstack(shown), nan=1.0), origin="lower", extent=cells.extent, interpolation="nearest")
    axes.grid(False)
    middle, half = (cells.extent[[0, 2]] + cells.extent[[1, 3]]) / 2, 0.53 * cells.longer_side()
    axes.set(xlim=middle[0] + half * np.array([-1, 1]), ylim=middle[1] + half * np.array([-1, 1]))
    return style.draw(figure, ".png")


def row(name, page):
    answer, judged = page["answer"], page_tables.judged_number(page)
    gap, _, applications = page_tables.sums(answer)
    error = "error" if judged["basis"] == "exact" else "estimated error"
    steps = len(answer.get("steps") or [0])
    work = [f"{applications:.0f} applications", "×".join(map(str, answer["cells"])) + " cells"]
    return "| {} | {} | {} | {} |".format(
        f"![{name}: stick and slip](gallery/{name}.png)",
        f"**`{name}`**: {page_tables.first_sentence((SCENES / f'{name}.toml').read_text())}.",
        f"{judged['words']} {page_tables.with_unit(judged, 'value').strip()}, {error} {page_tables.error_with_parts(judged)}, gap "
        f"{page_tables.sci(gap)}",
        ", ".join([f"{steps} steps"] * (steps > 1) + work))


def write(gallery, docs):
    pages = {folder.name: results.load(folder / "data/report.json") for folder in sorted(gallery.iterdir()) if folder.is_dir()}
    (docs / "gallery").mkdir(exist_ok=True)
    for name, page in pages.items():
        drawn = picture(page["answer"], gallery / name / "data/answer.h5")
        (docs / "gallery" / f"{name}.png").write_bytes(drawn)
    text = (docs / "gallery.md").read_text()
    table = HEAD + "".join(row(name, page) + "\n" for name, page in pages.items())
    (docs / "gallery.md").write_text(re.sub(r"(^\|.*\n)+", lambda _: table, text, count=1, flags=re.M))


if __name__ == "__main__":
    write(*map(pathlib.Path, sys.argv[1:3]))
