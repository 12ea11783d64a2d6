"""Mean velocity in slices across an axis, and the viscosity that its shape gives."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from mesokit.case.box import Axis
from mesokit.case.component import component, param, tag
from mesokit.geometry.solids.solids import slit_of
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.profile import (
    Array,
    Profile,
    ProfileAccumulator,
    expected_in_slices,
    part_of,
)
from mesokit.observe.shared.whose import KIND, ids_of_kind
from mesokit.seam.estimate import Estimate, fit, noted, of_ratio
from mesokit.seam.result import Comparison, Result

if TYPE_CHECKING:
    from mesokit.case.case import Case

VISCOSITY = "a^2/tau"
ENOUGH = 100  # relaxation times of a flow, for an error bar


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
    component: Axis | None = param(None, doc="axis of the velocity (that of the flow unless said)")
    kind: int | str | None = param(None, doc=KIND)

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not."""
        super(VelocityProfile, self).check(case)  # noqa: UP008  # the decorator makes a new class
        case.box.index(self.seen(case), "component")
        ids_of_kind(case, self.kind)

    def warnings(self, case: Case) -> Iterator[str]:
        """A component along which nothing flows."""
        if not case.particles_have("diameter"):
            yield from setting.across_the_flow(case, self.component)

    def seen(self, case: Case) -> Axis:
        """The axis of the velocity in this case."""
        if self.component is not None:
            return self.component
        flowing = [] if case.particles_have("diameter") else setting.flowing_axes(case)
        return flowing[0] if len(flowing) == 1 else "y" if self.axis == "x" else "x"

    def accumulator(self, case: Case) -> VelocityProfileAccumulator:
        """An empty memory for it."""
        return VelocityProfileAccumulator(self, case)


