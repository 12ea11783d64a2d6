"""Storage and loss modulus at the frequency of an oscillating shear."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, option, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import rouse_note, rouse_times_of, without_bonds
from mesokit.method.mpcd.observe.stress import PARTS, ROUSE, UNIT
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

LEAST_SAMPLES = 8  # in a period
KINETIC_OFF = 0.3  # part of the kinetic stress that molecular chaos misses where flights are short
MODULI = {"G'": "storage", "G''": "loss"}


@component
class DynamicModuli(Observable):
    """Shear stress over an oscillating strain: the part in phase with it, and with its rate.

    sigma_xy = strain_0 (G' sin wt + G'' cos wt) for the strain strain_0 sin wt that the box's
    shear_rate and shear_frequency, or its oscillating shear, give; fitted to every whole period of
    the run.
    """

    quantity: Literal["dynamic-moduli"] = tag("dynamic-moduli")
    measures: ClassVar[tuple[str, ...]] = ("stress",)
    drawing = "moduli"
    value_label = "modulus"
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)

    def check(self, case: Case) -> None:
        """Raise CaseError without an oscillating shear, or with too few samples in its period."""
        oscillation = case.box.oscillation
        if oscillation is None:
            raise CaseError("dynamic-moduli needs box.shear_rate and box.shear_frequency")
        if case.walls:
            raise CaseError("stress is measured without walls")
        samples = 2 * math.pi / (oscillation.frequency * case.fluid.timestep * self.every)
        if samples < LEAST_SAMPLES:
            raise CaseError(
                f"every = {self.every}: {samples:.2g} samples in a period; expected at least "
                f"{LEAST_SAMPLES}"
            )


@accumulator_of(DynamicModuli)
class DynamicModuliAccumulator(BlockAccumulator):
    """Moduli of every period (parts, 2), and the sums of the period that is under way."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "squares", "products", "began", "samples")
    added: ClassVar[tuple[str, ...]] = ("samples",)

    def prepare(self) -> None:
        case = self.case
        oscillation = case.box.oscillation
        assert oscillation is not None
        self.amplitude, self.frequency = oscillation.rate, oscillation.frequency
        bonded = case.fluid.molecule is not None or case.solutes is not None
        self.parts = PARTS[: 3 if bonded else 2]
        self.blocks = Blocks((len(self.parts) + 1, 2))
        self.squares, self.products = np.zeros((3, 3)), np.zeros((3, len(self.parts) + 1))
        self.began = np.full(1, np.nan)  # time of the first sample of this period
        self.samples = np.zeros(1, np.int64)

    def observe(self, fluid: RunningFluid) -> None:
        time = fluid.time
        if np.isnan(self.began[0]):
            self.began[0] = time
        # a rounded time must not put the first sample of a period into the one before
        elif self.frequency * (time - self.began[0]) > 2 * math.pi * (1 - 1e-9):
            self.close()
            self.began[0] += 2 * math.pi / self.frequency
        self.samples += 1
        # the stress is the mean over the step, whose images moved as in its middle
        phase = self.frequency * (time - 0.5 * self.case.fluid.timestep)
        basis = np.array([math.sin(phase), math.cos(phase), 1.0])
        parts = [fluid.stress[part][0, 1] for part in self.parts]
        self.squares += np.outer(basis, basis)
        self.products += np.outer(basis, [*parts, sum(parts)])

    def close(self) -> None:
        """Fit the period, and begin the next."""
        fitted = np.linalg.solve(self.squares, self.products)
        self.blocks.add(fitted[:2].T * self.frequency / self.amplitude)
        self.squares[:], self.products[:] = 0.0, 0.0

    def result(self) -> Result:
        newtonian = self.case.fluid.molecule is None
        return self.report(
            {"part": [*self.parts, "total"], "modulus": list(MODULI)},
            self.blocks,
            self.comparisons(),
            units={"value": UNIT[self.case.box.dimension]},
            expected=self.expected(),
            theory="Newtonian fluid, molecular chaos" if newtonian else ROUSE,
            samples=int(self.samples[0]),
            extra={"frequency": self.frequency},
        )

    def expected(self) -> Array:
        """eta w for the loss modulus, with the memory of flights; and what springs add to that."""
        expected, case = np.zeros((len(self.parts) + 1, 2)), self.case
        expected[:, 1] = np.nan
        c, w = setting.transport(case), self.frequency
        if case.fluid.molecule is not None:
            expected[:, 0] = np.nan
            c = without_bonds(case)
            times = None if c is None else rouse_times_of(case)
            if c is not None and times is not None:
                modulus = case.fluid.density / case.fluid.molecule.length * case.fluid.kT
                eta = c.viscosity * setting.mass_density(case)
                expected[2:, 0] = theory.storage_modulus(w, modulus, times.stress)
                expected[2, 1] = theory.loss_modulus(w, modulus, times.stress)
                expected[3, 1] = theory.loss_modulus(w, modulus, times.stress, eta)
        elif case.solutes is not None:
            expected[:, 0] = np.nan
        elif c is not None:
            rho, n_kT = setting.mass_density(case), case.fluid.density * case.fluid.kT
            if c.viscosity_kinetic > 0:
                eta = c.viscosity_kinetic * rho
                expected[0] = theory.flight_moduli(w, case.fluid.timestep, eta, n_kT)
            expected[1, 1] = c.viscosity_collisional * rho * w
            expected[2] = expected[0] + expected[1]
        return expected

    def comparisons(self) -> Iterator[Comparison]:
        if not self.blocks.count:
            return
        mean, error, expected = self.blocks.mean()[-1], self.blocks.error()[-1], self.expected()[-1]
        unit, notes = UNIT[self.case.box.dimension], [self.note(k) for k in range(len(MODULI))]
        for k, name in enumerate(MODULI.values()):
            yield Comparison(f"{name} modulus", mean[k], error[k], expected[k], unit, notes[k])
        if self.case.fluid.molecule is None:
            scale = setting.mass_density(self.case) * self.frequency
            eta, spread, known = mean[1] / scale, error[1] / scale, expected[1] / scale
            what = "viscosity from the loss modulus"
            yield Comparison(what, eta, spread, known, "a^2/tau", notes[1])

    def note(self, k: int) -> str:
        """Reason for which theory of a modulus is off by more than its error, "" if it is not."""
        if self.case.fluid.molecule is not None:
            return rouse_note(self.case)
        if setting.caveat(self.case):
            return setting.caveat(self.case)
        kinetic, _, total = np.abs(self.expected()[[0, 1, -1], k])
        short = setting.mean_free_path(self.case) < 1
        off = KINETIC_OFF * kinetic * short + setting.loop(self.case) * total * (k == 1)
        if not off > self.blocks.error()[-1, k]:
            return ""
        return "approximate: molecular chaos"
