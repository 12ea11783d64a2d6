"""Trajectories as H5MD for other programs, with the extensions that MDAnalysis needs.

MDAnalysis needs a group of the name `trajectory`, reads other properties of particles from
`observables`, so spins are linked there, and needs units that it has: a cell is an angstrom here
and a unit of time a picosecond, like in all files without units.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from mesokit import __version__
from mesokit.io.h5md import standard_box, standard_header
from mesokit.io.hdf5 import made
from mesokit.io.moments import Moment, Particles

UNITS = {
    "position": "Angstrom", "velocity": "Angstrom ps-1", "spin": "ps-1", "edges": "Angstrom",
    "orientation": None,
    "image": None,
}  # fmt: skip


def write(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """All frames, with box, masses, kinds, molecules, bonds and all known fields."""
    with made(path) as (file, check):
        standard_header(file, __version__)
        group = file.create_group("particles/trajectory")
        group.attrs["dimension"] = particles.dimension
        group["id"], group["mass"] = particles.number, particles.mass
        group["molecule"], group["species"] = particles.molecule, particles.kind
        group["species"].attrs["names"] = particles.names
        if particles.spheres:
            group["radius"] = 0.5 * particles.diameter
        box = standard_box(group, particles.closed)
        bonds = file.create_dataset("connectivity/bonds", data=particles.bonds)
        bonds.attrs["particles_group"] = group.ref
        for now in moments:
            check()
            edges = np.diag(particles.size)
            edges[1, 0] = now.tilt
            _append(box, "edges", edges, now)
            for name in ("position", "velocity", "spin", "orientation", "image"):
                _append(group, name, getattr(now, name), now)
        if "spin" in group:
            file["observables/trajectory/spin"] = group["spin"]


def _append(parent: Any, name: str, value: Any, now: Moment) -> None:
    """Add one frame of an element, if it is known."""
    if value is None:
        return
    if name not in parent:
        element = parent.create_group(name)
        element.create_dataset("step", (0,), np.int64, maxshape=(None,))
        time = element.create_dataset("time", (0,), float, maxshape=(None,))
        time.attrs["unit"] = "ps"
        data = element.create_dataset(
            "value",
            (0, *value.shape),
            np.int32 if name == "image" else np.float32,
            maxshape=(None, *value.shape),
            chunks=(1, *(max(length, 1) for length in value.shape)),
            compression=4,
            shuffle=True,
        )
        if UNITS[name]:
            data.attrs["unit"] = UNITS[name]
    for part, entry in (("step", now.step), ("time", now.time), ("value", value)):
        data = parent[name][part]
        data.resize(len(data) + 1, axis=0)
        data[-1] = entry
