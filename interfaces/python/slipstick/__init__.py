"""slipstick: the elastic torsional contact with slip and stick, exact and numerical, compared.

slipstick.exact    exact states over arrays: exact.twist(moment_ratio, profile="hertz")
slipstick.scenes   names of scenes that come with the package, slipstick.scene(name) the file of one
slipstick.solve    a scene, on a grid or exactly, with its fields as arrays
slipstick.check    a verdict on tractions that another program computed
slipstick.gate     numbers with bounds that they must keep, slipstick.assert_gates in tests
slipstick.study    orders of convergence and error budgets
slipstick.conformance  cases for the friction of simulators, with verdicts (import it by this name)
slipstick.command  any other command of the program
"""
from . import exact
from ._library import text as _text
from ._scenes import scene, scenes
from .errors import Failure, InputError, NotConvergedWarning
from .judge import Check, Gates, Study, assert_gates, check, command, gate, study
from .result import Result
from .solution import Fields, Solution, Step, solve

__version__: str = _text("version")
__all__ = ["exact", "scenes", "scene", "solve", "check", "gate", "assert_gates", "study", "command", "Solution", "Step", "Fields",
           "Result", "Check", "Gates", "Study", "InputError", "Failure", "NotConvergedWarning", "__version__"]
