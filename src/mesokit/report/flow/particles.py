"""Particles as dots, and bonds between them as lines."""

import math
from typing import Any

import numpy as np

from mesokit.report.flow.data import Flow
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import inches_of
from mesokit.report.style import COLOURS

NEEDS = "particles"
TITLE = "particles"
MANY = 5000  # dots, beyond which a vector file holds an image of them
COVERED = 0.08  # of the area by dots: less than hides where they are dense
LARGEST, SMALLEST = 3.0, 0.5  # points
THIN, CROWDED = 0.4, 0.4  # points of a bond; of the area by bonds: more cannot be distinguished


def reach(flow: Flow, region: Region) -> float:
    """1: there is no scale."""
    return 1.0


def scale(flow: Flow, reach: float) -> None:
    """No colours."""


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw those in the region, smaller where they are many, and bonds where these are few."""
    assert flow.particles is not None
    shown = flow.particles[region.holds(flow.particles)]
    area = 72.0**2 * math.prod(inches_of(ax))  # square points
    usual = np.sqrt(COVERED * area / max(len(shown), 1) * 4 / np.pi)
    look: Any = {"color": "black", "ms": float(np.clip(usual, SMALLEST, LARGEST)), "mew": 0}
    _bonds(ax, flow, region, area)
    ax.plot(*shown.T, "o", rasterized=len(shown) > MANY, **look)


def _bonds(ax: Any, flow: Flow, region: Region, area: float) -> None:
    """Thin lines, unless they would cover more of the area (in square points) than can be read."""
    from matplotlib.collections import LineCollection

    if flow.bonds is None:
        return
    lines = flow.bonds[region.holds(flow.bonds[:, 0]) | region.holds(flow.bonds[:, 1])]
    scale = np.sqrt(area / (np.ptp(ax.get_xlim()) * np.ptp(ax.get_ylim())))
    length = scale * np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum()
    if THIN * length < CROWDED * area:
        drawn = LineCollection(list(lines), colors=COLOURS[0], linewidths=THIN, zorder=1.5)
        ax.add_collection(drawn, autolim=False)
