"""Load on the floor of a silo over the weight of its filling."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.method.spheres.common.observe.protocol import OfSpheres, gravity_axis
from mesokit.method.spheres.common.observe.shared.bed_surface import heights_of, horizontal
from mesokit.method.spheres.common.observe.wall_force import exact, surface_names
from mesokit.seam.engine import Array, RunningSpheres
from mesokit.seam.estimate import of_mean, of_ratio
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result, joined
from mesokit.statistics import Blocks

USUAL_RATIO = 0.5  # of horizontal over vertical stress
FROZEN = 1e-4  # relative error of a load that tells of one state alone


@component
class WallLoad(OfSpheres):
    """Vertical force on the floor over the weight of all grains, by the height of the filling.

    The height is twice the mean height of the centres: that of a level filling. With the `friction`
    of grains at the side walls the law of Janssen is beside it.
    """

    quantity: Literal["wall-load"] = tag("wall-load")
    value_label = "load on the floor over the weight"
    units: ClassVar[dict[str, str]] = {"height": "a"}
    floor: str | None = param(
        None, doc="name of the surface below (that of the plates unless said)", min_length=1
    )
    bins: int = param(20, doc="heights, from 0 to that of the box", ge=1, le=10_000)
    friction: float | None = param(
        None, doc="of grains at the side walls, for the law of Janssen", gt=0, le=100
    )
    ratio: float = param(
        USUAL_RATIO, doc="horizontal over vertical stress, for that law", gt=0, le=10
    )
    width: float | None = param(
        None,
        doc="between the side walls, or the diameter in 3D, for that law (the box along the first "
        "horizontal axis unless said)",
        unit="a",
        gt=0,
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without a floor below, and for a law without side walls."""
        pull = gravity_axis(case, "wall-load")
        names = surface_names(case)
        if self.floor is not None and self.floor not in names:
            allowed = ", ".join(names)
            raise CaseError(f"floor = {show(self.floor)}: expected one of {allowed}")
        if self.width is not None and self.friction is None:
            raise CaseError(f"width = {show(self.width)}: no effect without friction")
        if self.friction is not None and not has_sides(case):
            axis = case.box.axes[pull]
            raise CaseError(f"friction = {show(self.friction)}: no walls beside those of {axis}")


def has_sides(case: Case) -> bool:
    """Whether there are walls beside those of the axis of gravity."""
    return len(closed_axes(case)) > 1 or len(case.walls) > 1


@accumulator_of(WallLoad)
class WallLoadAccumulator(BlockAccumulator):
    """Block sums of load and weight in bins of the height, and of load, weight and height.

    `before` are time and momentum taken by the floor at the last sample.
    """

    memory: ClassVar[tuple[str, ...]] = ("blocks", "means", "before")

    def prepare(self) -> None:
        case, observable = self.case, self.observable
        self.pull, along = horizontal(case, None, "wall-load")
        self.gravity = float(case.spheres.gravity[self.pull])
        self.depth = float(case.box.size[self.pull])
        self.surface = self.below()
        given = observable.width
        self.width = float(case.box.size[along]) if given is None else given
        self.edges = np.linspace(0.0, self.depth, observable.bins + 1)
        self.blocks, self.means = Blocks((2, observable.bins)), Blocks((3,))
        self.before = np.full(2, np.nan)

    def below(self) -> int:
        """Number of the surface that is the floor."""
        names = surface_names(self.case)
        if self.observable.floor is not None:
            return names.index(self.observable.floor)
        first = 0
        for wall in self.case.walls:
            if self.case.box.axes[self.pull] in wall.closed_axes:
                return first if self.gravity < 0 else first + len(wall.surfaces()) - 1
            first += len(wall.surfaces())
        raise AssertionError  # which `check` has seen

    def observe(self, spheres: RunningSpheres) -> None:
        """Take one sample: of what the floor has taken since the last."""
        taken = float(spheres.wall_impulse[self.surface, self.pull])
        now, before = np.array([spheres.time, taken]), self.before
        self.before = now
        if not now[0] > before[0]:
            return
        load = float(np.sign(self.gravity) * (now - before)[1] / (now - before)[0])
        masses = spheres.masses()
        weight = abs(self.gravity) * float(masses.sum())
        height = 2 * float(np.average(heights_of(self.case, spheres, self.pull), weights=masses))
        place = int(
            np.clip(np.searchsorted(self.edges, height, "right") - 1, 0, len(self.edges) - 2)
        )
        sample = np.zeros(self.blocks.shape)
        sample[:, place] = load, weight
        self.blocks.add(sample)
        self.means.add([load, weight, height])

    def result(self) -> Result:
        """Load over weight, height by height, beside the law of Janssen."""
        sums, _ = self.blocks.sums()
        middle = 0.5 * (self.edges[1:] + self.edges[:-1])
        found = of_ratio(sums[:, 0], sums[:, 1])
        law = self.law(middle)
        return self.report(
            {"height": middle},
            (found.value, np.where(np.isnan(found.value), np.nan, found.error)),
            self.comparisons(),
            expected=law,
            theory="" if law is None else "Janssen",
            extra={"edges": self.edges.copy()},
        )

    def law(self, height: Array) -> Array | None:
        """Load over weight by Janssen; None without the friction of the walls."""
        mu, ratio = self.observable.friction, self.observable.ratio
        if mu is None:
            return None
        length = theory.janssen_length(self.width, mu, ratio, self.case.box.dimension)
        return theory.janssen_share(height, length)

    def comparisons(self) -> Iterator[Comparison]:
        """Mean load over weight, and the mean height of the filling."""
        found = of_mean(self.means)
        load, weight, height = found.value
        share = found.linear(np.array([[1 / weight, -load / weight**2, 0.0]]))
        law, note = self.law(np.array([height])), ""
        if law is not None:
            note = f"approximate: Janssen, with a stress ratio of {self.observable.ratio:g}"
        error = exact(share)[0]
        if has_sides(self.case) and load / weight - 1 > max(2 * error, FROZEN):
            note = joined(note, "side walls press the filling down, as after a fall")
        if error < FROZEN * abs(load / weight):
            note = joined(note, "of one filling at rest: those of other seeds differ by more")
        known = np.nan if law is None else float(law[0])
        what = "load on the floor over the weight"
        yield Comparison(what, load / weight, error, known, "", note)
        yield Comparison("height of the filling", *found.scalar(height, np.eye(3)[2]), unit="a")
