"""Solutes: monomers and polymers that live in the fluid, as heavy as they are told to be."""

from __future__ import annotations

import functools
import math
from typing import Literal, NamedTuple

import numpy as np

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.method.mpcd import topology as links
from mesokit.method.mpcd.molecule import MOST_SUBSTEPS, PHASE, Molecule
from mesokit.method.mpcd.start.section import Start
from mesokit.potential import Angle, Bond, Pair
from mesokit.potential.thermal import stiffness

Topology = links.Topology


@component
class Polymer:
    """One kind of solute: so many molecules of so many beads; single beads are monomers."""

    number: int = param(1, doc="molecules of this kind", ge=1)
    length: int = param(1, doc="beads of a molecule; 1: monomers", ge=1, le=1000)
    topology: Topology = param("chain", doc="how the beads are linked")
    arms: int | None = param(None, doc="arms of a star, all of one length", ge=1)


@component
class Solutes:
    """Beads in the fluid: they fly by molecular dynamics and take part in its collisions.

    All beads have one mass and the same potentials. `pair` acts between any two of them, bonded
    ones too, `wall` between a bead and the nearest surface. With `solvent = "random"` there is no
    fluid: the beads of a cell collide with as many particles as it would hold, of a Maxwellian
    momentum that is forgotten (random-solvent MPCD; Kikuchi, Gent and Yeomans 2002, Ripoll, Winkler
    and Gompper 2007): friction and noise as in the fluid, but no hydrodynamics.
    """

    polymers: Many[Polymer] = param(doc="the kinds of molecules", min_length=1)
    mass: float = param(1.0, doc="mass of a bead", unit="m", ge=1e-3, le=1e6)
    bond: Bond | None = param(None, doc="potential of the bonds")
    bending: Angle | None = param(None, doc="stiffness of two bonds in a row (none unless said)")
    pair: Pair | None = param(None, doc="potential of any two beads (none unless said)")
    wall: Pair | None = param(
        None, doc="potential of a bead and the nearest surface, by their distance"
    )
    substeps: int | None = param(
        None,
        doc="sub-steps of velocity Verlet in a timestep (from the stiffest spring if none)",
        ge=1,
        le=MOST_SUBSTEPS,
    )
    skin: float = param(
        0.4,
        doc="by how much neighbour lists reach beyond the pair potential",
        unit="a",
        gt=0,
        le=1e6,
    )
    start: Start = param(Start(), doc="first places and velocities of the beads (drawn)")
    solvent: Literal["fluid", "random"] = param(
        "fluid", doc="what the beads collide with; 'random': without hydrodynamics"
    )

    def __post_init__(self) -> None:
        long = [i for i, polymer in enumerate(self.polymers) if polymer.length > 1]
        if long and self.bond is None:
            raise ValueError(
                f"bond: missing; polymers[#{long[0] + 1}].length = "
                f"{self.polymers[long[0]].length} needs one"
            )
        if not long and self.bond is not None:
            raise ValueError("bond: only with polymers of length = 2 or more")
        if self.bending is not None and max(p.length for p in self.polymers) < 3:
            raise ValueError("bending: only with polymers of length = 3 or more")
        for i, polymer in enumerate(self.polymers):
            if polymer.length == 1 and (polymer.topology != "chain" or polymer.arms is not None):
                raise ValueError(
                    f"polymers[#{i + 1}].topology = {polymer.topology!r}: a monomer is a chain"
                )
            try:
                self.molecule(i)
            except CaseError as error:
                words = str(error).removeprefix("Molecule.")
                raise ValueError(f"polymers[#{i + 1}].{words}") from None

    def molecule(self, kind: int) -> Molecule | None:
        """A kind as a molecule of its own; None for monomers."""
        polymer = self.polymers[kind]
        if polymer.length == 1 or self.bond is None:
            return None
        return _molecule(polymer, self.bond, self.bending, self.pair)

    @property
    def beads(self) -> int:
        """Number of all beads."""
        return sum(polymer.number * polymer.length for polymer in self.polymers)

    def first_bead(self, kind: int) -> int:
        """Beads of all kinds before this one."""
        return sum(polymer.number * polymer.length for polymer in self.polymers[:kind])

    def frequency(self, dimension: int, kT: float) -> float:
        """Angular frequency of the fastest oscillation."""
        kinds = [self.molecule(i) for i in range(len(self.polymers))]
        found = [m.frequency(dimension, kT, self.mass) for m in kinds if m is not None]
        for potential in (self.pair, self.wall):
            if potential is not None:
                square = stiffness((potential.kernel(),), kT, potential.reach)
                found.append(math.sqrt(2.0 * square / self.mass))
        return max(found, default=0.0)

    def needed_substeps(self, dimension: int, timestep: float, kT: float) -> int:
        """So many that the fastest oscillation turns by PHASE in each."""
        return max(1, math.ceil(self.frequency(dimension, kT) * timestep / PHASE))

    def number_of_substeps(self, dimension: int, timestep: float, kT: float) -> int:
        """Those given, or those that it needs."""
        return self.substeps or self.needed_substeps(dimension, timestep, kT)

    def bonds(self) -> np.ndarray:
        """Beads (bonds, 2) that are linked, counted from the first bead."""
        return self._all("bonds", 2)

    def angles(self) -> np.ndarray:
        """Beads (angles, 3), the second of which two bonds share; none without stiffness."""
        return self._all("angles", 3) if self.bending is not None else np.zeros((0, 3), np.int64)

    def _all(self, name: str, columns: int) -> np.ndarray:
        found = [np.zeros((0, columns), np.int64)]
        for kind, polymer in enumerate(self.polymers):
            molecule, first = self.molecule(kind), self.first_bead(kind)
            if molecule is not None:
                own = np.array(getattr(molecule, name), np.int64).reshape(-1, columns)
                starts = first + polymer.length * np.arange(polymer.number)
                found.append((starts[:, None, None] + own).reshape(-1, columns))
        return np.concatenate(found)

    def kernel(self, dimension: int, timestep: float, kT: float) -> Potentials:
        """Parameters for compiled code."""
        return Potentials(
            1.0 / self.mass,
            self.number_of_substeps(dimension, timestep, kT),
            tuple(p.kernel() for p in (self.bond,) if p is not None),
            tuple(p.kernel() for p in (self.bending,) if p is not None),
            tuple(p.kernel() for p in (self.pair,) if p is not None),
            tuple(p.kernel() for p in (self.wall,) if p is not None),
        )


class Potentials(NamedTuple):
    """What beads feel: (potential,) or () for each of bond, angle, pair and wall."""

    inverse_mass: float
    substeps: int
    bond: tuple
    angle: tuple
    pair: tuple
    wall: tuple


@functools.lru_cache(maxsize=64)
def _molecule(polymer: Polymer, bond: Bond, bending: Angle | None, pair: Pair | None) -> Molecule:
    return Molecule(
        topology=polymer.topology,
        length=polymer.length,
        arms=polymer.arms,
        bond=bond,
        bending=bending if polymer.length > 2 else None,
        pair=pair,
    )
