"""Theory of density, flow and temperature of spheres in slices across an axis."""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.geometry.walls import closed_axes
from mesokit.method.spheres.common.expected.equilibrium import Equilibrium, still_walls, surfaces
from mesokit.method.spheres.common.groups import ids_of_kind, refuse_molecules
from mesokit.method.spheres.common.kinds import SphereKind
from mesokit.observe.shared.profile import Compared, ProfileAccumulator
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.estimate import Estimate
from mesokit.seam.result import Comparison

Array = NDArray[np.float64]
Find = Callable[["Case"], Equilibrium | None]
DILUTE = 0.005  # fraction above which an ideal gas is 1 % off, or more
KEPT = 1e-9  # relative error below which there is none but rounding
FREEZES = {2: 0.69, 3: 0.49}  # packing fraction above which one sample is ordered for good


class Slices:
    """Equilibrium of a case, its closed axes and its gravity."""

    def __init__(self, find: Find, case: Case, observable: Any) -> None:
        self.case, self.state = case, find(case)
        self.pull = case.spheres.gravity or (0.0,) * case.box.dimension
        self.closed = closed_axes(case)
        self.axis = case.box.index(observable.axis)
        self.ids = None if observable.kind is None else ids_of_kind(case, observable.kind)

    def inside(self, edges: Array) -> NDArray[np.bool_]:
        """True for slices that centres of spheres of all sizes can fill."""
        off = self.case.spheres.largest(self.case.box) / 2 if self.axis in self.closed else 0.0
        return (edges[:-1] >= off) & (edges[1:] <= edges[-1] - off)

    def chi_square(
        self, profile: ProfileAccumulator, measured: Estimate, expected: Array, note: str
    ) -> list[Comparison]:
        """Chi-square of those slices."""
        inside, weights = self.inside(profile.edges), measured.weights
        weights = weights if weights.ndim == 1 else weights[:, inside]
        some = Estimate(measured.value[inside], measured.residuals[:, inside], weights)
        return profile.chi_square(some, expected[inside], note)

    @property
    def steady(self) -> bool:
        """True in equilibrium, and where an energy source balances the loss in collisions."""
        heated = self.case.spheres.energy_source is not None
        return self.state is not None or (heated and still_walls(self.case))


class DensityInSlices(Slices):
    """The same everywhere across an axis that repeats; between plates that of an ideal gas in
    gravity, whose centres come as near as a radius."""

    answers, width, label = "density-profile", 2, "number density"

    def __init__(self, find: Find, case: Case, observable: Any) -> None:
        refuse_molecules(observable.of)
        super().__init__(find, case, observable)
        counts = zip(case.spheres.kinds, case.spheres.counts(case.box), strict=True)
        self.kinds = [  # those that are looked at, and their numbers
            (kind, number)
            for k, (kind, number) in enumerate(counts)
            if observable.kind is None or observable.kind in (k + 1, kind.name)
        ]

    def sums(self, profile: ProfileAccumulator, spheres: RunningSpheres) -> Array:
        number, _, _, energy = profile.moments(spheres)
        return np.stack([number, energy])

    def compared(self, profile: ProfileAccumulator, density: Estimate, sums: Array) -> Compared:
        """The profile, compared as a whole, and beside gravity the mean place."""
        number, energy = sums.sum(axis=1)
        kT = float(energy / number) / self.case.box.dimension if number > 0 else np.nan
        expected, found = self.expected(profile.edges, kT), list[Comparison]()
        if expected is not None and profile.blocks.count:
            note = self.note(expected)
            if np.ptp(expected) > 0:
                share = profile.centres / number
                place, error = density.scalar(share @ density.value, share)
                wanted = float(profile.centres @ expected / expected.sum())
                what = f"mean {profile.observable.axis}, by slices"
                found.append(Comparison(what, place, error, wanted, "a", note))
            if not note:
                found += self.chi_square(profile, density, expected, "against theory")
        law = "" if expected is None else self.legend()
        return Compared(expected, law, found, extra={"edges": profile.edges.copy()})

    def expected(self, edges: Array, kT: float) -> Array | None:
        """Number per volume in each slice, at a mean m v^2 along an axis; None without a theory."""
        section, box, slices = self.case.spheres, self.case.box, len(edges) - 1
        if any(not wall.closed_axes for wall in self.case.walls):
            return None
        if self.axis in self.closed:
            gas = self.state is not None and self.state.hard and kT > 0
            if not gas or any(kind.spread for kind, _ in self.kinds):
                return None
            shares = np.array([self._between_plates(edges, kT, kind) for kind, _ in self.kinds])
        else:
            fluid = section.fraction(box) < FREEZES[box.dimension]
            if self.pull[self.axis] or not (self.steady and fluid):
                return None
            shares = np.full((len(self.kinds), slices), 1 / slices)
        numbers = np.array([number for _, number in self.kinds])
        return np.asarray(numbers @ shares / (box.volume / slices))

    def _between_plates(self, edges: Array, kT: float, kind: SphereKind) -> Array:
        """Share of the spheres of a kind in each slice (slices,)."""
        box, pull = self.case.box, self.pull[self.axis]
        diameter = kind.diameter * self.case.spheres.scale(box)
        free, above = float(edges[-1]) - diameter, edges - diameter / 2
        if pull == 0:
            return np.diff(np.clip(above / free, 0.0, 1.0))
        scale = kT / (kind.mean_mass(box.dimension) * abs(pull))
        if pull < 0:
            return np.diff(theory.barometric_cdf(above, scale, free))
        return -np.diff(theory.barometric_cdf(free - above, scale, free))

    def note(self, density: Array) -> str:
        """Note on the error of the theory at a density (slices,)."""
        if self.axis not in self.closed:
            return ""
        filled = self.case.spheres.fraction(self.case.box) * float(density.max() / density.mean())
        return "approximate: ideal gas" if filled > DILUTE else ""

    def legend(self) -> str:
        if self.axis in self.closed:
            return "barometric law" if self.pull[self.axis] else "ideal gas"
        return "the same everywhere"


