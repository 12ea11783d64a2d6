"""States of the sites of a lattice as colours."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.trajectory import Group
from mesokit.errors import CaseError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.flow.data import Flow
from mesokit.report.flow.palette import colours
from mesokit.report.flow.region import Region, View
from mesokit.report.flow.scale import Scale, heat_map
from mesokit.report.flow.setting import Setting
from mesokit.report.flow.state import State

NEEDS = "sites"
TITLE = "sites"
MOST_NAMED = 12  # states, beyond which a bar of colours has no name for each


class SiteSource:
    """The frames of a trajectory of sites; of three axes the layer at a place on the third."""

    gives = frozenset({"sites"})

    def __init__(
        self, case: Case, reader: TrajectoryReader | State, group: Group, view: View
    ) -> None:
        self.reader, self.group = reader, group
        self.axes, self.time = view.axes or ("x", "y"), reader.time
        self.whole = np.arange(len(reader))
        self.setting = Setting.of(case, self.axes)
        others = {*range(len(group.lattice.size))} - {*self.setting.columns}
        self.third = next(iter(others), None)
        if self.third is not None:  # the middle layer unless a place is given
            at, layers, length = view.at, group.lattice.size[self.third], case.box.size[self.third]
            if at is not None and not 0 <= at <= length:
                raise CaseError(f"at = {show(at)}: expected a place from 0 to {length:g}")
            self.layer = min(int((0.5 if at is None else at / length) * layers), layers - 1)

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """States as they are in the last of the frames."""
        frame = int(frames[-1])
        states = np.asarray(self.reader[frame]["site"]).reshape(self.group.lattice.size)
        if self.third is not None:
            states = states.take(self.layer, axis=self.third)
        if self.setting.columns[0] > self.setting.columns[1]:
            states = states.T
        names, time = self.group.states, float(self.time[frame])
        return replace(self.setting.flow(), sites=states, states=names, time=time)


def reach(flow: Flow, region: Region) -> float:
    """The largest number of a state."""
    assert flow.sites is not None
    return float(max(flow.sites.max(initial=1), len(flow.states) - 1))


def scale(flow: Flow, reach: float) -> Scale:
    """A colour for each state, from light to dark, with its name if there is one."""
    number = int(reach) + 1
    names = flow.states if len(flow.states) == number <= MOST_NAMED else ()
    return Scale(-0.5, number - 0.5, colours(number), "state", names)


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw those in the region."""
    assert flow.sites is not None
    heat_map(ax, flow, flow.sites.astype(float), region, scale(flow, reach))
