"""Frames of a trajectory, in files that survive a crash.

During a run, frames are kept in memory and written in segments: when there are many, and before
every checkpoint. A segment is one file, written whole. A run that goes on from a checkpoint drops
later frames, so no frame is missing or there twice. At the end all go to the data file of the run.
"""

import math
import shutil
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.trajectory import Trajectory
from mesokit.errors import RunError
from mesokit.io.arrays_file import LARGE, load, one, save
from mesokit.io.atomic import delete_folder
from mesokit.io.contact_records import FIELD, records_of

Frame = dict[str, Any]  # arrays, or what comes in pieces
OWN = ("mass", "diameter")  # of each sphere, the same in all frames
RAGGED = (FIELD,)  # entries that differ in length from frame to frame
COUNT = "{}_number"  # of the rows of such an entry in each frame of a segment
LARGEST = 64 * 2**20  # bytes of frames kept in memory


class TrajectoryWriter:
    """Frames of a running simulation, kept in the folder `folder`.

    Particles are stored in the order of their ids, from `first` on. Call `record` when a frame is
    due, `flush` before every checkpoint, `resume` before going on from one.

    Each rank keeps the rows of its particles (`engine.here`) until all flush together; the rank
    with `here` writes, resumes and reads. Of `spheres`, masses and diameters (n,) are kept (`own`).
    """

    def __init__(
        self,
        trajectory: Trajectory,
        folder: str | Path,
        particles: int,
        first: int = 0,
        spheres: bool = False,
        here: bool = True,
    ) -> None:
        self.trajectory, self.folder, self.here = trajectory, Path(folder), here
        self.first, self.number = first, min(trajectory.subset or particles, particles)
        self.spheres = spheres
        self._own: Frame = {}
        self._frames: list[Frame] = []
        self._bytes = 0

    def record(self, engine: Any) -> None:
        """Take one frame of an engine. Raises RunError if a full memory cannot be written out."""
        shares = hasattr(engine, "here")
        of = engine.here if shares else engine
        ids = of.ids(self.first, self.first + self.number) if shares else self.ids
        real = np.dtype(self.trajectory.precision)
        readings = {
            "position": lambda: _inside(of.positions(ids).astype(real), engine.box),
            "velocity": lambda: of.velocities(ids).astype(real),
            "spin": lambda: of.spins(ids).astype(real),
            "orientation": lambda: of.orientations(ids).astype(real),
            "site": lambda: _states(of.sites(ids)),
            "image": lambda: of.images(ids).astype(np.int32),
            FIELD: lambda: records_of(of.contacts(), self.first, self.number, real),
        }
        fields = self.trajectory.fields
        frame: Frame = {name: read() for name, read in readings.items() if name in fields}
        if self.spheres and not self._own:
            self._own = {"mass": of.masses(ids), "diameter": of.diameters(ids)}
        if shares:
            places = ids - self.first
            frame = {k: of.spread(self.number, places, rows) for k, rows in frame.items()}
        self._add({"step": np.array(engine.step), "time": np.array(engine.time), **frame})

    @property
    def ids(self) -> NDArray[np.int64]:
        """The particles of a frame, in the order of its rows."""
        return self.first + np.arange(self.number)

    @property
    def own(self) -> Frame:
        """Masses and diameters (n,) of spheres; {} for others, and before the first frame.

        Raises RunError for a damaged file.
        """
        if self.spheres and not self._own and self._own_file.exists():
            self._own = {name: _load(self._own_file, name) for name in OWN}
        return self._own

    @property
    def _own_file(self) -> Path:
        return self.folder / "own.npz"

    def take_back(self, frames: Iterable[Frame], own: Frame) -> None:
        """Make segments again from the frames and `own` of a data file, unless they are there."""
        if len(self.steps()):
            return
        delete_folder(self.coming)  # we may have been killed here before
        back = TrajectoryWriter(self.trajectory, self.coming, self.number, self.first, self.spheres)
        back._own = own
        for frame in frames:
            back._add({name: np.asarray(entry) for name, entry in frame.items()})
        back.flush()
        if self.coming.is_dir():
            self.coming.rename(self.folder)  # all or none

    @property
    def coming(self) -> Path:
        """Folder in which segments are made, to be renamed when all are there."""
        return self.folder.with_name(f".{self.folder.name}.coming")

    def _add(self, frame: Frame) -> None:
        self._frames.append(frame)
        self._bytes += sum(math.prod(a.shape) * a.dtype.itemsize for a in frame.values())
        if self._bytes >= LARGEST:
            self.flush()

    def flush(self) -> None:
        """Write what is in memory to a new segment. Raises RunError."""
        if not self._frames:
            return
        if self._own and not self._own_file.exists():
            save(self._own_file, self._own, folder=True)
        self._write(self._frames)
        self._frames, self._bytes = [], 0

    def resume(self, step: int) -> None:
        """Forget all frames after `step`. Raises RunError for a damaged segment before it."""
        self._frames, self._bytes = [], 0
        if not self.here:
            return
        for path in self.segments():
            if int(path.stem.split("-")[1]) > step:
                path.unlink()
                continue
            frames = list(_read(path))
            kept = [frame for frame in frames if frame["step"] <= step]
            if len(kept) < len(frames):
                self._write(kept)

    def steps(self) -> NDArray[np.int64]:
        """Steps of all frames, those in memory included."""
        found = [_load(path, "step") for path in self.segments()]
        found.append(np.array([frame["step"] for frame in self._frames], np.int64))
        return np.concatenate(found).astype(np.int64)

    def frames(self) -> Iterator[Frame]:
        """All frames in order. Raises RunError for a damaged segment."""
        for path in self.segments():
            yield from _read(path)
        yield from self._frames

    def segments(self) -> list[Path]:
        """Files of the segments in order."""
        return sorted(self.folder.glob("segment-*.npz"))

    def remove(self) -> None:
        """Delete all segments at once, after their frames have gone to the data file."""
        delete_folder(self.coming)
        done = self.folder.with_name(f".{self.folder.name}.done")
        delete_folder(done)  # we may have been killed here before
        if self.folder.is_dir():
            self.folder.rename(done)  # all or none, also if we are killed here
            shutil.rmtree(done, ignore_errors=True)

    def _write(self, frames: list[Frame]) -> None:
        path = self.folder / f"segment-{int(frames[0]['step']):015d}.npz"
        stacked: dict[str, Any] = {}
        for name in frames[0]:
            entries = [frame[name] for frame in frames]
            stacked[name] = Joined(entries) if name in RAGGED else Stacked(entries)
            if name in RAGGED:
                stacked[COUNT.format(name)] = np.array([len(entry) for entry in entries], np.int64)
        save(path, stacked, self.here, folder=True)


