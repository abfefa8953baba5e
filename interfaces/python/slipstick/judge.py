"""Functions that start the program: it judges fields of other programs, gates and studies."""
from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor, as_completed
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from . import _hdf5
from ._columns import Columns, are_stresses, columns_of, explained, field_columns, is_loop, is_readable
from ._program import run
from ._scene import Scene, prepared
from .errors import InputError
from .result import Result

Path_ = Union[str, "os.PathLike[str]"]
Progress = Optional[Callable[[str], object]]


class Check(Result):
    """A verdict on a field: `verdict` ("good" or "bad"), `why` in one sentence, and each error with its tolerance."""

    verdict: str
    why: str

    @property
    def good(self) -> bool:
        return bool(self["verdict"] == "good")


class Gates(Result):
    """Verdicts of gates: `gates` with a row for each, `counts` by outcome, and `passed`: no gate failed unexpectedly, and none was
    refused."""

    gates: list[Result]

    @property
    def passed(self) -> bool:
        return bool(self["exit_code"] == 0)

    @property
    def why(self) -> str:
        """One line for each gate that does not pass; empty if all pass."""
        against = ("failed", "passed unexpectedly", "refused")
        return "\n".join(f"{gate.id}: {gate.why}" for gate in self["gates"] if gate.outcome in against)

    def __repr__(self) -> str:
        return f"Gates(passed={self.passed}, why={self.why!r})"


class Study(Result):
    """A study: its runs, orders of convergence and error budget."""


@contextmanager
def _files(scene: Scene, field: Any, reading: Mapping[str, Any], overrides: Mapping[str, Any]) -> Iterator[list[str]]:
    """The names of files with the scene and the field, and the overrides as options; files of objects are temporary."""
    with tempfile.TemporaryDirectory() as folder, prepared(scene, overrides) as (text, name, assigned):
        if text is not None:
            name = os.path.join(folder, "scene.toml")
            Path(name).write_text(text)
        yield [name, _file_of(field, reading, Path(folder)), *_set(assigned)]


def _file_of(field: Any, reading: Mapping[str, Any], folder: Path) -> str:
    """The file of a field, which is written if it is an object: columns of a field or of a loop, or a field on a mesh."""
    is_file = isinstance(field, (str, os.PathLike))
    if is_file and _hdf5.is_h5py_needed(field):
        field, is_file = _hdf5.read(field), False
    elif is_file and not reading:
        return os.fspath(field)
    columns = None if is_file or reading or hasattr(field, "points") else columns_of(field)
    if columns is not None:
        if are_stresses(columns):
            return _written(columns, folder / "stresses.csv", all_rows=True)
        if (own := field_columns(columns)) is not None:
            return _written(own, folder / "field.csv")
        if is_loop(columns):
            file = folder / "field.json"
            file.write_text(json.dumps({name: np.asarray(values, float).tolist() for name, values in columns.items()}))
            return os.fspath(file)
        if not is_readable(columns):
            raise explained(columns, type(field).__name__)
    from .meshes import read

    file = folder / "field.contact"
    read(field if columns is None else columns, **reading).save(file)
    return os.fspath(file)


def _written(columns: Columns, file: Path, all_rows: bool = False) -> str:
    """A table of all rows, or of those that carry a pressure or a traction."""
    sizes = {name: values.size for name, values in columns.items()}
    if len({*sizes.values()}) > 1:
        raise InputError(f"the field's arrays have {', '.join(f'{name} {size}' for name, size in sizes.items())} values; "
                         "allowed: one a cell in each")
    rows = np.column_stack([np.asarray(values, np.float64) for values in columns.values()])
    if not all_rows:
        rows = rows[(rows[:, 2:5] != 0).any(axis=1)]
    np.savetxt(file, rows, fmt="%.17g", delimiter=",", header=",".join(columns), comments="")
    return os.fspath(file)


def check(scene: Scene, field: Any, *, twist: float | None = None, tolerance: float | None = None, discrete: bool = False,
          strict: bool = False, pressure_given: bool = False, stick_slope: float | None = None, normal_stiffness: float | None = None,
          held_at: float | tuple[float, float] | None = None, read_as: Mapping[str, Any] | None = None, **overrides: Any) -> Check:
    """Judges tractions from any program; docs/guides/verify-your-solver.md explains each number.

    field: a file, or columns by name, in a dict, a DataFrame, an array of records or a Dataset of xarray: x1, x2 (m, cell centres),
    pressure, q1, q2 (Pa), one number a cell, like the fields of a Solution; x, y, p, tau_x, tau_y and other common names are known.
    Or a field at any points or on a mesh: columns, or an object of meshio or pyvista. Or a loop, as a file or as columns: moment
    (N m), rotation (rad), or force (N), displacement (m), and optionally time, normal_load. Or stresses below the surface: x1, x2, x3
    (m, depth) and some of s11, s22, s33, s12, s13, s23 (Pa). twist: the reported twist in rad
    (`twist_angle` of a result, not its normalised `twist`). tolerance: the allowed error, instead of the tolerance of the mesh.
    pressure_given: the pressure is not judged. discrete: good only if the field solves the discrete problem of its grid. strict: good
    only in the scene's own units and signs. overrides: as in solve(). If the scene is not a file, write paths in it as absolute paths.

    For a field on a mesh only: stick_slope, normal_stiffness: of its penalties, Pa/m. held_at: the radius at which its bodies are
    held, m, and perhaps a factor of the effect. read_as: choices for its reader: kind, units, body, axis, basis, centre, names.
    """
    options: list[str] = []
    for option, value in (("--twist", twist), ("--tolerance", tolerance), ("--stick-slope", stick_slope),
                          ("--normal-stiffness", normal_stiffness)):
        if value is not None:
            options += [option, repr(float(value))]
    if held_at is not None:
        options += ["--held-at", ",".join(repr(float(part)) for part in np.atleast_1d(held_at))]
    options += ["--discrete"] * discrete + ["--strict"] * strict + ["--pressure-given"] * pressure_given
    with _files(scene, getattr(field, "fields", field), read_as or {}, overrides) as files:
        return Check(run("check", *files, *options))


