"""Particles that another program has written: which reader a file takes."""

from __future__ import annotations

from pathlib import Path

from mesokit.case.component import show
from mesokit.case.snapshot import Snapshot
from mesokit.errors import CaseError


def read_snapshot(path: str) -> Snapshot:
    """The particles of a GSD file or a LAMMPS data file, told apart by the ending.

    Raises CaseError for another ending, and for a file that cannot be read.
    """
    ending = Path(path).suffix
    if ending == ".gsd":
        from mesokit.io.gsd_file import read

        return read(path)
    if ending in (".data", ".lmp"):
        from mesokit.io.lammps_data import read as read_data

        return read_data(path)
    raise CaseError(f"ending {show(ending)}: expected '.gsd', '.data' or '.lmp'")
