"""tidy_tree_test.py SOURCE_DIR: no file is longer than 450 lines and no C++ function than 60; no sentence of a comment or a
page starts with "Of"; a constant's name has one value at namespace scope throughout the program."""

import pathlib
import re
import subprocess
import sys

MAX_FILE_LINES = 450
MAX_FUNCTION_LINES = 60
OLD_TEXT = ("CHANGELOG.md", "LICENSE")  # of the past, or not ours
CPP = (".cpp", ".hpp", ".h", ".c")
# A line that opens a scope which is no function: its body may hold many.
OTHER_SCOPE = re.compile(r"\b(?:namespace|class|struct|union|enum|concept|extern)\b[^()]*$|=\s*$")
SENTENCE_WITH_OF = re.compile(r"(?:^|[.:;!?)]\s+)Of\s+(?!course)")
# Tables are no constants: what they list differs with what they are of.
CONSTANT = re.compile(r"^(?:inline )?constexpr (?!std::array)[\w:<>, ]+? (k[A-Z]\w*)(?: = ([^;]+)|(\{[^;]+\}));", re.MULTILINE)


def functions(lines):
    """(first line, length) of each function: what clang-format closes at the indent where it began."""
    begin = 0
    while begin < len(lines):
        line = lines[begin]
        opened = re.match(r"( *)(?!//|\*|#|\}|namespace|class|struct|union|enum|extern|public|private)\S", line)
        end = begin
        if opened and "(" in line or opened and line.startswith("template"):
            indent = opened.group(1)
            while end + 1 < len(lines) and not lines[end].rstrip().endswith(("{", ";", "}")):
                end += 1  # a signature of several lines
            if lines[end].rstrip().endswith("{") and not OTHER_SCOPE.search(lines[end].rstrip()[:-1]):
                while end + 1 < len(lines) and not lines[end].startswith(indent + "}"):
                    end += 1
                yield begin + 1, end - begin + 1
        begin = end + 1


def comments(file, text):
    """(line, text) of each comment: lines that follow each other are one."""
    if file.suffix in (".md", ".j2"):
        pattern = r"(?:^(?!    )[^\n]*\S[^\n]*\n?)+"
    elif file.suffix in CPP:
        pattern = r"(?:(?://[/!]?<?)[^\n]*(?:\n[ \t]*(?=//))?)+"
    else:
        pattern = r'"""(?:[^"]|"(?!""))*"""|(?:#[^\n]*(?:\n[ \t]*(?=#))?)+'
    for found in re.finditer(pattern, text, re.MULTILINE):
        bare = re.sub(r"\s*\n\s*(?://[/!]?<?|#)?\s*|^(?://[/!]?<?|#|\"\"\")\s*", " ", found.group(0))
        yield text.count("\n", 0, found.start()) + 1, bare.strip()


def violations(root):
    values = {}
    listed = subprocess.run(["git", "-C", root, "ls-files"], capture_output=True, text=True, check=True).stdout
    for name in listed.split("\n"):
        file = root / name
        if file.suffix not in (*CPP, ".py", ".cmake", ".txt", ".md", ".sh", ".toml", ".j2") or name in OLD_TEXT or not file.exists():
            continue
        text = file.read_text(errors="replace")  # a corpus of bad input is no text
        lines = text.splitlines()
        if file.suffix in (*CPP, ".py") and len(lines) > MAX_FILE_LINES:
            yield name, 1, f"{len(lines)} lines, allowed: {MAX_FILE_LINES}"
        for line, comment in comments(file, text):
            if SENTENCE_WITH_OF.search(comment):
                yield name, line, f"a sentence starts with Of: {comment[:90]}"
        if file.suffix in CPP:
            yield from ((name, line, f"a function of {length} lines, allowed: {MAX_FUNCTION_LINES}")
                        for line, length in functions(lines) if length > MAX_FUNCTION_LINES)
            if "tests" not in file.parts:
                for found in CONSTANT.finditer(text):
                    value = re.sub(r"\s+", " ", found.group(2) or found.group(3))
                    values.setdefault(found.group(1), {}).setdefault(value, []).append(
                        (name, text.count("\n", 0, found.start()) + 1))
    for constant, places in sorted(values.items()):
        if len(places) > 1:
            for value, at in places.items():
                yield *at[0], f"{constant} = {value} here, and elsewhere {', '.join(sorted(places.keys() - {value}))}"


def main():
    found = sorted(violations(pathlib.Path(sys.argv[1])))
    print("\n".join(f"{name}:{line}: {what}" for name, line, what in found) or "the tree is tidy")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
