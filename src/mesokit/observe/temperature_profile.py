"""Temperature in slices across an axis, about the mean flow."""

from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.observe.shared.profile import KIND, Array, Compared, Profile, ProfileAccumulator
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.estimate import Estimate, of_ratio
from mesokit.seam.method import method_of
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Result
from mesokit.statistics import Blocks


class TemperatureInSlices(Protocol):
    """What a method says of the temperature.

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
    kind: int | str | None = param(None, doc=KIND)

    def theory(self, case: Case) -> TemperatureInSlices:
        """What the method of a case says of it. Raises CaseError for a kind that there is not."""
        found: TemperatureInSlices = method_of(case).expected["temperature-profile"](case, self)
        return found

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, and a kind that there is not."""
        super(TemperatureProfile, self).check(case)  # noqa: UP008  # the decorator makes a new class
        self.theory(case)


@accumulator_of(TemperatureProfile)
class TemperatureProfileAccumulator(ProfileAccumulator):
    """Number, mass, sum of m v^2 and momentum, (3 + d, bins, bins across the flow).

    There is one bin across the flow if nothing flows, or if it varies across the profile's axis.
    """

    def __init__(self, observable: TemperatureProfile, case: Case) -> None:
        width, self.dimension = 3 + case.box.dimension, case.box.dimension
        super().__init__(observable, case, width)
        self.theory = observable.theory(case)
        self.ids, self.across = self.theory.ids, self.theory.across
        if self.across is not None:
            self.axes += (self.across,)
            self.counts += (max(1, round(case.box.size[self.across] * observable.bins_per_cell)),)
        self.blocks = Blocks((width, *self.counts))

    def sums(self, engine: RunningFluid | RunningSpheres) -> Array:
        """Number, mass, sum of m v^2 and momentum."""
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
        return Result(
            quantity="temperature-profile",
            drawing="profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=np.where(few, np.nan, temperature.value),
            error=np.where(few, np.nan, temperature.error),
            label="temperature k_B T",
            units={"value": "m a^2/tau^2", self.observable.axis: "a"},
            expected=known.expected,
            theory=known.law,
            comparisons=tuple(known.comparisons),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )
