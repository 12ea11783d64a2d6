"""Force and torque of the fluid on each solid."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import free_volume, slit_of, solids_of
from mesokit.method.mpcd.expected import recognise, setting
from mesokit.method.mpcd.observe.shared.flow_memory import FlowMemory, build_up_of, flow_memory
from mesokit.method.mpcd.observe.wall_stress import PLATES, SinceLast, balance, require_counted
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import SURE, Estimate, noted, of_mean
from mesokit.seam.method import BuildUp
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined, with_error
from mesokit.statistics import Blocks, TimeSeries

FORCE, TORQUE = "m a/tau^2", "m a^2/tau^2"
NUMBERS = 2**20  # of the time series, for all bodies together
MOST_ROWS = 4096
NAMED = 8  # bodies with comparisons of their own


@component
class Forces(Observable):
    """Force and torque of the fluid on each solid: momentum and angular momentum per time.

    Torques are about the place about which the solid turns (2D: about z). With a `length` D there
    are drag and lift coefficients 2F/(rho U^2 D) (3D: 2F/(rho U^2 area)) and the Reynolds number
    U D/nu. U is `speed`, or else the superficial velocity along the flow as it is measured
    (momentum over the density and the whole box): where a force drives the fluid it is not
    known before.
    """

    quantity: Literal["forces"] = tag("forces")
    of_built_up_flow: ClassVar[bool] = True
    at_any_kT: ClassVar[tuple[str, ...]] = ("force on all solids",)
    asks_transport: ClassVar[bool] = True
    measures: ClassVar[tuple[str, ...]] = ("walls",)
    drawing = "per solid"
    value_label = "force and torque on each solid"
    length: float | None = param(
        None, doc="length D of the coefficients (none unless said)", unit="a", gt=0
    )
    speed: float | None = param(
        None, doc="speed U of the coefficients (mean of the fluid unless said)", unit="a/tau", gt=0
    )
    area: float | None = param(
        None, doc="area of the coefficients in 3D (length^2 unless said)", unit="a^2", gt=0
    )
    flow: Axis | None = param(
        None, doc="axis of the drag (that of the force on the fluid unless said)"
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without walls, or for coefficients of something else."""
        if not case.walls:
            raise CaseError("forces needs a [[wall]]")
        require_counted(case, self.quantity)
        if self.length is None:
            for key in ("speed", "area", "flow"):
                if getattr(self, key) is not None:
                    raise CaseError(f"{key}: no effect without length; give the length")
            return
        if self.area is not None and case.box.dimension == 2:
            raise CaseError("area: only in 3D; leave it out")
        if self.flow is not None:
            case.box.index(self.flow, "flow")
        elif setting.driven_axis(case) is None:
            raise CaseError("flow: missing; no force along one axis says which is that of the drag")


