"""Force of spheres on the walls."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.estimate import Array, Estimate, of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks

ROUNDING = 1e-12  # of a force
STILL = 1e-3  # of the weight that their momentum may grow by in a unit of time


def surface_names(case: Case) -> tuple[str, ...]:
    """Names of surfaces, wall by wall."""
    names = []
    for i, wall in enumerate(case.walls):
        name, keys = wall.name or f"{type(wall).__name__.lower()}-{i + 1}", wall.surfaces()
        names += [f"{name}-{key}" if len(keys) > 1 else name for key in keys]
    return tuple(names)


@component
class WallForce(OfSpheres):
    """Mean force on each surface, and of all of them beside the weight of the spheres.

    It is the momentum that spheres give to a surface per time.
    """

    quantity: Literal["wall-force"] = tag("wall-force")
    value_label = "force on a surface"
    units: ClassVar[dict[str, str]] = {"value": "m a/tau^2", "surface": "", "component": ""}

    def check(self, case: Case) -> None:
        """Raise CaseError without a wall."""
        if not case.walls:
            raise CaseError("wall-force needs a [[wall]]")


@accumulator_of(WallForce)
class WallForceAccumulator(BlockAccumulator):
    """Block averages of what surfaces take between two samples, of the mass of all spheres, and of
    the momentum that they gain meanwhile."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "before")

    def prepare(self) -> None:
        self.names, d = surface_names(self.case), self.case.box.dimension
        self.taken = len(self.names) * d
        self.blocks = Blocks((self.taken + 1 + d,))
        self.before = np.full(1 + self.taken + d, np.nan)  # time, momentum taken and there so far

    def observe(self, spheres: RunningSpheres) -> None:
        """Take one sample: of what has been taken since the last."""
        now = np.array([spheres.time, *spheres.wall_impulse.ravel(), *spheres.totals()[1]])
        if now[0] > self.before[0]:
            rates = (now - self.before)[1:] / (now[0] - self.before[0])
            self.blocks.add(np.insert(rates, self.taken, spheres.masses().sum()))
        self.before = now

    def result(self) -> Result:
        """Forces, and their sum along the axis of gravity."""
        axes = self.case.box.axes
        forces = self.forces() if self.blocks.count else of_mean(self.blocks)
        shape = len(self.names), len(axes)
        return self.report(
            {"surface": self.names, "component": axes},
            (forces.value[: self.taken].reshape(shape), exact(forces)[: self.taken].reshape(shape)),
            self.comparisons(forces),
        )

    def steady(self, axis: int) -> bool:
        """True if the spheres gain no momentum along an axis, but for chance."""
        found, section = of_mean(self.blocks), self.case.spheres
        mass, gained = self.taken, self.taken + 1 + axis
        g = section.gravity[axis] if section.gravity else 0.0
        least = max(float(found.error[gained]), STILL * float(found.value[mass]) * abs(g))
        return abs(float(found.value[gained])) <= least

    def forces(self) -> Estimate:
        """All means of the blocks; forces with the momentum that spheres gained by chance.

        What a surface has not taken by the end of the run is still in the spheres. Of several
        surfaces each has the share by which its force falls as the momentum grows.
        """
        found, d = of_mean(self.blocks), self.case.box.dimension
        matrix = np.eye(len(found.value))
        for k in filter(self.steady, range(d)):
            gained = found.residuals[:, self.taken + 1 + k]
            if (square := float(gained @ gained)) > 0:
                chosen = np.arange(k, self.taken, d)
                shares = -(found.residuals[:, chosen].T @ gained) / square
                matrix[chosen, self.taken + 1 + k] = shares
        return found.linear(matrix)

    def comparisons(self, forces: Estimate) -> Iterator[Comparison]:
        """The force on all walls along each axis of gravity: the weight, if the spheres gain no
        momentum on average."""
        box, mass = self.case.box, float(forces.value[self.taken])
        for k, (axis, g) in enumerate(zip(box.axes, self.case.spheres.gravity, strict=False)):
            if g:
                chosen = np.zeros((1, len(forces.value)))
                chosen[0, k : self.taken : box.dimension] = 1.0
                total = forces.linear(chosen)
                note = "approximate: they gain momentum meanwhile"
                if self.steady(k):
                    note = "the weight; with the momentum that spheres gained by chance"
                what, error = f"force on all walls along {axis}", exact(total)[0]
                yield Comparison(what, total.value[0], error, mass * g, "m a/tau^2", note)


def exact(found: Estimate) -> Array:
    """Standard errors, 0 where they are rounding."""
    error = found.error
    return np.where(error <= ROUNDING * np.abs(found.value), 0.0, error)
