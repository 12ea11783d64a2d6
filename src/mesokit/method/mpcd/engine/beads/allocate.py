"""The memory of solutes: beads, bonds, lists, as compiled code takes them."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.method.mpcd.engine.beads.external import external_of
from mesokit.method.mpcd.engine.beads.neighbours import lists_of
from mesokit.method.mpcd.engine.beads.state import GROUP, Beads, KindsOfLinks
from mesokit.method.mpcd.solutes import Solutes
from mesokit.potential.several import Several

ROOM = 1.5  # times as many neighbours as beads packed as densely as spheres can be


def allocate_beads(given: Solutes, memory: Any) -> Beads:
    """Beads at rest at 0, and room for all that their steps need."""
    numbers, threads, beads = memory.numbers, memory.threads, given.beads
    case, d = numbers.case, numbers.dimension
    fluid = case.fluid
    bond_starts, bonds, of_bonds = _partners(given.bonds(), given.kinds_of_bonds(), beads)
    angle_starts, angles, of_angles = _roles(given.angles(), given.kinds_of_angles(), beads)
    kinds = KindsOfLinks(of_bonds, of_angles, given.kinds(), len(given.polymers))
    potentials = given.kernel(d, fluid)
    differ = any(isinstance(one, Several) for group in potentials[2:5] for one in group)
    terms = (0.0,) * (d + 1 + len(fluid.collision.own_sums(d)))
    return Beads(
        number=beads,
        mass=given.mass_per_bead(),
        potentials=potentials,
        kinds=kinds if differ else (),
        neighbours=_neighbours(given, numbers.box, numbers.closed, threads),
        r=np.zeros(beads * d),
        v=np.zeros(beads * d),
        bond_starts=bond_starts,
        bonds=bonds,
        angle_starts=angle_starts,
        angles=angles,
        near_wall=_near_wall(given, memory),
        faults=np.zeros((threads, 8), np.int64),
        cell=np.zeros(beads, np.int32),
        head=np.full(memory.number_of_cells, -1, np.int32),
        following=np.zeros(beads, np.int32),
        given=np.zeros(beads * len(terms)),
        terms=terms,
        answers=np.zeros(beads * numbers.coefficient_count),
        leads=np.zeros(beads, np.bool_),
        solvent=(fluid.density, fluid.mass) if given.solvent == "random" else (),
        tensor=np.zeros((3, -(-beads // GROUP), 2 * d * d), np.int64),
        embedded=(),
        external=external_of(given, d),
        halo=() if memory.domain is None else memory.domain.halo(given, len(terms)),
    )


def _near_wall(given: Solutes, memory: Any) -> tuple:
    """The solid as the potential of walls sees it, and how far that reaches."""
    if given.wall is None:
        return ()
    solid, solids = memory.physics.solid, memory.numbers.solids
    if memory.numbers.slit is None:
        assert solids is not None
        solid = solids.reaching(given.wall.reach)
    return solid, given.wall.reach


def _neighbours(given: Solutes, box: NDArray[Any], closed: tuple[bool, ...], threads: int) -> tuple:
    """Lists for the pair potential, if there is one."""
    if not given.different_pairs:
        return ()
    farthest = max(pair.reach for pair in given.different_pairs)
    d, beads, reach = len(box), given.beads, farthest + given.skin
    ball = math.pi * reach**2 if d == 2 else 4.0 / 3.0 * math.pi * reach**3
    most = min(beads, int(ROOM * ball / (0.7 * _room_of_one(given, d))) + 16)
    return (lists_of(reach, given.skin, beads, most, box, closed, threads),)


def _room_of_one(given: Solutes, d: int) -> float:
    """The mean room sigma^d of a bead, of kinds that feel others."""
    sizes = [max((p.diameter for p in row if p), default=0.0) for row in given.pairs]
    if len(given.different_pairs) == 1:
        return max(sizes) ** d
    weight = given.numbers() * (np.array(sizes) > 0)
    return float((weight * np.array(sizes) ** d).sum() / weight.sum())


def _partners(
    bonds: NDArray[np.int64], kinds: NDArray[np.int64], beads: int
) -> tuple[NDArray, NDArray, NDArray]:
    """Where the partners of each bead start (beads + 1,), the partners in order, and the kinds of
    these bonds."""
    both = np.concatenate([bonds, bonds[:, ::-1]])
    order = np.lexsort((both[:, 1], both[:, 0]))
    starts = _starts(both[:, 0], beads)
    return starts, both[order, 1].astype(np.int32), np.tile(kinds, 2)[order]


def _roles(
    angles: NDArray[np.int64], kinds: NDArray[np.int64], beads: int
) -> tuple[NDArray, NDArray, NDArray]:
    """The same for angles: their three beads, and which of them (0, 1, 2) the bead is."""
    rows = [np.column_stack([angles, np.full(len(angles), role)]) for role in range(3)]
    owner = np.concatenate([angles[:, role] for role in range(3)])
    every = np.concatenate(rows)
    order = np.lexsort((every[:, 3], every[:, 0], owner))
    table = np.ascontiguousarray(every[order], np.int32).reshape(-1, 4)
    return _starts(owner, beads), table, np.tile(kinds, 3)[order]


def _starts(owner: NDArray[np.int64], beads: int) -> NDArray[np.int32]:
    count = np.bincount(owner, minlength=beads)
    return np.concatenate([[0], np.cumsum(count)]).astype(np.int32)
