"""messages_test.py SOURCE_DIR: docs/reference/messages.md has every message of the sources about bad input, failures and doubtful
results. Compares the longest part of a message without a number or name."""

import pathlib
import re
import sys

# Messages begin at calls that refuse or fail, and at assignments of a result's texts.
BEGINNING = re.compile(
    r"\bthrow\b(?! std::logic_error)"
    r"|\b(?:InputError|(?!logic_)\w+_error|out_of_range|fail\w*|refuse\w*|finish|stop|set_missing|set_number)\s*\("
    r"|\b(?:message|why|warning|reason|advice|note|\w+_note|trouble)(?:\"\])?\s*\+?=(?![=\\])")
RAISING = re.compile(r"\braise InputError\(")
# In these files every text is a reason.
WHOLE = ("convergence/gates/gate.cpp", "convergence/check/diagnosis.hpp", "convergence/check/verdict.cpp",
         "convergence/oracle/oracle.cpp", "interfaces/python/slipstick/speed/obstacles.py", "bench/timing/invalid_reason.cpp")
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"(?:\s*"((?:[^"\\\n]|\\.)*)")*')
SHORTEST = 12  # characters; a shorter text could occur anywhere


def without_comments(text):
    return re.sub(r"(^|\s)(?://|# )[^\n]*", r"\1", re.sub(r'""".*?"""', "", text, flags=re.DOTALL))


def end_of(text, start):
    """The end of a call's arguments or of an assignment: the closing bracket, or the semicolon."""
    depth, i = 0, start
    while i < len(text):
        if text[i] == '"':
            i = LITERAL.match(text, i).end()
            continue
        depth += (text[i] in "([{") - (text[i] in ")]}")
        if depth < 0 or (depth == 0 and text[i] == ";"):
            break
        i += 1
    return i


def literals(text):
    for found in LITERAL.finditer(text):
        parts = re.findall(r'"((?:[^"\\\n]|\\.)*)"', found.group(0))
        yield "".join(parts).replace('\\"', '"').replace("\\n", " ")


def fragment(literal):
    """The longest part without a value, if it has several words."""
    pieces = [piece.strip(" :") for piece in re.split(r"\{[^{}]*\}", literal)]
    longest = max(pieces, key=len)
    return longest if len(longest) >= SHORTEST and " " in longest else ""


def messages(root):
    """(place, fragment) of each message in the sources."""
    package = "interfaces/python/slipstick"
    tops = ("analytic", "bench", "convergence", f"{package}/meshes", f"{package}/speed", "reports", "solver")
    files = [file for top in tops for ending in ("cpp", "hpp", "py") for file in (root / top).rglob("*." + ending)]
    for file in sorted(files) + [root / "main.cpp"]:
        path = file.relative_to(root)
        if "tests" in path.parts:
            continue
        text = re.sub(r"#include[^\n]*|throw std::logic_error[^;]*;", "", without_comments(file.read_text()))
        beginning = RAISING if file.suffix == ".py" else BEGINNING
        spans = [text] if path.as_posix() in WHOLE else [
            text[begin.end():end_of(text, begin.end())] for begin in beginning.finditer(text)]
        for span in spans:
            for literal in literals(span):
                if fragment(literal):
                    yield path.as_posix(), fragment(literal)


def squeezed(text):
    return re.sub(r"\s+", " ", text.replace("\\|", "|").replace("`", ""))


def main():
    root = pathlib.Path(sys.argv[1])
    page = squeezed((root / "docs/reference/messages.md").read_text())
    found = sorted(set(messages(root)))
    missing = [(place, text) for place, text in found if squeezed(text) not in page]
    for place, text in missing:
        print(f"docs/reference/messages.md lacks a message of {place}: {text}")
    print(f"{len(found)} messages, {len(missing)} of them missing")
    return 1 if missing or len(found) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
