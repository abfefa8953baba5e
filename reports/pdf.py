#!/usr/bin/env python3
"""Prints the page into a PDF, A4, by a headless Chromium."""

import argparse
import re
import sys
from pathlib import Path

import browser
from whole_file import write_whole

MAX_PAGES = 29
MILLIMETRES = 25.4 / 72  # a point


def count_pages(content):
    """How many pages a PDF of Chromium has: its objects are not packed."""
    return len(re.findall(rb"/Type\s*/Page\b", content))


def paper_sizes(content):
    """Width and height in millimetres of each kind of page."""
    boxes = re.findall(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)\s*\]", content)
    return {(float(width) * MILLIMETRES, float(height) * MILLIMETRES) for width, height in boxes}


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=Path, help="index.html")
    parser.add_argument("--output", type=Path, required=True, help="the PDF")
    arguments = parser.parse_args(words)
    try:
        if not arguments.page.is_file():
            raise browser.BrowserError(f"{arguments.page} is missing: run `make report`")
        with browser.Browser() as chromium:
            chromium.media("print")
            chromium.open(arguments.page)
            content = chromium.pdf()
        write_whole(arguments.output, content)
    except browser.BrowserError as error:
        print(f"pdf.py: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"pdf.py: {error.filename or arguments.output}: {error.strerror}", file=sys.stderr)
        return 2
    pages = count_pages(content)
    print(f"{arguments.output}: {pages} pages, {len(content) / 1e6:.1f} MB")
    if not 0 < pages <= MAX_PAGES:
        print(f"pdf.py: {pages} pages; allowed: {MAX_PAGES} at most", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
