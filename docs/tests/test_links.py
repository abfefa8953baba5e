"""test_links.py SOURCE_DIR [MKDOCS]: every relative link and anchor of README.md, CONTRIBUTING.md and docs/**/*.md has a
target, and every file, function and test that they name exists. If MkDocs is installed, the site builds without a warning and
loads nothing from other servers."""
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unicodedata
import unittest
from urllib.parse import unquote

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from pages import line_of, pages, relative, without_blocks

ROOT = pathlib.Path(sys.argv[1]).resolve()
MKDOCS = sys.argv[2] if len(sys.argv) > 2 else ""
PAGES = [*pages(ROOT), ROOT / "CONTRIBUTING.md"]
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|\b(?:href|src)=\"([^\"]+)\"", re.S)


def plain(heading):
    """The heading's words, without the marks of code, emphasis and links."""
    return re.sub(r"<[^>]*>|[`*]|\[([^\]]*)\]\([^)]*\)", lambda match: match.group(1) or "", heading).strip()


def forge_anchor(heading):
    return re.sub(r"[^\w\- ]", "", plain(heading).lower()).replace(" ", "-")


def site_anchor(heading):
    ascii_only = unicodedata.normalize("NFKD", plain(heading)).encode("ascii", "ignore").decode()
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", ascii_only).strip().lower())


def anchors(page):
    """The #anchors of a page that work both on a forge and on the site."""
    headings = re.findall(r"^#{1,6} (.*)$", without_blocks(page.read_text()), re.M)
    return {forge_anchor(heading) for heading in headings if forge_anchor(heading) == site_anchor(heading)}


def broken_links(page):
    text = without_blocks(page.read_text())
    for match in LINK.finditer(text):
        target = unquote(match.group(1) or match.group(2))
        if re.match(r"[a-z]+:", target):
            continue
        where = f"{relative(page, ROOT)}:{line_of(text, match.start())}: {target}"
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.is_relative_to(ROOT):
            yield f"{where}: outside of the project"
        elif not file.exists():
            yield f"{where}: no such file"
        elif page.parent != ROOT and not file.is_relative_to(ROOT / "docs"):
            yield f"{where}: the site holds only docs/; name the file as code"
        elif anchor and (file.suffix != ".md" or anchor not in anchors(file)):
            yield f"{where}: no heading of this name, on a forge and on the site"


