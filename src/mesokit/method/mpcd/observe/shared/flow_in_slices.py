"""The steady flow of an MPCD fluid in slices, and the fit that suits it."""

import functools
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Axis
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import slit_of
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.profile import Array, Compared, ProfileAccumulator
from mesokit.observe.shared.short_run import ENOUGH_FOR_CURVATURE, of_relaxations
from mesokit.seam.estimate import Estimate, fit, noted
from mesokit.seam.result import Comparison

VISCOSITY = "a^2/tau"


def refuse_kinds(kind: int | str | None) -> None:
    """Raise CaseError for a kind of spheres: a fluid has none."""
    if kind is not None:
        raise CaseError(f"kind = {show(kind)}: of spheres alone")


class FlowInSlices:
    """The steady velocity along an axis, of theory."""

    answers = "velocity-profile"
    ids: NDArray[np.int64] | None = None  # all particles count

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, self.observable = case, observable
        self.component = case.box.index(self._axis(), "component")
        refuse_kinds(observable.kind)

    def _axis(self) -> Axis:
        """That of the velocity: along the flow unless said."""
        given: Axis | None = self.observable.component
        if given is not None:
            return given
        flowing = setting.flowing_axes(self.case)
        return flowing[0] if len(flowing) == 1 else "y" if self.observable.axis == "x" else "x"

    def warnings(self) -> Iterator[str]:
        yield from setting.across_the_flow(self.case, self.observable.component)

    def compared(self, profile: ProfileAccumulator, velocity: Estimate, sums: Array) -> Compared:
        """The profile beside the steady flow, by the sums (2, bins) of momentum and mass."""
        flow = setting.flow(self.case, self.component)
        expected = flow.bins(profile.axis, profile.edges)
        found: list[Comparison] = []
        curve, seen = None, Seen(self.case, self.component, profile)
        filled = np.isfinite(velocity.value).all()
        if flow.across == profile.axis and filled and profile.blocks.count:
            if flow.kind in FITS:
                curve, found = FITS[flow.kind](seen, velocity, sums[1])
            if flow.kind in ("lees-edwards", "rest") and expected is not None:
                found += profile.chi_square(velocity, expected, "against the line")
        return Compared(expected, flow.kind, found, curve, seen.raised(flow, expected))


class Seen:
    """A measured profile of the velocity along an axis, and what its fits need."""

    def __init__(self, case: Case, component: int, profile: ProfileAccumulator) -> None:
        self.case, self.component, self.profile = case, component, profile
        self.edges, self.bins = profile.edges, profile.bins

    def raised(self, flow: setting.Flow, expected: Array | None) -> dict[str, Array]:
        """The profile with the viscosity that fluctuations raise in 2D, of plates at rest."""
        viscous = flow.kind in ("poiseuille", "half poiseuille", "kolmogorov")
        if expected is None or not viscous:
            return {}
        part = setting.loop(self.case)
        moving = slit_of(self.case) is not None and np.any(self.plates())
        if part < 0.002 or moving:
            return {}
        return {"raised": expected / (1 + part), "raised_by": np.array(100 * part)}

    def powers(self, degree: int) -> Array:
        """Bin averages of 1, t, t^2 about the middle of the box, (bins, degree + 1)."""
        middle = self.edges[-1] / 2
        ends = self.edges[:, None] - middle
        powers = np.arange(1, degree + 2)
        return np.diff(ends**powers / powers, axis=0) / np.diff(ends, axis=0)

    def inside(self) -> Array:
        """1 for slices at least a cell away from the ends, 0 for the others."""
        height = self.edges[-1]
        cut = 1.0 if height >= 6 and not self.profile.periodic else 0.0
        return ((self.edges[:-1] >= cut - 1e-9) & (self.edges[1:] <= height - cut + 1e-9)) * 1.0

    def expected_viscosity(self) -> float:
        """That of the theory, nan for a mixture."""
        coefficients = setting.transport(self.case)
        return coefficients.viscosity if coefficients else np.nan

    def viscosity_note(self, error: float) -> str:
        """Reason for which the theory is off by more than the error bar."""
        caveat = setting.caveat(self.case)
        return caveat or setting.chaos_is_off(self.case, self.expected_viscosity(), error)

    def short_run(self, viscosity: float) -> str:
        """Caveat of a run that is short against the life H^2/(pi^2 nu) of the slowest eddies."""
        blocks, step = self.profile.blocks, self.case.fluid.timestep
        time = blocks.count / blocks.series * self.profile.observable.every * step
        times = time * np.pi**2 * viscosity / self.edges[-1] ** 2
        if not 0 < times < ENOUGH_FOR_CURVATURE:
            return ""
        return of_relaxations(times, blocks.series)

    def plates(self) -> tuple[float, float]:
        wall = slit_of(self.case)
        assert wall is not None  # only such flows are fitted so
        velocity, axis = setting.surface_velocity, self.component
        return velocity(wall.lower, axis), velocity(wall.upper, axis)