class Stacked:
    """An entry of some frames as one array, frame after frame."""

    def __init__(self, entries: Sequence[Any]) -> None:
        self.entries, self.dtype = entries, entries[0].dtype
        self.shape = len(entries), *entries[0].shape

    def blocks(self) -> Iterator[NDArray[Any]]:
        """Its rows, some at a time."""
        for entry in self.entries:
            yield from entry.blocks() if hasattr(entry, "blocks") else [entry]


class Joined:
    """The rows of an entry of some frames as one array, frame after frame."""

    def __init__(self, entries: Sequence[NDArray[Any]]) -> None:
        self.entries, self.dtype = entries, entries[0].dtype
        self.shape = (sum(len(entry) for entry in entries),)

    def blocks(self) -> Iterator[NDArray[Any]]:
        """Its rows, a frame at a time."""
        yield from self.entries


def _states(sites: NDArray[Any]) -> NDArray[np.int16]:
    """States of sites as they are stored. Raises RunError for those beyond 16 bits."""
    stored = sites.astype(np.int16)
    if not np.array_equal(stored, sites):
        raise RunError(
            f"trajectory.fields: 'site': states from {sites.min()} to {sites.max()}; "
            "expected -32768 to 32767"
        )
    return stored


def _inside(position: NDArray[Any], box: NDArray[Any]) -> NDArray[Any]:
    """Positions below the upper faces, onto which rounding to float32 may lift them."""
    edge = np.asarray(box, position.dtype)
    return np.where(position >= edge, np.nextafter(edge, np.zeros_like(edge)), position)


def _load(path: Path, name: str) -> NDArray[Any]:
    try:
        return one(path, name)
    except Exception:  # zip, zlib and numpy have many errors for a damaged file
        raise RunError(f"{path}: damaged: it is not a whole segment of a trajectory") from None


def _read(path: Path) -> Iterator[Frame]:
    """The frames of a segment; large ones are maps of the file."""
    try:
        arrays = load(path, LARGE)
    except Exception:
        raise RunError(f"{path}: damaged: it is not a whole segment of a trajectory") from None
    entries: dict[str, Any] = dict(arrays)
    for name in [name for name in RAGGED if name in arrays]:
        ends = np.cumsum(entries.pop(COUNT.format(name)))
        entries[name] = np.split(arrays[name], ends[:-1])
    for index in range(len(arrays["step"])):
        yield {name: entry[index] for name, entry in entries.items()}
