"""Solutes: monomers and polymers in the fluid, kind by kind, and the potentials of their beads."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, name_of, nearest, one_of, param, show
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.method.mpcd.fluid import Fluid
from mesokit.method.mpcd.molecule import MOST_SUBSTEPS, PHASE, Molecule
from mesokit.method.mpcd.solute.external import MagneticField, Pull, Trap
from mesokit.method.mpcd.solute.free import FreeMolecule
from mesokit.method.mpcd.solute.polymer import Between, Polymer
from mesokit.method.mpcd.start.section import Start
from mesokit.method.mpcd.topology import Links
from mesokit.potential import Angle, Bond, Pair
from mesokit.potential.several import several
from mesokit.potential.thermal import effective_radius, excluded_volume, stiffness


@component
class Solutes:
    """Beads in the fluid: they fly by molecular dynamics and take part in its collisions.

    `mass`, `bond`, `bending` and `pair` are those of all kinds that have none of their own. `pair`
    acts between any two beads, bonded ones too, `wall` between a bead and the nearest surface.
    Between kinds of different `pair` acts what `between` says, else the rule of Lorentz and
    Berthelot mixes the two: the mean of the diameters, the geometric mean of the energies; a kind
    without a pair potential acts on no other unless `between` has one. With
    `coupling = "potential"` beads take no part in the collisions. They push the particles of the
    fluid away, or attract them, by `solvent_pair` (Malevanets and Kapral 2000), so they have a
    size. With `solvent = "random"` there is no fluid: the beads of a cell collide with as many
    particles as it would hold, of a Maxwellian momentum that is forgotten (random-solvent MPCD;
    Kikuchi, Gent and Yeomans 2002, Ripoll, Winkler and Gompper 2007): friction and noise as in
    the fluid, but no hydrodynamics."""

    polymers: Many[Polymer] = param(doc="the kinds of molecules", min_length=1)
    mass: float = param(1.0, doc="mass of a bead", unit="m", ge=1e-3, le=1e6)
    bond: Bond | None = param(None, doc="potential of the bonds")
    bending: Angle | None = param(None, doc="stiffness of two bonds in a row (none unless said)")
    pair: Pair | None = param(None, doc="potential of any two beads (none unless said)")
    wall: Pair | None = param(
        None, doc="potential of a bead and the nearest surface, by their distance"
    )
    coupling: Literal["collision", "potential"] = param(
        "collision",
        doc="how beads and fluid act on one another: in its collisions, or by `solvent_pair`",
    )
    solvent_pair: Pair | None = param(
        None, doc="potential of a bead and any particle of the fluid, with coupling = 'potential'"
    )
    substeps: int | None = param(
        None,
        doc="sub-steps of velocity Verlet in a timestep (from the stiffest spring if none)",
        ge=1,
        le=MOST_SUBSTEPS,
    )
    skin: float = param(
        0.4,
        doc="by how much neighbour lists reach beyond potentials; with coupling = 'potential' also "
        "the farthest that a bead may go in a timestep",
        unit="a",
        gt=0,
        le=1e6,
    )
    start: Start = param(Start(), doc="first places and velocities of the beads (drawn)")
    solvent: Literal["fluid", "random"] = param(
        "fluid", doc="what the beads collide with; 'random': without hydrodynamics"
    )
    pulls: Many[Pull] = param((), doc="constant forces on chosen beads")
    traps: Many[Trap] = param((), doc="harmonic traps for chosen beads")
    magnetic: Many[MagneticField] = param((), doc="magnetic fields on chosen beads with a charge")
    between: Many[Between] = param(
        (), doc="pair potentials of two kinds (mixed by Lorentz and Berthelot unless said)"
    )

    def __post_init__(self) -> None:
        if (self.solvent_pair is not None) != (self.coupling == "potential"):
            if self.solvent_pair is None:
                raise ValueError("solvent_pair: missing; coupling = 'potential' needs it")
            raise ValueError("solvent_pair: only with coupling = 'potential'")
        for i, polymer in enumerate(self.polymers):
            if polymer.length > 1 and self.bond_of(i) is None:
                raise ValueError(
                    f"bond: missing; polymers[#{i + 1}].length = {polymer.length} needs one"
                )
        longest = max(polymer.length for polymer in self.polymers)
        if longest < 2 and self.bond is not None:
            raise ValueError("bond: only with polymers of length = 2 or more")
        if longest < 3 and self.bending is not None:
            raise ValueError("bending: only with polymers of length = 3 or more")
        for i in range(len(self.polymers)):
            try:
                self.molecule(i)
            except CaseError as error:
                words = str(error).removeprefix("Molecule.")
                raise ValueError(f"polymers[#{i + 1}].{words}") from None
        names = self.names
        for i, name in enumerate(names):
            if name in names[:i]:
                raise ValueError(
                    f"polymers[#{i + 1}].name = {name!r}: expected another than that of "
                    f"polymers[#{names.index(name) + 1}]"
                )
        seen = set()
        for n, between in enumerate(self.between):
            try:
                pair = frozenset(self.index_of(kind) for kind in between.kinds)
            except CaseError as error:
                raise ValueError(f"between[#{n + 1}].kinds: {error}") from None
            if len(pair) < 2:
                raise ValueError(
                    f"between[#{n + 1}].kinds = {show(between.kinds)}: expected two kinds; of one "
                    "kind it is its pair"
                )
            if pair in seen:
                raise ValueError(f"between[#{n + 1}].kinds = {show(between.kinds)}: said before")
            seen.add(pair)
        for i, j in itertools.combinations(range(len(self.polymers)), 2):
            one, other = self.own_pair(i), self.own_pair(j)
            if {i, j} in seen or one is None or other is None or self.pair_of(i, j) is not None:
                continue
            raise ValueError(
                f"between: missing; pair potentials of {names[i]!r} ({name_of(one)}) and "
                f"{names[j]!r} ({name_of(other)}) have no rule to mix them; expected "
                f"[[solutes.between]] with kinds = {show([names[i], names[j]])}"
            )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the kinds."""
        return tuple(p.name or f"polymer-{i}" for i, p in enumerate(self.polymers, start=1))

    def index_of(self, kind: int | str) -> int:
        """The place of a kind, given by its name or its number from 1, in `polymers`.

        Raises CaseError if there is none.
        """
        if isinstance(kind, str):
            if kind in self.names:
                return self.names.index(kind)
            raise CaseError(
                f"kind = {show(kind)}: expected {one_of(self.names)}{nearest(kind, self.names)}"
            )
        if not 1 <= kind <= len(self.polymers):
            raise CaseError(f"kind = {kind}: expected 1 to {len(self.polymers)} (solutes.polymers)")
        return kind - 1

    def mass_of(self, kind: int) -> float:
        """Of a bead of a kind."""
        own = self.polymers[kind].mass
        return self.mass if own is None else own

    def bond_of(self, kind: int) -> Bond | None:
        """Potential of the bonds of a kind; None for monomers."""
        polymer = self.polymers[kind]
        return (polymer.bond or self.bond) if polymer.length > 1 else None

    def bending_of(self, kind: int) -> Angle | None:
        """Potential of the angles of a kind, None if it has none."""
        polymer = self.polymers[kind]
        return (polymer.bending or self.bending) if polymer.length > 2 else None

    def own_pair(self, kind: int) -> Pair | None:
        """Potential of any two beads of a kind."""
        return self.polymers[kind].pair or self.pair

    def pair_of(self, one: int, other: int) -> Pair | None:
        """Potential of two beads, one of each kind; None if they do not feel one another."""
        mine, theirs = self.own_pair(one), self.own_pair(other)
        for between in self.between:
            if {self.index_of(kind) for kind in between.kinds} == {one, other}:
                return between.pair
        if mine is None or theirs is None or mine == theirs:
            return mine if theirs is not None else None
        return mine.mixed(theirs)

    @functools.cached_property
    def pairs(self) -> tuple[tuple[Pair | None, ...], ...]:
        """Those of all kinds with all."""
        kinds = range(len(self.polymers))
        return tuple(tuple(self.pair_of(i, j) for j in kinds) for i in kinds)

    @property
    def different_pairs(self) -> tuple[Pair, ...]:
        """Each pair potential once."""
        return tuple(dict.fromkeys(p for row in self.pairs for p in row if p is not None))

    def ideal(self, kind: int) -> bool:
        """True if its beads feel others only by bonds."""
        return not any(self.pairs[kind])

    def molecule(self, kind: int) -> Molecule | None:
        """A kind as a molecule of its own; None for monomers."""
        given = self.polymers[kind], self.bending_of(kind), self.own_pair(kind)
        bond = self.bond_of(kind)
        return None if bond is None else _molecule(bond, *given)

    @property
    def beads(self) -> int:
        """Number of all beads."""
        return sum(polymer.number * polymer.length for polymer in self.polymers)

    def first_bead(self, kind: int) -> int:
        """Beads of all kinds before this one."""
        return sum(polymer.number * polymer.length for polymer in self.polymers[:kind])

    def excluded_volume(self, dimension: int, kT: float) -> float:
        """Volume that a bead alone takes from the fluid (cells); 0 if it only collides with it."""
        pair = self.solvent_pair
        return excluded_volume(pair.kernel(), dimension, kT, pair.reach) if pair else 0.0

    def radius(self, kT: float) -> float:
        """Radius of the hard sphere that a bead is for the fluid; 0 if it only collides."""
        pair = self.solvent_pair
        return effective_radius(pair.kernel(), kT, pair.reach) if pair else 0.0

    def numbers(self) -> NDArray[np.int64]:
        """Beads of each kind."""
        return np.array([polymer.number * polymer.length for polymer in self.polymers])

    def kinds(self) -> NDArray[np.int64]:
        """The kind of each bead: its place in `polymers`."""
        return np.repeat(np.arange(len(self.polymers)), self.numbers())

    @functools.cached_property
    def masses(self) -> tuple[float, ...]:
        """Of a bead of each kind."""
        return tuple(self.mass_of(kind) for kind in range(len(self.polymers)))

    def mass_per_bead(self) -> float | NDArray[np.float64]:
        """Of each bead (beads,), or of all if they are equal."""
        first, *others = self.masses
        return first if {first, *others} == {first} else np.array(self.masses)[self.kinds()]

    def sum_over_mass(self, part: Callable[[float], float]) -> float:
        """Sum over all beads of what follows from the mass of one."""
        found = dict.fromkeys(self.masses, 0)
        for mass, number in zip(self.masses, self.numbers().tolist(), strict=True):
            found[mass] += number
        return sum(number * part(mass) for mass, number in found.items())

    @property
    def total_mass(self) -> float:
        """Of all beads."""
        return self.sum_over_mass(lambda mass: mass)

    def frequency(self, dimension: int, kT: float, lightest: float) -> float:
        """Angular frequency of the fastest motion in a fluid whose lightest particle has this mass.

        Bonds and other potentials, traps and the turning in magnetic fields count.
        """
        molecules = [(self.molecule(kind), mass) for kind, mass in enumerate(self.masses)]
        found = [m.frequency(dimension, kT, mass) for m, mass in molecules if m is not None]
        for i, row in enumerate(self.pairs):
            for j, pair in enumerate(row[: i + 1]):
                if pair is not None:
                    square = stiffness((pair.kernel(),), kT, pair.reach)
                    one, other = self.masses[i], self.masses[j]
                    both = 2.0 * square / one if one == other else square * (1 / one + 1 / other)
                    found.append(math.sqrt(both))
        if self.wall is not None:
            square = stiffness((self.wall.kernel(),), kT, self.wall.reach)
            found.append(math.sqrt(2.0 * square / min(self.masses)))
        if self.solvent_pair is not None:
            square = stiffness((self.solvent_pair.kernel(),), kT, self.solvent_pair.reach)
            found.append(math.sqrt(square * (1.0 / min(self.masses) + 1.0 / lightest)))
        found += [math.sqrt(trap.k / self.masses[self.index_of(trap.kind)]) for trap in self.traps]
        turning = np.zeros((self.beads if self.magnetic else 1, 3))  # q B/m of each bead
        for magnetic in self.magnetic:
            mass = self.masses[self.index_of(magnetic.kind)]
            turning[magnetic.beads(self)] += magnetic.charge / mass * np.array(magnetic.field)
        return max([*found, float(np.linalg.norm(turning, axis=1).max())])

    def needed_substeps(self, dimension: int, fluid: Fluid) -> int:
        """So many that the fastest motion turns by PHASE in each."""
        lightest = min(kind.mass for kind in fluid.kinds)
        turns = self.frequency(dimension, fluid.kT, lightest) * fluid.timestep
        return max(1, math.ceil(turns / PHASE))

    def number_of_substeps(self, dimension: int, fluid: Fluid) -> int:
        """Those given, or those that it needs."""
        return self.substeps or self.needed_substeps(dimension, fluid)

    def bonds(self) -> NDArray[np.int64]:
        """Beads (bonds, 2) that are linked, counted from the first bead."""
        return self._all(lambda molecule: molecule.bonds, 2)[0]

    def angles(self) -> NDArray[np.int64]:
        """Beads (angles, 3), the second of which two bonds share; none without stiffness."""
        return self._all(stiff_angles, 3)[0]

    def kinds_of_bonds(self) -> NDArray[np.int64]:
        """The kind of molecules that each of `bonds` belongs to."""
        return self._all(lambda molecule: molecule.bonds, 2)[1]

    def kinds_of_angles(self) -> NDArray[np.int64]:
        """The same of `angles`."""
        return self._all(stiff_angles, 3)[1]

    def _all(
        self, links: Callable[[Molecule], Links], columns: int
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        found, kinds = [np.zeros((0, columns), np.int64)], [np.zeros(0, np.int64)]
        for kind, polymer in enumerate(self.polymers):
            molecule, first = self.molecule(kind), self.first_bead(kind)
            if molecule is not None:
                own = np.array(links(molecule), np.int64).reshape(-1, columns)
                starts = first + polymer.length * np.arange(polymer.number)
                found.append((starts[:, None, None] + own).reshape(-1, columns))
                kinds.append(np.full(len(found[-1]), kind))
        return np.concatenate(found), np.concatenate(kinds)

    def kernel(self, dimension: int, fluid: Fluid) -> Potentials:
        """Parameters for compiled code."""
        every = range(len(self.polymers))
        return Potentials(
            1.0 / max(self.masses),
            self.number_of_substeps(dimension, fluid),
            _kernels([self.bond_of(kind) for kind in every]),
            _kernels([self.bending_of(kind) for kind in every]),
            _kernels([pair for row in self.pairs for pair in row], all_of_them=True),
            tuple(p.kernel() for p in (self.wall,) if p is not None),
        )


def stiff_angles(molecule: Molecule) -> Links:
    """The angles of a molecule that have a potential."""
    return molecule.angles if molecule.bending is not None else ()


def _kernels(potentials: Sequence[Any], all_of_them: bool = False) -> tuple[Any, ...]:
    """The only potential, Several that differ, or () where there is none.

    `all_of_them`: None is a potential too, namely no force.
    """
    kernels = [None if p is None else p.kernel() for p in potentials]
    given = {(type(one), one): one for one in kernels if one is not None or all_of_them}
    if set(given.values()) <= {None}:
        return ()
    return tuple(given.values()) if len(given) == 1 else (several(kernels),)


class Potentials(NamedTuple):
    """Potentials that act on beads: (potential,) or () for each of bond, angle, pair and wall.

    Where kinds of solutes differ it is (Several,). inverse_mass is that of beads of one mass.
    """

    inverse_mass: float
    substeps: int
    bond: tuple
    angle: tuple
    pair: tuple
    wall: tuple


@functools.lru_cache(maxsize=64)
def _molecule(bond: Bond, polymer: Polymer, bending: Angle | None, pair: Pair | None) -> Molecule:
    if polymer.topology == "free":
        return FreeMolecule(
            topology="free",
            length=polymer.length,
            bond=bond,
            bending=bending if polymer.angles else None,
            pair=pair,
            linked=polymer.pairs_of_beads,
            bent=polymer.triples_of_beads,
        )
    return Molecule(
        topology=polymer.topology,
        length=polymer.length,
        arms=polymer.arms,
        bond=bond,
        bending=bending if polymer.length > 2 else None,
        pair=pair,
    )
