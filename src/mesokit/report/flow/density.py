"""Density as colours: how many particles a cell holds."""

from typing import Any

from mesokit.report.flow.data import Flow
from mesokit.report.flow.heat_map import heat_map
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale, reach_of
from mesokit.report.style import labelled

NEEDS = "density"
TITLE = "occupancy"


def reach(flow: Flow, region: Region) -> float:
    """The highest density in the region."""
    assert flow.density is not None
    return reach_of(flow.surely(flow.density)[region.bins(flow.size, flow.density.shape)])


def scale(flow: Flow, reach: float) -> Scale:
    """To the fullest cell, from an empty one unless the flow says otherwise."""
    return Scale(flow.lowest, reach, "cividis", labelled("density", f"1/a^{flow.dimension}"))


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw it."""
    assert flow.density is not None
    heat_map(ax, flow, flow.density, region, scale(flow, reach))
