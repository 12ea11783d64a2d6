"""Density, flow and temperature of spheres in slices across an axis."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.geometry.walls import closed_axes
from mesokit.method.spheres.common.expected.equilibrium import Equilibrium, still_walls, surfaces

if TYPE_CHECKING:
    from mesokit.case.case import Case

Array = NDArray[np.float64]
Find = Callable[["Case"], Equilibrium | None]
DILUTE = 0.005  # fraction above which an ideal gas is 1 % off, or more
FREEZES = {2: 0.69, 3: 0.49}  # packing fraction above which one sample is ordered for good


class Slices:
    """What all of them ask: equilibrium, which axis is closed, and how spheres are pulled."""

    def __init__(self, find: Find, case: Case, observable: Any) -> None:
        self.case, self.state = case, find(case)
        self.pull = case.spheres.gravity or (0.0,) * case.box.dimension
        self.closed = closed_axes(case)
        self.axis = case.box.index(observable.axis)

    def inside(self, edges: Array) -> NDArray[np.bool_]:
        """The slices that centres of all sizes reach every place of."""
        off = self.case.spheres.largest(self.case.box) / 2 if self.axis in self.closed else 0.0
        return (edges[:-1] >= off) & (edges[1:] <= edges[-1] - off)

    @property
    def steady(self) -> bool:
        """Whether nothing changes any more: in equilibrium, or where heat comes in as it goes."""
        heated = self.case.spheres.energy_source is not None
        return self.state is not None or (heated and still_walls(self.case))


class DensityInSlices(Slices):
    """The same everywhere across an axis that repeats; between plates that of an ideal gas in
    gravity, whose centres come as near as a radius."""

    answers = "density-profile"

    def __init__(self, find: Find, case: Case, observable: Any) -> None:
        super().__init__(find, case, observable)
        section, d = case.spheres, case.box.dimension
        counts, scale = section.counts(case.box), section.scale(case.box)
        # number, mass, diameter and spread of each kind that is looked at
        self.kinds = [
            (number, kind.mean_mass(d), kind.diameter * scale, kind.spread)
            for k, (kind, number) in enumerate(zip(section.kinds, counts, strict=True))
            if observable.kind is None or observable.kind in (k + 1, kind.name)
        ]
        self.dimension = d

    def expected(self, edges: Array, kT: float) -> Array | None:
        """Number per volume in each slice, at a mean m v^2 along an axis."""
        shares = self.shares(edges, kT)
        if shares is None:
            return None
        numbers = np.array([number for number, _, _, _ in self.kinds])
        slice_volume = self.case.box.volume / (len(edges) - 1)
        return np.asarray(numbers @ shares / slice_volume)

    def shares(self, edges: Array, kT: float) -> Array | None:
        """The part of each kind that is in each slice, (kinds, slices); None without a theory."""
        if any(not wall.closed_axes for wall in self.case.walls):
            return None
        if self.axis not in self.closed:
            fluid = self.case.spheres.fraction(self.case.box) < FREEZES[self.dimension]
            if self.pull[self.axis] or not (self.steady and fluid):
                return None
            return np.full((len(self.kinds), len(edges) - 1), 1 / (len(edges) - 1))
        if self.state is None or not (self.state.hard and kT > 0):
            return None
        if any(spread for _, _, _, spread in self.kinds):
            return None
        return np.array([self.in_gravity(edges, kT, one) for one in self.kinds])

    def in_gravity(self, edges: Array, kT: float, one: tuple[float, ...]) -> Array:
        """Between plates, of one kind."""
        _, mass, diameter, _ = one
        free, pull = float(edges[-1]) - diameter, self.pull[self.axis]
        above = edges - diameter / 2
        if pull == 0:
            return np.diff(np.clip(above / free, 0.0, 1.0))
        scale = kT / (mass * abs(pull))
        if pull < 0:
            return np.diff(theory.barometric_cdf(above, scale, free))
        return -np.diff(theory.barometric_cdf(free - above, scale, free))

    def note(self, density: Array) -> str:
        """How far it is from exact, at a density (slices,)."""
        if self.axis not in self.closed:
            return ""
        filled = self.case.spheres.fraction(self.case.box) * float(density.max() / density.mean())
        return "approximate: ideal gas" if filled > DILUTE else ""

    def legend(self) -> str:
        """Whose law it is."""
        if self.axis in self.closed:
            return "barometric law" if self.pull[self.axis] else "ideal gas"
        return "the same everywhere"


class FlowInSlices(Slices):
    """At rest, where nothing drives the spheres; along smooth walls they go on as they began."""

    answers = "velocity-profile"

    def expected(self, component: int, found: float) -> float:
        """The velocity along an axis: 0, the mean `found` where nothing changes it, or nan."""
        if not (self.steady and still_walls(self.case)):
            return math.nan
        if component in self.closed:
            return 0.0
        if self.pull[component]:
            return math.nan
        holds = self.case.spheres.thermostatted or self.holding
        return 0.0 if holds or not (self.case.walls or any(self.pull)) else found

    @property
    def holding(self) -> bool:
        """Whether walls, or what heats, take momentum along walls."""
        rough = any(wall.closed_axes == () for wall in self.case.walls)
        warm = any(surface.rule == "diffuse" for surface in surfaces(self.case))
        collision, source = self.case.spheres.instant_collision, self.case.spheres.energy_source
        turning = collision is not None and collision.rough
        bath = source is not None and source.bath_kT is not None
        return rough or warm or turning or bath


class TemperatureInSlices(Slices):
    """The same everywhere in equilibrium."""

    answers = "temperature-profile"

    @property
    def rests(self) -> bool:
        """Whether nothing flows."""
        return self.state is not None

    def expected(self, found: float) -> tuple[float, bool]:
        """The temperature, nan without a theory, and whether it is not just the mean `found`."""
        if self.state is None:
            return math.nan, False
        known = not math.isnan(self.state.kT)
        return (self.state.kT if known else found), known
