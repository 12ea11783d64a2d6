"""GSD files of HOOMD-blue, OVITO and others: the schema `hoomd` of the package gsd.

Their box has its middle at the origin. Missing fields have defaults; velocities that are missing
count as unknown here, although their default is 0.
"""

from collections.abc import Iterable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError
from mesokit.io.moments import Moment, Particles
from mesokit.io.optional import package

SPIN = "log/particles/angular_velocity"
OWN_SIZE = ("Sphere", "Ellipsoid")  # other shapes OVITO draws times the radius of a particle


def require() -> ModuleType:
    """The package that reads and writes them. Raises CaseError where it is not installed."""
    return package("gsd.hoomd", "GSD files")


def read(path: str, frame: int | None = None) -> Snapshot:
    """The particles of a frame, from 0, the last unless said.

    Raises CaseError for a file that cannot be read.
    """
    hoomd = require()
    try:
        with hoomd.open(path, mode="r") as file:
            if not len(file):
                raise CaseError("it has no frame")
            index = len(file) - 1 if frame is None else frame
            if index >= len(file):
                raise CaseError(f"frame = {index}: it has {len(file)}, from 0 on")
            return _snapshot(file[index], file.file, index)
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

    spins = None
    if file.chunk_exists(index, SPIN):
        spins = np.asarray(file.read_chunk(index, SPIN), float)
        if spins.shape != (n, 3):
            raise CaseError(f"{SPIN} has shape {spins.shape}; expected {(n, 3)}")
    elif stored("angmom") and stored("moment_inertia"):
        spins = _spins(particles)
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
        diameters=np.asarray(particles.diameter, float) if stored("diameter") else None,
        spins=spins,
        orientations=np.asarray(particles.orientation, float) if stored("orientation") else None,
        kinds=np.array(particles.types, dtype=object)[np.asarray(particles.typeid, np.int64)],
        shapes=dict(zip(particles.types, particles.type_shapes or (), strict=False)),
    )


def _spins(particles: Any) -> Any:
    """Angular velocities (n, 3) from quaternions p = 2 q (0, L), L in the frame of each particle.

    About an axis with no moment of inertia there is none.
    """
    inertia = np.asarray(particles.moment_inertia, float)
    p = np.asarray(particles.angmom, float)
    s, v = np.split(np.asarray(particles.orientation, float), [1], axis=1)
    momentum = 0.5 * (s * p[:, 1:] - p[:, :1] * v - np.cross(v, p[:, 1:]))
    own = np.divide(momentum, inertia, out=np.zeros_like(momentum), where=inertia > 0)
    twist = 2.0 * np.cross(v, own)
    return own + s * twist + np.cross(v, twist)


def write(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """All frames, with box, kinds, masses, bonds and, where they are known, velocities and images.

    In 2D the box is one cell deep, which HOOMD-blue makes flat. `log/time` is the time. Molecules
    are bodies with numbers below -1. That an axis is closed has no place in such files.

    Spins are there twice: as the angular momenta and moments of inertia of the schema, and as
    `log/particles/angular_velocity`, of which OVITO makes a property of the particles. Bodies whose
    own axes are not principal ones of inertia have moments of 0, as the schema has no others.

    Diameters are those of spheres and the longest axes of ellipsoids; of other shapes they are 2,
    so that OVITO draws them to scale.
    """
    hoomd = require()
    kinds, size = particles.kind, particles.size
    frame = hoomd.Frame()
    frame.configuration.dimensions = particles.dimension
    frame.particles.N = len(kinds)
    frame.particles.types = list(particles.names)
    # a sphere for each kind, of the median diameter if those of single particles differ
    of_kinds = [particles.diameter[kinds == k] for k in range(len(particles.names))]
    frame.particles.type_shapes = [
        dict(particles.shapes[k])
        if k in particles.shapes
        else {"type": "Sphere", "diameter": float(np.median(own))}
        if len(own)
        else {}
        for k, own in enumerate(of_kinds)
    ]
    frame.particles.typeid, frame.particles.mass = kinds, particles.mass
    frame.particles.diameter = _diameters(particles)
    inertia = _moments_of_inertia(particles)
    if inertia.any():
        frame.particles.moment_inertia = inertia
    # -1: in no body; 0 and above: rigid ones, which molecules are not
    frame.particles.body = np.where(particles.molecule < 0, -1, -2 - particles.molecule)
    if len(particles.bonds):
        frame.bonds.N, frame.bonds.types = len(particles.bonds), ["bond"]
        frame.bonds.typeid, frame.bonds.group = np.zeros(len(particles.bonds)), particles.bonds
    with hoomd.open(str(path), mode="w") as file:
        for now in moments:
            middle = 0.5 * size + [0.5 * now.tilt, 0.0, 0.0]
            middle[particles.dimension :] = 0.0
            frame.configuration.step = now.step
            frame.configuration.box = [*size, now.tilt / size[1], 0.0, 0.0]
            faces = np.where(now.tilt == 0.0, 0.5 * size, np.inf)  # x of a tilted face varies
            frame.particles.position = _rounded(now.position - middle, faces)
            frame.particles.velocity, frame.particles.image = now.velocity, now.image
            frame.particles.orientation = now.orientation
            frame.log = {"time": np.array([now.time])}
            if now.spin is not None:
                frame.log[SPIN.removeprefix("log/")] = now.spin
                if inertia.any():
                    frame.particles.angmom = _angular_momenta(now, inertia)
            file.append(frame)


def _moments_of_inertia(particles: Particles) -> Any:
    """Moments (n, 3) of bodies, and of uniform spheres, in 2D disks about z; else 0."""
    if particles.spheres:
        share = np.array([0, 0, 1 / 8] if particles.dimension == 2 else [1 / 10] * 3)
        return (particles.mass * particles.diameter**2)[:, None] * share
    kinds = range(len(particles.names))
    return np.array([particles.inertia.get(k, (0.0, 0.0, 0.0)) for k in kinds])[particles.kind]


def _angular_momenta(now: Moment, inertia: Any) -> Any:
    """Quaternions (n, 4) 2 q (0, L), L in the frame of each particle; spheres keep q = 1."""
    spin = np.asarray(now.spin, float)
    if now.orientation is None:
        return np.pad(2 * (spin * inertia), ((0, 0), (1, 0)))
    s, v = np.split(np.asarray(now.orientation, float), [1], axis=1)
    twist = -2.0 * np.cross(v, spin)
    momentum = inertia * (spin + s * twist - np.cross(v, twist))
    scalar = -(v * momentum).sum(axis=1, keepdims=True)
    return 2.0 * np.concatenate([scalar, s * momentum + np.cross(v, momentum)], axis=1)


def _diameters(particles: Particles) -> Any:
    """Diameters (n,), 2 of kinds with a shape that OVITO scales by the radius."""
    scaled = [k for k, shape in particles.shapes.items() if shape["type"] not in OWN_SIZE]
    return np.where(np.isin(particles.kind, scaled), 2.0, particles.diameter)


def _rounded(position: Any, half: Any) -> Any:
    """Positions in single precision, below the upper faces (3,), which HOOMD-blue excludes."""
    edge = np.nextafter(np.asarray(half, np.float32), np.float32(0))
    return np.minimum(position.astype(np.float32), edge)
