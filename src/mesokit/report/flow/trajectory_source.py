"""Pictures from the particles of a trajectory, in bins of one cell."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.flow.bodies import bodies_of
from mesokit.report.flow.data import Array, Flow
from mesokit.report.flow.setting import Setting
from mesokit.report.flow.state import State
from mesokit.seam.method import method_of


class FluidBonds:
    """Those of which both particles are shown. `ids` are the numbers of the particles shown."""

    def __init__(self, case: Case, ids: NDArray[np.int64], columns: list[int]) -> None:
        method = method_of(case)
        self.case, self.columns = case, columns
        order = np.argsort(ids)
        bonds = method.bonds(case)
        place = np.searchsorted(ids[order], bonds).clip(max=max(len(ids) - 1, 0))
        shown = (ids[order][place] == bonds).all(axis=1) if len(ids) else np.zeros(len(bonds), bool)
        self.rows = order[place[shown]] if len(ids) else np.zeros((0, 2), np.int64)
        self.lengths = np.array(case.box.size, float)
        self.open = np.isin(np.arange(len(self.lengths)), list(method.enclosure.closed_axes(case)))

    def at(self, position: Array, time: float) -> Array | None:
        """Both ends (lines, 2, 2) in the picture of bonds as short as images allow, at a time.

        A bond over an end of the box is drawn at both ends. None where there is no bond.
        """
        if not len(self.rows):
            return None
        first, last = position[self.rows[:, 0]], position[self.rows[:, 1]]
        separation = last - first
        box = self.case.box
        if box.sheared:  # images above and below have slid
            separation[:, 0] -= box.displacement(time) * np.rint(separation[:, 1] / self.lengths[1])
        separation -= np.where(self.open, 0.0, self.lengths * np.rint(separation / self.lengths))
        over = (abs(first + separation - last) > 1e-6 * self.lengths).any(axis=1)
        starts = np.concatenate([first, (last - separation)[over]])
        separations = np.concatenate([separation, separation[over]])
        return np.stack([starts, starts + separations], axis=1)[:, :, self.columns]


class TrajectorySource:
    """The frames of the first group of particles; their density is known if all of them are in."""

    def __init__(self, case: Case, reader: TrajectoryReader | State, axes: tuple[str, str]) -> None:
        self.reader, self.axes, self.time = reader, axes, reader.time
        self.setting, self.kT = Setting.of(case, axes), case.groups[0].kT
        self.whole = np.arange(len(reader))
        self.rows = np.flatnonzero(reader.id < case.particles)
        self.bonds = FluidBonds(case, reader.id[self.rows], self.setting.columns)
        known = {"particles"}
        if bodies_of(case, reader, axes) is not None:
            known |= {"bodies"}
        if "velocity" in reader.fields and len(self.rows):
            known |= {"velocity", "headings"}
        if len(self.rows) == case.particles > 0:
            known.add("density")
        self.gives = frozenset(known)
        self.bins = tuple(max(1, int(length)) for length in self.setting.size)
        self.bin_volume = case.box.volume / np.prod(self.bins)

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """Means over some frames: momentum over mass."""
        columns, mass = self.setting.columns, self.reader.mass[self.rows]
        sums = np.zeros((4, *self.bins))  # number, mass, momentum
        for frame in frames:
            read = self.reader[int(frame)]
            place = read["position"][self.rows][:, columns]
            known = "velocity" in read
            velocity = read["velocity"][self.rows][:, columns] if known else 0 * place
            fine = np.array(self.bins) / self.setting.size  # 1 where lengths are whole numbers
            bins = np.minimum((place * fine).astype(int), np.array(self.bins) - 1)
            index = np.ravel_multi_index((bins[:, 0], bins[:, 1]), self.bins)
            each = (np.ones_like(mass), mass, mass * velocity[:, 0], mass * velocity[:, 1])
            for total, weight in zip(sums, each, strict=True):
                total += np.bincount(index, weight, total.size).reshape(self.bins)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = np.moveaxis(sums[2:] / sums[1], 0, -1)
            thermal = np.sqrt(self.kT / sums[1])[..., None]
        noise = np.random.default_rng(0).normal(size=mean.shape) * thermal
        flow = self.setting.flow(
            density=sums[0] / (len(frames) * self.bin_volume) if "density" in self.gives else None,
            velocity=mean if "velocity" in self.gives else None,
            particles=place,
            noise=noise,
        )
        bonds = self.bonds.at(read["position"][self.rows].astype(float), float(self.time[frame]))
        headings = velocity if "headings" in self.gives else None
        return replace(flow, bonds=bonds, headings=headings, time=float(self.time[frame]))
