"""Temperature in slices across an axis, about the mean flow."""

from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, tag
from mesokit.observe.shared.profile import KIND, Array, Compared, Profile, ProfileAccumulator
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.estimate import Estimate, of_ratio
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Result
from mesokit.statistics import Blocks


class TemperatureInSlices(Protocol):
    """Theory of the temperature by a method.

    It is made of a case and the observable, and raises CaseError for a kind that there is not.
    `ids` are the particles that count, None if all do; `across` is another axis across which the
    flow varies, None without one; `rests` is true if the mean velocity is known to be 0; slices
    with fewer sightings than `fewest` have no temperature.
    """

    ids: NDArray[np.int64] | None
    across: int | None
    rests: bool
    fewest: int

    def compared(
        self, profile: ProfileAccumulator, temperature: Estimate, mean: Estimate, number: Array
    ) -> Compared:
        """The temperature (bins,) and its mean over all, by the number (bins,) of sightings."""


@component
class TemperatureProfile(Profile):
    """Temperature in slices across an axis: kinetic energy about the mean flow.

    The flow is the mean over the whole run, not that of the few particles in a slice at one
    moment, so that the slices may be as fine as one likes; it must be steady. A flow that varies
    across another axis is resolved in slices across that axis, too. Spheres in equilibrium are as
    warm everywhere.
    """

    quantity: Literal["temperature-profile"] = tag("temperature-profile")
    at_any_kT: ClassVar[tuple[str, ...]] = ("",)
    value_label = "temperature k_B T"
    kind: int | str | None = param(None, doc=KIND)


@accumulator_of(TemperatureProfile)
class TemperatureProfileAccumulator(ProfileAccumulator):
    """Number, mass, sum of m v^2 and momentum, (3 + d, bins, bins across the flow).

    There is one bin across the flow if nothing flows, or if it varies across the profile's axis.
    """

    def prepare(self) -> None:
        super().prepare()
        self.dimension, self.across = self.case.box.dimension, self.theory.across
        if self.across is not None:
            length = self.case.box.size[self.across]
            self.axes += (self.across,)
            self.counts += (max(1, round(length * self.observable.bins_per_cell)),)
        self.blocks = Blocks((3 + self.dimension, *self.counts))

    def sums(self, engine: RunningFluid | RunningSpheres) -> Array:
        number, mass, momentum, energy = self.moments(engine)
        return np.concatenate([[number, mass, energy], momentum])

    def about_flow(self) -> tuple[Array, Array, NDArray[np.int64]]:
        """Sum of m (v - u)^2 and number (blocks, bins), samples (blocks,)."""
        sums, samples = self.blocks.sums()
        sums = sums.reshape(len(sums), 3 + self.dimension, self.bins, *(self.counts[1:] or (1,)))
        number, mass, energy, momentum = sums[:, 0], sums[:, 1], sums[:, 2], sums[:, 3:]
        # u is the same in all slices along which the flow does not vary
        alike = (0,) if self.across is None else (0, 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = np.stack([momentum[:, i].sum(alike) for i in range(self.dimension)])
            u = np.nan_to_num(u / mass.sum(alike)).reshape(self.dimension, 1, -1, number.shape[2])
        if self.theory.rests:
            u = np.zeros_like(u)
        moving = energy.copy()
        for i in range(self.dimension):
            moving += u[i] * (u[i] * mass - 2 * momentum[:, i])
        return moving.sum(axis=2), number.sum(axis=2), samples

    def result(self) -> Result:
        """T = <m (v - u)^2>/(d <N>), first order exact in u = <P>/<M>."""
        peculiar, number, samples = self.about_flow()
        temperature = of_ratio(peculiar, self.dimension * number)
        everywhere = of_ratio(peculiar.sum(axis=1), self.dimension * number.sum(axis=1))
        each, sightings = temperature._replace(weights=samples.astype(float)), number.sum(axis=0)
        known = self.theory.compared(self, each, everywhere, sightings)
        few = sightings < self.theory.fewest
        value, error = (np.where(few, np.nan, a) for a in (temperature.value, temperature.error))
        return self.in_slices((value, error), known, "m a^2/tau^2")
