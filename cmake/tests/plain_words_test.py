"""plain_words_test.py SOURCE_DIR: comments, messages and pages are written in sentences that a reader in another mother
tongue understands at first reading. The test counts lines with a turn of phrase from the list below in each top-level folder
and fails, with the lines, where their share exceeds MAX_SHARE."""

import pathlib
import re
import sys

FOLDERS = ("analytic", "bench", "cmake", "convergence", "docs", "interfaces", "reports", "solver")
# Well written numerical libraries have up to 1 % of such lines; a further 2 % allow for phrases that are right in their place.
MAX_SHARE = 0.03
# A clause as the subject or the object of a sentence; sentences without a subject.
STARTS = re.compile(r"(?:^|[.;:] +)(?:What|Who|Whoever|Those|Which|Such|Neither|Nor|Of|Nothing|Hence|Thus|So that)\s+(?!course)\S[^?]{4,}$")
PHRASES = re.compile(
    r"\b(?:(?:and|as|at|by|for|from|gives?|holds|in|is|keeps|of|on|says?|than|to|with) what"
    r"|those (?:that|of|which)|that of (?:an?|its|the|this)|of which|likewise|the like|the reverse"
    r"|besides?|nobody|somebody|whoever|no one|alone|merely|lest|in place of|so many|so much|not a few"
    r"|hand(?:s|ed)? on|takes? up|told|tells?|ask(?:s|ed) for|looks? at|remembers?|forgets?|forgotten|obeys?|cares?|wants?"
    r"|stands? (?:for|by itself)|knows? of|seen as|as \w+ as (?:it|they|there|that) |comes? to|does without|goes on|gone)\b",
    re.IGNORECASE)


def prose(file, text):
    """(line number, line of a comment, of a message or of a page)."""
    is_page, is_cpp = file.suffix == ".md", file.suffix in (".cpp", ".hpp", ".h", ".c")
    hidden = False  # in a code block of a page; outside of a doc string in Python
    for number, line in enumerate(text.splitlines(), 1):
        if is_page:
            hidden ^= line.lstrip().startswith("```")
            if not hidden and not line.startswith(("    ", "|--", "```")):
                yield number, re.sub(r"`[^`]*`", "x", line)
        elif is_cpp:
            comment = re.match(r'[^"]*?//[/!]?<?\s?(.*)', line)
            if comment:
                yield number, re.sub(r"`[^`]*`", "x", comment[1])
            elif not line.startswith("#"):
                yield from ((number, text) for text in re.findall(r'"((?:[^"\\]|\\.)*)"', line) if " " in text.strip())
        else:
            quotes = line.count('"""') if file.suffix == ".py" else 0
            if hidden or quotes:
                yield number, line.replace('"""', "").strip()
            elif comment := re.match(r"""[^"'#]*#(?!!)\s?(.*)""", line):
                yield number, comment[1]
            hidden ^= quotes % 2 == 1


def count(root, folder):
    """Number of lines of prose of a folder, and the lines with a phrase of the list."""
    lines, found = 0, []
    for file in sorted((root / folder).rglob("*")):
        if file.suffix not in (".cpp", ".hpp", ".h", ".c", ".py", ".md", ".cmake", ".toml") and file.name != "CMakeLists.txt":
            continue
        if file.name == pathlib.Path(__file__).name:
            continue
        for number, line in prose(file, file.read_text(errors="replace")):
            if len(line.split()) < 3:
                continue
            lines += 1
            if STARTS.search(line) or PHRASES.search(line):
                found.append(f"{file.relative_to(root).as_posix()}:{number}: {line.strip()[:120]}")
    return lines, found


if __name__ == "__main__":
    counts = {folder: count(pathlib.Path(sys.argv[1]), folder) for folder in FOLDERS}
    failed = {folder for folder, (lines, found) in counts.items() if len(found) > MAX_SHARE * lines}
    for folder in sorted(failed):
        print("\n".join(counts[folder][1]))
    for folder, (lines, found) in counts.items():
        print(f"{folder}: {len(found)} of {lines} lines of prose, {100 * len(found) / max(lines, 1):.1f} %")
    sys.exit(bool(failed))
