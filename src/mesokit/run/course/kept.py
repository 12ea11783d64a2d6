"""What a run keeps in its folder while it goes on: frames, log, checkpoints."""

from __future__ import annotations

import contextlib
from pathlib import Path

from mesokit.case.trajectory import written
from mesokit.errors import CheckpointError, RunError
from mesokit.io import h5md
from mesokit.io.frames import NONE_YET, require_frames
from mesokit.io.measured import keep
from mesokit.io.one_writer import alone
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.run import record
from mesokit.run.course.held import Held


def existing(output: str | Path, held: contextlib.ExitStack) -> RunDirectory:
    """A run that can go on, and in whose folder nobody else writes as long as that is held."""
    directory = RunDirectory.existing(output)
    held.enter_context(alone(directory))
    if not directory.checkpoint_file.exists() and "merged" in record.earlier(directory):
        raise RunError(
            f"{directory.path}: holds merged runs; go on with those and merge them again"
        )
    if directory.data_file.exists() and not directory.checkpoint_file.exists():
        raise CheckpointError(
            f"{directory.checkpoint_file}: no such checkpoint, though the run had come to "
            f"{directory.data_file.name}; to run it anew: {directory.again}"
        )
    return directory


class Kept(Held):
    """The folder of a run, if there is one."""

    def _attach(self, directory: RunDirectory) -> None:
        self.directory = directory
        if self.ranks.root:
            self.log.write_to(directory.log_file)
        if self.case.trajectory is not None:
            folder = directory.trajectory_folder
            number, first = written(self.case.trajectory, self.case.groups)
            spheres = self.case.particles_have("diameter")
            kept = spheres, self.ranks.root
            self.writer = TrajectoryWriter(self.case.trajectory, folder, number, first, *kept)

    def _resume_frames(self) -> None:
        """Those that came after the checkpoint are forgotten."""
        if self.writer is not None:
            assert self.directory is not None
            seen = self.step if self._looked else NONE_YET
            require_frames(self.directory, self.case, seen)
            self.writer.resume(self.step)

    def _keep(self) -> None:
        """What came before a checkpoint is as safe as the checkpoint."""
        assert self.directory is not None
        if self.writer is not None:
            self.writer.flush()
        self.log.sync()
        meta = {"step": self.step, "looked": self._looked}
        keep(self.directory, self.case, meta, self.replicas.state(), self.ranks.root)

    def _take_back(self) -> None:
        """A run that goes on has no results yet: its frames come back out of the data file."""
        assert self.directory is not None
        if self.writer is not None and self.directory.data_file.exists():
            file = self.directory.data_file
            self.writer.take_back(h5md.frames(file), h5md.own(file))
        self.directory.data_file.unlink(missing_ok=True)

    def _write_longer(self) -> None:
        assert self.directory is not None
        self._take_back()
        self.directory.write_case(self.case)
        record.note_longer(self.directory, self.case, self.step)
