"""What goes wrong, in the words of the program: docs/reference/messages.md has cause and cure of each message."""


class InputError(ValueError):
    """What the caller got wrong. The message names file, key and value, and what is allowed."""


class Failure(RuntimeError):
    """A mistake of the library or of the program."""


class NotConvergedWarning(UserWarning):
    """A solution that did not reach what was asked of it: its `message` says why."""
