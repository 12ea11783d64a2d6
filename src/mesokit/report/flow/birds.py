"""Birds as triangles that point along their headings, in a colour for each direction."""

import functools
import math
from typing import Any

import numpy as np

from mesokit.report.flow.data import Array, Flow
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale, inches_of

NEEDS = "headings"
TITLE = "birds"
MANY = 5000  # birds, beyond which a vector file holds an image of them
COVERED = 0.12  # of the area by birds: more hides them where they are dense
LONGEST, SHORTEST = 13.0, 2.2  # points
SLIM = 0.45  # width over length of a triangle
DARK, LIGHT, CHROMA = 33.0, 66.0, 42.0  # of the colours, in CIELAB: readable on white and in grey
STEPS = 256
BACK = np.pi / 3  # of a turn, in which colours go back from light to dark


def reach(flow: Flow, region: Region) -> float:
    """Half a turn: colours are those of directions."""
    return 1.0


def scale(flow: Flow, reach: float) -> Scale:
    """Colours of directions."""
    return Scale(-reach, reach, colours(), r"heading / $\pi$")


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw those in the region, smaller where they are many."""
    assert flow.particles is not None and flow.headings is not None
    inside = region.holds(flow.particles)
    places, headings = flow.particles[inside], flow.headings[inside]
    area = 72.0**2 * math.prod(inches_of(ax))  # square points
    usual = np.sqrt(COVERED * area / max(len(places), 1) / (0.5 * SLIM))
    long = float(np.clip(usual, SHORTEST, LONGEST)) / 72.0
    size = np.linalg.norm(headings, axis=1, keepdims=True)
    unit = headings / np.where(size > 0, size, 1.0)
    turned = np.arctan2(unit[:, 1], unit[:, 0]) / np.pi
    width = SLIM * long
    units = {"angles": "xy", "scale_units": "inches", "scale": 1.0, "units": "inches"}
    shaft = {"width": 0.2 * width, "minlength": 0.0, "minshaft": 1.0, "pivot": "mid"}
    head = {"headlength": long / (0.2 * width), "headaxislength": 0.8 * long / (0.2 * width)}
    look = {"color": scale(flow, reach).mappable().to_rgba(turned), "zorder": 2}
    look |= {"headwidth": 5.0, "rasterized": len(places) > MANY}
    ax.quiver(*places.T, *long * unit.T, **units, **shaft, **head, **look)


@functools.cache
def colours() -> Any:
    """A cyclic map: the hue turns once. Lightness rises over most of the turn and then falls, so
    that directions differ in grey too."""
    from matplotlib.colors import ListedColormap

    angle = np.linspace(-np.pi, np.pi, STEPS)
    lightness = np.interp(angle, [-np.pi, BACK - np.pi, np.pi], [LIGHT, DARK, LIGHT])
    a, b = CHROMA * np.cos(angle + 5.3), CHROMA * np.sin(angle + 5.3)
    return ListedColormap(_from_lab(lightness, a, b), "headings")


def _from_lab(lightness: Array, a: Array, b: Array) -> Array:
    """CIELAB (D65) to sRGB, cut where there is no such colour."""
    f = (lightness + 16) / 116
    white = np.array([0.95047, 1.0, 1.08883])
    t = np.stack([f + a / 500, f, f - b / 200], axis=1)
    xyz = white * np.where(t > 6 / 29, t**3, 3 * (6 / 29) ** 2 * (t - 4 / 29))
    matrix = np.array(
        [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]
    )
    linear = np.clip(xyz @ matrix.T, 0, 1)
    bent = 1.055 * linear ** (1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, 12.92 * linear, bent)
