"""What a run has come to: its state and what its observables measured, as checkpoints hold it."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.errors import CheckpointError
from mesokit.io import checkpoint
from mesokit.io.run_directory import RunDirectory
from mesokit.method.protocol import method_of
from mesokit.observe.shared.pooled import pool

if TYPE_CHECKING:
    from mesokit.case.case import Case


def keep(
    directory: RunDirectory, case: Case, meta: Mapping[str, Any], arrays: Mapping[str, Any]
) -> None:
    """Write a checkpoint of these arrays. Raises RunError."""
    checkpoint.write(directory.checkpoint_file, dict(arrays), dict(meta), _motion(directory, case))


def take_up(
    directory: RunDirectory, case: Case, parts: Iterable[tuple[str, Any]]
) -> dict[str, Any]:
    """Let engines and accumulators go on from the checkpoint; what else was kept with it.

    `parts` are replicas, each with what the names of its arrays begin with.

    Raises CheckpointError if it is damaged or of another case.
    """
    path = directory.checkpoint_file
    arrays, meta = _read(directory, case)
    with fitting(path):
        for prefix, replica in parts:
            own = checkpoint.part(arrays, prefix)
            replica.engine.restore(checkpoint.part(own, "engine/"))
            restore(replica.accumulators, own)
    return meta


def _read(directory: RunDirectory, case: Case) -> tuple[dict[str, Any], dict[str, Any]]:
    path, motion = directory.checkpoint_file, _motion(directory, case)
    return checkpoint.read(path, motion, method_of(case).start_from_run)


def _motion(directory: RunDirectory, case: Case) -> str:
    return checkpoint.digest_of_motion(case.to_toml(directory.path))


def measured(directory: RunDirectory, case: Case) -> tuple[dict[str, Any], int]:
    """The accumulators of a run by name, as its last checkpoint has them, and the step of it.

    Those of replicas are pooled. Raises CheckpointError if there is none or it is damaged.
    """
    arrays, meta = _read(directory, case)
    pooled: dict[str, Any] = {}
    with fitting(directory.checkpoint_file):
        for k in range(case.run.replicas):
            made = {observable.label: observable.accumulator(case) for observable in case.observe}
            restore(made, checkpoint.part(arrays, f"replica-{k}/") if k else arrays)
            for name, accumulator in made.items():
                if k:
                    pool(name, pooled[name], accumulator)
                else:
                    pooled[name] = accumulator
    return pooled, int(meta["step"])


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
