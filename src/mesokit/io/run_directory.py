"""The folder of a run: what lies where."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.case.outside import require_parts
from mesokit.errors import CaseError, RunError
from mesokit.io.atomic import write_text
from mesokit.io.record_shape import misshapen
from mesokit.seam.method import method_of

if TYPE_CHECKING:
    from mesokit.case.case import Case


@dataclass(frozen=True)
class RunDirectory:
    """The files of one run in the folder `path`."""

    path: Path

    @property
    def case_file(self) -> Path:
        """The resolved case."""
        return self.path / "case.toml"

    @property
    def provenance_file(self) -> Path:
        """Versions, seed, host, times."""
        return self.path / "provenance.json"

    @property
    def data_file(self) -> Path:
        """Results and trajectory, H5MD; there when the run has ended."""
        return self.path / "run.h5"

    @property
    def checkpoint_file(self) -> Path:
        """The last state from which the run can go on."""
        return self.path / "checkpoint.npz"

    @property
    def log_file(self) -> Path:
        """Numbers in time."""
        return self.path / "log.csv"

    @property
    def study_file(self) -> Path:
        """What a study varies; there if the folder holds one, and no run."""
        return self.path / "study.toml"

    @property
    def report_file(self) -> Path:
        """All of the run for people, where they name no other."""
        return self.path / "report.html"

    def wall_file(self, number: int | str) -> Path:
        """Distances from a solid that was read from a file, by the number of its wall."""
        return self.path / f"wall-{number}.npy"

    def part_file(self, name: str) -> Path:
        """What another part was read from, such as `force.npy`."""
        return self.path / f"part-{name}"

    @property
    def progress_file(self) -> Path:
        """How many steps are done, while another process runs it."""
        return self.path / ".progress"

    @property
    def lock_file(self) -> Path:
        """Held by the process that writes here."""
        return self.path / ".lock"

    @property
    def trajectory_folder(self) -> Path:
        """Frames that are not in the data file yet."""
        return self.path / "trajectory"

    @property
    def trajectory_remains(self) -> Path:
        """The same while it is being removed."""
        return self.path / ".trajectory.done"

    @property
    def trajectory_coming(self) -> Path:
        """The same while it is being taken out of the data file."""
        return self.path / ".trajectory.coming"

    def figure_file(self, name: str) -> Path:
        """Figure of one result."""
        return self.path / f"{name}.png"

    def flow_file(self, kind: str, ending: str) -> Path:
        """Picture or film of the flow, where users name no other."""
        return self.path / f"flow-{kind}{ending}"

    def files_of_parts(self) -> list[Path]:
        """All that is kept of files from which parts of the case were read."""
        kept = self.wall_file("*"), self.part_file("*")
        return [path for file in kept for path in self.path.glob(file.name)]

    @classmethod
    def create(cls, path: str | Path, case: Case) -> RunDirectory:
        """Make the folder and write the resolved case, and what it is made from.

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
            kept = method_of(case).keep_files(case, run.path)
            write_text(run.case_file, kept.to_toml(run.path))
        except BaseException:  # a folder without a case holds no run, and would be in the way
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
        with contextlib.suppress(RunError):  # a damaged record is told elsewhere
            record = self.read_provenance()
        try:
            require_parts(record.get("parts"))
        except (RunError, CaseError) as error:
            raise RunError(f"{self.path}: {error}") from None

    def read_provenance(self) -> dict[str, Any]:
        """What `write_provenance` wrote, {} if nothing. Raises RunError if it is damaged."""
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
        """That a run which has begun has no record, nothing if it has. Raises RunError."""
        begun = self.checkpoint_file.exists() or self.data_file.exists()
        if not begun or self.read_provenance():
            return ""
        how = "empty" if self.provenance_file.exists() else "missing"
        return f"{self.provenance_file}: {how}: what made this run is not known"

    def write_provenance(self, provenance: Mapping[str, Any]) -> None:
        """Replace the provenance. Raises RunError."""
        write_text(self.provenance_file, json.dumps(provenance, indent=2) + "\n")
