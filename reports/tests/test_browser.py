"""The page in a browser: it loads without a network and without messages, sorts, fits every screen, and is accessible.

The tests do not depend on the page's words."""

import json
import re
import tempfile
import unittest
from pathlib import Path

from made_report import run_render, save_quickly, small_page, write_data

import browser
import pdf
from test_study_figure import study, tolerance_study

CHECKS = (Path(__file__).parent / "page_checks.js").read_text(encoding="utf-8")
WIDTHS = (360, 800, 1600)
NOTHING = {"", "-", "–", "—"}
SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-")
NUMBER = re.compile(r"(?P<mantissa>[+−-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)"
                    r"(?:×10(?P<exponent>[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)|(?P<power>[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?(?P<percent>\s?%)?"
                    r"(?:\s(?P<prefix>[Mkmµnp])?(?P<unit>rad|N m|m|Pa|J|s)\b.*)?")  # words may follow a unit
PREFIXES = {"M": 1e6, "k": 1e3, None: 1.0, "m": 1e-3, "µ": 1e-6, "n": 1e-9, "p": 1e-12}
KINDS = {"exponent", "power", "percent", "unit", "plain", "text", "nothing"}  # what columns hold
DRAWN = 2  # figures; the others are empty here, since they cost more than all that is asked of the page
EMPTY = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 600 300"></svg>'


def number(cell):
    """A cell as (kind, unit, value), None for a cell without a number."""
    if not (found := NUMBER.fullmatch(cell)):
        return None
    value = float(found["mantissa"].translate(SUPERSCRIPTS))
    if found["exponent"]:
        value *= 10.0 ** int(found["exponent"].translate(SUPERSCRIPTS))
    if found["power"]:
        value **= int(found["power"].translate(SUPERSCRIPTS))
    kind = next((kind for kind in ("unit", "exponent", "power", "percent") if found[kind]), "plain")
    return kind, found["unit"], value * PREFIXES[found["prefix"]]


def make_page(folder):
    """A small made-up page with two studies."""
    page = small_page()
    page["studies"] = [study(), dict(tolerance_study(), name="made up: tolerance")]
    drawn = []

    def save_few(figure, stem):
        drawn.append(stem)
        return save_quickly(figure, stem) if len(drawn) <= DRAWN else EMPTY

    write_data(folder, page)
    exit_code, words = run_render(folder, save=save_few)
    assert exit_code == 0, words
    return folder / "index.html"


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if browser.MISSING:
            raise unittest.SkipTest(browser.MISSING)
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.file = make_page(cls.folder)
        cls.browser = cls.enterClassContext(browser.Browser())
        cls.browser.open(cls.file)
        cls.asked = cls.browser.requests()
        cls.browser.evaluate(CHECKS)

    def setUp(self):
        self.browser.width(1600)
        self.browser.media()

    def tearDown(self):
        """The page neither reports an error nor loads anything during its use."""
        type(self).asked += self.browser.requests()
        self.assertEqual(self.browser.complaints(), [])
        self.assertEqual([each for each in self.asked if not each.startswith("data:")], [self.file.resolve().as_uri()])

    def unfold(self):
        self.browser.evaluate("document.querySelectorAll('details').forEach((each) => { each.open = true; })")

    def nothing_wrong(self, check):
        found = self.browser.evaluate(f"checks.{check}()")
        self.assertEqual(found["bad"], [])
        self.assertGreater(found["seen"], 0)

    def test_every_drawing_has_an_alternative_text(self):
        self.nothing_wrong("alternatives")

    def test_headings_are_in_order(self):
        self.nothing_wrong("headings")

    def test_every_link_to_a_place_of_the_page_hits(self):
        self.nothing_wrong("anchors")

    def test_nothing_is_wider_than_the_screen(self):
        self.unfold()
        for pixels in WIDTHS:
            with self.subTest(pixels=pixels):
                self.browser.width(pixels)
                self.nothing_wrong("width")
                self.nothing_wrong("legible")
                self.nothing_wrong("reachable")

    def test_every_text_stands_out_from_its_background(self):
        self.unfold()
        for scheme, is_so in (("light", lambda light: light > 0.8), ("dark", lambda light: light < 0.05)):
            with self.subTest(scheme=scheme):
                self.browser.media(scheme=scheme)
                self.assertTrue(all(map(is_so, self.browser.evaluate("checks.canvases()"))))
                self.nothing_wrong("text")

    def test_folds_open_and_close_on_a_click(self):
        folds = "[...document.querySelectorAll('details')]"
        before = self.browser.evaluate(f"{folds}.map((each) => each.open)")
        self.assertGreater(len(before), 0)
        for expected in ([not each for each in before], before):
            self.browser.evaluate(f"{folds}.forEach((each) => each.querySelector('summary').click())")
            self.assertEqual(self.browser.evaluate(f"{folds}.map((each) => each.open)"), expected)

    def expect_sorted(self, before, after):
        """Only the header of the column shows its order; rows stay whole; cells without a value come last."""
        direction = after["sorts"][after["column"]]
        self.assertIn(direction, ("ascending", "descending"))
        self.assertEqual([each for each in after["sorts"] if each not in (None, "none")], [direction])
        self.assertEqual(sorted(after["rows"]), sorted(before["rows"]))
        values = [cell for cell in after["cells"] if cell not in NOTHING]
        self.assertEqual(after["cells"][:len(values)], values)
        sign = 1 if direction == "ascending" else -1
        kinds = {"nothing"} if 0 < len(values) < len(after["cells"]) else set()
        numbers = [number(cell) for cell in values]
        if all(numbers):
            for each in {unit for _, unit, _ in numbers}:
                order = [sign * value for _, unit, value in numbers if unit == each]
                self.assertEqual(order, sorted(order), values)
            kinds |= {kind for kind, _, _ in numbers}
        elif not any(re.match(r"[+−-]?\d", cell) for cell in values):
            self.assertTrue(self.browser.evaluate(f"checks.alphabetical({json.dumps(values)}, {sign})"), values)
            kinds.add("text")
        return kinds if len(set(values)) > 1 else set()

    def test_every_column_sorts_on_a_click_and_the_other_way_on_a_second(self):
        kinds = set()
        for before, once, twice in self.browser.evaluate("checks.clicked()"):
            with self.subTest(column=before["cells"]):
                kinds |= self.expect_sorted(before, once) | self.expect_sorted(before, twice)
                self.assertNotEqual(*(each["sorts"][each["column"]] for each in (once, twice)))
        self.assertEqual(kinds, KINDS)

    def test_sorts_by_keyboard(self):
        self.unfold()
        self.browser.evaluate("checks.focus()")
        before, directions = self.browser.evaluate("checks.focused()"), set()
        for key in ("ENTER", "SPACE"):
            self.browser.press(key)
            after = self.browser.evaluate("checks.focused()")
            self.assertTrue(after["focused"], "the focus stays where it was")
            self.expect_sorted(before, after)
            directions.add(after["sorts"][after["column"]])
        self.assertEqual(directions, {"ascending", "descending"})

    def test_prints_on_a4(self):
        content = self.browser.pdf()
        self.assertTrue(content.startswith(b"%PDF"))
        last = pdf.count_pages(content)
        self.assertEqual(pdf.count_pages(self.browser.pdf([str(last)])), 1)
        with self.assertRaises(browser.BrowserError, msg="there is no page after the last"):
            self.browser.pdf([str(last + 1)])
        (width, height), = pdf.paper_sizes(content)
        self.assertAlmostEqual(width, 210, delta=1)
        self.assertAlmostEqual(height, 297, delta=1)
