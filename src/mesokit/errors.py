"""The errors that users see. The text of each is one line that says what to change."""


class MesokitError(Exception):
    """Any error that mesokit raises on purpose; `str(error)` is one line for the user."""


class CaseError(MesokitError):
    """A case that cannot be run: unknown key, bad value or impossible combination."""


class RunError(MesokitError):
    """A run that cannot go on: full disk, missing file, numbers that blew up."""


class CheckpointError(RunError):
    """A checkpoint that is damaged or belongs to another case."""
