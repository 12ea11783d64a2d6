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
from mesokit.report.flow.palette import colours, deviations
from mesokit.report.flow.region import Region, View
from mesokit.report.flow.scale import Scale, heat_map
from mesokit.report.flow.setting import Setting
from mesokit.report.flow.site_map import SiteMap
from mesokit.report.flow.state import State
from mesokit.report.style import labelled

NEEDS = "sites"
TITLE = "sites"
MOST_NAMED = 12  # states, beyond which a bar of colours has no name for each


class SiteSource:
    """The frames of a trajectory of sites; of three axes the layer at a place on the third.

    Lengths are distances of neighbours.
    """

    gives = frozenset({"sites"})

    def __init__(
        self, case: Case, reader: TrajectoryReader | State, group: Group, view: View
    ) -> None:
        assert group.lattice is not None
        self.reader, self.group = reader, group
        self.axes, self.time = view.axes or ("x", "y"), reader.time
        self.whole = np.arange(len(reader))
        lattice, setting = group.lattice, Setting.of(case, self.axes)
        third = next(iter({*range(lattice.dimension)} - {*setting.columns}), None)
        layer, self.note = None, ""
        if third is None and view.at is not None:
            raise CaseError(f"at = {show(view.at)}: this lattice has no third axis; leave it out")
        if third is not None:  # the middle layer unless a place is given
            at, length = view.at, float(lattice.edges[third])
            if at is not None and not 0 <= at <= length:
                raise CaseError(f"at = {show(at)}: expected a place from 0 to {length:g}")
            layers = lattice.size[third]
            layer = min(int((0.5 if at is None else at / length) * layers), layers - 1)
            self.note = f"layer {layer + 1} of {layers} along ${case.box.axes[third]}$"
        first, second = setting.columns
        self.map = SiteMap(lattice, (first, second), layer)
        self.setting = replace(setting, size=self.map.size)

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """States as they are in the last of the frames."""
        frame = int(frames[-1])
        states = np.asarray(self.reader[frame]["site"], np.int64)
        if not self.group.states:
            states = deviations(states[None])[0][0]
        flow = self.setting.flow(sites=self.map.of(states), states=self.group.states)
        return replace(flow, time=float(self.time[frame]), note=self.note)


def reach(flow: Flow, region: Region) -> float:
    """The largest number of a state, or the largest deviation of a height."""
    assert flow.sites is not None
    if not flow.states:
        return max(1.0, float(abs(flow.sites).max()))
    return float(max(flow.sites.max(initial=1), len(flow.states) - 1))


def scale(flow: Flow, reach: float) -> Scale:
    """A colour for each state, from light to dark, with its name; of heights, of their deviation
    from the mean."""
    if not flow.states:
        return Scale(-reach, reach, "cividis", labelled("height less its mean", "a"))
    number = int(reach) + 1
    names = flow.states if len(flow.states) == number <= MOST_NAMED else ()
    return Scale(-0.5, number - 0.5, colours(number), "state", names)


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw those in the region."""
    assert flow.sites is not None
    heat_map(ax, flow, flow.sites.astype(float), region, scale(flow, reach))
