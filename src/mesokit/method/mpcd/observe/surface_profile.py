"""Density, temperature or speed as a function of the distance from the nearest solid."""

import functools
import math
from typing import Literal

import numpy as np

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import FINE, solids_of
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.observe.shared.shells import Array, ShellAccumulator, shell_volumes
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Comparison, Result

LABELS = {
    "temperature": ("temperature k_B T", "m a^2/tau^2"),
    "speed": ("speed along the surface", "a/tau"),
}


@component
class SurfaceProfile(Observable):
    """Density, temperature or speed in shells about the solids, bins finer than a cell.

    A shell holds all places at one distance from the nearest solid; its volume is found from the
    solids' shapes, so that the density of a uniform fluid is uniform up to the surface. The speed
    is that along the surface, in the direction in which the flow passes it; in 2D, where no force
    drives a flow, counter-clockwise about the solid.
    """

    quantity: Literal["surface-profile"] = tag("surface-profile")
    drawing = "profile"
    of: Literal["density", "temperature", "speed"] = param(
        "density", doc="what: 'density', 'temperature' or 'speed'"
    )
    depth: float = param(3.0, doc="largest distance from the surface", unit="a", gt=0)
    bins_per_cell: int = param(8, doc="shells per cell", ge=1)
    solid: str | None = param(None, doc="name of a solid: only where that is nearest (any)")
    flow: Axis | None = param(
        None, doc="axis of the flow, for the speed (that of the force unless said)"
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without walls, for an unknown solid, or a speed along nothing."""
        if not case.walls:
            raise CaseError("surface-profile needs a [[wall]]")
        names = solids_of(case).names
        if self.solid is not None and self.solid not in names:
            raise CaseError(f"solid = {show(self.solid)}: expected one of {', '.join(names)}")
        if self.flow is not None:
            case.box.index(self.flow, "flow")
            if self.of != "speed":
                raise CaseError(f"flow: no effect with of = {self.of!r}; leave it out")
        elif self.of == "speed" and case.box.dimension == 3 and setting.driven_axis(case) is None:
            raise CaseError(
                "flow: missing; no force drives the fluid along one axis, so say which is that of "
                "the speed"
            )


@accumulator_of(SurfaceProfile)
class SurfaceProfileAccumulator(ShellAccumulator):
    """Sums in shells; velocities are out of the surface, along it, and across both (3D)."""

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        solids = solids_of(case)
        self.look = solids.depths(observable.depth)
        self.body = None if observable.solid is None else solids.names.index(observable.solid)
        driven = setting.driven_axis(case)
        self.flow = AXES.index(observable.flow) if observable.flow else driven
        self.prepare_shells(0.0, observable.depth)

    def locate(self, r: Array) -> tuple[Array, Array]:
        body, distance, normal = self.look(r)
        # rounding may put a particle on a surface just behind it
        seen = body >= 0 if self.body is None else body == self.body
        return np.where(seen, np.maximum(distance, 0.0), np.inf), normal

    def along(self, place: Array, v: Array) -> Array:
        out, d = place, self.dimension
        if self.flow is None and d == 2:
            tangent = np.stack([-out[:, 1], out[:, 0]], axis=1)
        else:
            axis = self.flow or 0
            tangent = -out[:, [axis]] * out
            tangent[:, axis] += 1.0
            tangent /= np.maximum(np.sqrt((tangent**2).sum(axis=1)), 1e-12)[:, None]
        frame = [out, tangent] + ([np.cross(out, tangent)] if d == 3 else [])
        return np.stack([(direction * v).sum(axis=1) for direction in frame])

    def result(self) -> Result:
        of, expected = self.observable.of, self.expected()
        found: list[Comparison] = []
        value = {
            "density": lambda: self.density(self.volumes),
            "temperature": self.temperature,
            "speed": lambda: self.velocity(1),
        }[of]()
        label, unit = LABELS.get(of, (of, self.case.box.density_unit))
        note = self.note()
        if expected is not None and self.blocks.count and np.isfinite(value.value).all():
            found = [self.next_to_surface(value, expected, unit, note)]
            if not note:
                found += self.chi_square(value, expected, "against theory")
        return self.report(
            {"distance": self.centres},
            value,
            found,
            label=label,
            units={"value": unit, "distance": "a"},
            expected=expected,
            theory={"density": "ideal gas", "temperature": "kT of the case"}.get(of, "rest")
            + (", approximate" if note else ""),
            extra={"of": of, "edges": self.edges},
        )

    def note(self) -> str:
        """Reason for which theory is off by more than an error bar, "" where it is not."""
        of, driven = self.observable.of, setting.driven(self.case)
        if of == "temperature":
            if driven:
                return "approximate: counts how the flow varies along the surface"
            return setting.temperature_note(self.case)
        if of == "density" and driven:
            return "approximate: the pressure of the flow varies along the surface"
        return ""

    def expected(self) -> Array | None:
        fluid, driven = self.case.fluid, setting.driven(self.case)
        if self.observable.of == "density":
            return np.full(self.bins, fluid.density)
        if self.observable.of == "temperature":
            return np.full(self.bins, fluid.kT) if setting.at_kT(self.case) else None
        return None if driven else np.zeros(self.bins)

    def next_to_surface(self, value: Estimate, expected: Array, unit: str, note: str) -> Comparison:
        """The mean of the cell next to the surface: over its volume, or its particles."""
        first = self.edges[1:] <= 1.0 + 1e-9
        if not first.any():
            first = np.arange(self.bins) == 0
        parts = self.volumes if self.observable.of == "density" else self.crowd
        weight = np.where(first, parts, 0.0) / parts[first].sum()
        mean, error = value.total(weight)
        known, of = float(weight @ expected), self.observable.of
        if of == "temperature":
            error = setting.with_start(self.case, error, known, self.blocks.series)
        what = f"{of} in the cell at the surface"
        return Comparison(what, mean, error, known, unit, note)

    @functools.cached_property
    def volumes(self) -> Array:
        """Volume of each shell, from cubes of a fraction of a cell near the surface."""
        fine = 4 * FINE if self.dimension == 2 else 2 * FINE
        size = np.array(self.case.box.size)
        corners = np.stack(np.meshgrid(*map(np.arange, size), indexing="ij"), -1)
        corners = corners.reshape(-1, self.dimension)
        reach = 0.5 * math.sqrt(self.dimension)
        look = solids_of(self.case).depths(self.observable.depth + 2 * reach)
        far = np.abs(look(corners + 0.5)[1]) > self.observable.depth + reach
        steps = (np.arange(fine) + 0.5) / fine
        cubes = np.stack(np.meshgrid(*[steps] * self.dimension, indexing="ij"), -1)
        cubes, total = cubes.reshape(-1, self.dimension), np.zeros(self.bins)
        near = corners[~far].astype(float)
        for first in range(0, len(near), 256):
            points = (near[first : first + 256, None] + cubes).reshape(-1, self.dimension)
            body, distance, _ = look(points)
            share = np.ones(len(points)) if self.body is None else 1.0 * (body == self.body)
            total += shell_volumes(self.edges, distance, share, 1 / fine, self.dimension)
        return total
