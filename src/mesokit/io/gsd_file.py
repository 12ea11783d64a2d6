"""GSD files, those of HOOMD-blue, OVITO and others: the schema `hoomd` of the package gsd.

Their box has its middle at the origin. A field that a file leaves out has a default; for
velocities, which are 0 then, that is as good as none.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.errors import CaseError
from mesokit.io.optional import package
from mesokit.mpcd.snapshot import Snapshot


def read(path: str) -> Snapshot:
    """The particles of the last frame. Raises CaseError for a file that cannot be read."""
    hoomd = package("gsd.hoomd", "GSD files")
    try:
        with hoomd.open(path, mode="r") as file:
            if not len(file):
                raise CaseError("it has no frame")
            return _snapshot(file[len(file) - 1], file.file, len(file) - 1)
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise CaseError(f"cannot be read as a GSD file: {reason}") from None


def _snapshot(frame: Any, file: Any, index: int) -> Snapshot:
    box = np.asarray(frame.configuration.box, float)
    particles, bonds = frame.particles, frame.bonds
    n = int(particles.N)

    def stored(name: str) -> bool:
        chunk = f"particles/{name}"
        return bool(file.chunk_exists(index, chunk) or file.chunk_exists(0, chunk))

    links = np.zeros((0, 2), int) if not bonds.N else np.asarray(bonds.group, int)
    if links.size and not 0 <= links.min() <= links.max() < n:
        raise CaseError(f"it links particle {links.max()}, of {n}")
    return Snapshot(
        positions=np.asarray(particles.position, float),
        velocities=np.asarray(particles.velocity, float) if stored("velocity") else None,
        images=np.asarray(particles.image, np.int64) if stored("image") else None,
        masses=np.asarray(particles.mass, float) if stored("mass") else None,
        bonds=links,
        numbers=np.arange(n),
        low=-0.5 * box[:3],
        lengths=box[:3],
        tilts=box[3:],
    )
