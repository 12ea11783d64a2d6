"""What a run says of itself in its folder: that it was begun, resumed, made longer, or failed."""

from __future__ import annotations

import contextlib
import warnings
from typing import TYPE_CHECKING, Any

from mesokit.errors import RunError
from mesokit.io.run_directory import RunDirectory, now, provenance, recorded_case

if TYPE_CHECKING:
    from mesokit.case.case import Case


def earlier(directory: RunDirectory) -> dict[str, Any]:
    """The record so far, {} if there is none; one that is damaged or lost is a warning, and begun
    anew."""
    try:
        wrong, record = directory.record_lost, directory.read_provenance()
    except RunError as error:
        wrong, record = str(error), {}
    if wrong:
        warnings.warn(f"{wrong}; going on with a fresh record", stacklevel=3)
    return record


def note_resumed(
    directory: RunDirectory, case: Case, threads: int, ranks: int, begun: bool
) -> None:
    """It goes on, or begins if it had not begun. Raises RunError if that cannot be written."""
    record = earlier(directory) or provenance(case, threads, ranks)
    resumed = [*record.get("resumed", []), *([now()] if begun else [])]
    now_is = {"resumed": resumed, "threads": threads, "ranks": ranks, "failed": None}
    directory.write_provenance(record | recorded_case(case) | now_is)


def note_longer(directory: RunDirectory, case: Case, step: int) -> None:
    """At a step it was given the length that the case has now. Raises RunError."""
    record = earlier(directory) or provenance(case, threads=0)
    longer = [*record.get("lengthened", []), {"at": now(), "step": step, "steps": case.run.steps}]
    own = recorded_case(case) | {"ended": None, "lengthened": longer}
    directory.write_provenance(record | own)


def note_failed(directory: RunDirectory | None, reason: str) -> None:
    """Why it failed, where that can be written: the disk may be what failed."""
    if directory is not None:
        with contextlib.suppress(RunError):
            directory.write_provenance(directory.read_provenance() | {"failed": reason})
