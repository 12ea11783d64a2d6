"""States of engines and observables, written to checkpoints and restored from them."""

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.errors import CheckpointError, MesokitError
from mesokit.io import checkpoint
from mesokit.io.arrays_file import LARGE
from mesokit.io.run_directory import RunDirectory
from mesokit.seam.method import method_of
from mesokit.seam.pooled import pool


def keep(
    directory: RunDirectory,
    case: Case,
    meta: Mapping[str, Any],
    replicas: Sequence[Any],
    here: bool = True,
) -> None:
    """Write a checkpoint of these replicas. All ranks call this; the one with `here` writes.

    Raises RunError.
    """
    arrays: dict[str, Any] = {}
    for k, one in enumerate(replicas):
        states = {"engine": one.engine.state()}
        states |= {f"observe/{name}": a.state() for name, a in one.accumulators.items()}
        for start, state in states.items():
            arrays |= {f"{_prefix(k)}{start}/{key}": v for key, v in state.items()}
    motion = checkpoint.digest_of_motion(case.to_toml(directory.path))
    checkpoint.write(directory.checkpoint_file, arrays, meta, motion, here)


def _prefix(k: int) -> str:
    """Begin of the names of arrays of replica k; "" for the first, which may be the only one."""
    return f"replica-{k}/" if k else ""


def take_up(
    directory: RunDirectory, case: Case, replicas: Sequence[Any], comm: Any = None
) -> dict[str, Any]:
    """Restore engines and accumulators of replicas from the checkpoint; returns its meta.

    Of several ranks, those of `comm`, the first one reads.

    Raises CheckpointError if it is damaged or of another case.
    """
    if comm is None:
        arrays, meta = _read(directory, case)
    else:
        engines = tuple(f"{_prefix(k)}engine/" for k in range(len(replicas)))
        arrays, meta = _read_by_one(directory, case, engines, comm)
    with fitting(directory.checkpoint_file):
        if type(meta.get("looked")) is not bool:
            raise ValueError("it does not say whether its step was looked at")
        for k, replica in enumerate(replicas):
            own = checkpoint.part(arrays, _prefix(k))
            replica.engine.restore(checkpoint.part(own, "engine/"))
            restore(replica.accumulators, own)
            if replica.engine.step != meta["step"]:
                raise ValueError(
                    f"it is of step {meta['step']}, its state of step {replica.engine.step}"
                )
    return meta


def _read(
    directory: RunDirectory, case: Case, large: float = math.inf
) -> tuple[dict[str, Any], dict[str, Any]]:
    motion = checkpoint.digest_of_motion(case.to_toml(directory.path))
    start_key = method_of(case).initial.run
    return checkpoint.read(directory.checkpoint_file, motion, start_key, large)


def _read_by_one(
    directory: RunDirectory, case: Case, engines: tuple[str, ...], comm: Any
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The same on all ranks: the first reads, and sends all arrays but those of the engines, which
    distribute their own."""
    arrays: dict[str, Any] = {}
    sent: Any = None
    if comm.rank == 0:
        try:
            arrays, meta = _read(directory, case, LARGE)
            plain = {k: np.asarray(v) for k, v in arrays.items() if not k.startswith(engines)}
            sent = plain, meta, ""
        except CheckpointError as error:
            sent = {}, {}, str(error)
    plain, meta, wrong = comm.bcast(sent)
    if wrong:
        raise CheckpointError(wrong)
    return arrays or plain, meta


def measured(directory: RunDirectory, case: Case) -> tuple[dict[str, Any], int]:
    """The accumulators of a run by name, as its last checkpoint has them, and the step of it.

    Those of replicas are pooled. Raises CheckpointError if there is none or it is damaged.
    """
    arrays, meta = _read(directory, case)
    pooled: dict[str, Any] = {}
    with fitting(directory.checkpoint_file):
        for k in range(case.run.replicas):
            made = {observable.label: observable.accumulator(case) for observable in case.observe}
            restore(made, checkpoint.part(arrays, _prefix(k)))
            for name, accumulator in made.items():
                if k:
                    pool(name, pooled[name], accumulator)
                else:
                    pooled[name] = accumulator
    return pooled, meta["step"]


def restore(accumulators: Mapping[str, Any], arrays: Mapping[str, Any]) -> None:
    """Restore accumulators from the arrays of a checkpoint.

    Raises ValueError for one of other dimensions or another kind of numbers.
    """
    for name, accumulator in accumulators.items():
        own = checkpoint.part(arrays, f"observe/{name}/")
        for key, empty in accumulator.state().items():
            empty, given = np.asarray(empty), np.asarray(own[key])  # which may have grown
            other = (empty.ndim, empty.dtype.kind) != (given.ndim, given.dtype.kind)
            if empty.size and (other or given.size < empty.size):
                raise ValueError(f"observe/{name}/{key}: {given.dtype} of shape {given.shape}")
        accumulator.restore(own)


@contextlib.contextmanager
def fitting(path: Path) -> Iterator[None]:
    """Raise CheckpointError for any error of arrays that do not fit the case."""
    try:
        yield
    except MesokitError:
        raise
    except KeyError as error:
        lacks = f"{error.args[0]} is missing; an earlier version may have written it"
        raise CheckpointError(f"{path}: does not fit this case: {lacks}") from None
    except Exception as error:
        raise CheckpointError(f"{path}: does not fit this case: {error}") from None
