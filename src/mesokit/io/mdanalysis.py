"""What MDAnalysis knows of a trajectory, and the formats that it writes."""

import warnings
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
    made = _empty(particles)
    with _quiet():
        made.load_new(
            np.stack([now.position for now in frames]).astype(np.float32),
            order="fac",
            dimensions=np.stack([_dimensions(particles, now) for now in frames]),
            velocities=_velocities(frames),
            dt=frames[1].time - frames[0].time if len(frames) > 1 else 1.0,
            time_offset=frames[0].time,
        )
    return made


def write_frames(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """Positions and box of all frames (with velocities in TRR); what particles are has no place."""
    frames = iter(moments)
    first = next(frames)
    second = next(frames, None)
    every, interval = _spacing(first, second)
    known = [first, *([second] if second else [])]
    form = FRAMES["." + path.name.removeprefix(".").removesuffix(".tmp").rpartition(".")[2]]
    made = _empty(particles, velocities=first.velocity is not None)
    counted = {"dt": interval, "nsavc": every, "istart": first.step}  # a DCD has no times
    options = counted if form == "DCD" else {}
    with (
        _quiet(),
        require().coordinates.core.writer(
            str(path), n_atoms=len(made.atoms), format=form, multiframe=True, **options
        ) as writer,
    ):
        for now in (*known, *frames):
            _set(made, particles, now)
            writer.write(made.atoms)


def _spacing(first: Moment, second: Moment | None) -> tuple[int, float]:
    """Steps and time from a frame to the next; of one alone, a step and its time."""
    if second is not None:
        return second.step - first.step, second.time - first.time
    return 1, first.time / first.step if first.step else 1.0


def write_last(path: Path, particles: Particles, moments: Iterable[Moment]) -> None:
    """The last frame as a LAMMPS data file: kinds, masses, molecules, bonds and velocities."""
    now = None
    for now in moments:  # noqa: B007  the last one is meant
        pass
    assert now is not None
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
        made.add_TopologyAttr("names", names)
        made.add_TopologyAttr("types", names)
        made.add_TopologyAttr("masses", particles.mass)
        made.add_TopologyAttr("radii", 0.5 * particles.diameter)
        made.add_TopologyAttr("resids", np.arange(1, len(first) + 1))
        made.add_TopologyAttr("resnames", names[first])
        made.add_TopologyAttr("segids", ["mesokit"])
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


def _velocities(frames: list[Moment]) -> Any:
    known = [now.velocity for now in frames if now.velocity is not None]
    return np.stack(known).astype(np.float32) if known else None


@contextmanager
def _quiet() -> Iterator[None]:
    """MDAnalysis warns of whatever a chemist would want to know and these particles have not."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield
