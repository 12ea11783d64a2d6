"""The trajectory of a run as a file for other programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.component import one_of, show
from mesokit.errors import CaseError, RunError
from mesokit.io.atomic import replacing
from mesokit.io.h5md import bonds_of
from mesokit.io.trajectory import TrajectoryWriter, written
from mesokit.solids import free_volume

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.io.open import RunFiles

Array = NDArray[Any]


class Particles(NamedTuple):
    """What does not change from frame to frame: (n,) numbers from 0, kinds from 0, masses.

    `bonds` (b, 2) of rows; `size` (3,) of the box, one cell deep in 2D; `closed` by plates.
    """

    number: NDArray[np.int64]
    kind: NDArray[np.int64]
    mass: Array
    bonds: NDArray[np.int64]
    dimension: int
    size: Array
    closed: tuple[bool, bool, bool]


class Moment(NamedTuple):
    """One frame in three dimensions, z = 0 in 2D.

    `position` (n, 3) in the cell spanned by (L_x, 0, 0), (tilt, L_y, 0) and (0, 0, L_z) from the
    origin on; `velocity` and `image` (n, 3), counts of these edges, or None.
    """

    step: int
    time: float
    tilt: float
    position: Array
    velocity: Array | None
    image: Array | None


def export(files: RunFiles, path: str | Path) -> Path:
    """Write all frames of a run to a file whose ending says the format; the old one is replaced.

    Of a run that has not ended, frames are those up to its last checkpoint. Raises CaseError for
    an ending that is not known, RunError where there are no frames with positions.
    """
    path = Path(path)
    write = _writer(path)
    case = files.case
    if case.trajectory is None:
        raise RunError(f"{files.path}: it keeps no trajectory; run it with a section [trajectory]")
    if "position" not in case.trajectory.fields:
        raise RunError(f"{files.path}: trajectory.fields = {show(case.trajectory.fields)}: exports "
                       "need 'position'")  # fmt: skip
    particles, frames = _contents(files, case)
    with replacing(path) as temporary:
        write(temporary, particles, (_moment(case, frame) for frame in frames))
    return path


def _writer(path: Path) -> Callable[[Path, Particles, Iterator[Moment]], None]:
    from mesokit.io import gsd_file, text_frames

    known = {".gsd": gsd_file.write, ".lammpstrj": text_frames.dump, ".xyz": text_frames.xyz}
    if path.suffix not in known:
        raise CaseError(f"{path}: ending {show(path.suffix)}: expected {one_of(list(known))}")
    if path.suffix == ".gsd":
        gsd_file.require()
    return known[path.suffix]


def _contents(files: RunFiles, case: Case) -> tuple[Particles, Iterator[dict[str, Array]]]:
    """Particles and frames, of the data file or, while the run goes on, of its segments."""
    assert case.trajectory is not None
    if not files.directory.data_file.exists():
        folder = files.directory.trajectory_folder
        writer = TrajectoryWriter(case.trajectory, folder, *written(case))
        if writer.segments():
            mass, kind = _kinds(case)
            return _particles(case, writer.ids, kind[writer.ids], mass[kind[writer.ids]]), (
                writer.frames()
            )
    reader = files.trajectory  # says what is missing where a run has not come so far
    if reader is None or not len(reader):
        raise RunError(f"{files.path}: its trajectory has no frame; the run ended before the first")
    frames = (reader[index] for index in range(len(reader)))
    return _particles(case, reader.id, reader.species, reader.mass), frames


def _kinds(case: Case) -> tuple[Array, NDArray[np.int64]]:
    """Mass of each kind, and the kind of each particle: those of the fluid, then solutes."""
    volume = free_volume(case)
    masses = [kind.mass for kind in case.fluid.species] or [case.fluid.mass]
    counts = [round(kind.density * volume) for kind in case.fluid.species] or [case.particles]
    if case.solutes is not None:
        kinds = case.solutes.polymers
        masses += [case.solutes.mass] * len(kinds)
        counts += [kind.number * kind.length for kind in kinds]
    return np.array(masses), np.repeat(np.arange(len(counts)), counts)


def _particles(case: Case, number: Array, kind: Array, mass: Array) -> Particles:
    bonds = bonds_of(case) - (number[0] if len(number) else 0)
    bonds = bonds[((bonds >= 0) & (bonds < len(number))).all(axis=1)]
    size = np.ones(3)
    size[: case.box.dimension] = case.box.size
    plates = {wall.axis for wall in case.walls if wall.shape == "plates"}
    closed = ("x" in plates, "y" in plates, "z" in plates)
    return Particles(number, kind, mass, bonds, case.box.dimension, size, closed)


def _moment(case: Case, frame: dict[str, Array]) -> Moment:
    """A frame in the leaning box of this moment, which only under shear is not upright.

    Under shear mesokit takes x from 0 to L_x at any y: so particles are moved by whole L_x, and
    images are counted for the edge as it leans, which is by the least of all that span the same.
    """
    time, width = float(frame["time"]), float(case.box.size[0])
    position, velocity, image = (
        _deep(frame.get(name)) for name in ("position", "velocity", "image")
    )
    assert position is not None
    tilt = 0.0
    if case.box.shear_rate:
        slid = case.box.displacement(time)
        tilt = slid - width * np.round(slid / width)
        position = position.astype(float)
        over = np.floor((position[:, 0] - tilt * position[:, 1] / case.box.size[1]) / width)
        position[:, 0] -= over * width
        if image is not None:
            image = image.copy()
            image[:, 0] += over.astype(int) + image[:, 1] * (tilt < 0)
    return Moment(int(frame["step"]), time, float(tilt), position, velocity, image)


def _deep(values: Array | None) -> Array | None:
    """With a third column."""
    return None if values is None else np.pad(values, ((0, 0), (0, 3 - values.shape[1])))
