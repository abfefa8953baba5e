"""Scenes, solved on a grid or exactly."""
from __future__ import annotations

import ctypes
import json
import os
import signal
import threading
import warnings
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _hdf5, _library
from ._scene import Scene, prepared
from .errors import InputError, NotConvergedWarning
from .result import Result, unknown


#: Lines of the text that a solution shows of itself.
_SHOWN = ("status", "moment", "twist", "certificate")


class _Handle:
    """A solution of the library, freed with its last owner. In another process, or after a deep copy, there is none."""

    def __init__(self, pointer: int) -> None:
        self.pointer = pointer
        weakref.finalize(self, _library.function("solution_free"), pointer).atexit = False  # readers may need it until then

    def __reduce__(self) -> tuple[Any, ...]:
        return type(None), ()

    def fields(self, step: str = "") -> "Fields":
        """The fields of the last step, or of one like "steps[3]."."""
        cells, size = (ctypes.c_size_t * 2)(), (ctypes.c_double * 2)()
        _library.checked(_library.function("solution_grid")(self.pointer, cells, size))
        names: list[str] = []
        while (known := _library.function("solution_field_name")(self.pointer, len(names))) is not None:
            names.append(known.decode())
        arrays = {}
        for name in names:
            if step and "_" in name:  # corrected and exact tractions are those of the last step
                continue
            values, count = ctypes.POINTER(ctypes.c_double)(), ctypes.c_size_t()
            _library.checked(_library.function("solution_field")(
                self.pointer, (step + name).encode(), _library.byref(values), _library.byref(count)))
            memory = (ctypes.c_double * count.value).from_address(ctypes.addressof(values.contents))
            memory.handle = self  # type: ignore[attr-defined]
            arrays[name] = array = np.frombuffer(memoryview(memory), np.float64).reshape(cells[0], cells[1])
            array.flags.writeable = False
        return Fields(arrays)


class Fields(Mapping[str, npt.NDArray[np.float64]]):
    """The fields of a solution by name: x1, x2 (m), pressure, q1, q2 (Pa, on the lower body), slip1, slip2 (m, of the
    last step), stick (1 or 0), dissipated (J/m^2), pressure_sharpened, q1_sharpened, q2_sharpened (Pa, corrected
    near square-root edges), q1_exact, q2_exact (if known). Arrays of cells[0] x cells[1] in the library's memory, read-only;
    each keeps the solution alive. fields.q1 is fields["q1"]."""

    def __init__(self, arrays: dict[str, npt.NDArray[np.float64]]) -> None:
        self._arrays = arrays

    x1: npt.NDArray[np.float64]
    x2: npt.NDArray[np.float64]
    pressure: npt.NDArray[np.float64]
    q1: npt.NDArray[np.float64]
    q2: npt.NDArray[np.float64]
    slip1: npt.NDArray[np.float64]
    slip2: npt.NDArray[np.float64]
    stick: npt.NDArray[np.float64]
    dissipated: npt.NDArray[np.float64]

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        if name not in self._arrays:
            raise KeyError(f"there is no field {name}{unknown(name, self)}")
        return self._arrays[name]

    def __getattr__(self, name: str) -> npt.NDArray[np.float64]:
        if name.startswith("_") or name not in self._arrays:
            raise AttributeError(f"there is no field {name}{unknown(name, self.__dict__.get('_arrays', ()))}")
        return self._arrays[name]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._arrays]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __repr__(self) -> str:
        return f"Fields({', '.join(self)}{''.join(f': {x1.shape[0]} x {x1.shape[1]}' for x1 in [*self.values()][:1])})"


class _WithFields(Result):
    """Numbers with the fields that they belong to."""

    fields: Fields

    def plot(self) -> Any:
        """A matplotlib figure: pressure, traction with its direction, slip and stick. Needs matplotlib (slipstick[plots])."""
        from ._plot import drawn

        return drawn(self.fields, self.get("name", ""))


class Step(_WithFields):
    """A step of a history: its numbers, and its fields at its end, from x1 to dissipated."""

    def __init__(self, data: dict[str, Any], fields: Fields | InputError) -> None:
        super().__init__(data)
        self._fields = fields

    @property
    def fields(self) -> Fields:  # type: ignore[override]
        if isinstance(self._fields, InputError):
            raise self._fields
        return self._fields

    def __repr__(self) -> str:
        return f"Step({self.name!r}: {self.status}, moment {self.moment:.6g} N m, twist {self.twist_angle:.6g} rad)"


