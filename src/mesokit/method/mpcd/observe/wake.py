"""Velocity on the centre line behind a body, and how far the fluid flows back there."""

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.geometry.shape import array
from mesokit.geometry.shape.cylinder import Cylinder
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import Solids, solids_of
from mesokit.method.mpcd.expected import recognise, setting
from mesokit.method.mpcd.observe.shared.shells import nearest, periodic_lengths
from mesokit.seam.engine import RunningFluid, Some, Terms
from mesokit.seam.estimate import Estimate, fit, of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

SURE = 3.0  # standard errors by which the fluid must flow back
STEP = 0.01  # by which the ends of a body are looked for
PARABOLIC = "approximate: channel with parabolic inflow, at the Reynolds number of this flow"


@component
class Wake(Observable):
    """Mean velocity along the flow in a strip behind a body, from its rear on.

    Where the fluid flows back, the length L_r of that part over the size D of the body is where
    the velocity passes zero, by a straight line through the places around. It is given if the fluid
    flows back by more than 3 standard errors. D is the body's extent across the flow.
    """

    quantity: Literal["wake"] = tag("wake")
    of_built_up_flow: ClassVar[bool] = True
    asks_transport: ClassVar[bool] = True
    drawing = "centreline"
    units: ClassVar[dict[str, str]] = {"value": "a/tau", "distance": "a"}
    solid: str | None = param(None, doc="name of the body (the first that is no plate unless said)")
    flow: Axis | None = param(None, doc="axis of the flow (that of the force unless said)")
    width: float = param(1.0, doc="width of the strip", unit="a", gt=0)
    reach: float | None = param(
        None, doc="length of the strip (as far as there is fluid, at most 5 D)", unit="a", gt=0
    )
    bins_per_cell: int = param(2, doc="bins per cell", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without a body, a flow, or fluid behind the body."""
        if self.flow is not None:
            case.box.index(self.flow, "flow")
        if self.solid is not None and (not case.walls or self.solid not in solids_of(case).names):
            names = ", ".join(solids_of(case).names) if case.walls else "none there"
            raise CaseError(f"solid = {show(self.solid)}: expected one of {names}")
        number = self.body(case)
        if number is None:
            raise CaseError("wake needs a [[wall]] that stands in the flow")
        if self.flow is None and setting.driven_axis(case) is None:
            raise CaseError(
                "flow: missing; no force drives the fluid along one axis, so say which is that of "
                "the flow"
            )
        Standing(self, case)

    def body(self, case: Case) -> int | None:
        if not case.walls:
            return None
        solids = solids_of(case)
        if self.solid is not None:
            return solids.names.index(self.solid)
        solid = [not isinstance(case.walls[wall], Plates) for wall in solids.walls]
        return next((i for i, stands in enumerate(solid) if stands), None)


class Standing:
    """Place of a body in the flow: `axis` and `sign` of the flow, the axes `across` that bound
    the strip, its `middle`, how far its `rear` is from there, its `size`, and the `room` behind."""

    def __init__(self, observable: Wake, case: Case) -> None:
        solids, number = solids_of(case), observable.body(case)
        axis = AXES.index(observable.flow) if observable.flow else setting.driven_axis(case)
        assert number is not None and axis is not None  # as `check` has seen
        self.axis = axis
        self.sign = -1.0 if setting.uniform_acceleration(case)[axis] < 0 else 1.0
        wall: Any = case.walls[solids.walls[number]]
        wall = wall.of if isinstance(wall, array.Array) else wall
        along = int(np.argmax(np.abs(wall.direction))) if isinstance(wall, Cylinder) else None
        self.across = [k for k in range(case.box.dimension) if k not in (axis, along)]
        self.middle = np.array(solids.bodies[number].pieces[0].pivot)
        self.rear = _solid_until(solids, self.middle, axis, self.sign)
        sides = [_solid_until(solids, self.middle, self.across[0], s) for s in (-1.0, 1.0)]
        self.size = sum(sides)
        if not (self.rear > 0 and self.size > 0 and np.isfinite(self.rear + self.size)):
            name = solids.names[number]
            raise CaseError(f"solid: the middle of {name} is not in it, or it has no rear")
        start = self.middle.copy()
        start[axis] += self.sign * self.rear
        away, clear = _line(solids, start, axis, self.sign)
        stops = np.flatnonzero(clear[1:] <= 0)
        self.room = float(away[stops[0] + 1] if len(stops) else away[-1])
        if not self.room > 0:
            raise CaseError(f"solid: no fluid behind {solids.names[number]}")


def _line(solids: Solids, start: Array, axis: int, sign: float) -> tuple[Array, Array]:
    """Places along an axis, up to the length of the box, and the clearance there."""
    away = np.arange(1, round(solids.size[axis] / STEP)) * STEP
    points = np.tile(start, (len(away), 1))
    points[:, axis] += sign * away
    if solids.room.closed[axis]:  # beyond the plates there is nothing
        inside = (points[:, axis] >= 0) & (points[:, axis] <= solids.size[axis])
        away, points = away[inside], points[inside]
    return away, solids.distance(points)


def _solid_until(solids: Solids, start: Array, axis: int, sign: float) -> float:
    """Distance up to which there is solid; 0 where there is none, infinite where it never ends."""
    away, clear = _line(solids, start, axis, sign)
    if solids.distance(start)[0] > 0:
        return 0.0
    free = np.flatnonzero(clear > 0)
    if not len(free):
        return np.inf
    return float(away[free[0]] - clear[free[0]])  # the last step went beyond the surface


@accumulator_of(Wake)
class WakeAccumulator(BlockAccumulator):
    """Momentum and mass in the bins of the strip, and the momentum of the whole fluid."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "whole")

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.body = Standing(observable, case)
        reach = min(observable.reach or 5 * self.body.size, self.body.room)
        bins = max(round(reach * observable.bins_per_cell), 1)
        self.edges = np.linspace(0.0, reach, bins + 1)
        self.centres = (self.edges[1:] + self.edges[:-1]) / 2
        self.lengths = periodic_lengths(case)
        self.blocks, self.whole = Blocks((2, bins)), Blocks()

    def observe(self, fluid: RunningFluid) -> None:
        mass = self.case.fluid.mass
        units = [math.sqrt(mass * self.case.fluid.kT), mass]
        self.blocks.add(fluid.sums_of_particles(self.behind, len(self.centres), units))
        _, momentum, _ = fluid.totals()
        self.whole.add(self.body.sign * momentum[self.body.axis])

    def behind(self, some: Some) -> Terms:
        """Bins of the particles in the strip, their momentum along the flow and their mass."""
        body, r = self.body, some.positions
        behind = body.sign * (r[:, body.axis] - body.middle[body.axis]) - body.rear
        length = self.lengths[body.axis]
        if np.isfinite(length):
            behind -= length * np.floor(behind / length)
        off = nearest(r[:, body.across] - body.middle[body.across], self.lengths[body.across])
        inside = (np.abs(off) <= 0.5 * self.observable.width).all(axis=1)
        inside &= (behind >= 0) & (behind < self.edges[-1])
        bins = len(self.centres)
        place = np.minimum((behind[inside] / self.edges[-1] * bins).astype(int), bins - 1)
        m = some.masses[inside]
        return place, [m * (body.sign * some.velocities[inside, body.axis]), m]

    def result(self) -> Result:
        sums, _ = self.blocks.sums()
        velocity = of_ratio(sums[:, 0], sums[:, 1])
        found: list[Comparison] = []
        length = np.nan
        if self.blocks.count and np.isfinite(velocity.value).all():
            found = list(self.comparisons(velocity))
            length = next((c.measured for c in found if c.what == "L_r/D"), 0.0) * self.body.size
        return self.report(
            {"distance": self.centres},
            velocity,
            found,
            label=f"velocity v_{AXES[self.body.axis]}",
            extra={
                "edges": self.edges,
                "size": self.body.size,
                "recirculation": length,
                "speed": self.speed(),
            },
        )

    def speed(self) -> float:
        """Mean velocity along the flow, over the whole box; nan before the first sample."""
        if not self.whole.count:
            return np.nan
        mass = setting.mass_density(self.case) * float(np.prod(self.case.box.size))
        return float(of_mean(self.whole).value) / mass

    def comparisons(self, velocity: Estimate) -> Iterator[Comparison]:
        first = (self.edges[1:] <= 1.0 + 1e-9) * 1.0
        first[0] = 1.0
        near = velocity.total(first / first.sum())
        yield Comparison("velocity in the cell behind the body", *near, unit="a/tau")
        crossing = self.crossing(velocity)
        if crossing is not None:
            value, error = (x / self.body.size for x in crossing)
            expected, note = self.expected()
            yield Comparison("L_r/D", value, error, expected, "", note)

    def crossing(self, velocity: Estimate) -> tuple[float, float] | None:
        """Place where the velocity passes zero, and its error; None if nothing flows back.

        The flux behind the body falls to its minimum there, however noisy the velocity; it has to
        be negative by more than SURE standard errors. The line goes through the bins within a cell,
        or a quarter of the length if that is more.
        """
        flux = np.cumsum(velocity.value)
        last = int(np.argmin(flux))
        back = (np.arange(len(flux)) <= last) * 1.0
        value, error = velocity.scalar(flux[last], back)
        if not value < -SURE * error or last + 1 >= len(flux):
            return None
        place = float(self.edges[last + 1])
        near = abs(self.centres - place) <= max(1.0, 0.25 * place)
        if near.sum() < 2:
            return None
        basis = np.stack([np.ones(len(near)), self.centres - place], axis=1)
        line = fit(velocity, basis, near * 1.0)
        c0, c1 = line.value
        if not c1 > 0:
            return None
        away, error = line.scalar(-c0 / c1, np.array([-1 / c1, c0 / c1**2]))
        return place + away, error

    def expected(self) -> tuple[float, str]:
        """That of a cylinder or square in the middle of a channel 8 times as high, and why."""
        shape = recognise.in_channel(self.case)
        coefficients = setting.transport(self.case)
        if shape is None or coefficients is None:
            return np.nan, ""
        mass = setting.mass_density(self.case) * float(np.prod(self.case.box.size))
        mean = of_mean(self.whole)
        reynolds = 1.5 * float(mean.value) / mass * self.body.size / coefficients.viscosity
        note = f"{PARABOLIC}, {reynolds:.3g}"
        try:
            if shape == "square":
                return theory.square_wake_length(reynolds), note
            return theory.channel_cylinder("L_r/D", reynolds).value, note
        except ValueError:  # beyond the range of the reference
            return np.nan, f"Reynolds number {reynolds:.3g}"