class VelocityProfileAccumulator(ProfileAccumulator):
    """Momentum and mass of each slice."""

    def __init__(self, observable: VelocityProfile, case: Case) -> None:
        super().__init__(observable, case, width=2)
        self.letter = observable.seen(case)
        self.component = case.box.index(self.letter, "component")
        self.ids, self.known = (
            ids_of_kind(case, observable.kind),
            expected_in_slices(case, observable),
        )

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Momentum along the component, and mass."""
        return np.stack([momentum[self.component], mass])

    def result(self) -> Result:
        """The profile, the steady flow expected, and the fit that suits it."""
        sums, _ = self.blocks.sums()
        velocity = of_ratio(sums[:, 0], sums[:, 1])
        flow = self.flow()
        expected = flow.bins(self.axis, self.edges)
        comparisons: list[Comparison] = []
        curve = None
        inside = np.full(self.bins, True) if self.known is None else self.known.inside(self.edges)
        filled = np.isfinite(velocity.value[inside]).all()
        if flow.across == self.axis and filled and self.blocks.count:
            mass = sums[:, 1].sum(axis=0)
            if flow.kind in FITS:
                curve, comparisons = FITS[flow.kind](self, velocity, mass)
            if flow.kind in ("lees-edwards", "rest", "drift") and expected is not None:
                some = part_of(velocity, inside)
                comparisons += self.chi_square(some, expected[inside], "against the line")
        return Result(
            quantity="velocity-profile",
            drawing="profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=velocity.value,
            error=velocity.error,
            label=f"velocity v_{self.letter}",
            units={"value": "a/tau", self.observable.axis: "a"},
            expected=expected,
            fit=curve,
            theory=flow.kind,
            comparisons=tuple(comparisons),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell, "component": self.letter}
            | self.raised(flow, expected),
        )

    def flow(self) -> setting.Flow:
        """The steady flow; of spheres it is known where they are at rest, or go on as one."""
        if self.known is None:
            return setting.flow(self.case, self.component)
        momentum, mass = self.blocks.sums()[0].sum(axis=(0, 2))
        mean = float(momentum / mass) if mass > 0 else 0.0
        level = self.known.expected(self.component, mean)
        if np.isnan(level):
            return setting.Flow("", self.axis, None)
        return setting.Flow("rest" if level == 0 else "drift", self.axis, lambda y: level + 0 * y)

    def raised(self, flow: setting.Flow, expected: Array | None) -> dict[str, Array]:
        """The profile with the viscosity that fluctuations raise in 2D, of plates at rest."""
        viscous = flow.kind in ("poiseuille", "half poiseuille", "kolmogorov")
        if expected is None or not viscous:
            return {}
        part = setting.loop(self.case)
        if part < 0.002 or np.any(self.moving()):
            return {}
        return {"raised": expected / (1 + part), "raised_by": np.array(100 * part)}

    def moving(self) -> tuple[float, float]:
        """Velocities of the plates, if there are any."""
        return (0.0, 0.0) if slit_of(self.case) is None else self.plates()

    def powers(self, degree: int) -> Array:
        """Bin averages of 1, t, t^2 about the middle of the box, (bins, degree + 1)."""
        middle = self.edges[-1] / 2
        ends = self.edges[:, None] - middle
        powers = np.arange(1, degree + 2)
        return np.diff(ends**powers / powers, axis=0) / np.diff(ends, axis=0)

    def inside(self) -> Array:
        """1 for slices at least a cell away from the ends, 0 for the others."""
        height = self.edges[-1]
        cut = 1.0 if height >= 6 and not self.periodic else 0.0
        return ((self.edges[:-1] >= cut - 1e-9) & (self.edges[1:] <= height - cut + 1e-9)) * 1.0

    def expected_viscosity(self) -> float:
        """That of the theory, nan for a mixture."""
        coefficients = setting.transport(self.case)
        return coefficients.viscosity if coefficients else np.nan

    def short_run(self, viscosity: float) -> str:
        """Where blocking cannot see the slowest eddies, which live H^2/(pi^2 nu): a note."""
        time = self.blocks.count * self.observable.every * self.case.fluid.timestep
        times = time * np.pi**2 * viscosity / self.edges[-1] ** 2
        if not 0 < times < ENOUGH:
            return ""
        return f"error bar is a lower bound: the run has {times:.2g} relaxation times"

    def plates(self) -> tuple[float, float]:
        """Velocities of the lower and the upper plate."""
        wall = slit_of(self.case)
        assert wall is not None  # only such flows are fitted so
        lower, upper = (
            setting.surface_velocity(s, self.component) for s in (wall.lower, wall.upper)
        )
        return lower, upper


Fitted = tuple[Array, list[Comparison]]


def _poiseuille(acc: VelocityProfileAccumulator, velocity: Estimate, mass: Array) -> Fitted:
    """Parabola c0 + c1 t + c2 t^2: viscosity from the curvature, slip from where it meets walls."""
    basis = acc.powers(2)
    parabola = fit(velocity, basis, mass * acc.inside())
    c0, _, c2 = parabola.value
    push = setting.acceleration(acc.case)[acc.component]
    value, error = parabola.scalar(
        -push / (2 * c2), np.array([0, 0, push / (2 * c2**2)]), over=(c2, np.eye(3)[2])
    )
    short = acc.short_run(acc.expected_viscosity() if np.isnan(value) else value)
    found = [
        Comparison(
            "viscosity from curvature",
            value,
            error,
            acc.expected_viscosity(),
            VISCOSITY,
            noted(value, setting.caveat(acc.case), short) or "independent of slip",
        )
    ]
    quarter = acc.edges[-1] ** 2 / 4
    wall = sum(acc.plates()) / 2
    centre, slip = c0 - wall, c0 + quarter * c2 - wall
    share = slip / centre
    gradient = np.array([1 - share, 0, quarter]) / centre
    value, error = parabola.scalar(100 * share, 100 * gradient, over=(centre, np.eye(3)[0]))
    found.append(
        Comparison(
            "slip at the walls",
            value,
            error,
            0.0,
            "% of the centre velocity",
            noted(value, setting.slipping(acc.case), short) or "no slip",
        )
    )
    return basis @ parabola.value, found


def _half_poiseuille(acc: VelocityProfileAccumulator, velocity: Estimate, mass: Array) -> Fitted:
    """The same with one slip plate: only the curvature."""
    curve, found = _poiseuille(acc, velocity, mass)
    return curve, found[:1]


def _couette(acc: VelocityProfileAccumulator, velocity: Estimate, mass: Array) -> Fitted:
    """Straight line: its slope, and the velocity that it lacks at the walls."""
    basis, (lower, upper) = acc.powers(1), acc.plates()
    line = fit(velocity, basis, mass * acc.inside())
    height = acc.edges[-1]
    slope, error = line.scalar(line.value[1], np.array([0.0, 1.0]))
    difference, slips = upper - lower, setting.slipping(acc.case)
    return basis @ line.value, [
        Comparison("shear rate", slope, error, difference / height, "1/tau", slips),
        Comparison(
            "slip at the walls",
            50 * (1 - slope * height / difference),
            50 * error * height / abs(difference),
            0.0,
            "% of the velocity difference",
            slips or "mean of both plates",
        ),
    ]


def _lees_edwards(acc: VelocityProfileAccumulator, velocity: Estimate, mass: Array) -> Fitted:
    """Straight line: its slope."""
    basis = acc.powers(1)
    line = fit(velocity, basis, mass)
    slope, error = line.scalar(line.value[1], np.array([0.0, 1.0]))
    found = Comparison("shear rate", slope, error, acc.case.box.steady_rate, "1/tau")
    return basis @ line.value, [found]


def _kolmogorov(acc: VelocityProfileAccumulator, velocity: Estimate, mass: Array) -> Fitted:
    """Amplitude of the sine, which is inverse to the viscosity."""
    force: Any = acc.case.fluid.force
    k = 2 * np.pi * force.waves / acc.edges[-1]
    basis = np.stack(
        [np.ones(acc.bins), setting.bin_average(lambda y: np.sin(k * y), acc.edges)], axis=1
    )
    wave = fit(velocity, basis, mass)
    amplitude = wave.value[1]
    nu = force.amplitude / (amplitude * k**2)
    value, error = wave.scalar(nu, np.array([0, -nu / amplitude]), over=(amplitude, np.eye(2)[1]))
    return basis @ wave.value, [
        Comparison(
            "viscosity from amplitude",
            value,
            error,
            acc.expected_viscosity(),
            VISCOSITY,
            noted(value, setting.caveat(acc.case)) or "steady",
        )
    ]


FITS = {
    "poiseuille": _poiseuille,
    "half poiseuille": _half_poiseuille,
    "couette": _couette,
    "lees-edwards": _lees_edwards,
    "kolmogorov": _kolmogorov,
}
