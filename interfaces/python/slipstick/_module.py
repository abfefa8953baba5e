"""Commands of the program that are modules of this package: a request and its answer, both JSON."""
from __future__ import annotations

import importlib
import json
import os
import sys
from typing import Any

from .errors import InputError


def main(module: str) -> None:
    """Reads a request from standard input, passes it to the module's answer() and writes what that returns to standard output.
    An InputError and a package that is missing are answers too."""
    request = json.load(sys.stdin)
    output = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # a library that prints does not spoil the answer
    answer: dict[str, Any]
    try:
        answer = importlib.import_module(f"slipstick.{module}").answer(request)
    except InputError as error:
        answer = {"error": str(error)}
    except ModuleNotFoundError as error:
        answer = {"missing": error.name}
    with output:
        json.dump(answer, output, allow_nan=False)
