"""Spheres as a data file of LAMMPS: atom style sphere, with diameters, densities and spins."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from mesokit.io.moments import Moment, Particles

FIGURES = "%.17g"


def write(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """The last frame. In LAMMPS disks are spheres that stay in a plane, and so is their density."""
    now = None
    for now in moments:  # noqa: B007  the last one is meant
        pass
    assert now is not None
    n, numbers = len(particles.number), particles.number + 1
    density = particles.mass / (math.pi / 6 * particles.diameter**3)
    image = np.zeros((n, 3), int) if now.image is None else now.image
    with path.open("w", encoding="utf-8", newline="\n") as file:
        kinds = " ".join(particles.names)
        file.write(f"spheres of mesokit at step {now.step}, time {now.time:.9g}: {kinds}\n\n")
        file.write(f"{n} atoms\n{len(particles.names)} atom types\n\n")
        low = np.zeros(3)
        low[particles.dimension :] = -0.5  # LAMMPS wants the plane of disks inside its box
        for axis, start, length in zip("xyz", low.tolist(), particles.size.tolist(), strict=True):
            file.write(f"{start:.17g} {start + length:.17g} {axis}lo {axis}hi\n")
        if now.tilt:
            file.write(f"{now.tilt:.17g} 0 0 xy xz yz\n")
        columns = [numbers, particles.kind + 1, particles.diameter, density, now.position, image]
        file.write("\nAtoms # sphere\n\n")
        _rows(file, columns, ["%d", "%d", *[FIGURES] * 5, *["%d"] * 3])
        if now.velocity is not None:
            spin = np.zeros((n, 3)) if now.spin is None else now.spin
            file.write("\nVelocities\n\n")
            _rows(file, [numbers, now.velocity, spin], ["%d", *[FIGURES] * 6])


def _rows(file: Any, columns: list[Any], forms: list[str]) -> None:
    np.savetxt(file, np.column_stack(columns), fmt=" ".join(forms))
