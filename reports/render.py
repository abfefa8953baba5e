#!/usr/bin/env python3
"""Draws the page of each scene that `slipstick report` computed, and an index where there are several."""

import argparse
import itertools
import re
import sys
from pathlib import Path

import script

script.require("numpy", "matplotlib", "jinja2")

import jinja2  # noqa: E402
from markupsafe import Markup, escape  # noqa: E402

import crate  # noqa: E402
import figures  # noqa: E402
import hard_cases  # noqa: E402
import literature_figure  # noqa: E402
import page_tables  # noqa: E402
import plane_figure  # noqa: E402
import results  # noqa: E402
import scaling_figure  # noqa: E402
import study_figure  # noqa: E402
import style  # noqa: E402
import tables  # noqa: E402
from method_figures import METHODS  # noqa: E402
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


def show_sections(page, data, folder):
    """The lead figure, and the sections that the page has, figures numbered as they stand."""
    numbered = itertools.count(1)

    def draw(figure):
        return draw_entry(figure.name, figure.title, lambda: figure.draw(page, data), folder) | {"number": next(numbered)}

    lead = next(figure for figure in figures.LEADS if figures.has(page, figure.part))
    first, sections = draw(lead), {}
    for section in figures.SECTIONS:
        shown = [figure for figure in section.figures if figures.has(page, figure.part) and figure is not lead]
        if shown or (section.part and figures.has(page, section.part)):
            sections[section.name] = {"question": section.question, "figures": [draw(figure) for figure in shown]}
    return first, sections


def show_studies(page, folder):
    """Each study with its figure and tables."""
    entries = []
    for study in page.get("studies", []):
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
    """The measurements of `slipstick bench`: growth and crossings of times, and the plane of each scene; none without a run."""
    if benchmarks is None or not all((benchmarks / name).is_file() for name in ("scaling.json", "plane.json")):
        return []
    scaling, plane = (results.load(benchmarks / name) for name in ("scaling.json", "plane.json"))
    title, growth = scaling_figure.FIGURES[0]
    return [draw_entry("growth", title, lambda: growth(scaling), folder),
            *(draw_entry(f"plane-{k}", f"Speed against error at M/M_lim = {plain(results.number(scene, 'moment_ratio'))}",
                         lambda: plane_figure.draw(scene), folder)
              for k, scene in enumerate(results.rows(plane, "scenes"), 1))]


def tabulate(make, *arguments):
    try:
        return {"table": make(*arguments)}
    except results.Unavailable as reason:
        return {"unavailable": str(reason)}


def tabulate_all(page):
    """The page's tables by name; a table without a part of the page is missing."""
    makers = [(page_tables.numbers, "numbers"), (page_tables.program, "answer.program"), (page_tables.choices, "cost"),
              (page_tables.digits, "digits"), (page_tables.programs, "programs")]
    found = {make.__name__: tabulate(make, page) for make, part in makers if figures.has(page, part)}
    if "paper" in page:
        for name, part, columns in (("known_fields", "peers", tables.PEERS), ("loads", "loading", tables.LOADING),
                                    ("meshes", "mesh", tables.MESH), ("laws", "approximation_table", tables.APPROXIMATIONS),
                                    ("gates", "gates.gates", tables.GATES)):
            found[name] = tabulate(tables.table, page["paper"], part, columns)
    if figures.has(page, "paper.literature"):
        found["literature"] = tabulate(literature_figure.table, page["paper"])
    return found


def map_hard_cases(page):
    """The map of hard cases; without other methods its only column has the name of the answer's method."""
    try:
        found = hard_cases.square_map(page)
    except results.Unavailable as reason:
        return {"unavailable": str(reason)}
    if len(found["methods"]) == 1:
        method = page["answer"]["method"]
        found["methods"] = [(found["methods"][0][0], METHODS.get(method, (method,))[0])]
    return found


def environment():
    """Templates of pages."""
    found = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True, lstrip_blocks=True)
    found.filters["typeset"] = typeset
    return found


def write_page(output, templates, benchmarks=None):
    """Writes output/index.html and output/figures/ from output/data/report.json and its field files, of the paper's page
    also from benchmarks/scaling.json and plane.json where they are there; returns the page's content."""
    data = output / "data"
    page = results.load(data / "report.json")
    folder = output / "figures"
    folder.mkdir(parents=True, exist_ok=True)
    lead, sections = show_sections(page, data, folder)
    paper = page.get("paper")
    html = templates.get_template("page.html.j2").render(
        page=page, paper=paper, lead=lead, sections=sections, headline=page["headline"], tables=tabulate_all(page),
        remembered=page_tables.remembered(page), studies=show_studies(page, folder),
        speed=show_speed(benchmarks, folder) if paper else [],
        hard=map_hard_cases(page) if "hard" in page else None, hard_scenes=map_hard_cases(paper) if paper else None,
        nulls=results.nulls({"answer": page["answer"], "paper": {key: part for key, part in (paper or {}).items()
                                                                 if key not in ("hard", "gates", "literature", "peers")}}),
        data="data")
    write_whole(output / "index.html", html.encode())
    crate.write(output, page)
    return page


def render(output, folders, benchmarks=None):
    templates = environment()
    pages = [(folder, write_page(folder, templates, benchmarks)) for folder in folders]
    if len(pages) > 1:
        table = page_tables.index([(folder.relative_to(output), page) for folder, page in pages])
        write_whole(output / "index.html", templates.get_template("index.html.j2").render(table=table).encode())


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", type=Path, nargs="+", help="folders with data/report.json and its field files")
    parser.add_argument("--output", type=Path, required=True, help="folder of the index of several pages")
    parser.add_argument("--benchmarks", type=Path, help="folder with scaling.json and plane.json, of `slipstick bench`")
    arguments = parser.parse_args(words)
    return script.run(lambda: render(arguments.output.resolve(), [each.resolve() for each in arguments.folders],
                                     arguments.benchmarks), results.InputError, arguments.output)


if __name__ == "__main__":
    sys.exit(main())
