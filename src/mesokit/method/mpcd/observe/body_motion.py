"""Equipartition of bodies: how fast they move and turn beside the fluid."""

from collections.abc import Iterator
from itertools import chain
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.method.mpcd.columns import holds, total_mass
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import Followed, every_kind
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined
from mesokit.statistics import Blocks

COUNTED = ("second hits", "put back", "still hitting")


@component
class BodyMotion(Observable):
    """Mean squares of velocity and angular velocity of bodies over those of equipartition.

    They are <V^2> M/(d kT), and <Omega_i^2> I_i/kT about each axis of the body. Where the momentum
    of all is zero, the first is 1 - M/M_all. Beside them stand the kinetic temperature of the
    fluid, and in a step how many particles hit a body twice, had to be put back
    out of one, or still hit in the last round of hits. With flow, drift or swimming these are
    included, and there is no theory. What is fixed or hinged is left out. Of bodies in a trap
    there is also the mean square distance from it along each axis, beside kT/k.
    """

    quantity: Literal["body-motion"] = tag("body-motion")
    value_label = "mean square over equipartition"

    def check(self, case: Case) -> None:
        """Raise CaseError without bodies."""
        every_kind(case, self.quantity)


@accumulator_of(BodyMotion)
class BodyMotionAccumulator(BlockAccumulator):
    """Means of the fluid, and over the bodies of each kind."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "distances")

    def prepare(self) -> None:
        case, self.dimension = self.case, self.case.box.dimension
        self.kinds = every_kind(case, self.observable.quantity)
        self.axes = [2] if self.dimension == 2 else [0, 1, 2]
        # temperature of the fluid, counts, and numbers of each kind
        self.blocks = Blocks((1 + len(COUNTED) + len(self.kinds) * (1 + len(self.axes)),))
        self.held = [one for one in self.kinds if one.held]
        axes = sum(len(one.moving) for one in self.held)
        self.distances = Blocks((axes,)) if axes else None
        self.shared_momentum = not (case.walls or holds(case))

    def observe(self, fluid: Any) -> None:
        bodies, kT = fluid.bodies, self.case.fluid.kT
        v, spins = bodies.velocities, bodies.in_own_frame(bodies.spins)
        counts = bodies.counts()
        row = [self._warmth(fluid), *(counts[name] for name in COUNTED)]
        for one in self.kinds:
            freely = max(len(one.moving), 1)
            square = (v[one.rows] ** 2).sum(axis=1) * one.mass / (freely * kT)
            turning = (spins[one.rows] @ one.axes) ** 2 * one.moments / kT
            row += [square.mean(), *turning.mean(axis=0)[self.axes]]
        self.blocks.add(row)
        if self.distances is not None:
            self.distances.add(self._square_distances(bodies))

    def _square_distances(self, bodies: Any) -> Array:
        """Mean square distances of bodies from their traps, along each axis, kind after kind."""
        away, size = bodies.places(unwrapped=True) - bodies.homes, np.array(self.case.box.size)
        square = (away - size * np.rint(away / size)) ** 2
        found = [square[one.rows][:, list(one.moving)].mean(axis=0) for one in self.held]
        return np.concatenate(found)

    def _warmth(self, fluid: Any) -> float:
        """Kinetic temperature of what is no body: at rest, if the momentum of all is shared."""
        number, _, energy = fluid.totals()
        own, of_bodies = number - fluid.bodies.number, float(fluid.bodies.motion()[-1])
        free = float(own)
        if self.shared_momentum:
            mass = total_mass(self.case, number)
            free -= 1.0 - float(fluid.bodies.masses.sum()) / mass
        return (2.0 * energy - of_bodies) / (self.dimension * max(free, 1.0))

    def result(self) -> Result:
        value, error = self.blocks.mean(), self.blocks.error()
        of_fluid = value[: 1 + len(COUNTED)], error[: 1 + len(COUNTED)]
        value, error = (a[1 + len(COUNTED) :].reshape(len(self.kinds), -1) for a in (value, error))
        expected, width = np.stack([self._expected(one) for one in self.kinds]), value.shape[1]
        driven = [
            [not one.thermal and self._free(one, i) for i in range(width)] for one in self.kinds
        ]
        known = np.isfinite(expected) | np.array(driven)
        about = [""] if self.dimension == 2 else [f" about {axis}" for axis in AXES]
        names = ["velocity", *(f"angular velocity{axis}" for axis in about)]
        return self.report(
            {"kind": [one.name for one in self.kinds], "of": names},
            (np.where(known, value, np.nan), np.where(known, error, np.nan)),
            chain(
                self.of_kinds(names, value, error, expected),
                self.of_traps(),
                self.of_fluid(*of_fluid),
            ),
            expected=expected,
            theory="equipartition",
        )

    def _free(self, one: Followed, i: int) -> bool:
        """Whether the fluid moves bodies of a kind, or turns them about the ith axis, from 1."""
        if i == 0:
            return bool(one.moving)
        return bool(one.turning) and self.axes[i - 1] not in one.untouched

    def _expected(self, one: Followed) -> Array:
        """Of a kind: nan where it does not move or turn freely, or something drives it."""
        found = np.full(1 + len(self.axes), np.nan)
        if one.thermal and one.moving:
            found[0] = one.free_share
        if one.thermal and one.turning:
            found[1:] = [np.nan if k in one.untouched else 1.0 for k in self.axes]
        return found

    def of_kinds(
        self, names: list[str], value: Array, error: Array, expected: Array
    ) -> Iterator[Comparison]:
        why = self.driven()
        for k, one in enumerate(self.kinds):
            for i, name in enumerate(names):
                if np.isfinite(expected[k, i]) or (self._free(one, i) and not one.thermal):
                    found, known = float(value[k, i]), float(expected[k, i])
                    scatter = one.with_start(float(error[k, i]), known, self.blocks.series)
                    unit = "kT/I" if i else f"{len(one.moving)} kT/M"
                    what = f"mean square {name} of {one.name}"
                    yield Comparison(what, found, scatter, known, unit, why)

    def of_traps(self) -> Iterator[Comparison]:
        """How far bodies are from their traps."""
        if self.distances is None:
            return
        mean, error = self.distances.mean().tolist(), self.distances.error().tolist()
        places = [(one, axis) for one in self.held for axis in one.moving]
        for k, (one, axis) in enumerate(places):
            known, note = one.trapped_square()
            what = f"mean square distance along {AXES[axis]} from the trap of {one.name}"
            scatter = one.with_start(error[k], known, self.distances.series)
            yield Comparison(what, mean[k], scatter, known, "a^2", joined(note, self.driven()))

    def driven(self) -> str:
        """Why there is no equipartition; "" where there is."""
        besides = setting.motion_besides(self.case)
        return f"no equipartition: {besides} included" if besides else ""

    def of_fluid(self, mean: Array, spread: Array) -> Iterator[Comparison]:
        at_rest = not setting.driven(self.case)
        kT = float(self.case.fluid.kT) if at_rest else np.nan
        scatter = self.kinds[0].with_start(float(spread[0]), kT, self.blocks.series)
        what, unit = "temperature of the fluid", "m a^2/tau^2"
        yield Comparison(what, float(mean[0]), scatter, kT, unit, self.driven())
        for k, name in enumerate(COUNTED, start=1):
            yield Comparison(f"{name} in a step", float(mean[k]), float(spread[k]), np.nan)
