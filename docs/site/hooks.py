"""Hooks of MkDocs: only pages go to the site; its search also works on pages that are opened from a file; wide tables are
legible on narrow screens."""
import itertools
import re
from pathlib import Path

from mkdocs.structure.files import Files

NO_PAGES = (".py", ".yml", ".1", ".bash", ".in", "CMakeLists.txt", "site/search.js")


def on_files(files, config):
    return Files([file for file in files
                  if not file.src_uri.startswith(("tests/", "extend/examples/")) and not file.src_uri.endswith(NO_PAGES)])


def on_post_build(config):
    """The search box's own script asks a web worker and a request, which browsers refuse to a page from a file."""
    search = Path(config["site_dir"]) / "search"
    index = (search / "search_index.json").read_text(encoding="utf-8")
    (search / "search_index.js").write_text(f"var searchIndex = {index};\n", encoding="utf-8")
    (search / "main.js").write_text(Path(__file__).with_name("search.js").read_text())
    (search / "worker.js").unlink()


def on_page_content(html, **_):
    """Each cell of a table of three or more columns gets the words above its column, for screens too narrow for the table."""
    return re.sub(r"<table>.*?</table>", lambda table: _with_labels(table[0]), html, flags=re.S)


def _with_labels(table):
    heads = [re.sub(r"<[^>]*>", "", head).strip() for head in re.findall(r"<th[^>]*>(.*?)</th>", table, re.S)]
    if len(heads) < 3:
        return table
    columns = itertools.cycle(heads)
    labelled = re.sub(r"<td", lambda _: f'<td data-label="{next(columns)}"', table)
    return labelled.replace("<table>", '<table class="wide">', 1)
