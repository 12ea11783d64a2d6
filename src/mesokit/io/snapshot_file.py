"""Particles in files of other programs."""

from pathlib import Path

from mesokit.case.component import show
from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError


def read_snapshot(path: str, scale: float | None = None) -> Snapshot:
    """The particles of a GSD or LAMMPS data file, by its ending, with lengths times `scale`.

    Of GSD files it is the last frame. Raises CaseError for another ending, and for a file that
    cannot be read.
    """
    ending = Path(path).suffix
    if ending == ".gsd":
        from mesokit.io import gsd_file as reader
    elif ending in (".data", ".lmp"):
        from mesokit.io import lammps_data as reader  # type: ignore[no-redef]
    else:
        raise CaseError(f"ending {show(ending)}: expected '.gsd', '.data' or '.lmp'")
    found = reader.read(path)
    return found if scale is None else found.scaled(scale)
