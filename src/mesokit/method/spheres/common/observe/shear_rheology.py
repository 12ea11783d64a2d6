"""Rheology of a sheared bed: stress ratio and packing fraction against the inertial number."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.walls import closed_axes
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.method.spheres.common.observe.shared.cut_volumes import in_slabs, whole, with_images
from mesokit.seam.engine import Array, RunningSpheres
from mesokit.seam.estimate import Estimate, of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import NOT_STEADY, Comparison, Result, joined
from mesokit.statistics import Blocks

USUAL_MARGIN = 2.0  # mean diameters
WIDEST = 0.45  # of the bed: a margin
DRIFTS = 5.0  # standard errors between both halves of the samples: the flow still changes
DENSE = 0.3  # inertial number up to which flow is dense
RATE, SHEAR, PRESSURE, FRACTION, LOW, HIGH = COLUMNS = range(6)
LAWS = {2: "da Cruz et al., disks of friction 0.4", 3: "Jop et al., glass beads"}


@component
class ShearRheology(OfSpheres):
    """Shear rate, stress and packing fraction of a bed in simple shear, and its mu(I).

    Between plates that slide, pressure and shear stress are the forces on both plates over their
    area; in a box with Lees-Edwards shear they are those of motion and of contacts in the whole
    box, at the samples. The pressure is that on planes across the gradient. The shear rate is the
    slope of a straight line through the velocities, plates' surroundings aside. The bed reaches
    from the lowest to the highest point of its grains.
    """

    quantity: Literal["shear-rheology"] = tag("shear-rheology")
    drawing = "profile"
    axis: Axis | None = param(
        None, doc="axis of the gradient: that of the plates, unless several axes have plates"
    )
    component: Axis | None = param(None, doc="axis of the flow (x, or y across x, unless said)")
    margin: float | None = param(
        None,
        doc="layer at each plate that counts neither for the shear rate nor for the packing "
        "fraction (two mean diameters unless said)",
        unit="a",
        ge=0,
    )
    bins: int = param(20, doc="slices of the velocity profile", ge=2, le=10_000)

    def check(self, case: Case) -> None:
        """Raise CaseError unless something may shear the bed."""
        for key in ("axis", "component"):
            if (given := getattr(self, key)) is not None and given not in case.box.axes:
                allowed = ", ".join(case.box.axes)
                raise CaseError(f"{key} = {show(given)}: expected one of {allowed}")
        across, along = self.axes(case)
        if across == along:
            raise CaseError(f"component = {show(self.component)}: expected another axis than axis")
        if self.margin is not None and 2 * self.margin >= case.box.size[across]:
            raise CaseError(
                f"margin = {show(self.margin)}: expected less than half of the box along "
                f"{AXES[across]}, {0.5 * case.box.size[across]:g}"
            )

    def axes(self, case: Case) -> tuple[int, int]:
        """The axes of the gradient and of the flow. Raises CaseError without plates or shear."""
        if case.box.sheared:
            if self.axis not in (None, "y") or self.component not in (None, "x"):
                raise CaseError("axis: under Lees-Edwards shear flow is along x, its gradient y")
            return 1, 0
        closed = [wall.axis for wall in case.walls if isinstance(wall, Plates)]
        if not closed or (self.axis is not None and self.axis not in closed):
            raise CaseError("shear-rheology: expected plates across the gradient, or box.shear")
        if self.axis is None and len(closed) > 1:
            raise CaseError(f"axis: expected one of {', '.join(closed)}, which all have plates")
        across = AXES.index(self.axis or closed[0])
        usual = 1 if across == 0 else 0
        return across, usual if self.component is None else AXES.index(self.component)


@accumulator_of(ShearRheology)
class ShearRheologyAccumulator(BlockAccumulator):
    """Block averages of shear rate, shear stress, pressure, packing fraction and of both ends of
    the bed, and of momentum and mass in slices.

    `before` are time and momentum taken by both plates at the last sample, `grain` the mean
    diameter and the density of grains.
    """

    memory: ClassVar[tuple[str, ...]] = ("blocks", "profile", "before", "grain")

    def prepare(self) -> None:
        case, observable = self.case, self.observable
        self.across, self.along = observable.axes(case)
        size = np.array(case.box.size, float)
        self.depth, self.area = size[self.across], float(np.prod(size) / size[self.across])
        closed = closed_axes(case)
        self.period = np.where([k in closed for k in range(len(size))], 0.0, size)
        self.plates = None if case.box.sheared else self.surfaces()
        self.edges = np.linspace(0.0, self.depth, observable.bins + 1)
        self.blocks, self.profile = Blocks((len(COLUMNS),)), Blocks((2, observable.bins))
        self.before, self.grain = np.full(5, np.nan), np.full(2, np.nan)

    def surfaces(self) -> tuple[int, int]:
        """Numbers of the lower and the upper plate among all surfaces."""
        first = 0
        for wall in self.case.walls:
            if isinstance(wall, Plates) and AXES.index(wall.axis) == self.across:
                return first, first + 1
            first += len(wall.surfaces())
        raise AssertionError  # which `check` has seen

    def inner(self, low: float, high: float) -> tuple[float, float]:
        """Where the layers at both plates end, in a bed between two heights."""
        margin = self.observable.margin
        if margin is None:
            margin = 0.0 if self.plates is None else USUAL_MARGIN * float(self.grain[0])
        margin = min(margin, WIDEST * (high - low))
        return low + margin, high - margin

    def observe(self, spheres: RunningSpheres) -> None:
        """Take one sample; on plates of what they have taken since the last."""
        d, diameters, masses = spheres.dimension, spheres.diameters(), spheres.masses()
        volumes = whole(0.5 * diameters, d)
        self.grain = np.array([diameters.mean(), masses.sum() / volumes.sum()])
        if (stress := self.stress(spheres)) is None:
            return
        places, v = spheres.positions(), spheres.velocities()[:, self.along]
        height, ends = places[:, self.across], (0.0, self.depth)
        if self.plates is not None:  # which may have moved towards each other
            floor, top = (height - 0.5 * diameters).min(), (height + 0.5 * diameters).max()
            ends = max(0.0, float(floor)), min(self.depth, float(top))
        low, high = self.inner(*ends)
        inner = (height >= low) & (height <= high)
        rate = slope(height[inner], v[inner], masses[inner])
        region = np.stack([np.zeros(d), self.case.box.size], axis=1)
        around = with_images(places, 0.5 * diameters, self.period)
        edges = np.array([low, high])
        filled = float(in_slabs(*around, region, self.across, edges)[0])
        self.blocks.add([rate, *stress, filled / (self.area * (high - low)), *ends])
        cell = np.clip(np.searchsorted(self.edges, height, "right") - 1, 0, len(self.edges) - 2)
        count = len(self.edges) - 1
        self.profile.add(
            np.stack([np.bincount(cell, masses * v, count), np.bincount(cell, masses, count)])
        )

    def stress(self, spheres: RunningSpheres) -> tuple[float, float] | None:
        """Shear stress, positive with the shear rate, and pressure; None at the first sample of
        forces on plates."""
        k, j = self.across, self.along
        if self.plates is None:
            parts = spheres.stress  # type: ignore[attr-defined]  # of methods with box.shear
            found = sum(parts[name] for name in ("kinetic", "pair"))
            return 0.5 * float(found[j, k] + found[k, j]), -float(found[k, k])
        taken = spheres.wall_impulse[list(self.plates)][:, [j, k]]
        now = np.array([spheres.time, *taken.ravel()])
        before, self.before = self.before, now
        if not now[0] > before[0]:
            return None
        forces = ((now - before)[1:] / (now[0] - before[0])).reshape(2, 2)
        (low_shear, low_normal), (up_shear, up_normal) = forces / (2 * self.area)
        return float(low_shear - up_shear), float(up_normal - low_normal)

    def result(self) -> Result:
        """The velocity profile with the mean shear rate, and what follows for mu(I)."""
        sums, _ = self.profile.sums()
        velocity = of_ratio(sums[:, 0], sums[:, 1])
        middle, fit = 0.5 * (self.edges[1:] + self.edges[:-1]), None
        if self.blocks.count:
            mean = self.blocks.mean()
            low, high = self.inner(float(mean[LOW]), float(mean[HIGH]))
            known = (middle > low) & (middle < high) & np.isfinite(velocity.value)
            if known.any():
                start = float(np.mean(velocity.value[known]))
                line = start + mean[RATE] * (middle - middle[known].mean())
                fit = np.where(known, line, np.nan)
        axis, letter = AXES[self.across], AXES[self.along]
        return self.report(
            {axis: middle},
            velocity,
            self.comparisons(of_mean(self.blocks)),
            fit=fit,
            label=f"velocity $v_{letter}$",
            units={"value": "a/tau", axis: "a"},
            extra={"edges": self.edges.copy(), "component": letter},
        )

    def comparisons(self, found: Estimate) -> Iterator[Comparison]:
        """Shear rate, stress, stress ratio, inertial number and packing fraction."""
        d, (rate, shear, pressure, fraction, low, high) = self.case.box.dimension, found.value
        unit, one = "m/tau^2" if d == 2 else "m/(a tau^2)", np.eye(len(COLUMNS))
        sign = math.copysign(1.0, rate)
        nominal, note = self.nominal(high - low)
        early = self.early()
        found_rate = found.scalar(rate, one[RATE])
        yield Comparison("shear rate", *found_rate, nominal, "1/tau", joined(early, note))
        stress = found.scalar(sign * shear, sign * one[SHEAR])
        yield Comparison("shear stress", *stress, unit=unit)
        yield Comparison("pressure", *found.scalar(pressure, one[PRESSURE]), unit=unit)
        law, inertial, (size, density) = "", math.nan, map(float, self.grain)
        if pressure > 0:
            inertial = float(theory.inertial_number(rate, pressure, size, density, d))
            ratio = abs(inertial / rate) if rate else 0.0
            gradient = sign * ratio * one[RATE] - 0.5 * inertial / pressure * one[PRESSURE]
            yield Comparison("inertial number", *found.scalar(inertial, gradient))
            if 0 < inertial <= DENSE:
                law = joined(early, f"approximate: {LAWS[d]}")
            known = math.nan
            if law:
                laws = theory.friction_of_disks, theory.friction_of_spheres
                known = float(laws[d - 2](inertial))
            friction = sign * shear / pressure
            gradient = sign / pressure * one[SHEAR] - friction / pressure * one[PRESSURE]
            over = pressure, one[PRESSURE]
            measured = found.scalar(friction, gradient, over)
            yield Comparison("shear stress over pressure", *measured, known, "", law)
        known = float(theory.fraction_of_disks(inertial)) if law and d == 2 else math.nan
        measured = found.scalar(fraction, one[FRACTION])
        yield Comparison("packing fraction", *measured, known, "", law if d == 2 else "")
        if self.plates is not None:
            depth = found.scalar(high - low, one[HIGH] - one[LOW])
            yield Comparison("depth of the bed", *depth, unit="a")

    def early(self) -> str:
        """A note if the shear rate of both halves of the samples differs by more than chance."""
        halves = self.blocks.halves()
        if not halves:
            return ""
        first, second = (float(half.mean()[RATE]) for half in halves)
        error = math.hypot(*(float(half.error()[RATE]) for half in halves))
        drifts = abs(second - first) > DRIFTS * error
        return f"{NOT_STEADY}: the flow builds up" if drifts else ""

    def nominal(self, depth: float) -> tuple[float, str]:
        """The shear rate that is imposed on a bed so deep, and what it neglects."""
        box = self.case.box
        if self.plates is None:
            return (float(box.shear_rate), "") if box.shear_rate else (math.nan, "")
        for wall in self.case.walls:
            if isinstance(wall, Plates) and AXES.index(wall.axis) == self.across:
                low, up = ((s.velocity or (0.0,) * 3)[self.along] for s in (wall.lower, wall.upper))
                rate = (up - low) / depth
                return (
                    (rate, "approximate: no slip, and shear even across")
                    if rate
                    else (math.nan, "")
                )
        return math.nan, ""


def slope(x: Array, y: Array, weight: Array) -> float:
    """Slope of the straight line through y(x) by weighted least squares; nan for one place.

    >>> slope(np.array([0.0, 1, 2]), np.array([1.0, 3, 5]), np.ones(3))
    2.0
    """
    if not len(x):
        return math.nan
    away = x - np.average(x, weights=weight)
    square = float(weight @ (away * away))
    return float((weight * away) @ y) / square if square > 0 else math.nan
