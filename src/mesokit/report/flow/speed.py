"""Speed as colours."""

from typing import Any

from mesokit.report.flow.data import Flow
from mesokit.report.flow.heat_map import heat_map
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale, reach_of
from mesokit.report.style import labelled

NEEDS = "velocity"
TITLE = "speed"


def reach(flow: Flow, region: Region) -> float:
    """The highest speed in the region."""
    speed = flow.surely(flow.speed)
    return reach_of(speed[region.bins(flow.size, speed.shape)])


def scale(flow: Flow, reach: float) -> Scale:
    """From rest to the highest speed."""
    return Scale(0.0, reach, "viridis", labelled(label(flow), "a/tau"))


def label(flow: Flow) -> str:
    """What it is called."""
    return "speed" if flow.dimension == 2 else "speed in the plane"


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw it."""
    heat_map(ax, flow, flow.speed, region, scale(flow, reach))
