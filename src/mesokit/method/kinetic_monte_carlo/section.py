"""The section of a case on a lattice."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator

from mesokit.case.box import AXES, Axis
from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.method.kinetic_monte_carlo.engine.select import Selection
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS, Kind
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.protocol import Model
from mesokit.method.kinetic_monte_carlo.start import LatticeStart, RandomStart, UniformStart

Name = Literal["chain", "square", "triangular", "honeycomb", "cubic", "bcc", "fcc"]


@component
class Sublattices:
    """Blocks of the lattice that go on at the same time, on threads (Shim and Amar 2005).

    Each block is cut into sectors, two along each axis; one sector of all blocks is at work at a
    time, for a cycle. The shorter the cycle, the closer to exact.
    """

    block: int | None = param(
        None, doc="sites along an axis of a block (1024, 64 or 32 in 1, 2 or 3 dimensions)", gt=0
    )
    cycle: float | None = param(
        None, doc="time of a cycle (half of the mean wait at the fastest site)", gt=0, le=1e300
    )

    def of(self, dimension: int) -> int:
        """Sites along an axis of a block."""
        return self.block or {1: 1024, 2: 64, 3: 32}[dimension]


@component
class Lattice:
    """A lattice of as many sites along each axis as the box is long, and what happens there.

    Events happen one after the other, each at its own time; a step of the run is a slice of time.
    """

    kind: Name = param("square", doc="how sites are arranged")
    ends: Many[Axis] = param((), doc="axes along which the lattice ends (periodic unless said)")
    timestep: float = param(1.0, doc="time of a step of the run", gt=0, le=1e300)
    model: Model = param(Ising(), doc="what may happen at the sites")
    select: Selection = param(
        "auto", doc="how the next event is chosen; all ways draw the same law"
    )
    sublattices: Sublattices | None = param(
        None, doc="blocks on threads; without them one thread does exact events"
    )
    start: LatticeStart | None = param(
        None, doc="states that the sites start in (random, or heights 0, unless said)"
    )

    def first(self) -> LatticeStart:
        """The start, whether it is said or not."""
        if self.start is not None:
            return self.start
        return RandomStart() if self.model.states() else UniformStart()

    @field_validator("ends")
    @classmethod
    def _each_axis_once(cls, axes: tuple[Axis, ...]) -> tuple[Axis, ...]:
        return tuple(axis for axis in AXES if axis in axes)

    def cycle(self, rates: NDArray[np.float64]) -> float:
        """A cycle of sublattices, by the rates of a site."""
        given = self.sublattices.cycle if self.sublattices is not None else None
        return given or 0.5 / float(rates.max())

    @property
    def lattice(self) -> Kind:
        """Neighbours and places of its sites."""
        return KINDS[self.kind]


class Sections:
    """The section of a case on a lattice beside those of every case."""

    lattice: Lattice = param(Lattice(), doc="the lattice")