class LinksTest(unittest.TestCase):
    def test_lead_somewhere(self):
        broken = [line for page in PAGES for line in broken_links(page)]
        self.assertEqual("\n".join(broken), "")

    def test_index_and_menu_lead_to_every_page(self):
        docs = ROOT / "docs"
        index = (docs / "index.md").read_text()
        self.assertFalse([path.name for path in (docs / "guides").glob("*.md") if f"(guides/{path.name})" not in index])
        menu = set(re.findall(r": (\S+\.md)$", (docs / "site/mkdocs.yml").read_text(), re.M))
        self.assertEqual({path.relative_to(docs).as_posix() for path in docs.rglob("*.md")} - menu, set())

    @unittest.skipUnless(MKDOCS, "MkDocs is not installed")
    def test_site_builds_strictly_and_asks_nothing_of_others(self):
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run(
                [MKDOCS, "build", "--strict", "--quiet", "--config-file", ROOT / "docs/site/mkdocs.yml", "--site-dir", folder],
                capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            site = pathlib.Path(folder)
            self.assertTrue((site / "guides/verify-your-solver.html").is_file())
            self.assertIn('<td data-label="command"><code>solve</code></td>', (site / "index.html").read_text())  # on telephones
            asked = re.compile(r"<(?:script|link|img|iframe)\b[^>]*\b(?:src|href)=[\"']?((?:https?:)?//[^\"' >]+)|"
                               r"@import[^;]*(?:https?:)?//|url\([\"']?(?:https?:)?//")
            found = [f"{path.relative_to(site)}: {match.group()}" for path in [*site.rglob("*.html"), *site.rglob("*.css")]
                     for match in asked.finditer(path.read_text())]
            self.assertFalse(found)


class NamesTest(unittest.TestCase):
    def test_files_in_backquotes_exist(self):
        folders = {path.name for path in ROOT.iterdir() if path.is_dir() and not path.name.startswith(("build", "."))}
        missing = []
        for page in PAGES:
            text = without_blocks(page.read_text())
            for span in re.finditer(r"`([a-z]+)(/[\w./*-]*)`", text):
                if span[1] in folders and not list(ROOT.glob(span[1] + span[2].rstrip("/"))):
                    missing.append(f"{relative(page, ROOT)}:{line_of(text, span.start())}: {span[0]}")
        self.assertEqual("\n".join(missing), "")

    def test_architecture_names_every_folder_of_sources(self):
        text = (ROOT / "docs/architecture.md").read_text()
        folders = {file.relative_to(ROOT).parts[:2] for top in ["analytic", "solver", "convergence", "interfaces", "bench"]
                   for file in (ROOT / top).glob("*/*") if file.suffix in (".cpp", ".hpp", ".py")}
        self.assertGreater(len(folders), 30)
        self.assertEqual(sorted("/".join(parts) for parts in folders if parts[1] != "tests" and f"`{'/'.join(parts)}/`" not in text), [])

    def test_one_solve_goes_through_few_files_that_exist(self):
        rows = re.findall(r"^\| (\d+) \| `([^`]+)` \|", (ROOT / "docs/one-solve.md").read_text(), re.M)
        self.assertEqual([int(number) for number, _ in rows], list(range(1, len(rows) + 1)))
        self.assertIn(len(rows), range(10, 19), "a reader opens 18 files at most")
        self.assertEqual([file for _, file in rows if not (ROOT / file).is_file()], [])

    def test_functions_and_tests_of_the_equations_exist(self):
        rows = re.findall(r"^\| (\([^|]*) \|([^|]*)\|([^|]*)\|", (ROOT / "docs/theory.md").read_text(), re.M)
        self.assertEqual({number for row in rows for number in equations(row[0])}, set(range(1, 27)))
        sources = "".join(path.read_text() for folder in ["analytic", "solver"] for path in sorted((ROOT / folder).rglob("*.[ch]pp")))
        missing = []
        for equation, functions, tests in rows:
            for name in re.findall(r"`([\w:/.]+)`", functions):
                known = (ROOT / name).is_file() or list((ROOT / "analytic").glob(name)) if "." in name else \
                    re.search(rf"\b{name.rpartition(':')[2]}\b", sources)
                missing += [] if known else [f"{equation}: {name}"]
            for suite, test in re.findall(r"`(\w+)\.(\w*)", tests):
                known = re.search(rf"\bTEST(_[FP])?\(\s*{suite},\s*{test}", sources)
                missing += [] if known else [f"{equation}: {suite}.{test}"]
        self.assertFalse(missing)


def equations(text):
    """The numbers in '(10), (11)' or '(14)–(16)'."""
    ends = [int(number) for number in re.findall(r"\((\d+)\)", text)]
    return range(ends[0], ends[-1] + 1)


class ReadmeTest(unittest.TestCase):
    LINES = (ROOT / "README.md").read_text().splitlines()

    def test_shows_paper_pictures_and_the_two_commands_on_the_first_screen(self):
        screen = "\n".join(self.LINES[:40])
        for wanted in ["D. Gradinaru and S. Spinu", "Eq. (7)", "![Geometry", "![Twist against load", "make report", "make test"]:
            self.assertIn(wanted, screen)

    def test_is_short_and_leads_three_readers_on(self):
        self.assertLessEqual(len(self.LINES), 103)
        rows = [line for line in self.LINES[:40] if line.startswith("| ") and "](docs/guides/" in line]
        self.assertEqual(len(rows), 3)


class GlossaryTest(unittest.TestCase):
    def test_terms_are_in_alphabetical_order_and_short(self):
        terms = re.split(r"^## ", (ROOT / "docs/glossary.md").read_text(), flags=re.M)[1:]
        names = [term.partition("\n")[0].lower() for term in terms]
        self.assertEqual(names, sorted(names))
        self.assertEqual([name for name, term in zip(names, terms) if len(term.split()) > 110], [])


class GalleryTest(unittest.TestCase):
    def test_has_every_scene_with_its_picture_and_its_first_sentence(self):
        gallery = (ROOT / "docs/gallery.md").read_text()
        for scene in (ROOT / "convergence/scenes").glob("*.toml"):
            with self.subTest(scene=scene.stem):
                row = re.search(rf"^\| !\[.*?\]\(gallery/{scene.stem}\.png\) \| \*\*`{scene.stem}`\*\*: (.*?) \|", gallery, re.M)
                self.assertTrue(row)
                comment = " ".join(re.match(r"(#.*\n)+", scene.read_text())[0].replace("\n#", "").lstrip("# ").split())
                self.assertTrue(comment.startswith(row[1]), comment)
                self.assertIn(row[1][-1], ".:")


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "Matplotlib is not installed")
class SketchTest(unittest.TestCase):
    def test_is_the_one_that_its_script_draws(self):
        """By the labels, which Matplotlib writes as comments: its versions draw the same figure in other bytes."""
        with tempfile.TemporaryDirectory() as folder:
            drawn = pathlib.Path(folder) / "geometry.svg"
            subprocess.run([sys.executable, "-B", ROOT / "docs/generator/geometry.py", drawn], check=True)
            labels = [re.findall(r"<!-- (.*?) -->", file.read_text(), re.S) for file in [drawn, ROOT / "docs/geometry.svg"]]
        self.assertIn("sphere", "".join(labels[0]))
        self.assertEqual(*labels)
