"""Rigid bodies that move, at the time of a picture: outlines to scale, and their images."""

from collections.abc import Sequence
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.caption import in_cells
from mesokit.report.flow.body_distance import distance
from mesokit.report.flow.data import Array, Bodies
from mesokit.report.flow.images import shifts, towards
from mesokit.report.flow.shaded_parts import Placed
from mesokit.report.flow.state import State
from mesokit.seam.method import BodyShape, method_of

GRID = 128  # samples along the sides of a square that holds an outline
COLOURS = 4  # of kinds, one after the other
SHORT = 0.3  # of its half length: an arrow that is cut to less is drawn whole
ARROWS = "arrows: the way they swim"
ARROW = 0.6  # of half the length of a body that swims: half its arrow


class BodyFrames:
    """The bodies that a trajectory has, seen along the third axis of the box, without kinds that
    lack their orientations (see `left_out`).

    `plane` is the place along that axis where flow maps cut them, None in 2D; `behind` says that
    pictures in space show only those with a centre behind it. `traces` is the time over which the
    paths of their centres are shown.
    """

    def __init__(
        self,
        case: Case,
        reader: TrajectoryReader | State,
        axes: tuple[str, str],
        plane: float | None = None,
        behind: bool = False,
        traces: float = 0.0,
    ) -> None:
        self.case, self.reader, self.plane, self.behind = case, reader, plane, behind
        self.traces = traces
        self.shapes = method_of(case).bodies(case)
        self.rows, self.kinds = _rows(case, reader)
        drawn = _drawn(case, reader)
        self.rows, self.kinds = self.rows[drawn[self.kinds]], self.kinds[drawn[self.kinds]]
        self.called, self.shown = _names(case), tuple(np.flatnonzero(drawn).tolist())
        self.columns = [case.box.axes.index(axis) for axis in axes]
        self.third = next((k for k in range(case.box.dimension) if k not in self.columns), None)

    def at(self, time: float | None = None) -> Bodies:
        """In the frame that is nearest to a time, the last one unless said."""
        times = self.reader.time
        index = len(times) - 1 if time is None else int(np.argmin(np.abs(times - time)))
        now, read = float(times[index]), self.reader[index]
        places = read["position"][self.rows].astype(float)
        turns: Array = np.tile(np.eye(3), (len(places), 1, 1))
        if "orientation" in read:
            turns = rotations(read["orientation"][self.rows].astype(float))
        lines_of, kinds, arrows, swimmers = [], [], [], []
        for shift in shifts(self.case, now, range(self.case.box.dimension)):
            here = places + shift
            for n in np.flatnonzero(self._seen(here) & self._cut(here)):
                kind, middle = int(self.kinds[n]), here[n, self.columns]
                lines = self._outline(kind, here[n], turns[n])
                if not lines:
                    continue
                lines_of.append(tuple(middle + line for line in lines))
                kinds.append(kind)
                ends = self._arrows[kind] @ turns[n][self.columns].T
                if ends.any() and self._holds(kind, here[n], turns[n], ends):
                    arrows.append(middle + ends)
                    swimmers.append(kind)
        return Bodies(
            outlines=tuple(lines_of),
            kinds=np.array(kinds, np.int64),
            arrows=np.array(arrows, float).reshape(-1, 2, 2),
            swimmers=np.array(swimmers, np.int64),
            traces=self._traces(index),
            called=self.called,
            shown=self.shown,
            time=now,
            placed=None if self.third is None else partial(self._placed, places, turns, now),
            room=self._room(),
        )

    def gone(self, span: float) -> float:
        """How far a median body goes in a time at the end of the run, over its size.

        It is nan under shear, and in fewer than two frames. From frame to frame a body must go less
        than half of the box.
        """
        times, box = self.reader.time, self.case.box
        if len(times) < 2 or box.sheared:
            return np.nan
        gap = float(times[-1] - times[-2])
        lag = min(max(1, round(span / gap)), len(times) - 1)
        kept = range(len(times) - 1 - lag, len(times))
        places = np.stack([self.reader[k]["position"][self.rows].astype(float) for k in kept])
        steps, size = np.diff(places, axis=0), np.array(box.size)
        away = np.hypot.reduce((steps - size * np.rint(steps / size)).sum(axis=0), axis=-1)
        sizes = np.array([2.0 * shape.radius for shape in self.shapes])[self.kinds]
        return float(np.median(away / sizes)) * span / (lag * gap)

    def where(self, solid: bool) -> str:
        """Caption: where bodies are cut, or which are shown, and what shows the way they swim."""
        swimming = any(self.shapes[kind].forward for kind in self.shown)
        if self.third is None or self.plane is None:
            return ARROWS if swimming else ""
        words, sign = [], "<" if towards(self.columns) > 0 else ">"
        place = f"{self.plane:g}{in_cells()}$"
        if not solid:
            words = [f"cut at ${AXES[self.third]} = {place}"]
        elif self.behind:
            words = [f"those at ${AXES[self.third]} {sign} {place}"]
        if swimming:
            words.append("dark: their front, where it can be seen" if solid else ARROWS)
        return "; ".join(words)

    def _traces(self, last: int) -> Array:
        """Pieces (m, 2, 2) of the paths of their centres up to a frame, from frame to frame by the
        shorter way; those over an edge of the picture are there on both sides."""
        times = self.reader.time
        frames = [k for k in range(last + 1) if times[k] >= times[last] - self.traces]
        if len(frames) < 2:
            return np.zeros((0, 2, 2))
        size = np.array(self.case.box.size)[self.columns]
        closed = method_of(self.case).enclosure.closed_axes(self.case)
        open_ends = np.array([k not in closed for k in self.columns])
        path = np.stack([self.reader[k]["position"][self.rows] for k in frames]).astype(float)
        starts = path[:-1][..., self.columns].reshape(-1, 2)
        steps = path[1:][..., self.columns].reshape(-1, 2) - starts
        steps -= open_ends * size * np.rint(steps / size)
        ends = starts + steps
        found = []
        for inside in (starts, ends):
            shift = open_ends * size * np.floor(inside / size)
            found.append(np.stack([starts - shift, ends - shift], axis=1))
        return np.unique(np.concatenate(found), axis=0)

    @cached_property
    def _radii(self) -> Array:
        return np.array([shape.radius for shape in self.shapes])[self.kinds]

    def _seen(self, places: Array) -> NDArray[np.bool_]:
        """Which bodies at these places (n, d) can reach into the box, as the picture shows it."""
        size, own = np.array(self.case.box.size)[self.columns], places[:, self.columns]
        reach = self._radii[:, None]
        return np.all((own > -reach) & (own < size + reach), axis=1)

    def _cut(self, places: Array) -> NDArray[np.bool_]:
        """Which can reach the plane of the picture."""
        if self.third is None:
            return np.ones(len(places), bool)
        assert self.plane is not None
        return np.abs(places[:, self.third] - self.plane) < self._radii

    def _outline(self, kind: int, place: Array, turn: Array) -> list[Array]:
        """Closed lines (n, 2) around what the picture's plane cuts, about the body's centre."""
        if self.third is None:
            return [line @ turn[self.columns, :2].T for line in self._own[kind]]
        assert self.plane is not None
        axes = np.zeros((3, 3))
        axes[[0, 1, 2], [*self.columns, self.third]] = 1.0
        height = float(self.plane - place[self.third])
        return outlines(self.shapes[kind], axes @ turn, height)

    def _holds(self, kind: int, place: Array, turn: Array, shown: Array) -> bool:
        """Whether both ends of an arrow, as shown, are in what the picture's plane cuts."""
        if self.third is None or self.plane is None:
            return True
        ends = np.zeros((2, len(place)))
        ends[:, self.columns], ends[:, self.third] = shown, self.plane - place[self.third]
        own = ends @ turn[: len(place), : len(place)]
        return bool((distance(self.shapes[kind].parts, own) < 0).all())

    @cached_property
    def _arrows(self) -> Sequence[Array]:
        """Tail and tip (2, 3) of the arrow of each kind, in its own frame: as far behind and before
        its centre as they stay in it, and as a part of the way to its front; zeros without one.

        Where the centre is in a gap or a neck, so that little of the arrow is left, it is whole.
        Sections in space leave such arrows out (see `_holds`).
        """
        found = []
        for shape in self.shapes:
            ends = np.zeros((2, 3))
            if shape.forward:
                front = ARROW * np.array(shape.forward)
                inner = np.array([_inner_part(shape, -front), _inner_part(shape, front)])
                short = np.ptp(inner, axis=0).max() < SHORT * np.abs(front).max()
                ends[:, : len(front)] = (-front, front) if short else inner
            found.append(ends)
        return found

    @cached_property
    def _own(self) -> list[list[Array]]:
        """Outlines of all kinds in their own frames, in 2D."""
        return [outlines(shape, np.eye(2)) for shape in self.shapes]

    def _room(self) -> tuple[float, float]:
        if self.third is None:
            return 0.0, 0.0
        sign = towards(self.columns)
        back, front = sorted((0.0, sign * float(self.case.box.size[self.third])))
        if self.behind and self.plane is not None:
            front = sign * self.plane
        return back, front

    def _placed(self, places: Array, turns: Array, time: float) -> list[Placed]:
        """All parts in space, in the picture's axes, with images over its edges."""
        assert self.third is not None
        axes = np.zeros((3, 3))
        axes[[0, 1, 2], [*self.columns, self.third]] = 1.0, 1.0, towards(self.columns)
        plane = np.inf
        if self.behind and self.plane is not None:
            plane = towards(self.columns) * self.plane
        found = []
        for shift in shifts(self.case, time, self.columns):
            here = places + shift
            for n in np.flatnonzero(self._seen(here)):
                place, shape = axes @ here[n], self.shapes[self.kinds[n]]
                if place[2] <= plane:
                    colour, turn = int(self.kinds[n]) % COLOURS, axes @ turns[n]
                    found += [Placed(p, place, turn, colour, shape.forward) for p in shape.parts]
        return found


