"""slipstick: the elastic torsional contact with slip and stick, exact and numerical, compared.

slipstick.exact    exact states over arrays: exact.twist(moment_ratio, profile="hertz")
slipstick.solve    a scene, on a grid or exactly, with its fields as arrays
slipstick.check    a verdict on tractions that another program computed
slipstick.gate     numbers with bounds that they must keep
slipstick.study    orders of convergence and error budgets
slipstick.command  any other command of the program
"""
from . import exact
from ._library import text as _text
from .errors import Failure, InputError, NotConvergedWarning
from .judge import Check, Gates, Study, check, command, gate, study
from .result import Result
from .solution import Fields, Solution, solve

__version__: str = _text("version")
__all__ = ["exact", "solve", "check", "gate", "study", "command", "Solution", "Fields", "Result", "Check", "Gates", "Study",
           "InputError", "Failure", "NotConvergedWarning", "__version__"]
