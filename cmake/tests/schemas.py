"""The schemas of docs/schema, for tests."""

import json
from pathlib import Path

import jsonschema

ROOT = Path(__file__).resolve().parents[2]
SCHEMAS = {path.name.split(".")[0]: json.loads(path.read_text()) for path in (ROOT / "docs/schema").glob("*.json")}


def validator(name, part=None):
    """The validator of a schema, or of one of its $defs."""
    schema = {"$ref": f"{SCHEMAS[name]['$id']}#/$defs/{part}"} if part else SCHEMAS[name]
    try:
        import referencing
    except ImportError:  # before jsonschema 4.18
        store = {each["$id"]: each for each in SCHEMAS.values()}
        known = {"resolver": jsonschema.RefResolver(schema.get("$id", ""), schema, store)}
    else:
        resources = [(each["$id"], referencing.Resource.from_contents(each)) for each in SCHEMAS.values()]
        known = {"registry": referencing.Registry().with_resources(resources)}
    return jsonschema.Draft202012Validator(schema, **known)


def parse(text):
    """JSON as the standard has it: NaN and Infinity are none."""
    def refuse(word):
        raise ValueError(f"{word} is no JSON")
    return json.loads(text, parse_constant=refuse)


def unexplained(value, path="$"):
    """Nulls without a reason, and reasons without a null."""
    if isinstance(value, list):
        return [found for i, each in enumerate(value) for found in unexplained(each, f"{path}[{i}]")]
    if not isinstance(value, dict):
        return []
    found = [f"{path}.{key}" for key, each in value.items() if each is None and not value.get(f"{key}_reason")]
    found += [f"{path}.{key}" for key in value if key.endswith("_reason") and value.get(key[:-7], 0) is not None]
    return found + [each for key in value for each in unexplained(value[key], f"{path}.{key}")]


def problem(result, name, part=None):
    """Where and how a result differs from a schema, or the nulls without a reason; empty: it follows."""
    error = jsonschema.exceptions.best_match(validator(name, part).iter_errors(result))
    if error:
        return f"{name}: {error.json_path}: {error.message[:400]}"
    return " ".join(unexplained(result))
