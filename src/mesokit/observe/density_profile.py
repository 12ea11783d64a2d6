"""Number of particles, or of molecules, per cell in slices across an axis."""

from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, tag
from mesokit.observe.shared.profile import Array, Compared, Profile, ProfileAccumulator
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Result
from mesokit.statistics import Blocks


class DensityInSlices(Protocol):
    """Theory of the density by a method.

    It is made of a case and the observable, and raises CaseError where there is nothing to count.
    `width` numbers are summed in each slice, the first of which is that of what is counted; `label`
    says what that is. `ids` are the particles that count, None if all do.
    """

    width: int
    label: str
    ids: NDArray[np.int64] | None

    def sums(self, profile: ProfileAccumulator, engine: RunningFluid | RunningSpheres) -> Array:
        """The numbers (width, bins) at this moment."""

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


@accumulator_of(DensityProfile)
class DensityProfileAccumulator(ProfileAccumulator):
    """Sums of each slice, per volume."""

    def prepare(self) -> None:
        super().prepare()
        self.slice_volume = self.case.box.volume / self.bins
        self.blocks = Blocks((self.theory.width, self.bins))

    def sums(self, engine: RunningFluid | RunningSpheres) -> Array:
        return np.asarray(self.theory.sums(self, engine) / self.slice_volume)

    def result(self) -> Result:
        """The profile, compared as a whole, and single numbers that tell more."""
        every = of_mean(self.blocks)
        density = Estimate(every.value[0], every.residuals[:, 0], every.weights)
        known = self.theory.compared(self, density, every.value)
        unit = self.case.box.density_unit
        return self.in_slices(density, known, unit, label=self.theory.label)
