"""dataset.py PROGRAM OUTPUT [--small] [--workers N]: writes the reference data set to OUTPUT/slipstick-reference-VERSION/ and a zip
of it. Every value is recomputed by a second path; where one differs, nothing is written and the exit code is 1. Two runs give the same
bytes. It needs the Python package (PYTHONPATH=build/python), mpmath, SciPy and h5py, and a program with certified digits."""

import argparse
import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
import zipfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import fclib
import fields
import other_contacts
import stresses
import tables
from mpmath import mpf
from slipstick import conformance
from tables import COLUMNS

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reports"))
from crate import describe  # noqa: E402

VERSION, YEAR = "1.0", "2026"
NAME = f"slipstick-reference-{VERSION}"
LICENCE = "https://creativecommons.org/licenses/by/4.0/"
NUMBERS = ("at", "radius", "value", "error", "si", "si_error", "difference", "second_error")
BUILDERS = (tables.constants, tables.first_loading, tables.loops, stresses.stresses, other_contacts.coated, other_contacts.tangential,
            other_contacts.frictional, other_contacts.ellipses, other_contacts.limit_surfaces)


def disagreements(table):
    """Rows whose second path is farther off than both errors allow; NaN is."""
    at = list(COLUMNS).index
    return [row for row in table.rows if not mpf(row[at("difference")]) <= mpf(row[at("error")]) + mpf(row[at("second_error")])]


def write_table(folder, table):
    assert not any(mark in word for row in table.rows for word in row for mark in ',"\n'), table.name  # readers split at commas
    lines = [",".join(row) for row in ([*COLUMNS], *table.rows)]
    (folder / f"{table.name}.csv").write_text("\n".join(lines) + "\n", encoding="ascii")
    def entry(row):
        words = ((row[i] or "null") if name in NUMBERS else json.dumps(row[i]) for i, name in enumerate(COLUMNS))
        return "[" + ", ".join(words) + "]"
    head = {"table": table.name, "version": VERSION, "title": table.title, "about": table.about, "source": table.source,
            "licence": "CC-BY-4.0", "columns": [{"name": name, "meaning": meaning} for name, meaning in COLUMNS.items()]}
    text = json.dumps(head, indent=1).removesuffix("\n}") + ',\n "rows": [\n' + ",\n".join(map(entry, table.rows)) + "\n]}\n"
    (folder / f"{table.name}.json").write_text(text, encoding="ascii")


def write_package(root, found, cells, problems):
    """The files about the data: README, licence, citation, schema, readers, checksums, RO-Crate."""
    values = sum(len(table.rows) for table in found)
    listed = "".join(f"| `{table.name}` | {len(table.rows):,} | {table.title} |\n" for table in found)
    columns = "".join(f"| `{name}` | {meaning} |\n" for name, meaning in COLUMNS.items())
    replaced = {"@NAME@": NAME, "@VERSION@": VERSION, "@VALUES@": f"{values:,}", "@CELLS@": f"{cells:,}", "@TABLES@": listed,
                "@COLUMNS@": columns, "@PROBLEMS@": ", ".join(f"{name} ({count:,})" for name, count in problems.items())}
    for source in sorted((HERE / "package").iterdir()):
        text = source.read_text(encoding="utf-8")
        for mark, value in replaced.items():
            text = text.replace(mark, value)
        (root / source.name).write_text(text, encoding="utf-8")
    shutil.copytree(HERE / "readers", root / "readers", ignore=shutil.ignore_patterns("__pycache__", "assemble_fclib.py"))
    shutil.copy(HERE / "readers/assemble_fclib.py", root / "fclib")
    names = sorted(file.relative_to(root).as_posix() for file in root.rglob("*") if file.is_file())
    dataset = {"@id": "./", "@type": "Dataset", "name": NAME, "version": VERSION, "datePublished": YEAR, "license": {"@id": LICENCE},
               "identifier": "a DOI is added by the archive that publishes this folder",
               "description": f"Elastic contact with friction: {values:,} values with errors, each recomputed by a second path; reference "
               "fields; discrete problems with certified solutions.", "hasPart": [{"@id": name} for name in names]}
    metadata = {"@id": "ro-crate-metadata.json", "@type": "CreativeWork", "about": {"@id": "./"},
                "conformsTo": {"@id": "https://w3id.org/ro/crate/1.1"}}
    licence = {"@id": LICENCE, "@type": "CreativeWork", "name": "CC-BY-4.0"}
    crate = {"@context": "https://w3id.org/ro/crate/1.1/context", "@graph": [metadata, dataset, *map(describe, names), licence]}
    (root / "ro-crate-metadata.json").write_text(json.dumps(crate, indent=1) + "\n")
    sums = [f"{hashlib.sha256((root / name).read_bytes()).hexdigest()}  {name}\n" for name in sorted([*names, "ro-crate-metadata.json"])]
    (root / "SHA256SUMS").write_text("".join(sums))


def write_zip(root):
    file = root.parent / f"{root.name}.zip"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for part in sorted(root.rglob("*")):
            if part.is_file():
                entry = zipfile.ZipInfo(part.relative_to(root.parent).as_posix())  # its time is 1980
                entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
                archive.writestr(entry, part.read_bytes())
    return file


def main():
    arguments = argparse.ArgumentParser(usage=__doc__)
    arguments.add_argument("program", type=Path)
    arguments.add_argument("output", type=Path)
    arguments.add_argument("--small", action="store_true", help="a part of each table, one scene, one problem")
    arguments.add_argument("--workers", type=int, default=None)
    options = arguments.parse_args()
    program, root = options.program.resolve(), options.output.resolve() / NAME
    probe = subprocess.run([program, "exact", "--moment-ratio", "0.5", "--certified", "15", "--quiet"], capture_output=True, text=True)
    if probe.returncode != 0:
        print(f"the data set needs proven digits: {probe.stderr.strip()}", file=sys.stderr)
        return 2
    shutil.rmtree(root, ignore_errors=True)
    (root / "tables").mkdir(parents=True)
    with tempfile.TemporaryDirectory(prefix="slipstick-dataset-") as work, ProcessPoolExecutor(options.workers) as pool:
        scenes, cells = fields.make(program, root / "fields", Path(work), options.small, pool)
        problems = fclib.make(program, root / "fclib", Path(work), options.small, pool)
        found = [scenes]
        for build in BUILDERS:
            found += build(str(program), options.small, pool)
            print(f"{found[-1].name}: {len(found[-1].rows):,} values", flush=True)
    wrong = [(table.name, row) for table in found for row in disagreements(table)]
    for name, row in wrong:
        print(f"{name}: the second path differs: {dict(zip(COLUMNS, row))}", file=sys.stderr)
    if wrong:
        shutil.rmtree(root)
        return 1
    for table in found:
        write_table(root / "tables", table)
    conformance.write(root / "cases")
    write_package(root, found, cells, problems)
    file = write_zip(root)
    print(f"{file}: {sum(len(table.rows) for table in found):,} values, all recomputed; {cells:,} cells audited; {len(problems)} discrete "
          f"problems; {file.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
