"""Beads of solutes and the bonds between them, drawn over the flow."""

import itertools
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.flow.data import Array, Beads
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import points_of
from mesokit.report.flow.state import State
from mesokit.report.style import COLOURS
from mesokit.seam.method import method_of

SMALLEST = 1.6  # diameter, in points
EDGE, BOND = 0.2, 0.45  # widths of the edge and of bonds, of the diameter
RIM = 0.8  # points, the widest edge: that of a large bead would hide the fluid at its surface
ABOVE = 6  # the solids
MARKERS = "osD^vP"  # of kinds: in grey they look alike otherwise
ORDER = (1, 3, 4, 2, 5, 0)  # of colours: one and the next are far apart in grey
LAYERS, PALE = 6, 0.65  # of depth in 3D; how much of the colour the rearmost lacks


class BeadFrames:
    """The beads that a trajectory has."""

    def __init__(self, case: Case, reader: TrajectoryReader | State, axes: tuple[str, str]) -> None:
        method, (first, *others) = method_of(case), case.groups
        self.case, self.reader = case, reader
        self.columns = [case.box.axes.index(axis) for axis in axes]
        own = reader.id - first.number
        self.rows = np.flatnonzero((own >= 0) & (own < others[0].number))
        self.kinds = reader.species[self.rows] - len(first.kinds)
        bonds = method.bonds(case) - (reader.id[self.rows[0]] if len(self.rows) else 0)
        self.bonds = bonds[((bonds >= 0) & (bonds < len(self.rows))).all(axis=1)]
        self.diameters = np.array([kind.diameter for kind in others[0].kinds])
        self.called = tuple(
            f"kind {i}" if kind.name in ("", f"polymer-{i}") else kind.name
            for i, kind in enumerate(others[0].kinds, start=1)
        )
        closed = method.enclosure.closed_axes(case)
        sizes = enumerate(case.box.size)
        self.periods = np.array([np.inf if k in closed else float(n) for k, n in sizes])

    def at(self, time: float | None = None) -> Beads:
        """In the frame that is nearest to a time, the last one unless said."""
        times = self.reader.time
        index = len(times) - 1 if time is None else int(np.argmin(np.abs(times - time)))
        now, slid = float(times[index]), 0.0
        if self.case.box.sheared:
            slid = self.case.box.displacement(now) % float(self.case.box.size[0])
        position = self.reader[index]["position"][self.rows].astype(float)
        whole = self._whole(position, slid)
        edges = np.diag(np.where(np.isinf(self.periods), 0.0, self.periods))
        edges[1, 0] = slid
        repeats = self._repeats(whole, edges)
        near = np.ones(len(whole))
        for third in {*range(len(self.case.box.size))} - {*self.columns}:
            near = position[:, third] / float(self.case.box.size[third])
        how = self.kinds, self.bonds, self.diameters, self.called
        return Beads(whole[:, self.columns], *how, repeats, now, self.molecules, near)

    @cached_property
    def molecules(self) -> NDArray[np.int64]:
        """Number of the molecule of each bead: those that bonds join."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        n, links = len(self.rows), self.bonds
        joined = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(n, n))
        return np.asarray(connected_components(joined, directed=False)[1], np.int64)

    def _whole(self, r: Array, slid: float) -> Array:
        """Each bead next to the one before that it hangs on."""
        r = r.copy()
        for first, last in self.bonds[np.argsort(self.bonds.max(axis=1), kind="stable")]:
            near, far = min(first, last), max(first, last)
            separation = r[far] - r[near]
            separation[0] -= slid * np.rint(separation[1] / self.periods[1])
            boxes = np.rint(separation / self.periods)
            separation -= boxes * np.where(np.isinf(self.periods), 0.0, self.periods)
            r[far] = r[near] + separation
        return r

    def _repeats(self, whole: Array, edges: Array) -> tuple[tuple[float, float], ...]:
        """Displacements by boxes that bring some bead into the box of the picture."""
        if not len(whole):
            return ()
        counts = []
        for axis, period in enumerate(self.periods):
            if axis not in self.columns or np.isinf(period):
                counts.append(range(1))
                continue
            low, high = (np.floor(f(whole[:, axis]) / period) for f in (np.min, np.max))
            more = axis == 0 and bool(edges[1, 0])  # images above and below lie aside
            counts.append(range(-int(high) - more, -int(low) + more + 1))
        every = (np.array(n) @ edges for n in itertools.product(*counts))
        return tuple(sorted({tuple(shift[self.columns].tolist()) for shift in every}))


def frames_of(
    case: Case, trajectory: TrajectoryReader | State | None, axes: tuple[str, str]
) -> BeadFrames | None:
    """The beads of a run, None if it kept none of them."""
    if trajectory is None or len(case.groups) == 1 or not len(trajectory):
        return None
    if "position" not in trajectory.fields:
        return None
    found = BeadFrames(case, trajectory, axes)
    return found if len(found.rows) else None


def look(kind: int, molecule: int, only: bool) -> tuple[str, str]:
    """Colour and marker of a kind; of the molecules, where there is one kind only."""
    number = molecule if only else kind
    return COLOURS[ORDER[number % len(ORDER)]], MARKERS[kind % len(MARKERS)]


def keys(beads: Beads) -> tuple[list[Any], list[str]]:
    """Marks of a legend of the kinds, and their names."""
    from matplotlib.lines import Line2D

    looks = [look(int(kind), 0, False) for kind in np.unique(beads.kinds) if beads.names]
    marks = [Line2D([], [], color=colour, marker=marker, ls="", ms=5) for colour, marker in looks]
    return marks, beads.names


def draw(ax: Any, beads: Beads, region: Region) -> None:
    """Draw those in the region, kinds (or the molecules of one kind) in colours of their own.

    In 3D those at the back come first, and are paler.
    """
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb

    points, only = points_of(ax), not beads.names
    layers = np.minimum((beads.nearness * LAYERS).astype(int), LAYERS - 1)
    groups = np.stack([layers, beads.kinds, beads.molecules % len(COLOURS) * only], axis=1)
    for shift in beads.repeats:
        places = beads.places + shift
        inside = region.holds(places)
        ends = beads.bonds[inside[beads.bonds].any(axis=1)]
        for group in np.unique(groups, axis=0):  # from the back to the front
            layer, kind, molecule = (int(number) for number in group)
            colour, marker = look(kind, molecule, only)
            part = PALE * (1 - (layer + 1) / LAYERS)  # of white
            shade = tuple(x + (1 - x) * part for x in to_rgb(colour)) if part > 0 else colour
            chosen = (groups == group).all(axis=1)
            own, size = inside & chosen, max(SMALLEST, float(beads.diameters[kind]) * points)
            bonds = list(places[ends[chosen[ends[:, 0]]]])
            lines = LineCollection(bonds, colors=shade, linewidths=BOND * size, zorder=ABOVE)
            ax.add_collection(lines, autolim=False)
            style: Any = {"color": shade, "ms": size, "mec": "white"}
            rim = min(EDGE * size / 2, RIM)
            ax.plot(*places[own].T, marker, mew=rim, zorder=ABOVE, **style)