class Solution(_WithFields):
    """A scene's answer: the numbers of its result as attributes (docs/reference/results.md), its fields, its text. A pickled or
    copied solution contains them; only write() needs the process that solved."""

    name: str
    status: str
    cells: list[int]
    cell_size: list[float]
    normal_load: float
    contact_radius: float | None
    stick_radius: float | None
    stick_ratio: float | None
    peak_pressure: float
    twist: float | None
    twist_angle: float
    twist_error: float | None
    moment: float
    moment_ratio: float | None
    moment_limit: float | None
    certificate: Result
    resolved: Result
    limit: Result

    def __init__(self, pointer: int, message: str) -> None:
        self._handle: _Handle | None = _Handle(pointer)
        super().__init__(json.loads(_library.text("solution_json", pointer)))
        self.message = message
        """The reason why it cannot be trusted; empty if it converged and reached the requested accuracy."""
        self.fields = self._handle.fields()
        self._of_steps = [self._of_step(self._handle, k) for k in range(len(self._data.get("steps") or []))]
        self.text = _library.text("solution_text", pointer)
        """The result as the program prints it."""

    @staticmethod
    def _of_step(handle: _Handle, step: int) -> Fields | InputError:
        try:
            return handle.fields(f"steps[{step}].")
        except InputError as error:
            return error

    @property
    def steps(self) -> list[Step]:
        """The steps of a history, each with its numbers and its fields; of one load the only step."""
        if not self._of_steps:
            return [Step(self._data, self.fields)]
        return [Step(data, fields) for data, fields in zip(self._data["steps"], self._of_steps)]

    def __repr__(self) -> str:
        first, *rest = self.text.splitlines()
        lines = [line for line in rest if line.split()[0] in _SHOWN]
        return "\n".join([first, *lines[:len(_SHOWN)]])

    @property
    def converged(self) -> bool:
        """Whether the solve reached its tolerance and accuracy."""
        return not self.message and self["status"] == "converged"

    def write(self, file: str | os.PathLike[str]) -> None:
        """Writes all fields of the cells with pressure: .csv, .h5, .vti, or .npz."""
        if self._handle is None:
            raise InputError("write: a solution that was pickled or copied has arrays, but no files of them; allowed: the one "
                             "that solve() returned, in its process")
        if os.fspath(file).endswith(".npz"):
            rows = self.fields.pressure != 0
            np.savez(file, **{name: field[rows] for name, field in self.fields.items()})  # type: ignore[arg-type]
            return
        if _hdf5.is_h5py_needed(file):
            _hdf5.write(file, self.fields)
            return
        _library.checked(_library.function("solution_write")(self._handle.pointer, _library.encoded(os.fspath(file))))

    def fields_frame(self) -> Any:
        """The fields of the cells with pressure as a pandas.DataFrame, one row a cell. Needs pandas."""
        import pandas

        frame = pandas.DataFrame({name: field.ravel() for name, field in self.fields.items()})
        return frame[frame.pressure != 0]


class _Progress:
    """The callback of the library. An exception must not cross the library: it is stored, and the solve stops."""

    def __init__(self, progress: Callable[[int, float], object] | None) -> None:
        self.progress = progress
        self.error: BaseException | None = None
        self.function = _library.PROGRESS(self._called)

    def _called(self, iteration: int, change: float, _: int | None) -> int:
        if self.error is None and self.progress is not None:
            try:
                self.progress(iteration, change)
            except BaseException as error:  # noqa: BLE001
                self.error = error
        return 0 if self.error is None else 1

    def interrupt(self, *_: object) -> None:
        self.error = KeyboardInterrupt()


def solve(scene: Scene, *, accuracy: float = 0.0, progress: Callable[[int, float], object] | None = None,
          **overrides: Any) -> Solution:
    """Solves a scene: the name of its file, its text (a str of several lines) or a dict of its tables.

    overrides: replace keys of the scene, with two underscores for the dot: load__moment_ratio=0.5. accuracy: the relative
    error of the twist to reach; the solver then chooses cells, tolerance and model. progress(iteration, change): called
    during the solve; an exception from it ends the solve, and so does Ctrl-C. Other threads may run and solve meanwhile.

    Raises InputError for a mistake in the scene. If the solution did not converge, or did not reach the accuracy, there is a
    NotConvergedWarning.

    >>> sphere = {"upper": {"shape": "sphere", "radius": 0.018, "young_modulus": 210e9, "poisson_ratio": 0.3},
    ...           "lower": {"young_modulus": 210e9, "poisson_ratio": 0.3}, "contact": {"friction": 0.1},
    ...           "load": {"normal": 1000.0, "moment_ratio": 0.9}, "grid": {"cells": [48, 48]}}
    >>> solution = solve(sphere, load__moment_ratio=0.5)
    >>> solution.converged, round(solution.twist_angle * 1e3, 2), abs(solution.twist_error) < 1e-3  # mrad
    (True, 0.76, True)
    >>> solution.fields["pressure"].shape
    (48, 48)
    """
    return solve_assigned(scene, (), accuracy=accuracy, progress=progress, overrides=overrides)


def solve_assigned(scene: Scene, words: Sequence[str], *, accuracy: float = 0.0,
                   progress: Callable[[int, float], object] | None = None, overrides: Mapping[str, Any] = {}) -> Solution:
    """As solve(), with further overrides in the form of --set: "load.moment_ratio=0.5"."""
    called = _Progress(progress)
    pointer = ctypes.c_void_p()
    in_main = threading.current_thread() is threading.main_thread()
    with prepared(scene, overrides) as (text, name, assigned):
        encoded = [_library.encoded(word) for word in (*assigned, *words)]
        text_and_name = None if text is None else _library.encoded(text), _library.encoded(name)
        # Python drops an exception that a handler raises inside the library's callback, so this handler stores it.
        before = signal.signal(signal.SIGINT, called.interrupt) if in_main else None
        try:
            status = _library.function("solve")(
                *text_and_name, len(encoded), (ctypes.c_char_p * len(encoded))(*encoded), accuracy, called.function, None,
                _library.byref(pointer))
            message = _library.message() if status != _library.OK else ""
        finally:
            if in_main:
                signal.signal(signal.SIGINT, before or signal.SIG_DFL)
    if called.error is not None:
        if pointer.value:
            _library.function("solution_free")(pointer)
        raise called.error
    _library.checked(status)
    assert pointer.value is not None
    solution = Solution(pointer.value, message)
    if not solution.converged:
        warnings.warn(message, NotConvergedWarning, stacklevel=3)
    return solution
