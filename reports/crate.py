"""The provenance of a page as an RO-Crate (https://w3id.org/ro/crate/1.1): each figure and its data can be traced to scene,
build and machine by any program that reads such files."""

import datetime
import json
import mimetypes
import os

from whole_file import write_whole

NAME = "ro-crate-metadata.json"


def parts(folder):
    """The files of a page, by their place in its folder."""
    files = [folder / "index.html", folder / "data" / "report.json"]
    files += sorted(file for file in (folder / "data").glob("*") if file.suffix in (".h5", ".csv")) + sorted((folder / "figures").glob("*"))
    return [file.relative_to(folder).as_posix() for file in files if file.is_file()]


def describe(name):
    kind = mimetypes.guess_type(name)[0] or ("application/x-hdf5" if name.endswith(".h5") else "application/octet-stream")
    return {"@id": name, "@type": "File", "name": name.rpartition("/")[2], "encodingFormat": kind}


def crate(page, files, now):
    """The description of a page made of these files."""
    build = page["provenance"]
    name, verdict = page["scene"]["name"], page["headline"]["verdict"]
    machine = [{"@id": f"#{name}", "@type": "PropertyValue", "name": name, "value": str(build[name])}
               for name in ("compiler", "flags", "libraries", "cpu", "threads") if build.get(name) is not None]
    program = {"@id": "#slipstick", "@type": "SoftwareApplication", "name": "slipstick", "version": build["version"],
               "softwareVersion": build.get("commit") or build["version"]}
    action = {"@id": "#solve", "@type": "CreateAction", "name": "slipstick report", "endTime": now,
              "instrument": {"@id": "#slipstick"}, "object": {"@id": "#scene"}, "result": [{"@id": name} for name in files],
              "additionalProperty": [{"@id": entry["@id"]} for entry in machine]}
    scene = {"@id": "#scene", "@type": "CreativeWork", "name": name, "encodingFormat": "application/toml",
             "text": page["scene"]["text"]}
    root = {"@id": "./", "@type": "Dataset", "name": f"slipstick: {name}",
            "description": f"Answer, errors and orders of the scene {name}, whose verdict is {verdict}.",
            "datePublished": now, "license": {"@id": "https://spdx.org/licenses/GPL-3.0-or-later"},
            "hasPart": [{"@id": name} for name in files], "mentions": {"@id": "#solve"}}
    metadata = {"@id": NAME, "@type": "CreativeWork", "conformsTo": {"@id": "https://w3id.org/ro/crate/1.1"},
                "about": {"@id": "./"}}
    licence = {"@id": root["license"]["@id"], "@type": "CreativeWork", "name": "GPL-3.0-or-later"}
    return {"@context": "https://w3id.org/ro/crate/1.1/context",
            "@graph": [metadata, root, *map(describe, files), scene, program, action, *machine, licence]}


def write(folder, page):
    """Writes the crate to the folder of the page. Its time is SOURCE_DATE_EPOCH, if that is set."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH")
    when = datetime.datetime.fromtimestamp(float(seconds), datetime.timezone.utc) if seconds else \
        datetime.datetime.now(datetime.timezone.utc)
    found = crate(page, parts(folder), when.isoformat(timespec="seconds"))
    write_whole(folder / NAME, json.dumps(found, indent=1).encode())
