"""pages_test.py PROGRAM SOURCE_DIR: the pages of docs/extend show the files of docs/extend/examples unchanged, and name files
and words that exist; their study, gates and figure give the results that the pages state."""

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, ROOT = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
PAGES = sorted((ROOT / "docs/extend").glob("*.md"))
EXAMPLES = ROOT / "docs/extend/examples"
sys.path[:0] = [str(EXAMPLES), str(ROOT / "reports"), str(ROOT / "reports/tests")]


def rows(page):
    """The rows of its tables that begin with a file: (file, words in code in the other cells)."""
    for first, rest in re.findall(r"^\| `([^`|]+)` \|(.*)\|$", page.read_text(), re.MULTILINE):
        if "/" in first:
            yield first, [word for word in re.findall(r"`([^`]+)`", rest) if not word.startswith("make ")]


class Pages(unittest.TestCase):
    def test_show_the_examples_as_they_are(self):
        shown = []
        for page in PAGES:
            for name, text in re.findall(r"<!-- not run: (examples/\S+) is run by ctest -->\n```\w+\n(.*?)```", page.read_text(), re.DOTALL):
                self.assertEqual(text, (page.parent / name).read_text(), f"{page.name}: {name}")
                shown.append(Path(name).name)
        self.assertEqual(sorted(shown), ["friction.toml", "gates.toml", "method.hpp", "profile.hpp", "stick_figure.py"])

    def test_name_files_and_words_that_exist(self):
        named = 0
        for page in PAGES:
            for name, words in rows(page):
                files = sorted(ROOT.glob(name))
                self.assertTrue(files, f"{page.name}: {name}")
                for word in words:
                    found = any(word in file.read_text() if file.is_file() else (file / word).exists() for file in files)
                    self.assertTrue(found, f"{page.name}: {name} has no {word}")
                    named += 1
        self.assertGreater(named, 20)


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_program(self, *words):
        return subprocess.run([PROGRAM, *words, "--output", self.folder / "kept", "--json", self.folder / "out.json"],
                              capture_output=True, text=True)

    def test_study_and_gates(self):
        ended = self.run_program("study", EXAMPLES / "friction.toml")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        series = json.loads((self.folder / "out.json").read_text())["series"]
        first, second = (series[name]["order"]["traction_error.l1"]["value"] for name in ("0.1", "0.2"))
        self.assertAlmostEqual(first, second, 4)  # over mu p, tractions do not depend on the friction
        ended = self.run_program("gate", EXAMPLES / "gates.toml")
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_figure(self):
        import made_report
        import stick_figure
        entry = stick_figure.stick_ratio(made_report.small_page(), self.folder)
        self.assertEqual(len(entry.figure.axes[0].lines[0].get_xdata()), 3)
        self.assertTrue(all((entry.message, entry.details, entry.alt)))
