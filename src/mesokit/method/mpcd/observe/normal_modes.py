"""Normal modes of molecules: their size, and the time in which each decays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import mode_times_of, modes_of, springs_of, substep_of
from mesokit.method.mpcd.expected.selection import KIND, beads_of, molecule_of
from mesokit.method.mpcd.observe.shared.decay import fit_decay, normalised
from mesokit.observe.shared.short_run import ENOUGH, of_relaxations
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import noted
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Comparison, Result, joined
from mesokit.statistics import MultipleTau

SHOWN = 3  # modes whose times are compared
SQUARE = "equipartition, in sub-steps"


@component
class NormalModes(Observable):
    """Correlation in time of the normal modes X_p of molecules, the slowest first.

    Of Rouse molecules each decays as exp(-t/tau_p), with the normal-mode times tau_p; the stress
    times are half of these. Of solutes that drag the fluid along the times are Zimm's.
    X_p = sum_i v_i r_i with vectors v of unit length.
    """

    quantity: Literal["normal-modes"] = tag("normal-modes")
    needs_fluid: ClassVar[bool] = False
    drawing = "normal modes"
    value_label = "normal mode correlation"
    units: ClassVar[dict[str, str]] = {"time": "tau"}
    modes: int = param(5, doc="modes followed, from the slowest", ge=1)
    molecules: int = param(500, doc="molecules followed", ge=1)
    kind: int | str = param(1, doc=KIND)
    max_lag: int | None = param(
        None, doc="longest lag (as the run allows unless said)", unit="steps", ge=1
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules."""
        molecule_of(case, self.quantity, self.kind)


@accumulator_of(NormalModes)
class NormalModesAccumulator(BlockAccumulator):
    """One correlator for each mode, over molecules and axes."""

    memory: ClassVar[tuple[str, ...]] = ("correlators",)

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        molecule = molecule_of(case, observable.quantity, observable.kind)
        self.beads = beads_of(case, observable.molecules, observable.kind)
        modes = modes_of(molecule)
        self.count = min(observable.modes, molecule.length - 1)
        self.vectors = modes.vectors[:, 1 : self.count + 1]
        self.eigenvalues = modes.eigenvalues[1 : self.count + 1]
        shape = (len(self.beads), case.box.dimension)
        max_lag = None if observable.max_lag is None else observable.max_lag // observable.every
        self.correlators = {
            f"mode_{p}": MultipleTau(shape, max_lag=max_lag, pooled=2) for p in range(self.count)
        }

    def observe(self, fluid: RunningFluid) -> None:
        r = fluid.whole_positions(self.beads.ravel()).reshape(*self.beads.shape, -1)
        modes = np.einsum("mid,ip->pmd", r, self.vectors)
        for correlator, x in zip(self.correlators.values(), modes, strict=True):
            correlator.add(x)

    def interval(self) -> float:
        return self.observable.every * self.case.fluid.timestep

    def undisturbed(self) -> bool:
        return not (self.case.walls or self.case.bodies or setting.flowing(self.case))

    def result(self) -> Result:
        every = [c.correlation(normalised=True) for c in self.correlators.values()]
        lag, times = every[0].lag * self.interval(), self.times()[0]
        # molecules that drag a fluid along that is not part of them
        dragging = self.case.solutes is not None and self.case.solutes.solvent == "fluid"
        return self.report(
            {"time": lag, "mode": np.arange(1, self.count + 1)},
            every,
            self.comparisons(),
            expected=None if times is None else np.exp(-lag[:, None] / times.mode[: self.count]),
            theory=f"{'Zimm' if dragging else 'Rouse'}, exp(-t/tau_p)",
            samples=self.correlators["mode_0"].count,
        )

    def times(self) -> tuple[theory.RouseTimes | None, str]:
        """Relaxation times of theory, and what to say of them."""
        if not self.undisturbed():
            return None, "no theory of molecules in a flow or between walls"
        if setting.magnetic(self.case):
            return None, setting.MAGNETIC
        return mode_times_of(self.case, self.observable.kind)

    def comparisons(self) -> Iterator[Comparison]:
        (times, note), kind = self.times(), self.observable.kind
        spring = springs_of(self.case, kind) if self.undisturbed() else None
        d, slowest = self.case.box.dimension, list(self.correlators.values())[:SHOWN]
        for p, correlator in enumerate(slowest):
            measured = self.relaxation_time(correlator)
            if measured is not None:
                value, error = measured
                expected = float(times.mode[p]) if times is not None else np.nan
                least, short = self.short_run(correlator, 0)
                error, note_of_time = max(error, value * least), noted(value, note, short)
                yield Comparison(
                    f"normal-mode time {p + 1}", value, error, expected, "tau", note_of_time
                )
        for p, correlator in enumerate(slowest):
            square = correlator.correlation()
            if len(square.value):
                value, error = d * float(square.value[0]), d * float(square.error[0])
                least, short = self.short_run(correlator, 1)
                error, note_of_square = max(error, value * least), joined(SQUARE, short)
                known = np.nan
                if spring:  # equipartition, and what sub-steps of velocity Verlet add
                    stiffness = spring.k * self.eigenvalues[p]
                    swing = theory.verlet_swing(stiffness, *substep_of(self.case, kind))
                    known = d * (self.case.fluid.kT / stiffness * swing)
                yield Comparison(
                    f"mean square of mode {p + 1}", value, error, known, "a^2", note_of_square
                )

    def short_run(self, correlator: MultipleTau, more: int) -> tuple[float, str]:
        """Least relative error of a mode in a run of few of its relaxation times, and a caveat; 0
        in a long run, or where the time is not known.

        Independent components tell what blocks do not: an exponential memory leaves so many
        independent values of each as the run has relaxation times, of a mean `more` than that.
        """
        measured = self.relaxation_time(correlator)
        if measured is None or not measured[0] > 0:
            return 0.0, ""
        run, runs = correlator.count * self.interval() / measured[0], correlator.series
        if not 0 < run < ENOUGH:
            return 0.0, ""
        seen = len(self.beads) * self.case.box.dimension * (more + run)
        return (2 / seen) ** 0.5, of_relaxations(run / runs, runs)

    def relaxation_time(self, correlator: MultipleTau) -> tuple[float, float] | None:
        """From an exponential through the correlation, as far as it is above noise; its error."""
        lags, curve = normalised(correlator)
        fitted = fit_decay(lags * self.interval(), curve, lags > 0, below=1.0)
        if fitted is None or not fitted.value[0] > 0:
            return None
        rate = fitted.value[0]
        return fitted.scalar(1 / rate, np.array([-1 / rate**2, 0.0]), over=(rate, np.eye(2)[0]))
