"""Frames as text: dumps and data files of LAMMPS, and extended XYZ. None of them has bonds.

Columns have the names of LAMMPS, VMD and OVITO: of spheres also radius and angular velocity.
"""

import math
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from mesokit.io.moments import Moment, Particles

FIGURES = "%.9g"  # of a number: all digits of single precision
EXACT = " %.17g"  # a number with all digits of double precision


def dump(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """A text dump of LAMMPS: ids from 1, wrapped positions, images and velocities if known."""
    marks = " ".join("ff" if shut else "pp" for shut in particles.closed)
    axes = _axes(particles)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        for now in moments:
            bounds = np.stack([np.zeros(3), particles.size], axis=1)
            head, tilts = f"ITEM: BOX BOUNDS {marks}", ["", "", ""]
            if now.tilt:  # bounds of an upright box around the tilted one
                bounds[0] += min(0.0, now.tilt), max(0.0, now.tilt)
                head, tilts = f"ITEM: BOX BOUNDS xy xz yz {marks}", [f" {now.tilt:.9g}", " 0", " 0"]
            file.write(f"ITEM: TIMESTEP\n{now.step}\nITEM: NUMBER OF ATOMS\n")
            file.write(f"{len(particles.number)}\n{head}\n")
            for (low, high), tilt in zip(bounds.tolist(), tilts, strict=True):
                file.write(f"{low:.9g} {high:.9g}{tilt}\n")
            columns: list[tuple[str, str, Any]] = [
                ("id", "%d", particles.number + 1), ("type", "%d", particles.kind + 1),
                ("element", "%s", np.array(particles.names)[particles.kind]),
                ("mol", "%d", particles.molecule + 1),
                ("diameter", FIGURES, particles.diameter),
                *([("radius", FIGURES, 0.5 * particles.diameter)] * particles.spheres),
                ("mass", FIGURES, particles.mass), *_vector("x y z", FIGURES, now.position),
                *_vector("ix iy iz", "%d", now.image), *_vector("vx vy vz", FIGURES, now.velocity),
                *_vector("omegax omegay omegaz", FIGURES, now.spin),
                *_vector("quatw quati quatj quatk", FIGURES, now.orientation),
                *_vector("shapex shapey shapez", FIGURES, axes),
            ]  # fmt: skip
            file.write(f"ITEM: ATOMS {' '.join(name for name, _, _ in columns)}\n")
            _table(file, columns)


def xyz(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """Extended XYZ: kinds by name, molecules from 1, velocities if known; no images."""
    kinds = np.array(particles.names)[particles.kind]
    with path.open("w", encoding="utf-8", newline="\n") as file:
        for now in moments:
            edges = np.diag(particles.size)
            edges[1, 0] = now.tilt
            columns: list[tuple[str, str, Any]] = [
                ("species:S:1", "%s", kinds), ("pos:R:3", FIGURES, now.position),
                ("id:I:1", "%d", particles.number + 1),
                ("molecule:I:1", "%d", particles.molecule + 1),
                ("radius:R:1", FIGURES, 0.5 * particles.diameter),
            ]  # fmt: skip
            if now.velocity is not None:
                columns.append(("velo:R:3", FIGURES, now.velocity))
            if now.spin is not None:
                columns.append(("angular_velocity:R:3", FIGURES, now.spin))
            if now.orientation is not None:  # scalar last, as OVITO reads quaternions from XYZ
                columns.append(("orientation:R:4", FIGURES, np.roll(now.orientation, -1, axis=1)))
            extended_frame(file, edges, particles.closed, (now.time, now.step), columns)


def extended_frame(
    file: TextIO,
    edges: NDArray[np.float64],
    closed: Sequence[bool],
    when: tuple[float, int],
    columns: Sequence[tuple[str, str, Any]],
) -> None:
    """A frame of extended XYZ.

    Parameters: `edges` (3, 3) of the box, a row for each; its `closed` axes (3,); time and step;
    declarations of columns, the format of each number, and values (n,) or (n, numbers of a row).
    """
    lattice = " ".join(f"{number:.9g}" for number in edges.ravel())
    open_axes = " ".join("F" if shut else "T" for shut in closed)
    properties = ":".join(declared for declared, _, _ in columns)
    file.write(
        f'{len(columns[0][2])}\nLattice="{lattice}" Properties={properties}'
        f' Time={when[0]:.9g} Step={when[1]} pbc="{open_axes}"\n'
    )
    flat = []
    for declared, form, values in columns:
        single = [values] if values.ndim == 1 else values.T
        flat += [(declared, form, column) for column in single]
    _table(file, flat)


def data_of_spheres(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """The last frame as a data file of LAMMPS, atom style sphere: diameters, densities and spins.

    In LAMMPS disks are spheres that stay in a plane, and so is their density.
    """
    now = deque(moments, maxlen=1).pop()
    n, numbers = len(particles.number), particles.number + 1
    density = particles.mass / (math.pi / 6 * particles.diameter**3)
    image = np.zeros((n, 3), int) if now.image is None else now.image
    with path.open("w", encoding="utf-8", newline="\n") as file:
        kinds = " ".join(particles.names)
        file.write(f"spheres of mesokit at step {now.step}, time {now.time:.9g}: {kinds}\n\n")
        file.write(f"{n} atoms\n{len(particles.names)} atom types\n\n")
        low = np.zeros(3)
        low[particles.dimension :] = -0.5  # LAMMPS needs the plane of disks inside its box
        for axis, start, length in zip("xyz", low.tolist(), particles.size.tolist(), strict=True):
            file.write(f"{start:.17g} {start + length:.17g} {axis}lo {axis}hi\n")
        if now.tilt:
            file.write(f"{now.tilt:.17g} 0 0 xy xz yz\n")
        columns = [numbers, particles.kind + 1, particles.diameter, density, now.position, image]
        file.write("\nAtoms # sphere\n\n")
        np.savetxt(file, np.column_stack(columns), fmt=f"%d %d{EXACT * 5} %d %d %d")
        if now.velocity is not None:
            spin = np.zeros((n, 3)) if now.spin is None else now.spin
            file.write("\nVelocities\n\n")
            np.savetxt(file, np.column_stack([numbers, now.velocity, spin]), fmt=f"%d{EXACT * 6}")


def _axes(particles: Particles) -> NDArray[np.float64] | None:
    """Axes (n, 3) of ellipsoids and spheres, 0 of other shapes; None where no kind has a shape."""
    if not particles.shapes:
        return None
    found = np.repeat(particles.diameter[:, None], 3, axis=1)
    for k, shape in particles.shapes.items():
        if shape["type"] != "Sphere":
            found[particles.kind == k] = [2 * shape.get(axis, 0.0) for axis in "abc"]
    return found


def _vector(names: str, form: str, values: Any) -> Iterator[tuple[str, str, Any]]:
    """A column for each name, or none."""
    for column, name in enumerate(names.split() if values is not None else ()):
        yield name, form, values[:, column]


def _table(file: TextIO, columns: Sequence[tuple[str, str, Any]]) -> None:
    """A line for each particle."""
    line = " ".join(form for _, form, _ in columns) + "\n"
    rows = zip(*(values.tolist() for _, _, values in columns), strict=True)
    file.writelines(line % row for row in rows)
