"""Volume flux through the box, and the permeability that it means."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import recognise, setting
from mesokit.method.mpcd.observe.shared.flow_memory import FlowMemory, build_up_of, flow_memory
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import of_mean
from mesokit.seam.method import BuildUp
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Comparison, Result, joined
from mesokit.statistics import Blocks, TimeSeries

FLUX = {2: "a^2/tau", 3: "a^3/tau"}  # by dimension


@component
class FlowRate(Observable):
    """Mean velocity along an axis over the whole box, solids included, and the flow rate.

    The superficial velocity U is the momentum of the fluid over its density and the volume of the
    box; the flow rate is U times the cross-section of the box. Where a uniform force drives the
    fluid along that axis, the permeability is nu U/g with the theoretical viscosity.
    """

    quantity: Literal["flow-rate"] = tag("flow-rate")
    asks_transport: ClassVar[bool] = True
    of_built_up_flow: ClassVar[bool] = True
    drawing = "flow series"
    units: ClassVar[dict[str, str]] = {"value": "a/tau", "time": "tau"}
    axis: Axis | None = param(None, doc="axis of the flow (that of the force unless said)")

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not."""
        if self.axis is not None:
            case.box.index(self.axis)

    def seen(self, case: Case) -> int:
        """Number of the axis in this case."""
        if self.axis is not None:
            return AXES.index(self.axis)
        driven = setting.driven_axis(case)
        if driven is not None:
            return driven
        flowing = setting.flowing_axes(case)
        return AXES.index(flowing[0]) if len(flowing) == 1 else 0


@accumulator_of(FlowRate)
class FlowRateAccumulator(BlockAccumulator):
    """The superficial velocity: its average, and a time series that shows whether it is steady."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series")

    def prepare(self) -> None:
        self.axis = self.observable.seen(self.case)
        self.mass = setting.superficial_mass(self.case)
        self.blocks, self.series = Blocks(), TimeSeries(1)

    def observe(self, fluid: RunningFluid) -> None:
        velocity = fluid.totals()[1][self.axis] / self.mass
        self.blocks.add(velocity)
        self.series.add(fluid.time, [velocity])

    def result(self) -> Result:
        value = self.series.values()[:, 0]
        known, theory_name = self.expected()
        return self.report(
            {"time": self.series.time()},
            value,
            self.comparisons(known, theory_name),
            label=f"mean velocity along {AXES[self.axis]}",
            expected=None if np.isnan(known) else np.full(value.shape, known),
            theory=theory_name,
            extra={
                "mean": float(self.blocks.mean()),
                "mean_error": self.error(),
                "axis": AXES[self.axis],
            },
        )

    def flow_memory(self) -> FlowMemory:
        momentum = float(self.blocks.mean()) * self.mass
        return flow_memory(self.case, self.axis, momentum, self.blocks, self.observable.every)

    def build_up(self) -> BuildUp | None:
        return build_up_of(self.flow_memory(), self.case)

    def error(self) -> float:
        return max(float(self.blocks.error()), self.flow_memory().least / self.mass)

    def comparisons(self, known: float, name: str) -> Iterator[Comparison]:
        speed, error, case = float(of_mean(self.blocks).value), self.error(), self.case
        along, short = f"along {AXES[self.axis]}", self.flow_memory().note
        size = np.array(case.box.size, float)
        area = float(np.prod(size) / size[self.axis])
        off = setting.caveat(case) or (setting.rarefied(case) if name else "")
        note = joined(off or name, short)
        yield Comparison(f"mean velocity {along}", speed, error, known, "a/tau", note)
        flux = area * speed, area * error, area * known
        yield Comparison(f"flow rate {along}", *flux, FLUX[len(size)], note)
        coefficients = setting.transport(case)
        if setting.driven_axis(case) == self.axis and coefficients is not None:
            g = float(setting.uniform_acceleration(case)[self.axis])
            scale = coefficients.viscosity / g
            found = scale * speed, abs(scale) * error, scale * known
            note = joined(name, "theoretical viscosity", short)
            yield Comparison(f"permeability {along}", *found, "a^2", note)

    def expected(self) -> tuple[float, str]:
        """The superficial velocity and what says so; nan where nothing is known."""
        case, coefficients = self.case, setting.transport(self.case)
        acceleration = float(setting.uniform_acceleration(case)[self.axis])
        if not setting.obstructed(case):
            flow = setting.flow(case, self.axis)
            edges = np.linspace(0.0, case.box.size[flow.across], 65)
            bins = flow.bins(flow.across, edges)
            return (np.nan, "") if bins is None else (float(bins.mean()), flow.kind)
        if not setting.driven(case):
            return 0.0, "rest"
        if coefficients is None or not acceleration or setting.driven_axis(case) != self.axis:
            return np.nan, ""
        viscosity = coefficients.viscosity
        pipe, lattice = recognise.pipe(case), recognise.lattice(case)
        if pipe is not None and pipe.axis == self.axis:
            rate = theory.hagen_poiseuille_flow_rate(pipe.radius, acceleration, viscosity)
            area = np.prod(case.box.size) / case.box.size[self.axis]
            return float(rate / area), "hagen-poiseuille"
        if lattice is None or self.axis not in lattice.across:
            return np.nan, ""
        law, permeability = "cubic array, slow flow", theory.cubic_array_permeability
        if len(lattice.across) == 2:
            law, permeability = "square array, slow flow", theory.square_array_permeability
        try:
            k = permeability(lattice.concentration, lattice.pitch)
            return k * acceleration / viscosity, law
        except ValueError:  # denser than the theory goes
            return np.nan, ""
