"""What a run has come to: its state and what its observables measured, as checkpoints hold it."""

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


def keep(
    directory: RunDirectory,
    case: Case,
    meta: Mapping[str, Any],
    engine: Any,
    accumulators: Mapping[str, Any],
) -> None:
    """Write a checkpoint. Raises RunError."""
    arrays = {f"engine/{key}": value for key, value in engine.state().items()}
    for name, accumulator in accumulators.items():
        arrays |= {f"observe/{name}/{key}": v for key, v in accumulator.state().items()}
    checkpoint.write(directory.checkpoint_file, arrays, dict(meta), _motion(directory, case))


def take_up(
    directory: RunDirectory, case: Case, engine: Any, accumulators: Mapping[str, Any]
) -> dict[str, Any]:
    """Let an engine and accumulators go on from the checkpoint; what else was kept with it.

    Raises CheckpointError if it is damaged or of another case.
    """
    path = directory.checkpoint_file
    arrays, meta = _read(directory, case)
    with fitting(path):
        engine.restore(checkpoint.part(arrays, "engine/"))
        restore(accumulators, arrays)
    return meta


def _read(directory: RunDirectory, case: Case) -> tuple[dict[str, Any], dict[str, Any]]:
    path, motion = directory.checkpoint_file, _motion(directory, case)
    return checkpoint.read(path, motion, method_of(case).start_from_run)


def _motion(directory: RunDirectory, case: Case) -> str:
    return checkpoint.digest_of_motion(case.to_toml(directory.path))


def measured(directory: RunDirectory, case: Case) -> tuple[dict[str, Any], int]:
    """The accumulators of a run by name, as its last checkpoint has them, and the step of it.

    Raises CheckpointError if there is none or it is damaged.
    """
    arrays, meta = _read(directory, case)
    made = {observable.label: observable.accumulator(case) for observable in case.observe}
    with fitting(directory.checkpoint_file):
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