def bodies_of(
    case: Case,
    trajectory: TrajectoryReader | State | None,
    axes: tuple[str, str],
    plane: float | None = None,
    behind: bool = False,
    traces: float | None = None,
) -> BodyFrames | None:
    """The bodies of a run, None if it kept none, or not enough of any to draw it.

    Raises CaseError for traces that there are not.
    """
    if traces is not None:
        require_traces(case, traces)
    if trajectory is None or not _has_places(case, trajectory):
        return None
    found = BodyFrames(case, trajectory, axes, plane, behind, traces or 0.0)
    return found if len(found.rows) else None


def without_turns(case: Case, trajectory: TrajectoryReader | State | None) -> tuple[str, ...]:
    """Names of kinds of which a run kept places, but not the orientations that a picture needs."""
    if trajectory is None or not _has_places(case, trajectory):
        return ()
    names, drawn = _names(case), _drawn(case, trajectory)
    return tuple(names[kind] for kind in np.unique(_rows(case, trajectory)[1]) if not drawn[kind])


def left_out(case: Case, trajectory: TrajectoryReader | State | None) -> str:
    """Caption: which kinds are not drawn, "" where all are."""
    names = without_turns(case, trajectory)
    return f"left out: {', '.join(names)}, whose orientation was not kept" if names else ""


