"""The folder of a run: its files while it goes on and at its end."""

import contextlib
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesokit.case.case import Case
from mesokit.case.trajectory import written
from mesokit.errors import CheckpointError, MesokitError, RunError
from mesokit.io import h5md
from mesokit.io.frames import NONE_YET, require_frames
from mesokit.io.measured import keep, take_up
from mesokit.io.one_writer import alone
from mesokit.io.provenance import now, provenance, recorded_case
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.processes.world import World
from mesokit.run.log import RunLog
from mesokit.run.replicas import Replicas
from mesokit.seam.method import summary_of
from mesokit.seam.result import Result


class Folder:
    """Case, frames, log, checkpoints, results, and the record of their origin.

    All ranks call the methods, and rank 0 writes; its errors are errors of all ranks. All raise
    RunError if writing fails. The process that runs holds the lock of the folder.
    """

    def __init__(self, directory: RunDirectory, case: Case, ranks: World, log: RunLog) -> None:
        self.directory, self.case = directory, case
        self.ranks, self.log = ranks, log
        if ranks.root:
            log.write_to(directory.log_file)
        self.writer: TrajectoryWriter | None = None
        if case.trajectory is not None:
            folder = directory.trajectory_folder
            number, first = written(case.trajectory, case.groups)
            kept = case.particles_have("diameter"), ranks.root
            self.writer = TrajectoryWriter(case.trajectory, folder, number, first, *kept)

    def begin(self, threads: int, device: str) -> None:
        """Write the record at the begin of a run."""
        origin = provenance(self.case, threads, self.ranks.size, device)
        self.ranks.on_root(lambda: self.directory.write_provenance(origin))

    # --- while it goes on -----------------------------------------------------------------------

    def record(self, engine: Any) -> None:
        """Keep a frame, if the case has frames."""
        if self.writer is not None:
            self.writer.record(engine)

    def checkpoint(self, replicas: Replicas) -> None:
        """Write a checkpoint, after all earlier frames and lines of the log."""

        def write() -> None:
            if self.writer is not None:
                self.writer.flush()
            self.log.sync()
            meta = {"step": replicas.step, "looked": replicas.looked}
            keep(self.directory, self.case, meta, replicas.all, self.ranks.root)

        self.ranks.by_root(write)

    def lengthen(self, case: Case, step: int) -> None:
        """Give the run at this step the length of `case`."""

        def write() -> None:
            self._take_back()
            self.directory.write_case(case)
            record = _earlier(self.directory) or provenance(case, threads=0)
            steps = {"at": now(), "step": step, "steps": case.run.steps}
            own = {"ended": None, "lengthened": [*record.get("lengthened", []), steps]}
            self.directory.write_provenance(record | recorded_case(case) | own)

        self.case = case
        self.ranks.on_root(write)

    def _take_back(self) -> None:
        """Remove the results of a run that goes on; its frames become segments again."""
        file = self.directory.data_file
        if self.writer is not None and file.exists():
            self.writer.take_back(h5md.frames(file), h5md.own(file))
        file.unlink(missing_ok=True)

    # --- going on -------------------------------------------------------------------------------

    def take_up(self, replicas: Replicas) -> None:
        """Restore replicas from the checkpoint, or start them if there is none, and drop later
        frames. Raises CheckpointError if it is damaged."""
        if self.ranks.on_root(self.directory.checkpoint_file.exists):
            meta = take_up(self.directory, self.case, replicas.all, self.ranks.comm)
            replicas.looked = bool(meta["looked"])
        else:
            replicas.start({})

        def forget() -> None:
            if self.writer is not None:
                seen = replicas.step if replicas.looked else NONE_YET
                require_frames(self.directory, self.case, seen)
                self.writer.resume(replicas.step)

        self.ranks.on_root(forget)

    def go_on(self, replicas: Replicas, threads: int, device: str) -> None:
        """Let log and record go on, or begin if the run had not begun."""
        step, last = replicas.step, self.case.run.warmup + self.case.run.steps

        def write() -> None:
            if step < last:  # the case may have been made longer by hand
                self._take_back()
            self.log.resume(step)
            ranks = self.ranks.size
            record = _earlier(self.directory) or provenance(self.case, threads, ranks, device)
            begun = replicas.looked or step > 0
            resumed = [*record.get("resumed", []), *[now()] * begun]
            own = {"resumed": resumed, "threads": threads, "ranks": ranks, "device": device}
            own["failed"] = None
            self.directory.write_provenance(record | recorded_case(self.case) | own)

        self.ranks.on_root(write)

    # --- the end --------------------------------------------------------------------------------

    def end(self, results: Mapping[str, Result], spent: Mapping[str, Any]) -> None:
        """Write results, figures, and the record; `spent` are the times of stages, and that after
        which nothing could happen."""

        def write() -> None:
            record = self.directory.read_provenance() | {"ended": now(), **spent}
            with contextlib.suppress(MesokitError):  # a file of the first state may be gone
                record["warnings"] = list(summary_of(self.case).warnings)
            h5md.write(self.directory.data_file, self.case, record, results.values(), self.writer)
            self.directory.write_provenance(record)
            from mesokit.report import save_all

            save_all(results.values(), self.directory.path, self.case)
            if self.writer is not None:
                self.writer.remove()

        self.ranks.on_root(write)


def existing(output: str | Path, held: contextlib.ExitStack) -> RunDirectory:
    """The folder of a run that can go on, with its lock in `held`."""
    directory = RunDirectory.existing(output)
    held.enter_context(alone(directory))
    if not directory.checkpoint_file.exists() and "merged" in _earlier(directory):
        why = "holds merged runs; go on with those and merge them again"
        raise RunError(f"{directory.path}: {why}")
    if directory.data_file.exists() and not directory.checkpoint_file.exists():
        raise CheckpointError(
            f"{directory.checkpoint_file}: no such checkpoint, though the run had come to "
            f"{directory.data_file.name}; to run it anew: {directory.again}"
        )
    return directory


def note_failed(directory: RunDirectory, reason: str) -> None:
    """Record the reason why a run failed, if it can be written: the disk may be full."""
    with contextlib.suppress(RunError):
        directory.write_provenance(directory.read_provenance() | {"failed": reason})


def _earlier(directory: RunDirectory) -> dict[str, Any]:
    """The record so far; {} with a warning for one that is damaged or lost."""
    try:
        wrong, record = directory.record_lost, directory.read_provenance()
    except RunError as error:
        wrong, record = str(error), {}
    if wrong:
        warnings.warn(f"{wrong}; going on with a fresh record", stacklevel=3)
    return record
