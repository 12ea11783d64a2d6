"""The section of a case on a lattice."""

from __future__ import annotations

from typing import Literal

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

    @property
    def lattice(self) -> Kind:
        """Neighbours and places of its sites."""
        return KINDS[self.kind]


class Sections:
    """The section of a case on a lattice beside those of every case."""

    lattice: Lattice = param(Lattice(), doc="the lattice")
