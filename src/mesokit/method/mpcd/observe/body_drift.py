"""Mean velocity and mean angular velocity of bodies, and how easily a force moves them."""

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY, followed
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


@component
class BodyDrift(Observable):
    """Mean velocity and mean angular velocity of a kind of bodies, along the axes of the box.

    Also the mean of the velocity along each body's own axis x, by which swimmers swim. Over a
    constant force along an axis of the box the velocity is the mobility, and over a torque the
    angular velocity is that of rotation. What is fixed, or held by a trap, has neither.
    """

    quantity: Literal["body-drift"] = tag("body-drift")
    drawing, value_label = "body drift", "mean velocity"
    kind: int | str = param(1, doc=KIND_OF_BODY)

    def check(self, case: Case) -> None:
        """Raise CaseError without such bodies."""
        followed(case, self.quantity, self.kind)


@accumulator_of(BodyDrift)
class BodyDriftAccumulator(BlockAccumulator):
    """Means over all bodies of the kind."""

    def prepare(self) -> None:
        d = self.dimension = self.case.box.dimension
        self.of = followed(self.case, self.observable.quantity, self.observable.kind)
        self.turning = [2] if d == 2 else [0, 1, 2]
        self.blocks = Blocks((d + 1 + len(self.turning),))

    def observe(self, fluid: Any) -> None:
        bodies, rows = fluid.bodies, self.of.rows
        v, spins = bodies.velocities[rows], bodies.spins[rows][:, self.turning]
        along = (v * bodies.headings[rows]).sum(axis=1)
        self.blocks.add([*v.mean(axis=0), along.mean(), *spins.mean(axis=0)])

    def result(self) -> Result:
        along = [f"velocity along {axis}" for axis in AXES[: self.dimension]]
        about = [f"angular velocity about {AXES[k]}" for k in self.turning]
        names = [*along, "velocity along its own axis", *about]
        short = [*(f"v{a}" for a in AXES[: self.dimension]), "own axis", *(
            f"spin {AXES[k]}" for k in self.turning)]  # fmt: skip
        return self.report(
            {"component": short},
            self.blocks,
            self.comparisons(names),
            label=f"mean velocity of {self.of.name}",
            units={name: self._unit(k) for k, name in enumerate(short)},
        )

    def _unit(self, k: int) -> str:
        return "a/tau" if k <= self.dimension else "1/tau"

    def _held(self, k: int) -> str:
        """Why the mean of a component is 0: what is fixed, across a hinge, or held by a trap."""
        kind, d, trap = self.of.kind, self.dimension, self.of.kind.trap
        if k == d:
            return "" if self.of.moving else "fixed"
        if k < d:
            held = "held by a trap" if trap is not None and trap.k > 0 else ""
            return "fixed" if AXES[k] in kind.fixed else held
        axis = self.turning[k - d - 1]
        across = kind.hinge is not None and d == 3 and not kind.hinge[axis]
        if across or "orientation" in kind.fixed:
            return "fixed"
        direction = (1.0, 0.0, 0.0) if trap is None or trap.direction is None else trap.direction
        turns_freely = trap is None or trap.angular == 0 or (d == 3 and bool(direction[axis]))
        return "" if turns_freely else "held by a trap"

    def comparisons(self, names: list[str]) -> Iterator[Comparison]:
        mean, error = self.blocks.mean().tolist(), self.blocks.error().tolist()
        rest = np.nan if setting.driven(self.case) else 0.0
        for k, name in enumerate(names):
            known, why = (rest, "") if k != self.dimension else self.of.swimming_speed()
            known, why = (0.0, self._held(k)) if self._held(k) else (known, why)
            known = rest if np.isnan(known) else known
            if k > self.dimension and self.of.untouched == (0, 1, 2) and not why:
                known, why = np.nan, "as it started: no hit turns it"
            yield Comparison(name, mean[k], error[k], known, self._unit(k), why)
        kind, d = self.of.kind, self.dimension
        if kind.frame == "body" or kind.counter is not None:
            return
        torque = np.atleast_1d(kind.torque if kind.torque is not None else 0.0)
        for k, force in enumerate(kind.force or ()):
            if force and not self._held(k):
                what, (known, why) = f"mobility along {AXES[k]}", self.of.mobility()
                found = mean[k] / force, error[k] / abs(force)
                yield Comparison(what, *found, known, "tau/m", why)
        for k, size in enumerate(torque[: len(self.turning)].tolist()):
            if size and not self._held(d + 1 + k):
                what = f"rotational mobility about {AXES[self.turning[k]]}"
                known, why = self.of.rotational_mobility()
                found = mean[d + 1 + k] / size, error[d + 1 + k] / abs(size)
                yield Comparison(what, *found, known, "tau/(m a^2)", why)
