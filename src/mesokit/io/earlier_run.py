"""The last state of an earlier run of the same method in the same box, to start from."""

from __future__ import annotations

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.io import checkpoint
from mesokit.io.run_directory import RunDirectory
from mesokit.seam.engine import State


def earlier_state(case: Case, path: str) -> State:
    """State of the engine at the last checkpoint of the run in a folder; of replicas, the first.

    Raises CaseError for a run of another method or in another box, OSError and MesokitError where
    there is no run or no checkpoint.
    """
    directory = RunDirectory.existing(path)
    earlier = Case.from_toml(directory.case_file)
    if earlier.run.method != case.run.method:
        raise CaseError(f"that is a run of method {show(earlier.run.method)}")
    if list(earlier.box.size) != list(case.box.size):
        raise CaseError(
            f"that run has a box of {show(list(earlier.box.size))}, this case "
            f"{show(list(case.box.size))}"
        )
    arrays, _ = checkpoint.read(directory.checkpoint_file)
    return checkpoint.part(arrays, "engine/")
