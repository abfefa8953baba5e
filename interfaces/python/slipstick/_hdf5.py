"""HDF5 files by h5py, if the package has no HDF5 library of its own; a wheel has none."""
from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _library
from .errors import InputError


def is_h5py_needed(file: str | os.PathLike[str]) -> bool:
    """Whether the file is HDF5 and the library cannot read or write it."""
    return Path(file).suffix in (".h5", ".hdf5") and not _library.has_hdf5()


def _h5py(file: str | os.PathLike[str]) -> Any:
    try:
        import h5py
    except ImportError:
        raise InputError(f"{os.fspath(file)}: this package holds no HDF5; allowed: pip install h5py, a .csv file, or "
                         "arrays") from None
    return h5py


def read(file: str | os.PathLike[str]) -> dict[str, npt.NDArray[np.float64]]:
    """The datasets at the top of a file by name, without the datasets of groups."""
    h5py = _h5py(file)
    try:
        with h5py.File(file, "r") as stored:
            return {name: np.asarray(part[...], np.float64) for name, part in stored.items()
                    if isinstance(part, h5py.Dataset) and np.issubdtype(part.dtype, np.number)}
    except OSError as error:
        raise InputError(f"{os.fspath(file)}: {error}; allowed: an HDF5 file") from None


def write(file: str | os.PathLike[str], fields: Mapping[str, npt.NDArray[np.float64]]) -> None:
    """A dataset for each field, with the cells that have pressure, as the library writes them. An existing file is replaced only
    when the new one is complete."""
    h5py = _h5py(file)
    new = Path(f"{os.fspath(file)}.{os.getpid()}.new")
    rows = fields["pressure"] != 0
    try:
        with h5py.File(new, "w") as stored:
            for name, field in fields.items():
                stored[name] = field[rows]
        os.replace(new, file)
    except OSError as error:
        new.unlink(missing_ok=True)
        raise InputError(f"{os.fspath(file)}: {error}; allowed: a place where files can be written") from None
