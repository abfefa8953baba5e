"""The program of the package runs check, gate and study; the result is its JSON."""
from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ._library import PROGRAM
from ._scenes import SHARE
from .errors import Failure, InputError

_MESSAGE = "slipstick: "


def run(command: str, *words: str | os.PathLike[str], progress: Callable[[str], object] | None = None,
        folder: str | None = None) -> dict[str, Any]:
    """Runs a command and returns its result, good or bad; raises an error if it could not judge. progress is called with each
    line of progress. folder: where the command runs; None: here. Ctrl-C ends the program too, and so does, on Linux, the
    end of this process; finished solves stay on disk."""
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "result.json"
        process = subprocess.Popen(
            [os.fspath(PROGRAM), "--tied-to", str(os.getpid()), command, *(os.fspath(word) for word in words), "--quiet", "--json", os.fspath(output)],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
            env={**os.environ, "SLIPSTICK_PYTHON": sys.executable}, cwd=folder)
        assert process.stderr is not None
        said: list[str] = []
        try:
            for line in process.stderr:
                if line.startswith(_MESSAGE) or said:
                    said.append(line.removeprefix(_MESSAGE))
                elif progress is not None:
                    progress(line.strip())
            code = process.wait()
        except BaseException:
            process.terminate()  # like Ctrl-C; background jobs of a shell ignore SIGINT
            process.wait()
            raise
        finally:
            process.stderr.close()
        if code in (0, 1) or (code == 2 and not said and output.exists()):  # some gates were refused
            result: dict[str, Any] = json.loads(output.read_text())
            return result
    message = "".join(said).strip() or f"slipstick {command} ended with {code}"
    raise (InputError if code == 2 else Failure)(message)


def main() -> None:
    """The program itself, as `slipstick` on the command line."""
    os.environ.setdefault("SLIPSTICK_PYTHON", sys.executable)  # draws, and runs the commands that are modules of this package
    os.execv(PROGRAM, ["slipstick", *map(_packaged, sys.argv[1:])])


def _packaged(word: str) -> str:
    """A path as in the source tree, "convergence/scenes/paper.toml", names the package's own file where there is no other."""
    own = SHARE / word
    if not word.startswith("convergence/") or os.path.exists(word) or not own.is_file():
        return word
    print(f"slipstick: {word} is the file of the package, {own}", file=sys.stderr)
    return os.fspath(own)
