"""Pictures from the disks and spheres of a trajectory."""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.caption import in_cells
from mesokit.report.flow.colouring import Frame, chosen
from mesokit.report.flow.data import Array, Flow, Links, Spheres
from mesokit.report.flow.images import shifts, towards
from mesokit.report.flow.region import View
from mesokit.report.flow.setting import Setting
from mesokit.report.flow.state import State
from mesokit.seam.method import Plate, method_of


def from_the_side(gravity: Sequence[float]) -> tuple[str, str]:
    """Axes of a picture in which things fall, down where that is along z.

    >>> from_the_side((0.0, -1.0)), from_the_side(()), from_the_side((0.0, 0.1, -1.0))
    (('x', 'y'), ('x', 'y'), ('x', 'z'))
    """
    falls = len(gravity) == 3 and abs(gravity[2]) == max(map(abs, gravity))
    return ("x", "z") if falls else ("x", "y")


class SphereSource:
    """The frames of a trajectory of spheres."""

    def __init__(self, case: Case, reader: TrajectoryReader | State, view: View) -> None:
        self.case, self.reader, self.view = case, reader, view
        self.axes, self.time = view.axes or ("x", "y"), reader.time
        self.whole = np.arange(len(reader))
        self.gives = frozenset(["spheres", *["contacts"] * ("contact" in reader.fields)])
        self.setting = Setting.of(case, self.axes)
        self.third = next((k for k in range(3) if k not in self.setting.columns), 2)
        self.towards = towards(self.setting.columns)

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """Spheres as they are in the last of the frames."""
        frame = int(frames[-1])
        read, reader, box = self.reader[frame], self.reader, self.case.box
        assert reader.diameter is not None
        colouring = chosen(self.case, reader, self.view.colour)
        now = Frame(self.case, read, reader.diameter, reader.species)
        position = np.asarray(read["position"], float)
        spheres = Spheres(
            places=position[:, self.setting.columns],
            depth=None,
            room=(0.0, 0.0),
            diameters=reader.diameter,
            values=colouring.numbers(now) if colouring else np.zeros(len(position)),
            counted=colouring is not None and colouring.counted,
            scale=functools.partial(colouring.scale, self.case) if colouring else None,
            repeats=self._repeats(float(self.time[frame])),
            time=float(self.time[frame]),
            plates=self._plates(read, float(self.time[frame])),
            remark=colouring.remark(now) if colouring else "",
            links=functools.partial(self._links, read) if "contacts" in self.gives else None,
        )
        if box.dimension == 3:
            spheres = self._deep(spheres, self.towards * position[:, self.third])
        return replace(self.setting.flow(), spheres=spheres)

    def _plates(self, read: Mapping[str, Any], time: float) -> tuple[Plate, ...]:
        """Plates that are not where they are at rest; those that grains push are where contacts
        are recorded."""
        found = method_of(self.case).enclosure.moving_plates(self.case, time)
        if "contacts" not in self.gives:
            return tuple(found)
        records, position = read["contact"], np.asarray(read["position"], float)
        assert self.reader.diameter is not None
        radii, pushed = 0.5 * self.reader.diameter, method_of(self.case).enclosure.pushed_plates
        for surface, plate in pushed(self.case):
            here = records[records["pair"][:, 1] == -1 - surface]
            one = here["pair"][:, 0] - (int(self.reader.id[0]) if len(position) else 0)
            if len(one):
                away = (position[one] - plate.point) @ plate.normal - radii[one] - here["gap"]
                found = (*found, plate._replace(shift=float(away.mean())))
        return tuple(found)

    def _links(self, read: Mapping[str, Any]) -> Links:
        """The contacts of a frame, those of spheres that are shown.

        A line starts at a centre and follows the normal, so it needs no images of the other.
        """
        records, position = read["contact"], np.asarray(read["position"], float)
        assert self.reader.diameter is not None
        radii, first = 0.5 * self.reader.diameter, int(self.reader.id[0]) if len(position) else 0
        one, other = records["pair"].T - first
        between, normal = records["pair"][:, 1] >= 0, records["normal"].astype(float)
        length = radii[one] + np.where(between, radii[other], 0.0) + records["gap"]
        starts = position[one]
        ends = np.stack([starts, starts - length[:, None] * normal], axis=1)
        near, kept = np.ones(len(records)), np.ones(len(records), bool)
        if self.case.box.dimension == 3:
            depth = ends[:, :, self.third].mean(axis=1)
            share = depth / float(self.case.box.size[self.third])
            near = np.clip(share if self.towards > 0 else 1 - share, 0.0, 1.0)
            if self.view.at is not None:
                kept = self.towards * depth <= self.towards * self.view.at
        forces = (records["force"] * normal).sum(axis=1)
        return Links(ends[kept][:, :, self.setting.columns], forces[kept], near[kept])

    def _deep(self, spheres: Spheres, depth: Array) -> Spheres:
        """With their depths; behind a plane, if the picture is of a place on the third axis."""
        ends = sorted((0.0, self.towards * float(self.case.box.size[self.third])))
        if self.view.at is None:
            return replace(spheres, depth=depth, room=(ends[0], ends[1]))
        plane = self.towards * self.view.at
        kept, axis = depth <= plane, AXES[self.third]
        side = "<" if self.towards > 0 else ">"
        return replace(
            spheres,
            places=spheres.places[kept],
            depth=depth[kept],
            room=(ends[0], plane),
            diameters=spheres.diameters[kept],
            values=spheres.values[kept],
            note=f"spheres at ${axis} {side} {self.view.at:g}{in_cells()}$",
        )

    def _repeats(self, time: float) -> tuple[tuple[float, float], ...]:
        """No displacement, and those by one box along each periodic axis of the picture."""
        found = shifts(self.case, time, self.setting.columns)[:, self.setting.columns]
        return tuple(dict.fromkeys((float(first), float(second)) for first, second in found))
