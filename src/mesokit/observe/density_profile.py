"""Number of particles, or of molecules, per cell in slices across an axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from mesokit import theory
from mesokit.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.observe import setting
from mesokit.observe.estimate import Estimate, of_mean
from mesokit.observe.molecules import KIND, beads_of, molecule_of, spring_of
from mesokit.observe.profile import Array, Profile, ProfileAccumulator
from mesokit.observe.protocol import RunningFluid
from mesokit.observe.result import Comparison, Result

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.mpcd.molecule import Molecule

LABELS = {
    "particles": "density",
    "centres": "density of centres of mass",
    "ends": "density of end beads",
}


@component
class DensityProfile(Profile):
    """Particles per cell in slices across an axis.

    Uniform but for a force towards a plate, and for plates that keep the beads of molecules off.
    """

    quantity: Literal["density-profile"] = tag("density-profile")
    of: Literal["particles", "centres", "ends"] = param(
        "particles", doc='"centres": centres of mass of molecules; "ends": beads with one bond'
    )
    kind: int = param(1, doc=KIND, ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, and for what molecules have not."""
        super().check(case)
        if self.of == "particles":
            return
        molecule = molecule_of(case, f"of = '{self.of}'", self.kind)
        if self.of == "ends" and molecule.topology == "ring":
            raise CaseError("of = 'ends': rings have none")
        if self.of == "centres" and self.axis == "x" and case.box.shear_rate:
            raise CaseError(
                "of = 'centres': not along 'x' under box.shear_rate, whose images slide"
            )

    def accumulator(self, case: Case) -> DensityProfileAccumulator:
        """An empty memory for it."""
        return DensityProfileAccumulator(self, case)


class DensityProfileAccumulator(ProfileAccumulator):
    """Density of each slice."""

    def __init__(self, observable: DensityProfile, case: Case) -> None:
        super().__init__(observable, case, width=1)
        size = case.box.size
        self.slice_volume = np.prod(size) / self.bins
        self.of = observable.of
        self.molecule = case.fluid.molecule
        if self.of != "particles":
            self.molecule = molecule = molecule_of(case, kind=observable.kind)
            beads = beads_of(case, kind=observable.kind)
            self.beads = beads[:, np.array(_ends(molecule))] if self.of == "ends" else beads

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        if self.of == "particles":
            super().observe(fluid)
            return
        y = fluid.positions(self.beads.ravel(), unwrapped=self.of == "centres")[:, self.axis]
        if self.of == "centres":
            y = y.reshape(self.beads.shape).mean(axis=1)
            if self.periodic:
                y = y % self.edges[-1]
        number, _ = np.histogram(y, self.edges)
        self.blocks.add(number[None] / self.slice_volume)

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Particles per volume."""
        return number[None] / self.slice_volume

    def result(self) -> Result:
        """The profile, compared as a whole and next to each plate."""
        every = of_mean(self.blocks)
        density = Estimate(every.value[0], every.residuals[:, 0], every.weights)
        expected = self.expected()
        found: list[Comparison] = []
        if expected is not None and self.blocks.count:
            found = self.chi_square(density, expected, "against theory")
            if not self.periodic:
                cell = self.observable.bins_per_cell
                for name, part in (("lower", slice(0, cell)), ("upper", slice(-cell, None))):
                    mean = np.zeros(self.bins)
                    mean[part] = 1 / cell
                    value, error = density.scalar(mean @ density.value, mean)
                    where = f"density in the cell at the {name} plate"
                    found.append(Comparison(where, value, error, float(mean @ expected), "1/cell"))
        return Result(
            quantity="density-profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=density.value,
            error=density.error,
            label=LABELS[self.of],
            units={"value": "1/cell", self.observable.axis: "a"},
            expected=expected,
            theory=self.legend(),
            comparisons=tuple(found),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )

    def legend(self) -> str:
        """What the theory is called in a figure."""
        walls = self.molecule is not None and not self.periodic
        return "ideal molecules between walls" if walls else "ideal gas"

    def expected(self) -> Array | None:
        """Uniform where nothing is in the way; else that of a gas or of ideal molecules."""
        case, density = self.case, self.case.fluid.density
        if setting.obstructed(case):
            return None
        weight = 0.0 if self.periodic else float(setting.acceleration(case)[self.axis])
        decay = case.fluid.mass * weight / case.fluid.kT
        if self.molecule is not None:
            return self.expected_of_molecules(self.molecule, decay)
        if decay == 0:
            return np.full(self.bins, density)
        if len({kind.mass for kind in case.fluid.species}) > 1:
            return None
        height = self.edges[-1]
        scale = density * height * decay / np.expm1(decay * height)
        return scale * setting.bin_average(lambda y: np.exp(decay * y), self.edges)

    def expected_of_molecules(self, molecule: Molecule, decay: float) -> Array | None:
        """Of ideal molecules; None for other bonds, and where the sums would take too long."""
        ends, spring, solutes = _ends(molecule), spring_of(molecule), self.case.solutes
        share = {"particles": molecule.length, "centres": 1, "ends": len(ends)}[self.of]
        mean = self.case.fluid.density * share / molecule.length
        if solutes is not None:
            mean = share * len(self.beads) / self.case.box.volume
            if solutes.pair is not None or solutes.wall is not None or decay:
                return None
        if self.periodic:
            return np.full(self.bins, mean)
        if spring is None:
            return None
        spread = (self.case.fluid.kT / spring.k) ** 0.5
        given = self.edges, molecule.bonds, spread, decay
        try:
            if self.of == "centres":
                return mean * theory.centre_in_slit(*given)
            beads = theory.beads_in_slit(*given)
        except ValueError:  # a ring's centre, or a grid too fine
            return None
        return mean * (beads[ends] if self.of == "ends" else beads).mean(axis=0)


def _ends(molecule: Molecule) -> list[int]:
    """Beads of a molecule that have one bond."""
    return np.flatnonzero(np.bincount(np.ravel(molecule.bonds)) == 1).tolist()
