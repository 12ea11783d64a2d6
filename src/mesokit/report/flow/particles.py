"""Particles as dots."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.report.flow.data import Flow
from mesokit.report.flow.region import Region

NEEDS = "particles"
TITLE = "particles"
MANY = 5000  # dots, beyond which a vector file holds an image of them
COVERED = 0.08  # of the area by dots: less than hides where they are dense
LARGEST, SMALLEST = 3.0, 0.5  # points


def reach(flow: Flow, region: Region) -> float:
    """Nothing that a scale would need."""
    return 1.0


def scale(flow: Flow, reach: float) -> None:
    """No colours."""


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw those in the region, smaller where they are many."""
    assert flow.particles is not None
    shown = flow.particles[region.holds(flow.particles)]
    box = ax.get_position()
    width, height = ax.figure.get_size_inches()
    area = 72.0**2 * box.width * width * box.height * height
    size = float(
        np.clip(np.sqrt(COVERED * area / max(len(shown), 1) * 4 / np.pi), SMALLEST, LARGEST)
    )
    ax.plot(
        shown[:, 0],
        shown[:, 1],
        "o",
        color="black",
        markersize=size,
        markeredgewidth=0,
        rasterized=len(shown) > MANY,
    )
