"""Trajectories as H5MD for other programs: what they ask for beside what the standard does.

MDAnalysis wants the group to be called `trajectory`, takes what it does not know of particles from
`observables`, where spins are therefore linked to, and wants units that it knows: a cell is an
angstrom here and a unit of time a picosecond, as all files are read that name no units.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mesokit.io.hdf5 import made
from mesokit.io.moments import Moment, Particles

UNITS = {
    "position": "Angstrom",
    "velocity": "Angstrom ps-1",
    "spin": "ps-1",
    "orientation": None,
    "edges": "Angstrom",
    "image": None,
}


def write(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """All frames, with box, masses, kinds, molecules, bonds and what is known of them."""
    from mesokit import __version__

    with made(path) as (file, check):
        head = file.create_group("h5md")
        head.attrs["version"] = np.array([1, 1], np.int32)
        head.create_group("author").attrs["name"] = "unknown"
        creator = head.create_group("creator")
        creator.attrs["name"], creator.attrs["version"] = "mesokit", __version__
        group = file.create_group("particles/trajectory")
        group.attrs["dimension"] = particles.dimension
        group["id"], group["mass"] = particles.number, particles.mass
        group["molecule"], group["species"] = particles.molecule, particles.kind
        group["species"].attrs["names"] = particles.names
        if particles.spheres:
            group["radius"] = 0.5 * particles.diameter
        box = group.create_group("box")
        boundary = ["none" if shut else "periodic" for shut in particles.closed]
        box.attrs["dimension"] = 3
        box.attrs["boundary"] = np.array(boundary, dtype=h5py.string_dtype("ascii"))
        bonds = file.create_dataset("connectivity/bonds", data=particles.bonds)
        bonds.attrs["particles_group"] = group.ref
        for now in moments:
            check()
            edges = np.diag(particles.size)
            edges[1, 0] = now.tilt
            _append(box, "edges", edges, now)
            _append(group, "position", now.position, now)
            _append(group, "velocity", now.velocity, now)
            _append(group, "spin", now.spin, now)
            _append(group, "orientation", now.orientation, now)
            _append(group, "image", now.image, now)
        if "spin" in group:
            file["observables/trajectory/spin"] = group["spin"]


def _append(parent: Any, name: str, value: Any, now: Moment) -> None:
    """One frame more of an element; none of what is not known."""
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
