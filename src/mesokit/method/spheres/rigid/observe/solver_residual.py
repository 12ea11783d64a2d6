"""How well the forces of rigid grains are known."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.method.spheres.common.observe.protocol import OfSpheres, Samples
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.method.spheres.rigid.engine.engine import RigidEngine

READ = ("sweeps in a step", "residual", "largest overlap over the mean diameter")
EXACT = 1e-4  # change of an impulse in a sweep to which needed sweeps are estimated


@component
class SolverResidual(OfSpheres):
    """Sweeps in a step, the residual of the last of them, and the largest overlap, in time.

    The residual is the largest change of an impulse in the last sweep of a step over the mean
    impulse. Impulses spread like heat, so that the error of a force may be larger by far, up to the
    number of sweeps that cross the packing (Unger, Brendel, Wolf and Kertész 2002). Overlaps show
    how much of it has added up.
    """

    quantity: Literal["solver-residual"] = tag("solver-residual")
    methods: ClassVar[tuple[str, ...]] = ("contact-dynamics",)
    drawing, value_label = "path", "of the solver"
    units: ClassVar[dict[str, str]] = {"value": "", "time": "tau", "of": ""}


@accumulator_of(SolverResidual)
class SolverResidualAccumulator(Samples):
    """The three numbers in time, and block averages of sweeps in a step between two samples, of the
    residual, and of whether a step had all sweeps that are allowed."""

    memory: ClassVar[tuple[str, ...]] = ("series", "samples", "blocks", "before")
    width = len(READ)

    def prepare(self) -> None:
        super().prepare()
        self.blocks, self.before = Blocks((3,)), np.full(2, np.nan)

    def observe(self, spheres: RigidEngine) -> None:
        solved, now = spheres.solved, np.zeros(2)
        diameter = float(spheres.diameters().mean())
        self.series.add(spheres.time, [solved.sweeps, solved.residual, solved.overlap / diameter])
        now[:] = spheres.step, solved.so_far
        if now[0] > self.before[0]:
            sweeps = (now[1] - self.before[1]) / (now[0] - self.before[0])
            at_most = float(solved.sweeps >= self.case.spheres.solver.sweeps)
            self.blocks.add([sweeps, solved.residual, at_most])
        self.before, self.samples = now, self.samples + 1

    def result(self) -> Result:
        """The series, with error bars where four runs or more are pooled."""
        time, rows, errors = self.series.time(), self.series.values(), self.series.error()
        return self.report(
            {"time": time, "of": list(READ)},
            (rows, errors),
            self.comparisons(rows, errors),
            samples=self.samples,
        )

    def comparisons(self, rows: Array, errors: Array) -> Iterator[Comparison]:
        """Means of sweeps and residual, and the largest overlap at the end."""
        if not len(rows):
            return
        if self.blocks.count:
            value, error = self.blocks.mean(), self.blocks.error()
            need = theory.packing_sweeps(self.case.particles, self.case.box.dimension, EXACT)
            note = f"without those of the step before, {need:.2g} settle forces to {EXACT:g}"
            yield Comparison("mean sweeps in a step", value[0], error[0], note=note)
            yield Comparison("mean residual", value[1], error[1])
            soft = "their forces are softer than rigid" if value[2] > 0 else ""
            yield Comparison("share of steps with all sweeps", value[2], error[2], note=soft)
        yield Comparison("largest overlap at the end", rows[-1, 2], errors[-1, 2])