def _has_places(case: Case, trajectory: TrajectoryReader | State) -> bool:
    kept = len(trajectory) and "position" in trajectory.fields
    return bool(kept and method_of(case).bodies(case))


def _drawn(case: Case, trajectory: TrajectoryReader | State) -> NDArray[np.bool_]:
    """Of each kind, whether the run kept all that a picture needs of it beside its places."""
    turned = "orientation" in trajectory.fields
    return np.array([turned or _round(shape) for shape in method_of(case).bodies(case)])


def _rows(
    case: Case, trajectory: TrajectoryReader | State
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The rows of bodies in a frame, and the kind of each."""
    before = [group for group in case.groups if "orientation" not in group.has]
    own = trajectory.id - sum(group.number for group in before)
    bodies = next(group for group in case.groups if "orientation" in group.has)
    rows = np.flatnonzero((own >= 0) & (own < bodies.number))
    return rows, trajectory.species[rows] - sum(len(group.kinds) for group in before)


def _names(case: Case) -> tuple[str, ...]:
    bodies = next(group for group in case.groups if "orientation" in group.has)
    return tuple(kind.name for kind in bodies.kinds)


def require_traces(case: Case, traces: float) -> None:
    """Raise CaseError for traces of a case without bodies or with sliding images, or of no time."""
    if not method_of(case).bodies(case):
        raise CaseError(f"traces = {show(traces)}: the case has no bodies that move; leave it out")
    if case.box.sheared:
        raise CaseError(f"traces = {show(traces)}: not under box.shear_rate, whose images slide")
    if not traces > 0:
        raise CaseError(f"traces = {show(traces)}: expected a time above 0")


def _inner_part(shape: BodyShape, end: Array) -> Array:
    """The last place (d,) in the body on the line from its centre to `end` (d,), in cells."""
    line = np.outer(np.linspace(0.0, 1.0, 41), end)
    left = np.flatnonzero(distance(shape.parts, line) >= 0)
    return line[max(left[0] - 1, 0) if len(left) else -1]


def _round(shape: BodyShape) -> bool:
    """Whether a picture of a body has no need of its orientation."""
    alone = len(shape.parts) == 1 and shape.parts[0].kind == "ball"
    return alone and not shape.forward


def rotations(turns: Array) -> Array:
    """Matrices (n, 3, 3) of unit quaternions (n, 4) w, x, y, z.

    >>> float(rotations(np.array([[0.5**0.5, 0, 0, 0.5**0.5]]))[0, 1, 0].round(9))  # x to y
    1.0
    """
    w, u = turns[:, 0, None, None], turns[:, 1:]
    cross = np.cross(np.eye(3)[None], u[:, None])  # its rows times a vector: u x vector
    found: Array = np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross
    return found


def outlines(shape: BodyShape, turn: Array, height: float = 0.0) -> list[Array]:
    """Closed lines (n, 2) where a plane cuts the surface, about the centre.

    `turn` (d, d) takes vectors of the body's frame to the picture's; in 3D the plane is at a
    `height` along the picture's third axis.
    """
    from contourpy import contour_generator

    reach = shape.radius * (1.0 + 4.0 / GRID)
    along = np.linspace(-reach, reach, GRID)
    u, v = np.meshgrid(along, along)
    places = np.stack([u, v, np.full_like(u, height)][: len(turn)], axis=-1).reshape(-1, len(turn))
    values = distance(shape.parts, places @ turn).reshape(u.shape)
    lines: Any = contour_generator(u, v, values).lines(0.0)
    return [np.asarray(line) for line in lines]
