"""large_contacts_test.py SOURCE_DIR: the model of large contacts agrees with the counts, its arithmetic with theory,
and the page with the model."""

import json
import math
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv[1]).resolve()
FOLDER = ROOT / "bench/scaling/large"
sys.path.insert(0, str(FOLDER))
import large_contacts as large

COUNTS = json.loads((FOLDER / "counts.json").read_text())


class LargeContactsTest(unittest.TestCase):
    def test_transposes_are_those_counted(self):
        for row in COUNTS["transposes"]:
            n, ranks = row["cells"], row["ranks"]
            self.assertEqual(large.messages(ranks), row["messages"], row)
            self.assertLess(abs(large.sent(n, ranks) - row["bytes"]), 0.02 * row["bytes"] + 1e-9, row)
            self.assertLessEqual(row["bytes"], 64.0 * n * n, row)

    def test_transforms_are_those_counted(self):
        """As bench/gates/work.toml has them: 776 transforms of 64 points."""
        self.assertEqual(large.transforms(64), 776)

    def test_a_law_is_found_and_its_error_seen(self):
        rows = [(n, 3.0 + 0.5 * n * n) for n in (64, 128, 256, 512, 1024)]
        law = large.Law("made up", rows, lambda n: (1.0, n * n), (64, 128, 256))
        self.assertAlmostEqual(law.factors[0], 3.0, places=6)
        self.assertAlmostEqual(law.factors[1], 0.5, places=9)
        self.assertLess(law.error, 1e-9)
        rows[-1] = (1024, 2.0 * rows[-1][1])
        self.assertAlmostEqual(large.Law("", rows, lambda n: (1.0, n * n), (64, 128, 256)).error, 0.5, places=6)

    def test_what_is_left_out_was_not_fitted(self):
        for law in large.Model(COUNTS).laws():
            self.assertTrue(law.left_out, law.name)
            self.assertFalse(set(law.left_out) & set(law.fitted), law.name)
            self.assertGreater(max(law.left_out), max(law.fitted), law.name)

    def test_scaling_without_a_price_is_ideal(self):
        model = large.Model(COUNTS)
        alone = large.Machine("", 1, **large.NODE)
        free = large.Machine("", 64, **{**large.NODE, "network": math.inf, "latency": 0.0})
        self.assertAlmostEqual(model.solve_seconds(8192, alone) / model.solve_seconds(8192, free), 64.0, places=9)
        self.assertEqual(model.sending(8192, alone), 0.0)

    def test_where_it_stops_paying(self):
        rows = [(1, 8.0, 0, 0), (2, 7.0, 0, 0), (4, 4.0, 0, 0), (8, 3.0, 0, 0)]
        self.assertEqual(large.pays_to(rows), 4)
        self.assertEqual(large.pays_to(rows[:2]), 1)

    def test_a_rough_surface_of_4096_cells_fits(self):
        self.assertLess(large.Model(COUNTS).memory(4096), 20.0 * large.GIB)

    def test_the_page_has_the_numbers(self):
        page = (ROOT / "docs/large-contacts.md").read_text()
        for name, text in large.tables(COUNTS).items():
            self.assertIn(text, page, f"{name}: python3 bench/scaling/large/large_contacts.py shows what changed")
