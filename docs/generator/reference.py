#!/usr/bin/env python3
"""reference.py PROGRAM FOLDER: writes the reference that comes from the program itself (`slipstick reference --json`): pages of
commands and of keys, the manual page, the completion for bash."""

import json
import subprocess
import sys
from pathlib import Path, PurePath

import jinja2

KEY_PAGES = {
    "scene": ("Keys of a scene", "`slipstick solve SCENE.toml`, and every command that takes a scene, reads these keys. Units are SI, or\n"
              "any other consistent set, though results print SI units. `--set key=value` overrides any key, with its table:\n"
              '`--set load.moment_ratio=0.5`, `--set "step[0].moment=2"`. The meanings of allowed words are in the order of the words.'),
    "study": ("Keys of a study", "`slipstick study STUDY.toml` reads these keys."),
    "gate": ("Keys of a gate", "`slipstick gate GATES.toml` reads these keys."),
    "hard": ("Keys of hard cases", "`slipstick hard CASES.toml` reads these keys."),
    "program": ("Keys of a program", "`solver.program` and `--program FILE` name a file with these keys."),
}


def cell(text):
    """The program's own Markdown in a cell of a table."""
    for plain, escaped in (("\\", "\\\\"), ("|", "\\|"), ("<", "&lt;"), ("\n", "<br>")):
        text = text.replace(plain, escaped)
    return text


def troff(text):
    """Text of a manual page, where no line may begin with a dot or a quote."""
    lines = text.replace("\\", "\\e").replace("-", "\\-").split("\n")
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in lines)


def value_of(option):
    """The type with its range or its allowed words: "INT in [1 - 9]"."""
    kind, colon, check = option["type"].partition(":")
    if colon:
        kind = check if check.startswith("{") or " in " in check else f"{kind} {check}"
    if option["many_values"]:
        return f"{kind} ..." if kind else ""
    return f"{kind} {kind}" if kind and option["two_values"] else kind


def default_of(option):
    """Numbers in their shortest form, paths of this build by their last part."""
    text = "required" if option["required"] else option["default"]
    if text and option["type"].startswith("FLOAT") and not option["required"]:
        return f"{float(text):g}"
    return f"{PurePath(text).name} of this build" if PurePath(text).is_absolute() else text


def completed(option):
    """An option with the texts that the pages show."""
    meaning = option["meaning"]
    for verb in ("needs", "excludes"):
        if option[verb]:
            meaning += f"; {verb} {', '.join(option[verb])}"
    value = value_of(option)
    return dict(option, value=value, default=default_of(option), long_name=option["name"].rpartition(",")[2],
                meaning=meaning + ("; one of these is required" if option["one_required"] else ""),
                words=value[value.index("{") + 1:value.index("}")].split(",") if "{" in value else [])


def command(found):
    """A command; its files come before its options."""
    options = sorted(map(completed, found["options"]), key=lambda option: not option["file"])
    words = [f"{file['name']}{'...' if file['many_values'] else ''}" if file["required"] else
             f"[{file['name']}{'...' if file['many_values'] else ''}]" for file in options if file["file"]]
    return dict(found, options=options, usage=" ".join(["slipstick", found["name"], "[OPTIONS]", *words]))


def tables(keys):
    """The tables of a kind of file. A table whose keys all stand in one before it refers to that one."""
    found = {}
    for key in keys:
        table, _, name = key["name"].rpartition(".")
        shapes = f" For `{'`, `'.join(key['shapes'])}`." if key["shapes"] else ""
        row = (name, key["type"], key["unit"], key["default"], key["allowed"], cell(key["meaning"]) + shapes)
        found.setdefault(table, []).append(row)
    several = {"upper.shape", *(key["name"] for key in keys if key["type"] == "tables")}
    headings = {table: (f"[[{table}]]" if table in several else f"[{table}]") if table else "Above all tables" for table in found}
    names = list(found)
    for i, table in enumerate(names):
        same = next((headings[other] for other in names[:i] if set(found[table]) <= set(found[other])), None)
        yield {"heading": headings[table], "rows": found[table], "same": same}


def main(program, folder):
    run = subprocess.run([program, "reference", "--json", "-"], stdout=subprocess.PIPE, check=True)
    data = json.loads(run.stdout)
    pages = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent), trim_blocks=True, lstrip_blocks=True,
                               keep_trailing_newline=True, undefined=jinja2.StrictUndefined)
    pages.filters.update(cell=cell, troff=troff)
    commands = [command(found) for found in data["commands"]]
    # Keys of tables that may occur several times have no place in --set.
    scene_keys = [key["name"] for key in data["keys"]["scene"] if not key["name"].startswith(("upper.shape.", "step"))]
    texts = {name: pages.get_template(f"{name}.jinja").render(commands=commands, version=data["version"], scene_keys=scene_keys)
             for name in ("commands.md", "slipstick.1", "slipstick.bash")}
    for name, (title, text) in KEY_PAGES.items():
        texts[f"{name}.md"] = pages.get_template("keys.md.jinja").render(title=title, text=text, tables=tables(data["keys"][name]))
    Path(folder).mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        Path(folder, name).write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
