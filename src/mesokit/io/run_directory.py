"""The folder of a run, and the files in it."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mesokit.case.case import Case
from mesokit.case.outside import require_parts
from mesokit.errors import CaseError, RunError
from mesokit.io.atomic import write_text
from mesokit.io.record_shape import misshapen
from mesokit.seam.method import method_of


class _Named:
    """A file or folder of this name in the folder of a run."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __get__(self, run: RunDirectory, owner: type) -> Path:
        return run.path / self.name


@dataclass(frozen=True)
class RunDirectory:
    """The files of one run in the folder `path`."""

    path: Path

    case_file = _Named("case.toml")  # the resolved case
    provenance_file = _Named("provenance.json")  # versions, seed, host, times
    data_file = _Named("run.h5")  # results and trajectory, H5MD; there once the run has ended
    checkpoint_file = _Named("checkpoint.npz")  # the last state from which the run can go on
    log_file = _Named("log.csv")  # numbers in time
    study_file = _Named("study.toml")  # there if the folder holds a study, and no run
    report_file = _Named("report.html")  # all of the run for people
    progress_file = _Named(".progress")  # number of steps done, while another process runs it
    lock_file = _Named(".lock")  # held by the process that writes here
    trajectory_folder = _Named("trajectory")  # frames that are not in the data file yet
    trajectory_remains = _Named(".trajectory.done")  # the same, while it is being removed
    trajectory_coming = _Named(".trajectory.coming")  # the same, taken out of the data file

    def wall_file(self, number: int) -> Path:
        """Distances from a solid that was read from a file, by the number of its wall."""
        return self.path / f"wall-{number}.npy"

    def part_file(self, name: str) -> Path:
        """The file of another part, such as `force.npy`."""
        return self.path / f"part-{name}"

    def figure_file(self, name: str) -> Path:
        """Figure of one result."""
        return self.path / f"{name}.png"

    def flow_file(self, kind: str, ending: str) -> Path:
        """Picture or film of the flow, unless users name another file."""
        return self.path / f"flow-{kind}{ending}"

    def files_of_parts(self) -> list[Path]:
        """Copies of the files from which parts of the case were read."""
        return [*self.path.glob("wall-*.npy"), *self.path.glob("part-*")]

    @classmethod
    def create(cls, path: str | Path, case: Case) -> RunDirectory:
        """Make the folder, and write the resolved case and the files of its parts.

        Raises RunError if something is there already, or the folder cannot be written.
        """
        run = cls(Path(path))
        run.require_empty()
        try:
            made = not run.path.exists()
            run.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise RunError(f"{path}: cannot make the folder: {reason}") from None
        try:
            kept = method_of(case).initial.kept(case, run.path)
            write_text(run.case_file, kept.to_toml(run.path))
        except BaseException:  # a folder with files but no case would refuse the next try
            for left in run.files_of_parts():
                left.unlink(missing_ok=True)
            if made:
                with contextlib.suppress(OSError):
                    run.path.rmdir()
            raise
        return run

    def require_empty(self) -> None:
        """Raise RunError if something is in the folder."""
        try:
            if self.path.is_dir() and any(self.path.iterdir()):
                hint = "resume that run or " if self.case_file.exists() else ""
                raise RunError(f"{self.path}: folder is not empty; {hint}choose another output")
        except OSError as error:
            raise RunError(f"{self.path}: {(error.strerror or str(error)).lower()}") from None

    def write_case(self, case: Case) -> None:
        """Replace the case by one that differs in how long it runs. Raises RunError."""
        write_text(self.case_file, case.to_toml(self.path))

    @property
    def again(self) -> str:
        """The command that runs the case anew."""
        return f"mesokit run {self.case_file} --output {self.path} --overwrite"

    @classmethod
    def existing(cls, path: str | Path) -> RunDirectory:
        """An earlier run. Raises RunError if there is none in that folder."""
        run = cls(Path(path))
        if not run.path.is_dir():
            raise RunError(f"{path}: no such folder")
        if run.study_file.exists():
            raise RunError(
                f"{path}: holds a study, not a run; mesokit study {path} goes on with it and shows "
                "its numbers, mesokit report writes them down, mesokit.Study.open reads them"
            )
        if not run.case_file.exists():
            raise RunError(f"{path}: holds no run; expected a file case.toml in it")
        run.require_parts()
        return run

    def require_parts(self) -> None:
        """Raise RunError if the case has a part from outside mesokit that is not here."""
        record: dict[str, Any] = {}
        with contextlib.suppress(RunError):  # a damaged record is reported elsewhere
            record = self.read_provenance()
        try:
            require_parts(record.get("parts"))
        except (RunError, CaseError) as error:
            raise RunError(f"{self.path}: {error}") from None

    def read_provenance(self) -> dict[str, Any]:
        """The record of `write_provenance`, {} if there is none. Raises RunError if damaged."""
        try:
            record = json.loads(self.provenance_file.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return {}
        except (OSError, ValueError, RecursionError) as error:
            raise RunError(f"{self.provenance_file}: cannot be read: {error}") from None
        if (wrong := misshapen(record)) is not None:
            raise RunError(f"{self.provenance_file}: damaged: {wrong}")
        return dict(record)

    @property
    def record_lost(self) -> str:
        """A warning if a run that has begun has no record, else "". Raises RunError."""
        begun = self.checkpoint_file.exists() or self.data_file.exists()
        if not begun or self.read_provenance():
            return ""
        how = "empty" if self.provenance_file.exists() else "missing"
        return f"{self.provenance_file}: {how}: what made this run is not known"

    def write_provenance(self, provenance: Mapping[str, Any]) -> None:
        """Replace the provenance. Raises RunError."""
        write_text(self.provenance_file, json.dumps(provenance, indent=2) + "\n")
