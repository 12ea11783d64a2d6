"""The cells that two plates cut, and their pieces of surface: they need no search."""

from typing import Any

import numpy as np

from mesokit.case.box import AXES
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.clearance import Block, corners_of

PROBE = 1.0  # from a plate to where fluid is first looked for: the cell there is never cut


def ends(plates: Plates, size: tuple[int, ...]) -> list[tuple[int, float, float]]:
    """The plates that hold virtual particles: number, height along the axis, normal."""
    length = float(size[AXES.index(plates.axis)])
    both = ((0, 0.0, 1.0, plates.lower), (1, length, -1.0, plates.upper))
    return [(term, at, up) for term, at, up, surface in both if surface.rule != "slip"]


def cut_cells(
    plates: Plates, size: tuple[int, ...], cells: tuple[int, ...], block: Block | None = None
) -> tuple[Any, ...]:
    """As `clearance.cut_cells`, for the one interval of offsets: starts, numbers and corners."""
    where = corners_of(cells, block)
    layer = where[:, AXES.index(plates.axis)]
    chosen = where[np.isin(layer, [at for _, at, _ in ends(plates, size)])]
    return np.array([0, len(chosen)], np.int64), _number(chosen.astype(np.int64), cells), chosen


def cut_planes(plates: Plates, size: tuple[int, ...], corners: Any) -> tuple[Any, ...]:
    """As `clearance.cut_planes`: normals, heights, middles, terms, and cells of the surface.

    In the middle of the interval of offsets the middle of a cut cell is on the plate.
    """
    axis = AXES.index(plates.axis)
    normals, terms = np.zeros(corners.shape), np.zeros(len(corners), np.int64)
    for term, at, up in ends(plates, size):
        here = corners[:, axis] == at
        normals[here, axis], terms[here] = up, term
    inside = np.minimum(corners, np.array(size) - 1).astype(np.int64)
    return normals, np.zeros(len(corners)), corners.copy(), terms, _number(inside, size)


def surface_pieces(plates: Plates, size: tuple[int, ...]) -> tuple[Any, ...]:
    """As `clearance.surface_pieces`: number of the piece in each cell or -1, then for each piece
    its normal, the first place to look for fluid, and its term."""
    axis, where = AXES.index(plates.axis), corners_of(size)
    pieces = np.full(len(where), -1, np.int32)
    outward, probes = [np.zeros((0, len(size)))], [np.zeros((0, len(size)))]
    terms = [np.zeros(0, np.int64)]
    for term, at, up in ends(plates, size) if plates.virtual == "extrapolate" else []:
        here = np.flatnonzero(where[:, axis] == min(at, size[axis] - 1))
        pieces[here] = sum(map(len, terms)) + np.arange(len(here))
        normal = np.zeros((len(here), len(size)))
        normal[:, axis] = up
        place = where[here] + 0.5
        place[:, axis] = at + up * PROBE
        outward.append(normal)
        probes.append(place)
        terms.append(np.full(len(here), term, np.int64))
    return pieces, np.concatenate(outward), np.concatenate(probes), np.concatenate(terms)


def _number(where: Any, cells: tuple[int, ...]) -> Any:
    return where @ np.cumprod([1, *cells[:-1]])
