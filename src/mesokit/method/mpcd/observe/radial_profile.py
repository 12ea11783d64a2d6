"""Velocity, density or temperature in rings about an axis."""

import functools
from collections.abc import Callable
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import FINE, solids_of
from mesokit.method.mpcd.expected import recognise, setting
from mesokit.method.mpcd.observe.shared.shells import (
    Array,
    ShellAccumulator,
    nearest,
    periodic_lengths,
    shell_volumes,
)
from mesokit.observe.shared.short_run import ENOUGH_FOR_CURVATURE, of_relaxations
from mesokit.seam.estimate import Estimate, fit, noted
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Comparison, Result, joined

COMPONENTS = ("radial", "azimuthal", "axial")
UNITS = {"density": "1/a^d", "temperature": "m a^2/tau^2"}


@component
class RadialProfile(Observable):
    """A velocity component, the density or the temperature in rings about an axis.

    Centre, axis and radii are those of the round pipe, drum, gap or post that the walls make;
    without one the axis goes through the middle of the box. Azimuthal velocities are
    counter-clockwise. Fits leave out the cell next to each surface, where the no-slip rule is only
    approximate.
    """

    quantity: Literal["radial-profile"] = tag("radial-profile")
    asks_transport: ClassVar[bool] = True
    of_built_up_flow: ClassVar[bool] = True
    drawing = "profile"
    of: Literal["azimuthal", "axial", "radial", "density", "temperature"] = param(
        "azimuthal", doc="what: a velocity component, 'density' or 'temperature'"
    )
    centre: Either[None, float] = param(None, doc="a place on the axis", unit="a")
    axis: Axis | None = param(None, doc="direction of the axis, in 3D (z unless the walls say)")
    radii: tuple[float, float] | None = param(None, doc="innermost and outermost", unit="a")
    bins_per_cell: int = param(4, doc="rings per cell", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for another dimension or no rings."""
        d = case.box.dimension
        if self.centre is not None and len(self.centre) != d:
            raise CaseError(
                f"centre = {show(self.centre)}: expected {d} numbers, one for each axis"
            )
        if d == 2:
            if self.axis is not None:
                raise CaseError(f"axis = {self.axis!r}: only in 3D; leave it out")
            if self.of == "axial":
                raise CaseError("of = 'axial': only in 3D; expected 'azimuthal' or 'radial'")
        if self.radii is not None and not 0 <= self.radii[0] < self.radii[1]:
            raise CaseError(f"radii = {show(self.radii)}: expected 0 <= innermost < outermost")


@accumulator_of(RadialProfile)
class RadialProfileAccumulator(ShellAccumulator):
    """Sums in rings; velocities are radial, azimuthal and, in 3D, axial."""

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.flow = RoundFlow(case)
        self.axis = AXES.index(observable.axis) if observable.axis else self.flow.axis
        self.plane = [k % 3 for k in (self.axis + 1, self.axis + 2)]
        self.centre = np.array(observable.centre or self.flow.centre)[self.plane]
        self.known = self.axis == self.flow.axis and np.allclose(
            self.centre, np.array(self.flow.centre)[self.plane]
        )
        lengths = np.array(case.box.size, float)[self.plane]
        self.lengths = periodic_lengths(case)[self.plane]
        inner, outer = self.flow.radii if self.known else (0.0, np.inf)
        inner, outer = observable.radii or (inner, min(outer, lengths.min() / 2))
        self.prepare_shells(inner, outer)

    def locate(self, r: Array) -> tuple[Array, Array]:
        arm = nearest(r[:, self.plane] - self.centre, self.lengths)
        return np.hypot(arm[:, 0], arm[:, 1]), arm

    def along(self, place: Array, v: Array) -> Array:
        out = (place / np.maximum(np.hypot(*place.T), 1e-12)[:, None]).T
        first, second = v[:, self.plane[0]], v[:, self.plane[1]]
        turned = [out[0] * first + out[1] * second, out[0] * second - out[1] * first]
        return np.stack(turned + ([v[:, self.axis]] if self.dimension == 3 else []))

    def result(self) -> Result:
        of, expected, curve = self.observable.of, self.expected(), None
        found: list[Comparison] = []
        kind = self.flow.kind if self.known else "rest"
        if of == "density":
            value, label = self.density(self.volumes), "density"
        elif of == "temperature":
            value, label = self.temperature(), "temperature k_B T"
        else:
            value, label = self.velocity(COMPONENTS.index(of)), f"{of} velocity"
        if expected is not None and self.blocks.count and np.isfinite(value.value).all():
            if of == self.flow.component and self.known and kind in FITS:
                curve, found = FITS[kind](self, value)
            if of == "temperature":
                found = [self.mean_temperature(value)]
            if not self.approximate():
                found += self.chi_square(value, expected, "against theory")
        unit = UNITS.get(of, "a/tau").replace("1/a^d", self.case.box.density_unit)
        return self.report(
            {"r": self.centres},
            value,
            found,
            label=label,
            units={"value": unit, "r": "a"},
            expected=expected,
            fit=curve,
            theory=self.flow.name(of) if self.known else "rest",
            extra={"of": of, "kind": kind, "edges": self.edges},
        )

    def approximate(self) -> bool:
        """Whether theory is known to be off by more than an error bar."""
        if self.observable.of == "temperature":
            return setting.driven(self.case) or bool(setting.temperature_note(self.case))
        uneven = self.observable.of == "density" or bool(setting.slipping(self.case))
        return uneven and setting.driven(self.case)

    def expected(self) -> Array | None:
        of, fluid, still = self.observable.of, self.case.fluid, not setting.driven(self.case)
        if of == "density":
            pressed = not still and not (self.known and self.flow.profile is not None)
            return None if pressed else np.full(self.bins, fluid.density)
        if of == "temperature":
            return np.full(self.bins, fluid.kT) if setting.at_kT(self.case) else None
        if still:
            return np.zeros(self.bins)
        if not self.known or self.flow.profile is None:
            return None
        if of != self.flow.component:
            return np.zeros(self.bins)
        return ring_average(self.flow.profile, self.edges)

    def mean_temperature(self, temperature: Estimate) -> Comparison:
        """Of all rings together."""
        weight = self.crowd / self.crowd.sum()
        value, error = temperature.total(weight)
        kT = self.case.fluid.kT
        error = setting.with_start(self.case, error, kT, self.blocks.series)
        note = setting.temperature_note(self.case)
        if setting.driven(self.case):
            note = "approximate: shear in the rings and cells adds to it"
        return Comparison("mean temperature", value, error, kT, "m a^2/tau^2", note)

    @functools.cached_property
    def volumes(self) -> Array:
        """Volume of fluid in each ring: all of it where the walls are round about the axis."""
        size = np.array(self.case.box.size, float)
        if self.edges[-1] <= size[self.plane].min() / 2 and (
            not self.case.walls or (self.known and self.flow.round)
        ):
            length = size[self.axis] if self.dimension == 3 else 1.0
            return np.asarray(np.pi * np.diff(self.edges**2) * length)
        fine = 4 * FINE if self.dimension == 2 else FINE
        grids = [(np.arange(n * fine) + 0.5) / fine for n in self.case.box.size]
        total = np.zeros(self.bins)
        for x in grids[0]:
            points = np.stack(np.meshgrid([x], *grids[1:], indexing="ij"), -1)
            points = points.reshape(-1, self.dimension)
            share = np.ones(len(points))
            if self.case.walls:
                share = np.clip(0.5 + fine * solids_of(self.case).distance(points), 0.0, 1.0)
            distance = self.locate(points)[0]
            total += shell_volumes(self.edges, distance, share, 1 / fine, self.dimension)
        return total

    def powers(self, *powers: int) -> Array:
        """Ring averages of powers of r, (bins, powers)."""
        return np.stack([ring_average(_power(p), self.edges) for p in powers], axis=1)

    def inside(self) -> Array:
        """1 for rings at least a cell away from the surfaces, 0 for the others."""
        inner, outer = self.flow.radii
        cut = 1.0 if outer - inner >= 4 else 0.0
        low, high = inner + cut * (inner > 0), outer - cut
        return ((self.edges[:-1] >= low - 1e-9) & (self.edges[1:] <= high + 1e-9)) * 1.0

    def short_run(self, rate: float) -> str:
        """Caveat of a run that is short against the decay of the slowest eddies, at this rate."""
        runs, step = self.blocks.series, self.case.fluid.timestep
        time = self.blocks.count / runs * self.observable.every * step
        if not 0 < time * rate < ENOUGH_FOR_CURVATURE:
            return ""
        return of_relaxations(time * rate, runs)


class RoundFlow:
    """The flow about an axis: where it is, what kind, and its velocity as a function of r.

    `radii` of the innermost and outermost fluid, `component` along which it flows, `profile` None
    without a theory, `round` whether all solids are round about the axis.
    """

    def __init__(self, case: Case) -> None:
        pipe, gap, drum = recognise.pipe(case), recognise.gap(case), recognise.drum(case)
        post = recognise.lone_post(case)
        acceleration, coefficients = setting.uniform_acceleration(case), setting.transport(case)
        self.kind, self.component, self.round = "rest", "azimuthal", True
        self.profile: Callable[[Array], Array] | None = None
        self.surfaces: tuple[float, ...] = ()
        forced = case.fluid.force.acts
        if pipe is not None and forced:
            self.axis, self.centre, self.radii = pipe.axis, pipe.centre, (0.0, pipe.radius)
            self.kind, self.component = "hagen-poiseuille", "axial"
            if coefficients and setting.driven_axis(case) == pipe.axis:
                nu, g = coefficients.viscosity, float(acceleration[pipe.axis])
                self.profile = lambda r: theory.hagen_poiseuille_velocity(r, pipe.radius, g, nu)
        elif gap is not None:
            self.axis, self.centre, self.radii = gap.axis, gap.centre, (gap.inner, gap.outer)
            self.surfaces = gap.inner * gap.inner_rate, gap.outer * gap.outer_rate
            self.kind = "taylor-couette"
            if not forced:
                self.profile = lambda r: theory.taylor_couette_velocity(
                    r, gap.inner, gap.outer, gap.inner_rate, gap.outer_rate
                )
        elif drum is not None:
            self.axis, self.centre, self.radii = drum.axis, drum.centre, (0.0, drum.radius)
            self.kind = "drum"
            if not forced:
                self.profile = lambda r: drum.rate * r
        elif post is not None:
            self.axis, self.centre, self.radii = post.axis, post.centre, (post.radius, np.inf)
        else:
            middle = tuple(length / 2 for length in case.box.size)
            self.axis, self.centre, self.radii = 2, middle, (0.0, np.inf)
            self.round = not case.walls

    def name(self, of: str) -> str:
        if of in UNITS:
            return {"density": "ideal gas", "temperature": "kT of the case"}[of]
        return self.kind


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


def _power(p: int) -> Callable[[Array], Array]:
    return lambda r: r ** float(p)


def ring_average(function: Callable[[Array], Array], edges: Array) -> Array:
    """Average of a smooth function of r over the area of each ring, (rings,).

    >>> ring_average(lambda r: r**2, np.array([0.0, 2.0]))
    array([2.])
    """
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    r = middle[:, None] + half[:, None] * _NODES
    return np.asarray((np.asarray(function(r)) * r) @ _WEIGHTS / (r @ _WEIGHTS))


Fitted = tuple[Array, list[Comparison]]


def _couette(acc: RadialProfileAccumulator, velocity: Estimate) -> Fitted:
    """A r + B/r, and what it lacks at either surface."""
    basis = acc.powers(1, -1)
    line = fit(velocity, basis, acc.crowd * acc.inside())
    fastest, found = max(map(abs, acc.flow.surfaces)), []
    if fastest > 0:
        coefficients, gap = setting.transport(acc.case), acc.flow.radii[1] - acc.flow.radii[0]
        rate = np.pi**2 * coefficients.viscosity / gap**2 if coefficients else np.inf
        parts = setting.slipping(acc.case), acc.short_run(rate)
        note = joined(*parts) or "fit of A r + B/r"
        both = zip(("inner", "outer"), acc.flow.radii, acc.flow.surfaces, strict=True)
        for name, radius, speed in both:
            gradient = 100 / fastest * np.array([radius, 1 / radius])
            slip = line.scalar(gradient @ line.value - 100 * speed / fastest, gradient)
            what, unit = f"slip at the {name} surface", "% of the surface speed"
            found.append(Comparison(what, *slip, 0.0, unit, note))
    return basis @ line.value, found


def _drum(acc: RadialProfileAccumulator, velocity: Estimate) -> Fitted:
    """A r: the rate of rotation."""
    basis = acc.powers(1)
    line = fit(velocity, basis, acc.crowd * acc.inside())
    drum, found = recognise.drum(acc.case), line.total(np.ones(1))
    assert drum is not None  # only such flows are fitted so
    return basis @ line.value, [Comparison("rate of rotation", *found, drum.rate, "1/tau")]


def _pipe(acc: RadialProfileAccumulator, velocity: Estimate) -> Fitted:
    """c0 + c2 r^2: viscosity from the curvature, slip from where it meets the wall."""
    basis, radius = acc.powers(0, 2), acc.flow.radii[1]
    parabola = fit(velocity, basis, acc.crowd * acc.inside())
    c0, c2 = parabola.value
    acceleration = setting.uniform_acceleration(acc.case)[acc.axis]
    coefficients = setting.transport(acc.case)
    curved = np.array([0, acceleration / (4 * c2**2)])
    nu, error = parabola.scalar(-acceleration / (4 * c2), curved, over=(c2, np.eye(2)[1]))
    known = coefficients.viscosity if coefficients else np.nan
    slowest = known if np.isnan(nu) else nu
    short = acc.short_run(5.78 * slowest / radius**2)  # the first zero of J0, squared
    off = setting.caveat(acc.case) or setting.chaos_is_off(acc.case, known, error)
    note = noted(nu, off, short) or "independent of slip"
    viscosity = Comparison("viscosity from curvature", nu, error, known, "a^2/tau", note, True)
    share = 1 + radius**2 * c2 / c0
    gradient = np.array([-(radius**2) * c2 / c0**2, radius**2 / c0])
    value, error = parabola.scalar(100 * share, 100 * gradient, over=(c0, np.eye(2)[0]))
    note = noted(value, setting.slipping(acc.case), short) or "no slip"
    slip = Comparison("slip at the wall", value, error, 0.0, "% of the centre velocity", note)
    return basis @ parabola.value, [viscosity, slip]


FITS: dict[str, Callable[[Any, Estimate], Fitted]] = {
    "taylor-couette": _couette,
    "hagen-poiseuille": _pipe,
    "drum": _drum,
}
