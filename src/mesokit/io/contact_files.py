"""Contacts of all frames as tables for other programs."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from mesokit.io.contact_records import FIELD, VECTORS, Records
from mesokit.io.moments import Particles

NUMBER = "%.9g"  # all digits of single precision


def csv(path: Path, particles: Particles, frames: Iterable[Mapping[str, Any]]) -> None:
    """A table: a line for each contact of each frame, particles by their numbers from 0.

    The second of a contact with a wall is -1 less the number of its surface.
    """
    axes = "xyz"[: particles.dimension]
    vectors = [f"{name}_{axis}" for name in VECTORS for axis in axes]
    with path.open("w", encoding="utf-8", newline="\n") as file:
        forces = "normal_force", "tangential_force"
        names = ("step", "time", "first", "second", *vectors, "gap", *forces)
        file.write(",".join(names) + "\n")
        for frame in frames:
            records = frame[FIELD]
            start = f"{int(frame['step'])},{float(frame['time']):.9g},%d,%d,"
            _lines(file, start + ",".join([NUMBER] * (len(vectors) + 3)), _numbers(records))


def dump_local(path: Path, particles: Particles, frames: Iterable[Mapping[str, Any]]) -> None:
    """A dump of local data as of LAMMPS: contacts of two particles, whose numbers are from 1.

    Contacts with walls are left out, since such files have none.
    """
    marks = " ".join("ff" if shut else "pp" for shut in particles.closed)
    bounds = "".join(f"0 {length:.9g}\n" for length in particles.size)
    vectors = " ".join(f"{sign}{axis}" for sign in "nfr" for axis in "xyz"[: particles.dimension])
    with path.open("w", encoding="utf-8", newline="\n") as file:
        for frame in frames:
            records = frame[FIELD][frame[FIELD]["pair"][:, 1] >= 0]
            numbers = _numbers(records)
            numbers[:, :2] += 1
            file.write(f"ITEM: TIMESTEP\n{int(frame['step'])}\nITEM: NUMBER OF ENTRIES\n")
            file.write(f"{len(records)}\nITEM: BOX BOUNDS {marks}\n{bounds}")
            file.write(f"ITEM: ENTRIES batom1 batom2 {vectors} gap fn ft\n")
            _lines(file, "%d %d " + " ".join([NUMBER] * (numbers.shape[1] - 2)), numbers)


def _numbers(records: Records) -> Any:
    """A row for each contact: pair, vectors, gap, and the two parts of the force."""
    force, normal = records["force"].astype(float), records["normal"].astype(float)
    along = (force * normal).sum(axis=1)
    across = np.linalg.norm(force - along[:, None] * normal, axis=1)
    vectors = [records[name] for name in VECTORS]
    return np.column_stack([records["pair"], *vectors, records["gap"], along, across]).astype(float)


def _lines(file: TextIO, line: str, numbers: Any) -> None:
    file.writelines((line + "\n") % tuple(row) for row in numbers.tolist())


WRITERS = {".csv": csv, ".local": dump_local}
