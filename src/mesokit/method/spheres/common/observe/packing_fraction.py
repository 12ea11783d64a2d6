"""Packing fraction of spheres: the part of a region that they fill."""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes, surfaces
from mesokit.method.spheres.common.observe.protocol import OfSpheres, pull_axis
from mesokit.method.spheres.common.observe.shared.cut_volumes import in_slabs, with_images
from mesokit.method.spheres.common.observe.wall_force import ROUNDING
from mesokit.method.spheres.common.region import check_region
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.estimate import Array
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks

SURFACE = 0.1  # of the grains, above the interior of a bed and below it


@component
class PackingFraction(OfSpheres):
    """Part of the space that disks or spheres fill, in slabs across an axis and in a region.

    What the edges of the region and of slabs cut off of a grain is left out: exactly, but for
    spheres that edges cut across two axes or three, which are good to 1e-4 of a sphere. Overlaps
    count twice, and space within solids counts as empty.
    """

    quantity: Literal["packing-fraction"] = tag("packing-fraction")
    drawing, value_label = "profile", "packing fraction"
    region: Either[None, tuple[float, float]] = param(
        None, doc="[from, to] along each axis (the whole box unless said)", unit="a"
    )
    axis: Axis | None = param(
        None, doc="axis across which the slabs lie (that of gravity, else y, unless said)"
    )
    bins: int = param(40, doc="slabs", ge=1, le=10_000)
    interior: bool = param(
        False,
        doc="also in the interior of a bed: of the region what lies above a tenth of the grains, "
        "and below another tenth",
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for a region outside the box, and an interior without gravity."""
        box = case.box
        if self.axis is not None and self.axis not in box.axes:
            raise CaseError(f"axis = {show(self.axis)}: expected one of {', '.join(box.axes)}")
        check_region(self.region, case)
        if self.interior and pull_axis(case) is None:
            raise CaseError("interior = true: expected gravity along one axis")


@accumulator_of(PackingFraction)
class PackingFractionAccumulator(BlockAccumulator):
    """Block averages of slabs, of the region and of the interior."""

    def prepare(self) -> None:
        case, observable = self.case, self.observable
        size = np.array(case.box.size, float)
        closed = closed_axes(case)
        self.period = np.where([k in closed for k in range(len(size))], 0.0, size)
        whole = np.stack([np.zeros_like(size), size], axis=1)
        self.region = whole if observable.region is None else np.array(observable.region, float)
        pull = pull_axis(case)
        usual = 1 if pull is None else pull
        self.axis = usual if observable.axis is None else AXES.index(observable.axis)
        self.edges = np.linspace(
            self.region[self.axis, 0], self.region[self.axis, 1], observable.bins + 1
        )
        self.pull = pull if observable.interior else None
        self.blocks = Blocks((observable.bins + 1 + observable.interior,))

    def observe(self, spheres: RunningSpheres) -> None:
        centres = spheres.positions()
        places, radius = with_images(centres, 0.5 * spheres.diameters(), self.period)
        filled = in_slabs(places, radius, self.region, self.axis, self.edges)
        volume = float(np.prod(self.region[:, 1] - self.region[:, 0]))
        sample = [*filled * (len(self.edges) - 1) / volume, filled.sum() / volume]
        if self.pull is not None:
            height, bounds = centres[:, self.pull], self.region.copy()
            middle = np.quantile(height, [SURFACE, 1 - SURFACE])
            bounds[self.pull] = np.clip(middle, *self.region[self.pull])
            size = float(np.prod(bounds[:, 1] - bounds[:, 0]))
            inside = in_slabs(places, radius, bounds, self.pull, bounds[self.pull])
            sample.append(float(inside.sum()) / size if size > 0 else np.nan)
        self.blocks.add(sample)

    def result(self) -> Result:
        """The profile, and the fractions of the region and of the interior."""
        value, error, bins = self.blocks.mean(), self.blocks.error(), len(self.edges) - 1
        axis = AXES[self.axis]
        return self.report(
            {axis: 0.5 * (self.edges[1:] + self.edges[:-1])},
            (value[:bins], error[:bins]),
            self.comparisons(value[bins:], error[bins:]),
            units={axis: "a"},
            extra={"edges": self.edges.copy()},
        )

    def comparisons(self, value: Array, error: Array) -> Iterator[Comparison]:
        """The fractions of the region and of the interior."""
        whole = self.observable.region is None
        what = f"packing fraction of the {'box' if whole else 'region'}"
        contacts = [face.contact for _, face, _ in surfaces(self.case)] if whole else []
        moved = any(contact is not None and contact.drives for contact in contacts)
        note = "space that plates have passed counts; plate-motion, of rigid grains, leaves it out"
        rounding = error[0] <= ROUNDING * value[0]
        yield Comparison(what, value[0], 0.0 if rounding else error[0], note=note if moved else "")
        if self.pull is not None:
            note = "between heights with a tenth of the grains below and a tenth above"
            yield Comparison("packing fraction of the interior", value[1], error[1], note=note)
