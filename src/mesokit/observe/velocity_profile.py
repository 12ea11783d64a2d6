"""Mean velocity in slices across an axis, and the viscosity that its shape gives."""

from collections.abc import Iterator
from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.observe.shared.profile import KIND, Array, Compared, Profile, ProfileAccumulator
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.estimate import Estimate, of_ratio
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Result
from mesokit.statistics import Blocks


class FlowInSlices(Protocol):
    """Theory of the flow by a method.

    It is made of a case and the observable, and raises CaseError for an axis or a kind that there
    is not. `component` is the axis of the velocity, `ids` are the particles that count, None if
    all do.
    """

    component: int
    ids: NDArray[np.int64] | None

    def warnings(self) -> Iterator[str]:
        """Warnings before it is measured."""

    def compared(self, profile: ProfileAccumulator, velocity: Estimate, sums: Array) -> Compared:
        """The velocity (bins,) beside the steady flow, by the sums (2, bins) of momentum and
        mass."""


@component
class VelocityProfile(Profile):
    """Mean velocity in slices across an axis: momentum over mass.

    Without `component` it is the velocity along the axis of the flow; where nothing or more than
    one thing flows, along x, or along y in slices across x. Fits leave out the cell next to each
    plate, where the no-slip rule is only approximate. Spheres are at rest where nothing drives
    them.
    """

    quantity: Literal["velocity-profile"] = tag("velocity-profile")
    asks_transport: ClassVar[bool] = True
    of_built_up_flow: ClassVar[bool] = True
    at_any_kT: ClassVar[tuple[str, ...]] = ("shear rate", "chi-square")
    component: Axis | None = param(None, doc="axis of the velocity (that of the flow unless said)")
    kind: int | str | None = param(None, doc=KIND)

    def warnings(self, case: Case) -> Iterator[str]:
        """A component along which nothing flows."""
        yield from self.theory(case).warnings()


@accumulator_of(VelocityProfile)
class VelocityProfileAccumulator(ProfileAccumulator):
    """Momentum and mass of each slice."""

    def prepare(self) -> None:
        super().prepare()
        self.blocks = Blocks((2, self.bins))

    def sums(self, engine: RunningFluid | RunningSpheres) -> Array:
        _, mass, momentum, _ = self.moments(engine)
        return np.stack([momentum[self.theory.component], mass])

    def result(self) -> Result:
        """The profile, the steady flow expected, and the fit that suits it."""
        sums, _ = self.blocks.sums()
        velocity = of_ratio(sums[:, 0], sums[:, 1])
        known = self.theory.compared(self, velocity, sums.sum(axis=0))
        axis = AXES[self.theory.component]
        return self.in_slices(
            velocity, known, "a/tau", label=f"velocity v_{axis}", extra={"component": axis}
        )