class FlowInSlices(Slices):
    """At rest, where nothing drives the spheres; along smooth walls they go on as they began."""

    answers = "velocity-profile"

    def __init__(self, find: Find, case: Case, observable: Any) -> None:
        super().__init__(find, case, observable)
        along = observable.component or ("y" if observable.axis == "x" else "x")
        self.component = case.box.index(along, "component")

    def warnings(self) -> Iterator[str]:
        yield from ()

    def compared(self, profile: ProfileAccumulator, velocity: Estimate, sums: Array) -> Compared:
        momentum, mass = profile.blocks.sums()[0].sum(axis=(0, 2))
        level = self.expected(self.component, float(momentum / mass) if mass > 0 else 0.0)
        if np.isnan(level):
            return Compared(None, "", [])
        expected, found = np.full(profile.bins, level), list[Comparison]()
        filled = np.isfinite(velocity.value[self.inside(profile.edges)]).all()
        if filled and profile.blocks.count:
            found = self.chi_square(profile, velocity, expected, "against the line")
        return Compared(expected, "rest" if level == 0 else "drift", found)

    def expected(self, component: int, found: float) -> float:
        """The velocity along an axis: 0, the mean `found` where nothing changes it, or nan."""
        if not (self.steady and still_walls(self.case)):
            return math.nan
        if component in self.closed:
            return 0.0
        if self.pull[component]:
            return math.nan
        rests = self._braked or not (self.case.walls or any(self.pull))
        return 0.0 if rests else found

    @property
    def _braked(self) -> bool:
        """True if a thermostat, walls or an energy source take momentum along walls."""
        rough = any(wall.closed_axes == () for wall in self.case.walls)
        warm = any(surface.rule == "diffuse" for surface in surfaces(self.case))
        collision, source = self.case.spheres.instant_collision, self.case.spheres.energy_source
        turning = collision is not None and collision.rough
        bath = source is not None and source.bath_kT is not None
        return self.case.spheres.thermostatted or rough or warm or turning or bath


class TemperatureInSlices(Slices):
    """The same everywhere in equilibrium."""

    answers = "temperature-profile"
    across = None  # no flow of spheres is expected to vary
    fewest = 20  # about their own mean few spheres are colder than they are

    @property
    def rests(self) -> bool:
        """True in equilibrium, where nothing flows."""
        return self.state is not None

    def compared(
        self, profile: ProfileAccumulator, temperature: Estimate, mean: Estimate, number: Array
    ) -> Compared:
        value, error = float(mean.value), float(mean.error)
        error = 0.0 if error < KEPT * value else error  # collisions keep it
        known = math.nan if self.state is None else self.state.kT
        found, expected = [Comparison("mean temperature", value, error, known, "m a^2/tau^2")], None
        level = value if self.state is not None and math.isnan(known) else known
        if not math.isnan(level):
            expected = np.full(profile.bins, level)
            found += self.chi_square(profile, temperature, expected, "against theory")
        return Compared(expected, "the same everywhere", found if profile.blocks.count else [])
