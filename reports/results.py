"""Reads what `slipstick report` wrote: numbers by their path, fields on their grid.

A file that cannot be read is an InputError. A number that is missing or null makes what needs it Unavailable;
the rest of the page stands.
"""

import json
import math
import re
from collections import Counter

import numpy as np

NO_REASON = "no reason given"


class InputError(Exception):
    """The data as a whole cannot be used; the message names the file."""


class Unavailable(Exception):
    """One figure or table cannot be made; the message says why."""


def load(path):
    """The object in a JSON file. NaN and Infinity are not JSON and are refused."""

    def refuse(constant):
        raise InputError(f"{path}: holds {constant}, which is not JSON (a missing number is null, with a reason)")

    try:
        content = json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: {error}") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: holds no JSON object")
    return printable(content)


STEERING = {code: f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" for code in (
    *range(0x9), *range(0xb, 0x20), *range(0x7f, 0xa0), 0x61c, 0x200e, 0x200f, *range(0x2028, 0x202f), *range(0x2066, 0x206a))}


def printable(tree):
    """The same content without characters that steer what shows a text or turn its direction; names of users may have any."""
    if isinstance(tree, dict):
        return {printable(key): printable(part) for key, part in tree.items()}
    if isinstance(tree, list):
        return [printable(part) for part in tree]
    return tree.translate(STEERING) if isinstance(tree, str) else tree


def value(tree, path):
    """The value at a dotted path; None for null."""
    for key in path.split("."):
        if tree is None:
            return None
        if not isinstance(tree, dict) or key not in tree:
            raise Unavailable(f"“{path}” is missing from the data")
        tree = tree[key]
    return tree


def number(tree, path):
    """The finite number at a dotted path."""
    found = value(tree, path)
    if found is None:
        raise Unavailable(f"“{path}” is null: {reason(tree, path)}")
    if isinstance(found, bool) or not isinstance(found, (int, float)) or not math.isfinite(found):
        raise Unavailable(f"“{path}” is not a number: {found!r}")
    return float(found)


def text(tree, path):
    """The text at a dotted path."""
    found = value(tree, path)
    if not isinstance(found, str):
        raise Unavailable(f"“{path}” is not a text: {found!r}")
    return found


def reason(tree, path):
    """Why the value at a path is null: the reason of the first null on the path."""
    for key in path.split("."):
        if tree[key] is None:
            return tree.get(key + "_reason", NO_REASON)
        tree = tree[key]
    return NO_REASON


def rows(tree, path):
    """The non-empty list at a dotted path."""
    found = value(tree, path)
    if not found:
        raise Unavailable(f"“{path}” holds no results")
    return found


def column(table, path):
    """One number of every row, NaN where it is null; Unavailable where no row has it."""
    values = np.array([np.nan if value(row, path) is None else number(row, path) for row in table])
    if np.isnan(values).all():
        raise Unavailable(f"“{path}” is null in every row: {reason(table[0], path)}")
    return values


def nearest(values, wanted):
    """Index of the value nearest to a given one."""
    return int(np.nanargmin(np.abs(values - wanted)))


def groups(table, *keys):
    """The rows by the values of some keys, in order of first appearance."""
    result = {}
    for row in table:
        result.setdefault(tuple(value(row, key) for key in keys), []).append(row)
    return result


def nulls(tree):
    """Every number that is null, as {(path without indices, reason): how often}."""
    found = Counter()

    def walk(node, path):
        if isinstance(node, list):
            for item in node:
                walk(item, path + "[]")
        elif isinstance(node, dict):
            for key, item in node.items():
                inner = f"{path}.{key}".lstrip(".")
                if item is None:
                    found[inner, node.get(key + "_reason", NO_REASON)] += 1
                walk(item, inner)

    walk(tree, "")
    return dict(found)


def _datasets(path):
    import h5py

    with h5py.File(path, "r") as file:
        return {name: file[name][...] for name in file}


def _table(path):
    with open(path, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        return dict(zip(names, np.loadtxt(file, delimiter=",", ndmin=2, unpack=True)))


class Columns:
    """The columns of a field file (HDF5, or CSV), one value for each contact cell."""

    def __init__(self, path):
        try:
            self.columns = (_table if path.suffix == ".csv" else _datasets)(path)
        except (OSError, ValueError, ImportError) as error:
            raise Unavailable(f"{path.name} cannot be read: {re.sub(r' *[(].*', '', str(error))}") from error
        self.name = path.name

    def __contains__(self, name):
        return name in self.columns

    def __getitem__(self, name):
        if name not in self.columns:
            raise Unavailable(f"{self.name} has no dataset “{name}”")
        values = self.columns[name]
        if values.size == 0 or not np.isfinite(values).all():
            raise Unavailable(f"{self.name}: “{name}” is empty or has values that are not numbers")
        return values