def gate(files: Path_ | Iterable[Path_], *, only: Iterable[str] = (), output: Path_ | None = None,
         results: Path_ | None = None, jobs: int = 0, executor: Executor | None = None, progress: Progress = None) -> Gates:
    """Runs gates: numbers with bounds that they must keep (docs/guides/gate-your-ci.md).

    files: gate files. only: ids of the gates to run. output: a folder that stores finished solves (default: they are not
    stored). results: the folder of the result files that gates name. jobs: parallel solves, 0: one a processor. executor:
    solves the runs, as in study(). Raises InputError if a file is missing; a gate that cannot be judged has the outcome `refused`.
    """
    names = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    if missing := [os.fspath(name) for name in names if not os.path.isfile(name)]:
        raise InputError(f"{', '.join(missing)}: cannot be read: no such file; allowed: files with gates")
    options = ["--only", *only] if (only := list(only)) else []
    if results is not None:
        options += ["--results", os.fspath(results)]
    with _kept(output) as folder:
        words = [*names, *options, "--output", folder, "--jobs", str(jobs)]
        _solve_listed("gate", words, executor, progress)
        return Gates(run("gate", *words, progress=progress))


def assert_gates(files: Path_ | Iterable[Path_], **options: Any) -> Gates:
    """As gate(), for tests: AssertionError with a line for each gate that does not pass.

        def test_accuracy():
            slipstick.assert_gates("gates.toml")
    """
    __tracebackhide__ = True  # pytest shows the line of the test
    gates = gate(files, **options)
    if not gates.passed:
        raise AssertionError(gates.why)
    return gates


def study(file: Path_, *, output: Path_ | None = None, jobs: int = 0, executor: Executor | None = None,
          progress: Progress = None, **overrides: Any) -> Study:
    """Solves a scene on many meshes or with many tolerances, and judges orders and errors (docs/reference/study.md).

    file: a study file. output: a folder that stores finished solves, which the same call uses again (default: they are not
    stored). jobs: parallel solves, 0: one a processor. executor: solves each run in a call of its own, in processes or on other
    machines that have this package and see the files under the same paths (docs/guides/many-scenes.md). overrides: replace keys
    of the scene, as in solve().
    """
    with _kept(output) as folder, prepared(Path(file), overrides) as (_, name, assigned):
        words: list[Path_] = [name, *_set(assigned), "--output", folder, "--jobs", str(jobs)]
        _solve_listed("study", words, executor, progress)
        return Study(run("study", *words, progress=progress))


def command(name: str, *words: Path_, progress: Progress = None) -> Result:
    """Runs any command of the program with its options (docs/reference/commands.md), and returns its result.

    >>> command("exact", "--profile", "cone", "--stick-ratio", "1").moment_ratio
    0.0
    """
    return Result(run(name, *words, progress=progress))


def _solve_listed(command: str, words: list[Path_], executor: Executor | None, progress: Progress) -> None:
    """Solves the runs that a command lists, and lists again with their results, until the list is empty."""
    seen: set[str] = set()
    while executor is not None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "runs.jsonl"
            run(command, *words, "--list-runs", file)
            lines = [line for line in file.read_text().splitlines() if line not in seen]
        if not lines:
            return
        seen.update(lines)
        futures = [executor.submit(_solve_line, line, os.getcwd()) for line in lines]
        try:
            for done, future in enumerate(as_completed(futures), 1):
                future.result()
                if progress is not None:
                    progress(f"{done} of {len(lines)} runs")
        finally:
            for future in futures:
                future.cancel()


def _solve_line(line: str, folder: str) -> None:
    """Solves one run of a list that was written in this folder."""
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "runs.jsonl"
        file.write_text(line + "\n")
        run("run", file, "--only", "1", folder=folder)


def _set(assigned: list[str]) -> list[str]:
    return [word for assignment in assigned for word in ("--set", assignment)]


@contextmanager
def _kept(output: Path_ | None) -> Iterator[str]:
    if output is not None:
        yield os.fspath(output)
        return
    with tempfile.TemporaryDirectory() as folder:
        yield folder