Fitted = tuple[Array, list[Comparison]]


def _poiseuille(seen: Seen, velocity: Estimate, mass: Array, half: bool = False) -> Fitted:
    """Parabola c0 + c1 t + c2 t^2: viscosity from the curvature, slip from where it meets walls.

    With one slip plate (`half`) only the curvature.
    """
    basis = seen.powers(2)
    parabola = fit(velocity, basis, mass * seen.inside())
    c0, _, c2 = parabola.value
    acceleration = setting.uniform_acceleration(seen.case)[seen.component]
    value, error = parabola.scalar(
        -acceleration / (2 * c2),
        np.array([0, 0, acceleration / (2 * c2**2)]),
        over=(c2, np.eye(3)[2]),
    )
    short = seen.short_run(seen.expected_viscosity() if np.isnan(value) else value)
    known = seen.expected_viscosity()
    note = noted(value, seen.viscosity_note(error), short) or "independent of slip"
    found = [Comparison("viscosity from curvature", value, error, known, VISCOSITY, note, True)]
    if half:
        return basis @ parabola.value, found
    quarter = seen.edges[-1] ** 2 / 4
    wall = sum(seen.plates()) / 2
    centre, slip = c0 - wall, c0 + quarter * c2 - wall
    share = slip / centre
    gradient = np.array([1 - share, 0, quarter]) / centre
    value, error = parabola.scalar(100 * share, 100 * gradient, over=(centre, np.eye(3)[0]))
    note = noted(value, setting.slipping(seen.case), short) or "no slip"
    unit = "% of the centre velocity"
    found.append(Comparison("slip at the walls", value, error, 0.0, unit, note))
    return basis @ parabola.value, found


def _couette(seen: Seen, velocity: Estimate, mass: Array) -> Fitted:
    """Straight line: its slope, and the velocity that it lacks at the walls."""
    basis, (lower, upper) = seen.powers(1), seen.plates()
    line = fit(velocity, basis, mass * seen.inside())
    height = seen.edges[-1]
    slope, error = line.scalar(line.value[1], np.array([0.0, 1.0]))
    difference, slips = upper - lower, setting.slipping(seen.case)
    short = seen.short_run(seen.expected_viscosity())
    note = noted(slope, slips, short)
    found = Comparison("shear rate", slope, error, difference / height, "1/tau", note)
    slip, spread = 50 * (1 - slope * height / difference), 50 * error * height / abs(difference)
    unit, note = "% of the velocity difference", note or "mean of both plates"
    return basis @ line.value, [
        found,
        Comparison("slip at the walls", slip, spread, 0.0, unit, note),
    ]


def _lees_edwards(seen: Seen, velocity: Estimate, mass: Array) -> Fitted:
    basis = seen.powers(1)
    line = fit(velocity, basis, mass)
    slope, error = line.scalar(line.value[1], np.array([0.0, 1.0]))
    found = Comparison("shear rate", slope, error, seen.case.box.steady_rate, "1/tau")
    return basis @ line.value, [found]


def _kolmogorov(seen: Seen, velocity: Estimate, mass: Array) -> Fitted:
    """Amplitude of the sine, which is inverse to the viscosity."""
    force: Any = seen.case.fluid.force
    k = 2 * np.pi * force.waves / seen.edges[-1]
    basis = np.stack(
        [np.ones(seen.bins), setting.bin_average(lambda y: np.sin(k * y), seen.edges)], axis=1
    )
    wave = fit(velocity, basis, mass)
    amplitude = wave.value[1]
    nu = force.amplitude / (amplitude * k**2)
    value, error = wave.scalar(nu, np.array([0, -nu / amplitude]), over=(amplitude, np.eye(2)[1]))
    what, known = "viscosity from amplitude", seen.expected_viscosity()
    note = noted(value, seen.viscosity_note(error)) or "steady"
    return basis @ wave.value, [Comparison(what, value, error, known, VISCOSITY, note, True)]


FITS: dict[str, Callable[[Seen, Estimate, Array], Fitted]] = {
    "poiseuille": _poiseuille,
    "half poiseuille": functools.partial(_poiseuille, half=True),
    "couette": _couette,
    "lees-edwards": _lees_edwards,
    "kolmogorov": _kolmogorov,
}
