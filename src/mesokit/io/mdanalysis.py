"""Trajectories as universes of MDAnalysis, and the formats that it writes."""

import itertools
import warnings
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from mesokit.io.moments import Moment, Particles
from mesokit.io.optional import package

FRAMES = {".dcd": "DCD", ".xtc": "XTC", ".trr": "TRR"}  # endings of formats with many frames


def require() -> ModuleType:
    """The package. Raises CaseError where it is not installed."""
    return package("MDAnalysis", "files of MDAnalysis")


def universe(particles: Particles, moments: Iterable[Moment]) -> Any:
    """All frames in memory, as a `Universe`; a cell is an angstrom there, a unit of time a ps."""
    frames = list(moments)
    velocities = [now.velocity for now in frames if now.velocity is not None]
    made = _empty(particles)
    with _quiet():
        made.load_new(
            np.stack([now.position for now in frames]).astype(np.float32),
            order="fac",
            dimensions=np.stack([_dimensions(particles, now) for now in frames]),
            velocities=np.stack(velocities).astype(np.float32) if velocities else None,
            dt=frames[1].time - frames[0].time if len(frames) > 1 else 1.0,
            time_offset=frames[0].time,
        )
    return made


def write_frames(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """Positions and box of all frames (with velocities in TRR), without kinds, masses and bonds."""
    frames = iter(moments)
    known = list(itertools.islice(frames, 2))
    first, last = known[0], known[-1]
    # steps and time from a frame to the next; of one alone, a step and its time
    every, interval = 1, first.time / first.step if first.step else 1.0
    if len(known) > 1:
        every, interval = last.step - first.step, last.time - first.time
    form = FRAMES["." + path.name.removeprefix(".").removesuffix(".tmp").rpartition(".")[2]]
    made = _empty(particles, velocities=first.velocity is not None)
    options = {"dt": interval, "nsavc": every, "istart": first.step}  # a DCD has no times
    options = options if form == "DCD" else {}
    with (
        _quiet(),
        require().coordinates.core.writer(
            str(path), n_atoms=len(made.atoms), format=form, multiframe=True, **options
        ) as writer,
    ):
        for now in (*known, *frames):
            _set(made, particles, now)
            writer.write(made.atoms)


def write_last(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """The last frame as a LAMMPS data file: kinds, masses, molecules, bonds and velocities."""
    now = deque(moments, maxlen=1).pop()
    made = _empty(particles, velocities=now.velocity is not None)
    made.add_TopologyAttr("types", (particles.kind + 1).astype(str))
    made.add_TopologyAttr("charges", np.zeros(len(made.atoms)))
    for kind in ("angles", "dihedrals", "impropers"):
        made.add_TopologyAttr(kind, [])
    _set(made, particles, now)
    made.trajectory.ts.data["molecule_tag"] = particles.molecule + 1  # 0 is none, as in dumps
    writes = require().coordinates.LAMMPS.DATAWriter
    # The unit of time is MDAnalysis' own: by default velocities would be those per femtosecond.
    with _quiet(), writes(str(path), timeunit="ps") as writer:
        writer.write(made.atoms)


def _empty(particles: Particles, velocities: bool = False) -> Any:
    """Particles without places: a residue for each molecule, and one for the rest of each kind."""
    alone = particles.molecule < 0
    own = np.where(alone, -1 - particles.kind, particles.molecule)
    _, first, residue = np.unique(own, return_index=True, return_inverse=True)
    residue, first = np.argsort(np.argsort(first))[residue], np.sort(first)  # as they appear
    names = np.array(particles.names, object)[particles.kind]
    with _quiet():
        made = require().Universe.empty(
            len(names),
            n_residues=len(first),
            atom_resindex=residue,
            residue_segindex=np.zeros(len(first), int),
            trajectory=True,
            velocities=velocities,
        )
        attributes = {
            "names": names, "types": names, "masses": particles.mass,
            "radii": 0.5 * particles.diameter, "resids": np.arange(1, len(first) + 1),
            "resnames": names[first], "segids": ["mesokit"],
        }  # fmt: skip
        for name, values in attributes.items():
            made.add_TopologyAttr(name, values)
        pairs = [tuple(pair) for pair in particles.bonds.tolist()]
        bonds = require().core.topologyattrs.Bonds(pairs, types=["1"] * len(pairs))
        made.add_TopologyAttr(bonds)
    return made


def _set(made: Any, particles: Particles, now: Moment) -> None:
    """Bring the particles to where they are in a frame."""
    moment = made.trajectory.ts
    moment.positions = now.position
    moment.dimensions = _dimensions(particles, now)
    if now.velocity is not None:
        moment.velocities = now.velocity
    moment.data |= {"time": now.time, "step": now.step}


def _dimensions(particles: Particles, now: Moment) -> Any:
    """Lengths and angles of the box."""
    x, y, z = np.diag(particles.size)
    y[0] = now.tilt
    return require().lib.mdamath.triclinic_box(x, y, z)


@contextmanager
def _quiet() -> Iterator[None]:
    """Without warnings of MDAnalysis about chemistry that these particles do not have."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield
