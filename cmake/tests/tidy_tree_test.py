"""tidy_tree_test.py SOURCE_DIR: no file is longer than 450 lines and no C++ function than 60; a constant's
name has one value at namespace scope throughout the program; a type's name is defined once in a namespace, since
two definitions of one name destroy each other's objects."""

import pathlib
import re
import sys

FOLDERS = ("analytic", "bench", "cmake", "convergence", "docs", "interfaces", "reports", "solver")
MAX_FILE_LINES = 450
MAX_FUNCTION_LINES = 60
CPP = (".cpp", ".hpp", ".h", ".c")
TEXTS = (*CPP, ".py", ".cmake", ".txt", ".md", ".sh", ".toml", ".j2")
# A line that opens a scope other than a function, which may contain many functions.
OTHER_SCOPE = re.compile(r"\b(?:namespace|class|struct|union|enum|concept|extern)\b[^()]*$|=\s*$")
# Tables are not constants.
CONSTANT = re.compile(r"^(?:inline )?constexpr (?!std::array)[\w:<>, ]+? (k[A-Z]\w*)(?: = ([^;]+)|(\{[^;]+\}));", re.M)

TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)[^;(]*\{", re.M)
NAMESPACE = re.compile(r"^namespace ([\w:]+) \{", re.M)


def functions(lines):
    """(first line, length) of each function: clang-format closes it at its first indent."""
    begin = 0
    while begin < len(lines):
        opened = re.match(r"( *)(?!//|\*|#|\{|\}|namespace|class|struct|union|enum|extern|public|private)\S", lines[begin])
        end = begin
        if opened and ("(" in lines[begin] or lines[begin].startswith("template")):
            while end + 1 < len(lines) and not lines[end].rstrip().endswith(("{", ";", "}")):
                end += 1  # a signature of several lines
            if lines[end].rstrip().endswith("{") and not OTHER_SCOPE.search(lines[end].rstrip()[:-1]):
                while end + 1 < len(lines) and not lines[end].startswith(opened.group(1) + "}"):
                    end += 1
                yield begin + 1, end - begin + 1
        begin = end + 1


def violations(root):
    values = {}
    types = {}
    files = [file for folder in FOLDERS for file in (root / folder).rglob("*")] + list(root.glob("*"))
    for file in sorted(file for file in files if file.suffix in TEXTS and file.name != "CHANGELOG.md"):
        name, text = file.relative_to(root).as_posix(), file.read_text(errors="replace")
        if file.suffix in (*CPP, ".py") and text.count("\n") > MAX_FILE_LINES:
            yield f"{name}:1: {text.count(chr(10))} lines, allowed: {MAX_FILE_LINES}"
        for line, length in functions(text.splitlines()) if file.suffix in CPP else ():
            if length > MAX_FUNCTION_LINES:
                yield f"{name}:{line}: a function of {length} lines, allowed: {MAX_FUNCTION_LINES}"
        for found in CONSTANT.finditer(text) if file.suffix in CPP and "tests" not in file.parts else ():
            value = " ".join((found.group(2) or found.group(3)).split())
            place = f"{name}:{text.count(chr(10), 0, found.start()) + 1}"
            values.setdefault(found.group(1), {}).setdefault(value, place)
        if file.suffix in (".hpp", ".h") and "tests" not in file.parts and (space := NAMESPACE.search(text)):
            for found in TYPE.finditer(text):
                types.setdefault(f"{space[1]}::{found[1]}", []).append(name)
    for type_name, places in sorted(types.items()):
        if len(places) > 1:
            yield f"{places[0]}: {type_name} is defined here, and in {', '.join(places[1:])}"
    for constant, places in sorted(values.items()):
        for value, place in places.items() if len(places) > 1 else ():
            yield f"{place}: {constant} = {value} here, and elsewhere {', '.join(sorted(places.keys() - {value}))}"


if __name__ == "__main__":
    sys.exit("\n".join(violations(pathlib.Path(sys.argv[1]))) or 0)