@accumulator_of(Forces)
class ForcesAccumulator(BlockAccumulator):
    """Mean force and torque since the sample before, and the fluid's momentum."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series", "walls")

    def prepare(self) -> None:
        case = self.case
        self.dimension = d = case.box.dimension
        slit = slit_of(case)
        self.bodies = list(PLATES) if slit else solids_of(case).names
        turns = ("tz",) if d == 2 else ("tx", "ty", "tz")
        self.components = (*(f"f{axis}" for axis in AXES[:d]), *turns)
        self.shape = len(self.bodies), len(self.components)
        size = len(self.bodies) * len(self.components)
        self.walls = SinceLast(*self.shape)
        self.blocks = Blocks((size + d,))
        self.series = TimeSeries(size, min(MOST_ROWS, 2 * max(NUMBERS // size // 2, 1)))

    def observe(self, fluid: RunningFluid) -> None:
        impulse, steps = self.walls.take(fluid)
        if steps:
            taken = impulse.ravel() / (steps * self.case.fluid.timestep)
            _, momentum, _ = fluid.totals()
            self.blocks.add(np.concatenate([taken, momentum]))
            self.series.add(fluid.time - 0.5 * steps * self.case.fluid.timestep, taken)

    def result(self) -> Result:
        expected, every = self.expected(), (self.blocks.mean(), self.errors())
        value, error = (of[: np.prod(self.shape)].reshape(self.shape) for of in every)
        plates = np.isin(range(len(self.bodies)), self.obstacles(), invert=True)
        pivots = [body.pieces[0].pivot for body in solids_of(self.case).bodies]
        units = {name: FORCE if name[0] == "f" else TORQUE for name in self.components}
        return self.report(
            {"body": self.bodies, "component": self.components},
            (value, error),
            self.comparisons(expected),
            units=units,
            expected=expected,
            theory="momentum balance",
            extra={
                "coefficient": self.coefficient(),
                "time": self.series.time(),
                "series": self.series.values().reshape(-1, *self.shape),
                "plates": plates.astype(int),
                "pivot": np.array(pivots, float),
            },
        )

    def errors(self) -> Array:
        found = of_mean(self.blocks, falling=True).error
        known = self.balanced_error()
        if len(self.bodies) == 1 and np.isfinite(known):
            found[: self.dimension] = known
        return found

    def balanced_error(self) -> float:
        """Standard error of the force on all solids together, nan where it is not known.

        They take all the momentum that the force gives the fluid but for what the fluid has gained
        from the first to the last step. That has the variance 2 N m kT whatever happens between, so
        that the error falls with the time and not with its root.
        """
        case, count = self.case, self.blocks.count
        uniform = case.fluid.force.uniform(self.dimension) is not None
        # under shear images hand on momentum, and what heats has no one kT
        if case.box.sheared or not (uniform and setting.at_kT(case) and count):
            return float("nan")
        mass = setting.mass_density(case) * free_volume(case)
        time = count * self.observable.every * case.fluid.timestep
        return float((2 * self.blocks.series * mass * case.fluid.kT) ** 0.5 / time)

    def obstacles(self) -> list[int]:
        """Numbers of the bodies that stand in the flow: all but plates."""
        solids = solids_of(self.case)
        walls = [self.case.walls[number] for number in solids.walls]
        return [i for i, wall in enumerate(walls) if not isinstance(wall, Plates)]

    def total(self) -> Array:
        """(d,): the force on the fluid, all of which the solids take in a steady flow.

        nan where there is none, such as along slip plates, which hold nothing.
        """
        case = self.case
        if case.fluid.force.uniform(self.dimension) is None:
            rest = np.zeros(self.dimension)
            rest[[case.fluid.force.drives(axis) for axis in range(self.dimension)]] = np.nan
            return rest
        mass = setting.mass_density(case) * free_volume(case)
        total: Array = setting.uniform_acceleration(case) * mass
        if all(isinstance(wall, Plates) and wall.slips for wall in case.walls):
            closed = np.isin(range(self.dimension), list(setting.closed_axes(case)))
            total[~closed & (total != 0)] = np.nan
        return total

    def expected(self) -> Array:
        """Force and torque on each solid by a balance or a theory, nan elsewhere."""
        case, d = self.case, self.dimension
        expected = np.full(self.shape, np.nan)
        wall, gap = slit_of(case), recognise.gap(case)
        if wall is not None:
            area = np.prod(case.box.size) / case.box.size[AXES.index(wall.axis)]
            expected[:, :d] = area * balance(case)
            expected[:, d:] = 0.0
        elif len(self.bodies) == 1:
            expected[0, :d] = self.total()
        elif gap is not None and not case.fluid.force.acts:
            expected[:, :] = 0.0
            torques = self.torques(gap)
            column = d if d == 2 else d + gap.axis
            expected[gap.inner_body, column], expected[gap.outer_body, column] = torques
        return expected

    def torques(self, gap: recognise.Gap) -> tuple[float, float]:
        """On the inner and the outer of two round surfaces, nan without theory."""
        coefficients = setting.transport(self.case)
        if coefficients is None:
            return np.nan, np.nan
        one_sided, radii = 0.0, (gap.inner, gap.outer)
        if "angular momentum" not in self.case.fluid.collision.conserves:
            one_sided = setting.mass_density(self.case) * coefficients.viscosity_collisional
        length = self.case.box.size[gap.axis] if self.dimension == 3 else 1.0
        rates, eta = (gap.inner_rate, gap.outer_rate), coefficients.dynamic_viscosity
        inner, outer = theory.taylor_couette_torque(*radii, *rates, eta, one_sided)
        return length * inner, length * outer

    def comparisons(self, expected: Array) -> Iterator[Comparison]:
        mean, total = of_mean(self.blocks, falling=True), self.total()
        force = np.arange(np.prod(self.shape)).reshape(self.shape)  # places of the components
        few = len(self.bodies) <= NAMED
        for axis in map(int, np.flatnonzero(setting.uniform_acceleration(self.case))):
            every = np.zeros(mean.value.shape)
            every[force[:, axis]] = 1.0
            value, error = mean.total(every)
            known, short = self.balanced_error(), self.flow_memory(axis).note
            note = "the force on the fluid; steady flow"
            if np.isnan(total[axis]):
                note = "nothing holds the fluid"
            elif np.isfinite(known):  # however short the run
                error = known
            else:
                note = joined(note, short)
            what = f"force on all solids along {AXES[axis]}"
            yield Comparison(what, value, error, total[axis], FORCE, note)
            if few and len(self.bodies) > 1 and np.isfinite(total[axis]):
                yield from self.shares(mean, force[:, axis], axis, expected, short)
        for body, column in np.argwhere(expected[:, self.dimension :] != 0) if few else ():
            place = body, self.dimension + column
            if np.isfinite(expected[place]):
                one = np.zeros(mean.value.shape)
                one[force[place]] = 1.0
                note = setting.caveat(self.case) or self.note_on_torque(int(body))
                what = f"torque on {self.bodies[body]}"
                yield Comparison(what, *mean.total(one), expected[place], TORQUE, note)
        if self.observable.length is not None:
            yield from self.coefficients(mean, force, few)

    def shares(
        self, mean: Estimate, places: NDArray[np.intp], axis: int, expected: Array, short: str
    ) -> Iterator[Comparison]:
        """Part of the force on the fluid that each solid takes; `short`: the caveat of the run."""
        total = self.total()[axis]
        note = joined("of the force on the fluid", short)
        for body, place in enumerate(places):
            gradient = np.zeros(mean.value.shape)
            gradient[place] = 100.0 / total
            what = f"share of {self.bodies[body]} along {AXES[axis]}"
            known = 100.0 * float(expected[body, axis] / total)
            yield Comparison(what, *mean.total(gradient), known, "%", note)

    def coefficient(self) -> float:
        """Coefficient over force along the flow, nan without a length."""
        if self.observable.length is None or not self.blocks.count:
            return np.nan
        if self.observable.speed is not None:
            return self.scale(self.observable.speed)
        speed, spread, _ = self.speed()
        return self.scale(speed) if abs(speed) > SURE * spread else np.nan

    def note_on_torque(self, body: int) -> str:
        """Note on how well cells resolve a round surface: the inner one takes too little.

        Measured: 31 % less at a radius of 1, 15 % at 2; the outer one within 3 %.
        """
        gap = recognise.gap(self.case)
        if gap is None or body != gap.inner_body:
            return "Taylor-Couette"
        return f"approximate: Taylor-Couette; cells at this radius take {30 / gap.inner:.2g} % off"

    def along(self) -> int:
        given = self.observable.flow
        flow = setting.driven_axis(self.case) if given is None else AXES.index(given)
        assert flow is not None  # as `check` has seen
        return flow

    def scale(self, speed: float) -> float:
        """Coefficient over force at a speed."""
        given, rho = self.observable, setting.mass_density(self.case)
        assert given.length is not None
        area = given.length if self.dimension == 2 else given.area or given.length**2
        return float(2.0 / (rho * speed**2 * area) * np.sign(speed))

    def speed(self) -> tuple[float, float, str]:
        """Mean superficial velocity along the flow, its standard error and its caveat.

        The error is that of blocks of time, whatever the momentum of all solids together does.
        """
        slope, rho = np.zeros(self.blocks.shape), setting.mass_density(self.case)
        slope[np.prod(self.shape) + self.along()] = 1.0 / (rho * np.prod(self.case.box.size))
        value, error = of_mean(self.blocks).total(slope)
        memory = self.flow_memory(self.along())
        return value, max(error, memory.least * float(slope.max())), memory.note

    def flow_memory(self, axis: int) -> FlowMemory:
        momentum = float(self.blocks.mean()[int(np.prod(self.shape)) + axis])
        return flow_memory(self.case, axis, momentum, self.blocks, self.observable.every)

    def build_up(self) -> BuildUp | None:
        axis = setting.driven_axis(self.case)
        return None if axis is None else build_up_of(self.flow_memory(axis), self.case)

    def coefficients(
        self, mean: Estimate, force: NDArray[np.intp], few: bool
    ) -> Iterator[Comparison]:
        """Reynolds number, drag and lift, with the error of the speed where that is measured."""
        given, flow = self.observable, self.along()
        assert given.length is not None
        speed, spread, short = self.speed()
        note = f"U = {with_error(abs(speed), spread)} a/tau, the mean superficial velocity"
        if given.speed is not None:
            speed, spread, note = given.speed, 0.0, f"U = {given.speed:g} a/tau"
        note = joined(note, short)
        if speed == 0:
            return
        transport = setting.transport(self.case)
        if transport is not None:
            inverse = given.length / transport.viscosity
            yield Comparison("Reynolds number", abs(speed) * inverse, spread * inverse, note=note)
        scale, part = self.scale(speed), spread / abs(speed)
        for body in self.obstacles() if few else ():
            for axis in (flow, *(k for k in range(self.dimension) if k != flow)):
                one: Array = np.zeros(mean.value.shape)
                one[force[body, axis]] = scale
                value, error = mean.total(one)
                error = float(np.hypot(error, 2 * part * value))  # the coefficient goes as 1/U^2
                if part > 1 / SURE:  # U may be zero
                    value = error = np.nan
                kind = "drag coefficient" if axis == flow else "lift coefficient"
                where = f" along {AXES[axis]}" if self.dimension == 3 and axis != flow else ""
                what = f"{kind} of {self.bodies[body]}{where}"
                yield Comparison(what, value, error, note=noted(value, note))
