"""How each script here begins and ends: with the packages that it needs, and with an exit code."""

import os
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path


def require(*names):
    """Ends the script with exit code 2 unless all packages can be imported."""
    missing = [name for name in names if find_spec(name) is None]
    if missing:
        print(f"{Path(sys.argv[0]).name}: {sys.executable} cannot import {', '.join(missing)}. On Debian or Ubuntu: apt-get install "
              f"{' '.join(f'python3-{name}' for name in missing)}; elsewhere: {sys.executable} -m pip install {' '.join(missing)}",
              file=sys.stderr)
        sys.exit(2)
    if "matplotlib" in names:  # read where no matplotlibrc of the user's can be found: a broken one ends its import
        here = Path.cwd()
        os.environ["MATPLOTLIBRC"] = os.devnull
        os.chdir("/")
        import_module("matplotlib")
        os.chdir(here)


def run(work, refused, output):
    """The exit code of a script: 0, or 2 with a message where work() raises `refused` or cannot write a file."""
    name = Path(work.__code__.co_filename).name
    try:
        work()
    except refused as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"{name}: {error.filename or output}: cannot be written: {error.strerror}", file=sys.stderr)
        return 2
    return 0
