"""Particles that another program has written: which reader a file takes."""

from collections.abc import Callable
from pathlib import Path

from mesokit.case.component import show
from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError


def read_snapshot(path: str, scale: float | None = None) -> Snapshot:
    """The particles of a GSD file or a LAMMPS data file, told apart by the ending, with lengths
    times `scale`.

    Raises CaseError for another ending, and for a file that cannot be read.
    """
    found = _reader_of(path)(path)
    return found if scale is None else found.scaled(scale)


def _reader_of(path: str) -> Callable[[str], Snapshot]:
    ending = Path(path).suffix
    if ending == ".gsd":
        from mesokit.io.gsd_file import read

        return read
    if ending in (".data", ".lmp"):
        from mesokit.io.lammps_data import read as read_data

        return read_data
    raise CaseError(f"ending {show(ending)}: expected '.gsd', '.data' or '.lmp'")
