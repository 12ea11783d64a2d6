"""Normal modes of molecules: how large they are, and how fast each forgets itself."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import mode_times_of, modes_of, springs_of, substep_of
from mesokit.method.mpcd.expected.selection import KIND, beads_of, molecule_of
from mesokit.method.mpcd.observe.shared.decay import fit_curve, normalised
from mesokit.method.mpcd.observe.transverse_modes import FEWEST, LOWEST, decaying
from mesokit.observe.shared.short_run import ENOUGH, of_relaxations
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import noted
from mesokit.seam.observable import Observable, State, accumulator_of, pack, unpack
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import MultipleTau

SHOWN = 3  # modes whose times are compared


@component
class NormalModes(Observable):
    """Correlation in time of the normal modes X_p of molecules, the slowest first.

    Of Rouse molecules each decays as exp(-t/tau_p), with the normal-mode times tau_p; the stress
    times are half of these. Of solutes that drag the fluid along the times are Zimm's.
    X_p = sum_i v_i r_i with vectors v of unit length.
    """

    quantity: Literal["normal-modes"] = tag("normal-modes")
    needs_fluid: ClassVar[bool] = False
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
class NormalModesAccumulator:
    """One correlator for each mode, over molecules and axes."""

    def __init__(self, observable: NormalModes, case: Case) -> None:
        molecule = molecule_of(case, observable.quantity, observable.kind)
        self.observable, self.case, self.name = observable, case, observable.label
        self.beads = beads_of(case, observable.molecules, observable.kind)
        modes = modes_of(molecule)
        self.count = min(observable.modes, molecule.length - 1)
        self.vectors = modes.vectors[:, 1 : self.count + 1]
        self.eigenvalues = modes.eigenvalues[1 : self.count + 1]
        shape = (len(self.beads), case.box.dimension)
        max_lag = None if observable.max_lag is None else observable.max_lag // observable.every
        self.correlators = [MultipleTau(shape, max_lag=max_lag, pooled=2) for _ in self.eigenvalues]

    def observe(self, fluid: RunningFluid) -> None:
        r = fluid.whole_positions(self.beads.ravel()).reshape(*self.beads.shape, -1)
        for correlator, x in zip(
            self.correlators, np.einsum("mid,ip->pmd", r, self.vectors), strict=True
        ):
            correlator.add(x)

    def state(self) -> State:
        return pack(**{f"mode_{p}": c for p, c in enumerate(self.correlators)})

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        self.correlators = [
            MultipleTau.from_state(unpack(state, f"mode_{p}")) for p in range(self.count)
        ]

    def pool(self, other: NormalModesAccumulator) -> None:
        """Take in the samples of an independent run of the same case: only to read."""
        for own, others in zip(self.correlators, other.correlators, strict=True):
            own.pool(others)

    def interval(self) -> float:
        """Time between two samples."""
        return self.observable.every * self.case.fluid.timestep

    def undisturbed(self) -> bool:
        """Whether theory of a fluid at rest without walls applies."""
        return not (self.case.walls or setting.flowing(self.case))

    def result(self) -> Result:
        """The decay of each mode, its relaxation time and its mean square."""
        every = [c.correlation(normalised=True) for c in self.correlators]
        lag = every[0].lag * self.interval()
        times = self.times()[0]
        expected = None
        if times is not None:
            expected = np.exp(-lag[:, None] / times.mode[: self.count])
        return Result(
            quantity="normal-modes",
            drawing="normal modes",
            name=self.name,
            x={"time": lag, "mode": np.arange(1, self.count + 1)},
            value=np.stack([c.value for c in every], axis=1),
            error=np.stack([c.error for c in every], axis=1),
            label="normal mode correlation",
            units={"value": "", "time": "tau"},
            expected=expected,
            theory="Zimm, exp(-t/tau_p)" if self.dragging() else "Rouse, exp(-t/tau_p)",
            comparisons=tuple(self.comparisons()),
            samples=self.correlators[0].count,
        )

    def dragging(self) -> bool:
        """Whether molecules drag a fluid along that is not part of them."""
        return self.case.solutes is not None and self.case.solutes.solvent == "fluid"

    def times(self) -> tuple[theory.RouseTimes | None, str]:
        """Relaxation times of theory, and what to say of them."""
        if not self.undisturbed():
            return None, "no theory of molecules in a flow or between walls"
        if setting.magnetic(self.case):
            return None, setting.MAGNETIC
        return mode_times_of(self.case, self.observable.kind)

    def comparisons(self) -> list[Comparison]:
        """Relaxation times and mean squares of the slowest."""
        found = []
        times, note = self.times()
        kind = self.observable.kind
        spring = springs_of(self.case, kind) if self.undisturbed() else None
        for p, correlator in enumerate(self.correlators[:SHOWN]):
            measured = self.relaxation_time(correlator)
            if measured is not None:
                value, error = measured
                expected = float(times.mode[p]) if times is not None else np.nan
                what, run, short = f"normal-mode time {p + 1}", self.relaxations(correlator), ""
                if 0 < run < ENOUGH:  # the rate of an exponential memory has this error at least
                    seen = len(self.beads) * self.case.box.dimension * run
                    error = max(error, value * (2 / seen) ** 0.5)
                    runs = correlator.series
                    short = of_relaxations(run / runs, runs)
                note_of_time = noted(value, note, short)
                found.append(Comparison(what, value, error, expected, "tau", note_of_time))
        for p, correlator in enumerate(self.correlators[:SHOWN]):
            square = correlator.correlation()
            if len(square.value):
                d = self.case.box.dimension
                value, error = d * float(square.value[0]), d * float(square.error[0])
                times_of_run, short = self.relaxations(correlator), ""
                if 0 < times_of_run < ENOUGH:  # independent components tell what blocks do not
                    seen = len(self.beads) * d * (1 + times_of_run)
                    error = max(error, value * (2 / seen) ** 0.5)
                    runs = correlator.series
                    short = of_relaxations(times_of_run / runs, runs)
                found.append(
                    Comparison(
                        f"mean square of mode {p + 1}",
                        value,
                        error,
                        d * self.mean_square(spring.k * self.eigenvalues[p]) if spring else np.nan,
                        "a^2",
                        "; ".join(filter(None, ("equipartition, in sub-steps", short))),
                    )
                )
        return found

    def relaxations(self, correlator: MultipleTau) -> float:
        """How many relaxation times of a mode all runs last; 0 where it is not known."""
        measured = self.relaxation_time(correlator)
        if measured is None or not measured[0] > 0:
            return 0.0
        return correlator.count * self.interval() / measured[0]

    def mean_square(self, stiffness: float) -> float:
        """Of a mode along one axis: equipartition, and what sub-steps of velocity Verlet add."""
        swing = theory.verlet_swing(stiffness, *substep_of(self.case, self.observable.kind))
        return self.case.fluid.kT / stiffness * swing

    def relaxation_time(self, correlator: MultipleTau) -> tuple[float, float] | None:
        """From an exponential through the correlation, as far as it is above noise; its error."""
        lags, curve = normalised(correlator)
        time = lags * self.interval()
        for lowest in LOWEST:
            below = np.flatnonzero(~(curve.value > lowest))
            use = (np.arange(len(time)) < (below[0] if len(below) else len(time))) & (lags > 0)
            if use.sum() >= FEWEST:
                break
        if use.sum() < 3 or curve.value[use][-1] >= 1:
            return None
        start = [-np.log(curve.value[use][-1]) / time[use][-1], 1.0]
        fitted = fit_curve(time, curve, decaying, start, use)
        if fitted is None or not fitted.value[0] > 0:
            return None
        rate = fitted.value[0]
        return fitted.scalar(1 / rate, np.array([-1 / rate**2, 0.0]), over=(rate, np.eye(2)[0]))
