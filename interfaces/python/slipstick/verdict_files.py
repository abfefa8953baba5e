"""Verdicts in files for CI servers: JUnit's XML, and Markdown. Whatever a text says stays text: markup is escaped."""
from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

MAX_MARKDOWN = 64_000  # bytes: GitHub cuts a comment off above 64 kB
ROOM_FOR_NOTE = 100  # bytes
# Control characters other than tab and end of line, and those of Unicode that turn the direction of text or end a line.
STEERING = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
NO_CHARACTER = re.compile("[\ud800-\udfff\ufffe\uffff]")
XML = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#10;", "\t": "&#9;"}
MARKDOWN = {"&": "&amp;", "<": "&lt;", "\n": "<br>", "@": "@&#8203;", "#": "#&#8203;", **{each: "\\" + each for each in "\\`*_[]|~"}}
LINKS = re.compile(r"(?<=:)(?=/)|(?<=www)(?=\.)")  # of http:// and www., which a server makes links of


def printable(text: str) -> str:
    shown = STEERING.sub(lambda found: f"\\x{ord(found[0]):02x}" if found[0] < "\u0100" else f"\\u{ord(found[0]):04x}", text)
    return NO_CHARACTER.sub("?", shown)


def xml_text(text: str) -> str:
    return "".join(XML.get(each, each) for each in printable(text))


def markdown_text(text: str) -> str:
    """Also in a cell of a table."""
    return LINKS.sub("&#8203;", "".join(MARKDOWN.get(each, each) for each in printable(text)))


def junit(title: str, suite: str, cases: Sequence[dict[str, Any]]) -> str:
    """One suite. Each case has a name and a verdict, passed, failure or error; perhaps seconds, type, message, details, shown."""
    counts = (f'tests="{len(cases)}" ' + " ".join(f'{kind}s="{sum(each["verdict"] == kind for each in cases)}"'
                                                  for kind in ("failure", "error"))
              + f' skipped="0" time="{sum(each.get("seconds", 0.0) for each in cases):.3f}"')
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', f'<testsuites name="{xml_text(title)}" {counts}>',
             f'  <testsuite name="{xml_text(suite)}" {counts}>']
    for each in cases:
        message, details, shown = (xml_text(each.get(key, "")) for key in ("message", "details", "shown"))
        verdict = each["verdict"]
        wrong = "" if verdict == "passed" else f'<{verdict} message="{message}" type="{xml_text(each["type"])}">{details}</{verdict}>'
        lines.append(f'    <testcase classname="{xml_text(title.split()[-1])}" name="{xml_text(each["name"])}" '
                     f'time="{each.get("seconds", 0.0):.3f}">{wrong}<system-out>{shown}</system-out></testcase>')
    return "\n".join([*lines, "  </testsuite>", "</testsuites>"]) + "\n"


def markdown_table(text: str, header: Sequence[str], rows: Sequence[Sequence[str]], noun: str) -> str:
    """A text and a table below it, together shorter than MAX_MARKDOWN: rows that do not fit are counted; the worst come first."""
    text += f"| {' | '.join(header)} |\n|{'---|' * len(header)}\n"
    size = len(text.encode())
    for i, row in enumerate(rows):
        line = f"| {' | '.join(row)} |\n"
        size += len(line.encode())
        if size + ROOM_FOR_NOTE > MAX_MARKDOWN:
            return text + f"\n{len(rows) - i} more {noun}, none worse than these, are left out here.\n"
        text += line
    return text
