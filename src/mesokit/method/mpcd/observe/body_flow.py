"""Mean flow around bodies, on a grid that moves and turns with them."""

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY, followed
from mesokit.method.mpcd.groups import fluid_mass_density
from mesokit.method.mpcd.observe.shared.shells import nearest, periodic_lengths
from mesokit.seam.engine import Some, Terms
from mesokit.seam.estimate import Estimate, of_ratio
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks, spread_ids

CAPACITY = 16  # blocks: a map has many bins
RADII = 3.0  # of a body, how far the grid reaches unless said
FINER = 4  # places along each side of a bin, over which theory is a mean
COMPONENTS = {2: ("along", "across"), 3: ("along", "across", "around")}
UNBOUNDED = "approximate: of one swimmer alone in a fluid without bounds or inertia"
SLOW = 0.1  # Reynolds number below which nothing is said of inertia


@component
class BodyFlow(Observable):
    """Mean velocity of the fluid around bodies of a kind, on a grid in their own frame.

    The grid moves with the centre and turns with the axis x of each body. Velocities are those in
    the box, so that the fluid is at rest far away; their components are along that axis and across
    it. In 2D `across` is to the left of the axis; in 3D it is the distance from the axis, the flow
    is a mean over all places around it, and "around" is the velocity about it. Squirmers on disks
    and spheres have the flow of theory beside.
    """

    quantity: Literal["body-flow"] = tag("body-flow")
    drawing, value_label = "body flow", "velocity"
    units: ClassVar[dict[str, str]] = {"value": "a/tau", "along": "a", "across": "a"}
    kind: int | str = param(1, doc=KIND_OF_BODY)
    reach: float | None = param(
        None,
        doc="from the centre to the end of the grid along each axis (three radii of a body unless "
        "said, or half of the shortest side of the box)",
        unit="a",
        gt=0,
    )
    bins_per_cell: int = param(1, doc="bins per cell along each axis", ge=1)
    bodies: int = param(20, doc="bodies over which the flow is a mean, evenly spread", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without such bodies, under shear, and for a reach beyond the box."""
        followed(case, self.quantity, self.kind)
        if case.box.sheared:
            raise CaseError(f"{self.quantity}: not under box.shear_rate, whose images slide")
        half = _half(case)
        if self.reach is not None and self.reach > half:
            raise CaseError(
                f"reach = {self.reach:g}: expected at most {half:g}, half of the shortest side"
            )


def _half(case: Case) -> float:
    """Half of the shortest side."""
    return float(min(case.box.size)) / 2


@accumulator_of(BodyFlow)
class BodyFlowAccumulator(BlockAccumulator):
    """Mass and momentum of each bin, and how fast the bodies are along their own axis."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "own")

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.of = followed(case, observable.quantity, observable.kind)
        self.dimension = case.box.dimension
        self.radius = float(self.of.kind.solid(self.dimension).radius)
        reach = observable.reach or min(RADII * self.radius, _half(case))
        half = max(1, round(reach * observable.bins_per_cell))
        self.reach, self.side = reach, reach / half
        lowest = -half if self.dimension == 2 else 0
        self.edges = [
            np.arange(-half, half + 1) * self.side,
            np.arange(lowest, half + 1) * self.side,
        ]
        self.bins = tuple(len(edges) - 1 for edges in self.edges)
        # Slip and images are in the theory of one swimmer in a periodic cube or square.
        self.box: tuple[float, ...] = ()
        self.why, self.bounds = UNBOUNDED, "without bounds"
        if (known := self.of.alone_in_a_cube()) is not None:
            radius, side, viscosity = known
            slip, self.why = self.of.slip
            self.box = slip / radius, side**self.dimension, self.of.asymmetric_share
            self.bounds = "in this box"
            reynolds = self._speed() * radius * fluid_mass_density(case) / viscosity
            if reynolds > SLOW:
                inertia = f"approximate: without inertia, whose Re is {reynolds:.2g}"
                self.why = f"{inertia}; {self.why}"
        self.lengths = periodic_lengths(case)
        self.rows = self.of.rows.start + spread_ids(observable.bodies, self.of.number)
        self.places = self.axes = np.zeros((0, self.dimension))  # of these bodies, now
        self.blocks = Blocks((1 + self.dimension, *self.bins), capacity=CAPACITY)
        self.own = Blocks()

    def observe(self, fluid: Any) -> None:
        bodies, mass, kT = fluid.bodies, self.case.fluid.mass, self.case.fluid.kT
        self.places, self.axes = bodies.places()[self.rows], bodies.headings[self.rows]
        along = (bodies.velocities[self.rows] * self.axes).sum(axis=1)
        self.own.add(float(along.mean()))
        units = [mass, *[math.sqrt(mass * kT)] * self.dimension]
        size = math.prod(self.bins)
        sums = fluid.sums_of_particles(self.around, size, units)
        self.blocks.add(np.reshape(sums, (-1, *self.bins)))

    def around(self, some: Some) -> Terms:
        """Bins of the particles near each body, their masses and momenta in its frame."""
        where: list[NDArray[np.int64]] = []
        terms: list[list[Array]] = []
        for place, axis in zip(self.places, self.axes, strict=True):
            away = nearest(some.positions - place, self.lengths)
            along = _times(away, axis)
            near = np.flatnonzero(np.abs(along) < self.reach)
            along, away, v = along[near], away[near], some.velocities[near]
            across, directions = self._frame(away, along, axis)
            inside = np.flatnonzero(np.abs(across) < self.reach)
            cells = [
                np.clip(((x[inside] - edges[0]) / self.side).astype(np.int64), 0, len(edges) - 2)
                for x, edges in zip((along, across), self.edges, strict=True)
            ]
            m = some.masses[near][inside]
            found = [m]
            for direction in directions:
                one = direction if direction.ndim == 1 else direction[inside]
                found.append(m * _times(v[inside], one))
            where.append(cells[0] * self.bins[1] + cells[1])
            terms.append(found)
        return np.concatenate(where), [np.concatenate(one) for one in zip(*terms, strict=True)]

    def _frame(self, away: Array, along: Array, axis: Array) -> tuple[Array, list[Array]]:
        """Coordinate across the axis, and directions of the components: in 3D at each place."""
        if self.dimension == 2:
            left = np.array([-axis[1], axis[0]])
            return _times(away, left), [axis, left]
        out = away - along[:, None] * axis
        distance = np.sqrt(_times(out, out))
        out = out / np.maximum(distance, 1e-300)[:, None]
        return distance, [axis, out, np.cross(np.broadcast_to(axis, out.shape), out)]

    def result(self) -> Result:
        sums, _ = self.blocks.sums()
        mass = np.broadcast_to(sums[:, :1], sums[:, 1:].shape)
        velocity, expected = of_ratio(sums[:, 1:], mass), self.expected()
        names = COMPONENTS[self.dimension]
        x = dict(zip(names, ((e[1:] + e[:-1]) / 2 for e in self.edges), strict=False))
        return self.report(
            x | {"component": np.array(names)},
            (np.moveaxis(velocity.value, 0, -1), np.moveaxis(velocity.error, 0, -1)),
            self.comparisons(velocity, expected),
            label=f"velocity around {self.of.name}",
            expected=expected,
            theory="" if expected is None else f"one squirmer {self.bounds}",
            extra={
                "radius": self.radius if self.of.ball else np.nan,
                "speed": float(self.own.mean()) if self.own.count else np.nan,
                "side": self.side,
            },
        )

    def _speed(self) -> float:
        """The larger of the two velocities of a swimming surface."""
        swim = self.of.kind.swim
        return 0.0 if swim is None else max(abs(swim.B1), abs(swim.B2))

    def expected(self) -> Array | None:
        """The flow around a squirmer, a mean over the part of each bin that is fluid."""
        swim = self.of.kind.swim
        if swim is None or not self.of.ball:
            return None
        d = self.dimension
        offsets = (np.arange(FINER) + 0.5) / FINER
        along, across = ((edges[:-1, None] + self.side * offsets).ravel() for edges in self.edges)
        places = np.zeros((len(along), len(across), d))
        places[..., 0], places[..., 1] = along[:, None], across
        flow = theory.squirmer_flow(places, np.eye(d)[0], self.radius, swim.B1, swim.B2, *self.box)
        weight = (np.hypot(along[:, None], across) > self.radius) * (1.0 if d == 2 else across)

        def means(values: Array) -> Array:
            shaped = values.reshape(self.bins[0], FINER, self.bins[1], FINER, -1)
            return np.asarray(shaped.sum(axis=(1, 3)))

        with np.errstate(invalid="ignore"):
            return means(flow * weight[..., None]) / means(weight[..., None])

    def comparisons(self, velocity: Estimate, expected: Array | None) -> Iterator[Comparison]:
        """The flow over that of theory: its projection on it, weighted by mass."""
        speed, error = float(self.own.mean()), float(self.own.error())
        known, why = self.of.swimming_speed()
        yield Comparison("velocity along its own axis", speed, error, known, "a/tau", why)
        if expected is None:
            return
        wanted = np.moveaxis(expected, -1, 0)
        weight = velocity.weights.sum(axis=0) * np.isfinite(wanted) * np.isfinite(velocity.value)
        wanted = np.nan_to_num(wanted)
        weight = weight * wanted / max(float((weight * wanted**2).sum()), 1e-300)
        flat = Estimate(
            np.nan_to_num(velocity.value).ravel(),
            np.nan_to_num(velocity.residuals).reshape(len(velocity.residuals), -1),
            velocity.weights.reshape(len(velocity.weights), -1),
        )
        value, error = flat.total(weight.ravel())
        yield Comparison("flow over theory", value, error, 1.0, note=self.why)


def _times(vectors: Array, other: Array) -> Array:
    """Products (n,) of vectors (n, d) with one, or each with its own, each by its row alone."""
    found = vectors[:, 0] * other[..., 0]
    for k in range(1, vectors.shape[1]):
        found = found + vectors[:, k] * other[..., k]
    return np.asarray(found)
