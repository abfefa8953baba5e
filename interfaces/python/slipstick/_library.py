"""The shared library behind the package: slipstick.h as ctypes sees it. Arrays are passed without copies."""
import ctypes
import os
import pathlib
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_void_p
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import Failure, InputError

_NATIVE = pathlib.Path(__file__).parent / "_native"
_LIBRARY = ctypes.CDLL(os.fspath(_NATIVE / "libslipstick.so"))
PROGRAM = _NATIVE / "slipstick"


def has_hdf5() -> bool:
    """Whether the package contains the HDF5 library."""
    return (_NATIVE / "libslipstick_hdf5.so").exists()


OK, NOT_CONVERGED, BAD_INPUT, STOPPED, NO_MEMORY, FAILED = range(6)
PROGRESS = ctypes.CFUNCTYPE(c_int, c_int, c_double, c_void_p)


class Profile(ctypes.Structure):
    """slipstick_profile."""
    _fields_ = [(name, c_double) for name in ("load", "moment_limit", "full_stick")]


class Indentation(ctypes.Structure):
    """slipstick_indentation."""
    _fields_ = [(name, c_double) for name in ("contact_radius", "approach", "reference_pressure")]


STATE = np.dtype([(name, np.float64) for name in (
    "moment_ratio", "moment_deficit", "stick_ratio", "stick_complement", "twist", "moment", "tangent_stiffness")])
CYCLE_STATE = np.dtype([(name, np.float64) for name in (
    "moment_ratio", "moment", "twist", "stick_ratio", "tangent_stiffness", "dissipated")])
STRESS = np.dtype([(name, np.float64) for name in (
    "rr", "tt", "zz", "rz", "rt", "tz", "von_mises", "tresca", "tension")])

LARGEST_STRESS = np.dtype([(name, np.float64) for name in ("value", "radius", "depth")])

_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "version": (c_char_p, []),
    "message": (c_char_p, []),
    "exact": (c_int, [c_char_p, c_int, c_size_t, c_void_p, c_int, c_void_p]),
    "exact_states": (c_int, [c_char_p, c_int, c_size_t, c_void_p, c_void_p]),
    "exact_energy_lost": (c_int, [c_char_p, c_int, c_size_t, c_void_p, c_double, c_void_p]),
    "exact_traction": (c_int, [c_char_p, c_int, c_double, c_size_t, c_void_p, c_void_p]),
    "exact_pressure": (c_int, [c_char_p, c_size_t, c_void_p, c_void_p]),
    "exact_profile": (c_int, [c_char_p, POINTER(Profile)]),
    "exact_history": (c_int, [c_char_p, c_size_t, c_void_p, c_void_p]),
    "exact_curve": (c_int, [c_char_p, c_size_t, c_void_p, c_size_t, c_void_p]),
    "exact_history_traction": (c_int, [c_char_p, c_size_t, c_void_p, c_size_t, c_void_p, c_void_p]),
    "exact_stresses": (c_int, [c_char_p, c_int, c_size_t, c_void_p, c_double, c_double, c_size_t, c_void_p, c_void_p, c_void_p]),
    "exact_largest_stress": (c_int, [c_char_p, c_int, c_size_t, c_void_p, c_double, c_double, c_int, c_void_p]),
    "exact_indentation": (c_int, [c_char_p, c_double, c_double, c_size_t, c_void_p, POINTER(Indentation)]),
    "solve": (c_int, [c_char_p, c_char_p, c_size_t, POINTER(c_char_p), c_double, PROGRESS, c_void_p, POINTER(c_void_p)]),
    "solution_free": (None, [c_void_p]),
    "solution_json": (c_char_p, [c_void_p]),
    "solution_text": (c_char_p, [c_void_p]),
    "solution_grid": (c_int, [c_void_p, POINTER(c_size_t), POINTER(c_double)]),
    "solution_field": (c_int, [c_void_p, c_char_p, POINTER(POINTER(c_double)), POINTER(c_size_t)]),
    "solution_field_name": (c_char_p, [c_void_p, c_size_t]),
    "solution_write": (c_int, [c_void_p, c_char_p]),
}
for _name, (_result, _arguments) in _SIGNATURES.items():
    _function = getattr(_LIBRARY, f"slipstick_{_name}")
    _function.restype, _function.argtypes = _result, _arguments


def function(name: str) -> Any:
    """The C function slipstick_NAME."""
    return getattr(_LIBRARY, f"slipstick_{name}")


def text(name: str, *arguments: Any) -> str:
    """The text that the C function slipstick_NAME returns."""
    said: bytes = function(name)(*arguments)
    return said.decode(errors="replace")


def message() -> str:
    return text("message")


def checked(status: int) -> int:
    """Returns the status if there is a result; otherwise raises the corresponding exception."""
    if status in (OK, NOT_CONVERGED):
        return status
    if status == BAD_INPUT:
        raise InputError(message())
    if status == NO_MEMORY:
        raise MemoryError(message())
    if status == STOPPED:
        raise KeyboardInterrupt
    raise Failure(message())


def doubles(values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """The numbers as an array for C; copied only if necessary."""
    return np.asarray(values, dtype=np.float64, order="C")


def address(array: npt.NDArray[Any]) -> int:
    return array.ctypes.data


def encoded(text: str) -> bytes:
    """The text for C; a zero byte would end it there."""
    if "\0" in text:
        raise InputError(f"{text!r}: a text with a zero byte in it; allowed: one without")
    return os.fsencode(text)


__all__ = ["OK", "NOT_CONVERGED", "STOPPED", "PROGRESS", "PROGRAM", "Profile", "Indentation", "STATE", "CYCLE_STATE",
           "function", "text", "message", "checked", "doubles", "address", "encoded", "byref"]
