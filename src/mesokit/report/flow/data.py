"""Data from which a picture of the flow is drawn."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Links:
    """Contacts of spheres at one time, as lines.

    Parameters
    ----------
    ends: (m, 2, 2) in the picture, of the first sphere and of its partner, or the place at a wall.
    forces: (m,) along the normals, positive where the two repel.
    nearness: (m,) from 0 (at the back of the box) to 1 along the third axis; all 1 in 2D.
    """

    ends: Array
    forces: Array
    nearness: Array


@dataclass(frozen=True)
class Spheres:
    """Spheres at one time.

    Parameters
    ----------
    places: (n, 2) along the axes of the picture.
    depth: (n,) towards the eye, None of disks.
    room: the least and the largest depth.
    diameters: (n,).
    values: (n,) numbers that colours stand for.
    counted: whether these are whole numbers from 0.
    scale: of colours, for the largest number; None where all are alike.
    repeats: vectors (2,) by which all of it repeats, the first of them 0.
    time: of the frame.
    note: what of the box is shown.
    remark: what colours do not show of this time.
    plates: that are not where they are at rest, see `moving_plates`.
    links: function that returns the contacts of this time, None where they are not known.
    """

    places: Array
    depth: Array | None
    room: tuple[float, float]
    diameters: Array
    values: Array
    counted: bool
    scale: Callable[[float], Any] | None
    repeats: tuple[tuple[float, float], ...]
    time: float
    note: str = ""
    plates: tuple[Any, ...] = ()
    remark: str = ""
    links: Callable[[], Links] | None = None

    def seen(
        self, low: tuple[float, float], high: tuple[float, float]
    ) -> tuple[NDArray[np.int64], Array]:
        """Rows and places (m, 2) of all that can be seen between two corners, images included."""
        radius = 0.5 * self.diameters[:, None]
        rows, places = [], []
        for shift in self.repeats:
            here = self.places + shift
            inside = ((here + radius > low) & (here - radius < high)).all(axis=1)
            rows.append(np.flatnonzero(inside))
            places.append(here[inside])
        return np.concatenate(rows), np.concatenate(places)


@dataclass(frozen=True)
class Beads:
    """Beads at one time, molecules whole, so that some may lie outside the box.

    Parameters
    ----------
    places: (n, 2) along the axes of the picture.
    kinds: (n,) from 0.
    bonds: (m, 2) rows of `places`.
    diameters: of each kind, in cells.
    called: what each kind is called.
    repeats: vectors (2,) by which all of it repeats.
    time: of the frame.
    molecules: (n,) numbers of the molecules, from 0.
    nearness: (n,) from 0 (at the back of the box) to 1 along the third axis; all 1 in 2D.
    """

    places: Array
    kinds: NDArray[np.int64]
    bonds: NDArray[np.int64]
    diameters: Array
    called: tuple[str, ...]
    repeats: tuple[tuple[float, float], ...]
    time: float
    molecules: NDArray[np.int64]
    nearness: Array

    @property
    def names(self) -> list[str]:
        """Names of the kinds in a legend; none where there is one kind only."""
        kinds = np.unique(self.kinds)
        return [self.called[kind] for kind in kinds] if len(kinds) > 1 else []


@dataclass(frozen=True)
class Bodies:
    """Rigid bodies at one time, images over the edges of a periodic box included.

    Parameters
    ----------
    outlines: of each, closed lines (n, 2) in the picture; in 3D of its section.
    kinds: of each, from 0.
    arrows: (m, 2, 2) tail and tip along the axis of those that swim; swimmers: their kinds (m,).
    traces: (m, 2, 2) pieces of the paths of their centres up to this time.
    called: what each kind is called.
    shown: kinds that are drawn wherever they can be seen.
    time: of the frame.
    placed: function that returns their parts in space, None in 2D.
    room: the least and the largest depth, in space.
    """

    outlines: tuple[tuple[Array, ...], ...]
    kinds: NDArray[np.int64]
    arrows: Array
    swimmers: NDArray[np.int64]
    traces: Array
    called: tuple[str, ...]
    shown: tuple[int, ...]
    time: float
    placed: Callable[[], Any] | None = None
    room: tuple[float, float] = (0.0, 0.0)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the kinds `shown` in a legend; none where the case has one kind only."""
        return tuple(self.called[kind] for kind in self.shown) if len(self.called) > 1 else ()


@dataclass(frozen=True)
class Flow:
    """Means over a time on a grid over two axes of the box, and particles at its end.

    Parameters
    ----------
    axes: the two axes of the picture.
    size: lengths of the box along them, in cells.
    dimension: of the box.
    periodic: whether the flow goes on unchanged beyond the end of each axis.
    density: particles per cell (nx, ny), None if not known.
    velocity: components along the two axes (nx, ny, 2), nan where there is no fluid, or None.
    particles: positions (n, 2), or None.
    error: standard error of the velocity (nx, ny, 2), or None if not known.
    noise: as the velocity, but without the flow: an example of its noise, or None.
    sure: bins (nx, ny) that are mostly fluid, which the colours are chosen from, None for all.
    lowest: density at which its colours start.
    smoothing: width over which the velocity has been smoothed, in bins.
    beads: of solutes, drawn over all, or None.
    bodies: that move, drawn over all but beads, or None.
    bonds: ends (m, 2, 2) of those between the `particles`, or None.
    spheres: at the end of the time, or None.
    headings: velocities (n, 2) of the `particles` along the two axes, or None.
    sites: states (nx, ny) of the sites of a lattice at one time, or deviations of their heights
        from the mean, in bins that each show one site; or None.
    states: their names, by number; none of heights.
    time: of the `particles`, where they have headings, and of the `sites`.
    note: which of the `sites` are shown.
    """

    axes: tuple[str, str]
    size: tuple[float, float]
    dimension: int
    periodic: tuple[bool, bool] = (False, False)
    density: Array | None = None
    velocity: Array | None = None
    particles: Array | None = None
    error: Array | None = None
    noise: Array | None = None
    sure: NDArray[np.bool_] | None = None
    lowest: float = 0.0
    smoothing: float = 0.0
    beads: Beads | None = None
    bodies: Bodies | None = None
    bonds: Array | None = None
    spheres: Spheres | None = None
    headings: Array | None = None
    sites: NDArray[Any] | None = None
    states: tuple[str, ...] = ()
    time: float = 0.0
    note: str = ""

    @property
    def speed(self) -> Array:
        """Speed in the plane of the picture (nx, ny)."""
        assert self.velocity is not None
        return np.hypot(self.velocity[..., 0], self.velocity[..., 1])

    def surely(self, values: Array) -> Array:
        """Values (nx, ny, ...), nan in the bins that no colour is to be chosen from."""
        if self.sure is None:
            return values
        return np.where(
            self.sure.reshape(self.sure.shape + (1,) * (values.ndim - 2)), values, np.nan
        )


def spacing(flow: Flow, values: Array) -> tuple[float, float]:
    """Lengths of a bin of `values` (nx, ny) along the two axes."""
    return flow.size[0] / values.shape[0], flow.size[1] / values.shape[1]
