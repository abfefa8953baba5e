"""Errors with the messages of the program; docs/reference/messages.md gives cause and cure of each."""


class InputError(ValueError):
    """A mistake in the input. The message names file, key, value and allowed values."""


class Failure(RuntimeError):
    """A mistake of the library or of the program."""


class NotConvergedWarning(UserWarning):
    """A solution that did not reach its tolerance or accuracy; its `message` gives the reason."""
