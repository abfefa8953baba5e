"""interface_test.py SOURCE_DIR [--write]: every name of the last release still exists: keys of files, options, keys of results, exit
codes, headers, functions of C and Python. docs/reference/interface-N.N.txt lists them; --write writes the names of this version
before its release. New names are allowed."""

import ast
import json
import pathlib
import re
import sys

ROW = re.compile(r"^\| `([^`]+)`")


def keys(page):
    """The keys of a page, as TABLE.KEY, or as KEY above all tables."""
    table = ""
    for line in page.read_text().splitlines():
        if line.startswith("## "):
            table = match[1] + "." if (match := re.search(r"\[+([\w.]+)\]+", line)) else ""
        elif row := ROW.match(line):
            yield table + row[1]


def options(page):
    command = ""
    for line in page.read_text().splitlines():
        if line.startswith("## slipstick "):
            command = line.split()[2]
            yield command
        elif command and (row := ROW.match(line)):
            yield f"{command} {row[1].split()[0].rstrip(',')}"


def exit_codes(page):
    for line in page.read_text().splitlines():
        if row := re.match(r"^\| ((?:`[a-z]+`(?:, )?)+) \| ([^|]*)\|", line):
            for command in re.findall(r"`(\w+)`", row[1]):
                yield f"{command} {'0 2' if row[2].strip() == 'never' else '0 1 2'}"


def properties(schema, path=""):
    if isinstance(schema, list):
        for part in schema:
            yield from properties(part, path)
    elif isinstance(schema, dict):
        for word, part in schema.items():
            if word in ("properties", "$defs"):
                for name, inner in part.items():
                    name = f"{path}.{name}" if word == "properties" else f"<{name}>"
                    if word == "properties":
                        yield name.lstrip(".")
                    yield from properties(inner, name)
            elif word in ("items", "prefixItems", "additionalProperties", "allOf", "anyOf", "oneOf", "then", "else"):
                yield from properties(part, path)


def functions_of_c(header):
    text = re.sub(r"/\*.*?\*/", "", header.read_text(), flags=re.DOTALL)
    for result, name, parameters in re.findall(r"^(\w[\w ]*\**) ?(slipstick_\w+)\(([^;]*)\);", text, re.MULTILINE):
        yield f"{result.strip()} {name}({' '.join(parameters.split())})"


def names_of_python(package):
    for file in sorted(package.glob("*.py")):
        module = "slipstick" if file.stem == "__init__" else f"slipstick.{file.stem}"
        if file.stem.startswith("_") and file.stem != "__init__":
            continue
        for node in ast.parse(file.read_text()).body:
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
                yield from (f"{module}.{name}" for name in ast.literal_eval(node.value))
            elif isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.name.startswith("_"):
                yield f"{module}.{node.name}"


def interface(root):
    """Each name with its kind before it, in order."""
    reference = root / "docs/reference"
    kinds = {f"key of a {kind} file": keys(reference / f"{kind}.md") for kind in ("scene", "study", "gate", "hard", "program")}
    kinds["option"] = options(reference / "commands.md")
    kinds["exit codes"] = exit_codes(reference / "exit-codes.md")
    for file in sorted((root / "docs/schema").glob("*.schema.json")):
        kinds[f"key of a {file.name.split('.')[0]} result"] = properties(json.loads(file.read_text()))
    kinds["header"] = re.findall(r"^  \S*/(\w+\.hpp)", (root / "cmake/PublicHeaders.cmake").read_text(), re.MULTILINE)
    kinds["C"] = functions_of_c(root / "interfaces/c/slipstick.h")
    kinds["Python"] = names_of_python(root / "interfaces/python/slipstick")
    lines = [f"{kind}: {name}" for kind, names in kinds.items() for name in names]
    return list(dict.fromkeys(lines))


def main():
    root = pathlib.Path(sys.argv[1])
    now = interface(root)
    version = re.search(r"VERSION (\d+)\.(\d+)", (root / "CMakeLists.txt").read_text().partition("project(")[2])
    if "--write" in sys.argv:
        (root / f"docs/reference/interface-{version[1]}.{version[2]}.txt").write_text("\n".join(now) + "\n")
        return 0
    promised = [file for file in root.glob("docs/reference/interface-*.txt") if file.stem.split("-")[1].split(".")[0] == version[1]]
    lost = [f"{file.name}: {name}" for file in promised for name in file.read_text().splitlines() if name not in set(now)]
    for line in lost:
        print(f"{line}\n  is promised and gone: it comes back, or the next version is {int(version[1]) + 1}.0.0")
    cited = re.search(r"^version: (\S+)$", (root / "CITATION.cff").read_text(), re.MULTILINE)[1]
    described = json.loads((root / "codemeta.json").read_text())["version"]
    if not (cited == described and cited.startswith(f"{version[1]}.{version[2]}.")):
        lost.append("version")
        print(f"CITATION.cff has version {cited}, codemeta.json {described}, CMakeLists.txt {version[1]}.{version[2]}")
    if not promised:
        print(f"no docs/reference/interface-{version[1]}.N.txt; python3 docs/tests/interface_test.py . --write makes it")
    print(f"{len(now)} names, {len(lost)} lost")
    return 1 if lost or not promised else 0


if __name__ == "__main__":
    sys.exit(main())
