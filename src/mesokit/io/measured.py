"""What observables have measured by a checkpoint."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.errors import CheckpointError
from mesokit.io import checkpoint
from mesokit.io.run_directory import RunDirectory
from mesokit.method.protocol import method_of

if TYPE_CHECKING:
    from mesokit.case.case import Case


def measured(directory: RunDirectory, case: Case) -> tuple[dict[str, Any], int]:
    """The accumulators of a run by name, as its last checkpoint has them, and the step of it.

    Raises CheckpointError if there is none or it is damaged.
    """
    path = directory.checkpoint_file
    motion = checkpoint.digest_of_motion(case.to_toml(directory.path))
    arrays, meta = checkpoint.read(path, motion, method_of(case).start_from_run)
    made = {observable.label: observable.accumulator(case) for observable in case.observe}
    with fitting(path):
        restore(made, arrays)
    return made, int(meta["step"])


def restore(accumulators: Mapping[str, Any], arrays: Mapping[str, Any]) -> None:
    """Let accumulators go on from the arrays of a checkpoint."""
    for name, accumulator in accumulators.items():
        accumulator.restore(checkpoint.part(arrays, f"observe/{name}/"))


@contextlib.contextmanager
def fitting(path: Path) -> Iterator[None]:
    """Arrays that do not fit the case are a CheckpointError."""
    try:
        yield
    except (KeyError, ValueError, IndexError) as error:
        raise CheckpointError(f"{path}: does not fit this case: {error}") from None
