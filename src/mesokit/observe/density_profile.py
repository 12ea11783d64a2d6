"""Number of particles, or of molecules, per cell in slices across an axis."""

from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.observe.shared.profile import Array, Compared, Profile, ProfileAccumulator
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.method import method_of
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Result


class DensityInSlices(Protocol):
    """What a method says of the density.

    It is made of a case and the observable, and raises CaseError where there is nothing to count.
    `width` numbers are summed in each slice, the first of which is that of what is counted; `label`
    says what that is. `ids` are the particles that count, None if all do.
    """

    width: int
    label: str
    ids: NDArray[np.int64] | None

    def sums(self, profile: ProfileAccumulator, engine: RunningFluid | RunningSpheres) -> Array:
        """Those numbers (width, bins) at this moment."""

    def compared(self, profile: ProfileAccumulator, density: Estimate, sums: Array) -> Compared:
        """The density (bins,) beside theory, by the means (width, bins) of sums per volume."""


@component
class DensityProfile(Profile):
    """Particles per cell in slices across an axis.

    Uniform but for a force towards a plate, for plates that keep the beads of molecules off, and
    for traps, in which solutes are spread by Boltzmann's distribution. Rules that make species
    demix leave fewer particles where they meet, of which there is no theory. Of spheres it is the
    density of centres, in gravity between plates beside that of an ideal gas at the temperature as
    measured.
    """

    quantity: Literal["density-profile"] = tag("density-profile")
    of: Literal["particles", "beads", "centres", "ends"] = param(
        "particles",
        doc='"beads": of solutes or molecules; "centres": of mass; "ends": beads with one bond',
    )
    kind: int | str | None = param(
        None,
        doc="which kind: name or number of solutes.polymers or spheres.kinds, or number of "
        "fluid.species, from 1; 'fluid': its molecules (the first kind of solutes, particles of "
        "all species and all spheres unless said)",
    )

    def theory(self, case: Case) -> DensityInSlices:
        """What the method of a case says of it. Raises CaseError without something to count."""
        found: DensityInSlices = method_of(case).expected["density-profile"](case, self)
        return found

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, and for what molecules have not."""
        super().check(case)
        self.theory(case)


@accumulator_of(DensityProfile)
class DensityProfileAccumulator(ProfileAccumulator):
    """Sums of each slice, per volume."""

    def __init__(self, observable: DensityProfile, case: Case) -> None:
        self.theory = observable.theory(case)
        super().__init__(observable, case, self.theory.width)
        self.ids = self.theory.ids
        self.unit, self.slice_volume = case.box.density_unit, case.box.volume / self.bins

    def sums(self, engine: RunningFluid | RunningSpheres) -> Array:
        """What the method counts."""
        return self.theory.sums(self, engine) / self.slice_volume

    def result(self) -> Result:
        """The profile, compared as a whole, and single numbers that tell more."""
        every = of_mean(self.blocks)
        density = Estimate(every.value[0], every.residuals[:, 0], every.weights)
        known = self.theory.compared(self, density, every.value)
        return Result(
            quantity="density-profile",
            drawing="profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=density.value,
            error=density.error,
            label=self.theory.label,
            units={"value": self.unit, self.observable.axis: "a"},
            expected=known.expected,
            theory=known.law,
            comparisons=tuple(known.comparisons),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell} | dict(known.extra),
        )
