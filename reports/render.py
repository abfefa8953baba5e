#!/usr/bin/env python3
"""Draws the figures and writes the page from what `slipstick report` computed."""

import argparse
import itertools
import os
import re
import sys
from pathlib import Path

import script

script.require("numpy", "matplotlib", "jinja2", "h5py")

import jinja2  # noqa: E402
from markupsafe import Markup, escape  # noqa: E402

import figures  # noqa: E402
import hard_cases  # noqa: E402
import plane_figure  # noqa: E402
import results  # noqa: E402
import scaling_figure  # noqa: E402
import study_figure  # noqa: E402
import style  # noqa: E402
import tables  # noqa: E402
from whole_file import write_whole  # noqa: E402
from wording import plain, typeset  # noqa: E402

HERE = Path(__file__).parent


def inline(svg, alt):
    """An SVG as it stands in a page: as wide as its place, named for those who do not see it."""
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg[svg.index("<svg"):] if "<svg" in svg else "", flags=re.DOTALL)
    head = f'<svg role="img" aria-label="{escape(alt)}"'
    return Markup(re.sub(r'^<svg[^>]*?(viewBox="[^"]*")[^>]*>',
                         lambda tag: f'{head} {tag[1]} xmlns:xlink="http://www.w3.org/1999/xlink">', svg))


def draw_entry(name, title, draw, folder):
    """A figure as the page needs it: drawn, or with the reason why not."""
    entry = {"name": name, "title": title}
    try:
        drawn = draw()
        svg = style.save(drawn.figure, folder / name) or ""
        entry.update(message=drawn.message, details=drawn.details, numbers=drawn.numbers, sources=drawn.sources,
                     svg=inline(svg, drawn.alt), csv=(folder / f"{name}.csv").exists())
    except results.Unavailable as reason:
        entry["unavailable"] = str(reason)
        print(f"render.py: {name} is not available: {reason}", file=sys.stderr)
    return entry


def show_sections(report, data_dir, folder):
    """The lead figure, and the sections with theirs, numbered as they stand on the page."""
    numbered = itertools.count(1)

    def draw(figures_of):
        return [draw_entry(name, title, lambda: make(report, data_dir), folder) | {"number": next(numbered)}
                for name, title, make in figures_of]

    lead, = draw([figures.LEAD])
    return lead, {section.name: {"question": section.question, "figures": draw(section.figures)}
                  for section in figures.SECTIONS}


def show_studies(report, folder):
    """Each study with its figure and tables."""
    entries = []
    for study in report.get("studies", []):
        name = results.text(study, "name")
        entry = draw_entry("study-" + re.sub(r"\W+", "_", name), name.replace("_", " "),
                           lambda: study_figure.draw(study), folder)
        if "unavailable" not in entry:
            entry.update(message=escape(entry["message"]), details=escape(entry["details"]))
            entry.update(orders={"table": tables.study_orders(study)}, expectations=tables.study_expectations(study))
            if tables.has_budget(study):
                series, budget = tables.study_budget(study)
                entry.update(budget={"table": budget}, budget_series=series)
        entries.append(entry)
    return entries


def show_speed(benchmarks, folder):
    """What `slipstick bench` measured: how times grow and cross, and the plane of each scene; none where it has not run."""
    if benchmarks is None or not all((benchmarks / name).is_file() for name in ("scaling.json", "plane.json")):
        return []
    scaling, plane = (results.load(benchmarks / name) for name in ("scaling.json", "plane.json"))
    title, growth = scaling_figure.FIGURES[0]
    return [draw_entry("growth", title, lambda: growth(scaling), folder),
            *(draw_entry(f"plane-{k}", f"Speed against error at M/M_lim = {plain(results.number(scene, 'moment_ratio'))}",
                         lambda: plane_figure.draw(scene), folder)
              for k, scene in enumerate(results.rows(plane, "scenes"), 1))]


def tabulate(report, name, columns):
    try:
        return {"table": tables.table(report, name, columns)}
    except results.Unavailable as reason:
        return {"unavailable": str(reason)}


def tabulate_gallery(report, data_dir, output):
    """The gallery's table, its scenes linked to their files where those lie on the page's side of the disc."""

    def link(stem):
        file = data_dir / "scenes" / f"{stem}.toml"
        return os.path.relpath(file, output) if file.is_relative_to(output) and file.exists() else None

    try:
        return {"table": tables.gallery(report, link)}
    except results.Unavailable as reason:
        return {"unavailable": str(reason)}


def map_hard_cases(report):
    try:
        return hard_cases.square_map(report)
    except results.Unavailable as reason:
        return {"unavailable": str(reason)}


def environment():
    """Templates of pages."""
    found = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True, lstrip_blocks=True)
    found.filters["typeset"] = typeset
    return found


def render(data_dir, output, benchmarks=None):
    """Writes output/index.html and output/figures/ from data_dir/report.json and the field files beside it, and from
    benchmarks/scaling.json and plane.json where they are there."""
    report = results.load(data_dir / "report.json")
    folder = output / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    lead, sections = show_sections(report, data_dir, folder)
    page = environment().get_template("page.html.j2").render(
        report=report,
        lead=lead,
        sections=sections,
        headline=report.get("headline"),
        remembered=tables.remembered(report),
        studies=show_studies(report, folder),
        speed=show_speed(benchmarks, folder),
        gates=tabulate(report, "gates.gates", tables.GATES),
        peers=tabulate(report, "peers", tables.PEERS),
        gallery=tabulate_gallery(report, data_dir, output),
        loading=tabulate(report, "loading", tables.LOADING),
        mesh=tabulate(report, "mesh", tables.MESH),
        approximations=tabulate(report, "approximation_table", tables.APPROXIMATIONS),
        hard=map_hard_cases(report),
        nulls=results.nulls({key: part for key, part in report.items() if key not in ("studies", "hard", "headline", "gates", "peers")}),
        data=os.path.relpath(data_dir, output) if data_dir.is_relative_to(output) else None)
    write_whole(output / "index.html", page.encode())


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data_dir", type=Path, help="folder with report.json and its field files")
    parser.add_argument("--output", type=Path, required=True, help="folder for index.html and figures/")
    parser.add_argument("--benchmarks", type=Path, help="folder with scaling.json and plane.json, of `slipstick bench`")
    arguments = parser.parse_args(words)
    return script.run(lambda: render(arguments.data_dir.resolve(), arguments.output.resolve(), arguments.benchmarks),
                      results.InputError, arguments.output)


if __name__ == "__main__":
    sys.exit(main())
