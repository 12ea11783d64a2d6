"""Molecules: fluid particles that are linked by springs, which makes the fluid viscoelastic."""

from __future__ import annotations

import functools
import math
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param
from mesokit.method.mpcd import topology as links
from mesokit.potential import Angle, Bond, Pair
from mesokit.potential.thermal import mean_square, stiffness
from mesokit.scalar.pointer import address

PHASE = 0.15  # of the fastest oscillation in a sub-step: springs read (PHASE/2)^2 = 0.6 % too long
COARSE = 0.7  # beyond this phase they read 12 % too long, which is a warning
UNSTABLE = 2.0  # from this phase on velocity Verlet blows up

MOST_SUBSTEPS = 100_000
FLUID = "fluid"  # names the molecules of the fluid among kinds of molecules


@component
class Molecule:
    """Chains, rings or stars of beads and bonds: every particle of the fluid is a bead of one."""

    topology: links.Topology = param("chain", doc="how the beads are linked")
    length: int = param(2, doc="beads of a molecule", symbol="N", ge=2, le=1000)
    arms: int | None = param(None, doc="arms of a star, all of one length", ge=1)
    bond: Bond = param(doc="potential of the bonds")
    bending: Angle | None = param(None, doc="stiffness of two bonds in a row (none unless said)")
    pair: Pair | None = param(
        None, doc="potential of any two beads of one molecule, bonded ones too (none unless said)"
    )
    substeps: int | None = param(
        None,
        doc="sub-steps of velocity Verlet in a timestep (from the stiffest spring if none)",
        ge=1,
        le=MOST_SUBSTEPS,
    )
    propagation: Literal["verlet", "exact"] = param(
        "verlet", doc='"exact": closed form, for harmonic dimers'
    )
    conformation: Literal["thermal", "octant"] = param(
        "thermal", doc='how molecules start; "octant": all bonds in the positive octant'
    )

    def __post_init__(self) -> None:
        if self.topology == "free" and type(self) is Molecule:
            raise ValueError("topology = 'free': only of solutes.polymers, with bonds")
        if self.topology == "ring" and self.length < 3:
            raise ValueError(f"length = {self.length}: a ring has at least 3 beads")
        if self.topology != "star":
            if self.arms is not None:
                raise ValueError(f"arms = {self.arms}: only with topology = 'star'")
        elif self.arms is None:
            raise ValueError("arms: missing; a star needs their number")
        elif (self.length - 1) % self.arms:
            arm = max(1, round((self.length - 1) / self.arms))
            raise ValueError(
                f"length = {self.length}: a star of {self.arms} equal arms has a centre and "
                f"{self.arms} times as many beads; the nearest is {1 + arm * self.arms}"
            )
        if self.propagation == "exact":
            key = "propagation = 'exact'"
            if self.length != 2 or self.bond.spring() is None:
                raise ValueError(
                    f"{key}: only for length = 2 and a spring without a length of its own, such "
                    "as bond.rule = 'harmonic'"
                )
            for name in ("bending", "pair", "substeps"):
                if getattr(self, name) is not None:
                    raise ValueError(f"{key}: not with {name}; leave it out")
        if self.conformation == "octant":
            key = "conformation = 'octant'"
            if self.topology == "ring":
                raise ValueError(f"{key}: bonds that all point one way close no ring")
            if self.bending is not None:
                raise ValueError(f"{key}: not with bending; its bonds know nothing of angles")

    @property
    def bonds(self) -> links.Links:
        """Pairs of beads that are linked."""
        return links.bonds(self.topology, self.length, self.arms or 1)

    @property
    def angles(self) -> links.Links:
        """Triples of beads, the second of which two bonds share."""
        return links.angles(self.topology, self.length, self.arms or 1)

    @property
    def bond_potentials(self) -> tuple[Any, ...]:
        """Parameters of all that acts between bonded beads."""
        return tuple(p.kernel() for p in (self.bond, self.pair) if p is not None)

    def mean_square_bond(self, dimension: int, kT: float) -> float | None:
        """Mean square length of a bond at rest; None where beads that are not bonded matter."""
        if self.topology == "ring" and (self.bond.spring() is None or self.bending):
            return None
        if self.pair is not None and self.length > 2:
            return None
        square = mean_square(self.bond_potentials, dimension, kT, self.bond.longest)
        return square * (1.0 - 1.0 / self.length) if self.topology == "ring" else square

    @functools.lru_cache(maxsize=64)  # noqa: B019  of few molecules, which are values
    def frequency(self, dimension: int, kT: float, mass: float) -> float:
        """Angular frequency of the fastest oscillation."""
        bond, longest = self.bond_potentials, self.bond.longest
        square = stiffness(bond, kT, longest) * links.stiffest_mode(self.bonds, self.length)
        if self.bending is not None:  # four neighbours at most move against a bead
            size = mean_square(bond, dimension, kT, longest)
            square += 16.0 * self.bending.stiffness / size
        if self.pair is not None and self.length > 2:
            square += 4.0 * stiffness((self.pair.kernel(),), kT, self.pair.reach)
        return math.sqrt(square / mass)

    def phase(self, dimension: int, timestep: float, kT: float, mass: float) -> float:
        """Of the fastest oscillation in one sub-step, in radians."""
        return self.frequency(dimension, kT, mass) * timestep / (self.substeps or 1)

    def number_of_substeps(self, dimension: int, timestep: float, kT: float, mass: float) -> int:
        """Those given, or those that it needs."""
        return self.substeps or self.needed_substeps(dimension, timestep, kT, mass)

    def needed_substeps(self, dimension: int, timestep: float, kT: float, mass: float) -> int:
        """So many that the fastest oscillation turns by PHASE in each."""
        return max(1, math.ceil(self.frequency(dimension, kT, mass) * timestep / PHASE))

    def kernel(
        self, dimension: int, timestep: float, kT: float, mass: float
    ) -> tuple[Springs | Dimers, NDArray[np.int64]]:
        """Parameters for compiled code, and the table in them that must be kept."""
        if self.propagation == "exact":
            spring = self.bond.spring()
            assert spring is not None  # as `__post_init__` has checked
            omega = 2.0 * math.sqrt(spring.K / mass)
            cosine, sine = math.cos(omega * timestep), math.sin(omega * timestep)
            swing = sine * cosine / omega
            dimers = Dimers(
                beads=2,
                cosine=cosine,
                late=sine / omega,
                early=-sine * omega,
                separations=-spring.K * (timestep + swing),
                mixed=-spring.K * (sine / omega) ** 2,
                rates=-spring.K * (timestep - swing) / omega**2,
            )
            return dimers, np.zeros(0, np.int64)
        bends = self.angles if self.bending is not None else ()
        pairs = links.pairs(self.length) if self.pair is not None else ()
        numbers = [k for kind in (self.bonds, bends, pairs) for link in kind for k in link]
        table = np.array(numbers, np.int64)
        kernel = Springs(
            self.length,
            self.number_of_substeps(dimension, timestep, kT, mass),
            1.0 / mass,
            address(table),
            (len(self.bonds), len(bends), len(pairs)),
            self.bond.kernel(),
            (self.bending.kernel(),) if self.bending is not None else (),
            (self.pair.kernel(),) if self.pair is not None else (),
        )
        return kernel, table


class Dimers(NamedTuple):
    """Harmonic dimers in closed form, for the vector r between the two beads and its rate v.

    After a timestep r is cosine r + late v, and v is early r + cosine v. The bond has handed over
    the momentum ways r r + mixed (r v + v r) + rates v v by then.
    """

    beads: int
    cosine: float
    late: float
    early: float
    separations: float
    mixed: float
    rates: float


class Springs(NamedTuple):
    """Molecules that are moved by velocity Verlet.

    links: address of bead numbers, as int64: two for each bond, three for each angle, two for each
    pair; `number` of each of these. angle, pair: (potential,) or ().
    """

    beads: int
    substeps: int
    inverse_mass: float
    links: int
    number: tuple[int, int, int]
    bond: tuple
    angle: tuple
    pair: tuple
