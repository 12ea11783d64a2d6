"""How solutes lie at the start: grown bead by bead where there is room, so that none overlap.

Every bond is drawn with the length and the angle of the temperature, a number at a time, and the
first whose end has room is taken; a molecule that comes to a dead end begins anew (self-avoiding
growth after Rosenbluth and Rosenbluth 1955). Rings start as regular polygons.
"""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.solute.free import FreeMolecule, phantom
from mesokit.method.mpcd.solutes import Solutes
from mesokit.method.mpcd.start.conformation import first_bonds, nearest_of, turned
from mesokit.method.mpcd.start.draws import Draws
from mesokit.scalar.random import INITIAL_SOLUTES

Floats = NDArray[np.float64]
InFluid = Callable[[Floats], NDArray[np.bool_]]
TRIES = 1000  # to place one molecule
AT_ONCE = 32  # candidates for the place of a bead
POOL = 4096  # bonds drawn at once, from which candidates are taken
FIRST_OF_POOLS = 2**60  # the number of the first of these bonds; molecules are numbered from 0


def grown(
    solutes: Solutes, kT: float, box: Floats, periods: Floats, seed: int, in_fluid: InFluid
) -> Floats:
    """Places (beads, d) of all solutes, molecules whole: bonds may leave the box.

    Parameters
    ----------
    box, periods : arrays (d,)
        Lengths of the box, and those after which it repeats, infinite where walls close it.
    seed : int
        Of the run; each molecule draws by its number.
    in_fluid : function
        Which of places (n, d) are in the fluid.

    Raises RunError where there is no room.
    """
    limits = np.array(  # how near two beads may start to one another
        [
            [nearest_of(p.kernel(), kT) if p is not None else 0.0 for p in row]
            for row in solutes.pairs
        ]
    )
    there, before = Placed(solutes.kinds(), box, periods, limits), 0
    # Molecule by molecule, in the order of ids, each among those that are already there. Random
    # numbers follow from the seed and the molecule.
    for kind, polymer in enumerate(solutes.polymers):
        molecule = solutes.molecule(kind)
        pool = np.zeros((1, len(box)))
        if molecule:
            first = FIRST_OF_POOLS + POOL * kind
            draws = Draws(seed, INITIAL_SOLUTES, np.arange(first, first + POOL))
            pool = first_bonds(molecule, kT, len(box), draws)
            if molecule.bending is not None:  # bonds that follow one along x
                pool = turned(molecule, np.tile(np.eye(len(box))[0], (POOL, 1)), pool, kT, draws)
        for number in range(polymer.number):
            random = Draws(seed, INITIAL_SOLUTES, [before + number])
            if not _place(there, molecule, pool, kT, random, in_fluid):
                raise RunError(
                    f"solutes.polymers[#{kind + 1}].number = {polymer.number}: no place for "
                    f"molecule {number + 1} in {TRIES} tries; expected fewer or smaller molecules, "
                    "or a larger box"
                )
        before += polymer.number
    return there.places


def _place(
    there: Placed,
    molecule: Molecule | None,
    pool: Floats,
    kT: float,
    random: Draws,
    in_fluid: InFluid,
) -> bool:
    """Add a molecule; true if that worked."""
    d = len(there.box)
    for _ in range(TRIES):
        done = there.number
        first = random.units(d)[0] * there.box
        if isinstance(molecule, FreeMolecule) and not (molecule.tree and molecule.loops == 0):
            # springs in equilibrium, as if beads did not feel one another otherwise
            normal = np.concatenate([random.normals(d) for _ in range(molecule.length)])
            placed = there.add_all(first + phantom(molecule, kT, normal), in_fluid, apart=True)
        elif molecule and molecule.topology == "ring":
            # a regular polygon in any direction, its bonds as long as they are on average
            side, beads = math.sqrt(float((pool**2).sum(axis=1).mean())), molecule.length
            angle = 2.0 * math.pi * np.arange(beads) / beads
            flat = np.stack([np.cos(angle), np.sin(angle)], axis=1) * side
            ring = np.pad(flat / (2 * math.sin(math.pi / beads)), ((0, 0), (0, d - 2)))
            placed = there.add_all(first + ring @ _any_turn(d, random), in_fluid)
        else:
            placed = _grow(there, molecule, pool, first, random, in_fluid)
        if placed:
            return True
        there.remove_from(done)
    return False


def _grow(
    there: Placed,
    molecule: Molecule | None,
    pool: Floats,
    first: Floats,
    random: Draws,
    in_fluid: InFluid,
) -> bool:
    """Bead by bead along the bonds of a chain or star."""
    if not (in_fluid(first[None])[0] and there.free(first)):
        return False
    start = there.number
    there.add(first)
    came: dict[int, Floats] = {}  # the bond by which each bead was reached
    links = molecule.tree if isinstance(molecule, FreeMolecule) else getattr(molecule, "bonds", ())
    for a, b in links:  # from a bead to the next one in order
        bonds = pool[(random.units(AT_ONCE)[0] * len(pool)).astype(int)]
        if molecule and molecule.bending is not None:
            if a in came:  # in the mirror that takes the x axis to the bond before
                mirror = np.eye(len(first))[0] - came[a] / np.linalg.norm(came[a])
                square = float(mirror @ mirror)
                if square >= 1e-20:
                    bonds = bonds - np.outer(bonds @ mirror, 2.0 / square * mirror)
            else:
                bonds = bonds @ _any_turn(len(first), random)
        ends = there.places[start + a] + bonds
        good = next((n for n in np.flatnonzero(in_fluid(ends)) if there.free(ends[n])), None)
        if good is None:
            return False
        came[b] = bonds[good]
        there.add(ends[good])
    return True


def _any_turn(d: int, random: Draws) -> Floats:
    q, r = np.linalg.qr(np.concatenate([random.normals(d) for _ in range(d)]))
    return q * np.sign(np.diag(r))


class Placed:
    """The beads that have a place already, in cells, to find those nearby.

    Beads are of `kinds` (beads,); limits (kinds, kinds): how near those of two kinds may come.
    """

    def __init__(
        self, kinds: NDArray[np.int64], box: Floats, periods: Floats, limits: Floats
    ) -> None:
        self.places, self.number = np.empty((len(kinds), len(box))), 0
        self.kinds, self.squares = kinds, limits**2
        self.box, self.limit, self.inverse = box, float(limits.max()), 1.0 / periods
        self.cells = np.maximum((box / max(self.limit, 1e-300)).clip(max=1000).astype(int), 1)
        self.inside: dict[tuple[int, ...], list[int]] = defaultdict(list)

    def add(self, place: Floats) -> None:
        """One more bead."""
        self.places[self.number] = place
        if self.limit > 0.0:
            self.inside[self._cell(place)].append(self.number)
        self.number += 1

    def add_all(self, places: Floats, in_fluid: InFluid, apart: bool = False) -> bool:
        """Add beads if all are free in the fluid, and if `apart` of one another; true if that
        worked."""
        if not (in_fluid(places).all() and all(map(self.free, places))):
            return False
        for place in places:
            if apart and not self.free(place):
                return False
            self.add(place)
        return True

    def remove_from(self, number: int) -> None:
        """Remove the last beads, from this number on."""
        for i in range(self.number - 1, number - 1, -1):
            if self.limit > 0.0:
                self.inside[self._cell(self.places[i])].pop()
        self.number = number

    def free(self, place: Floats) -> bool:
        """True if all beads are farther from the next one than the limit."""
        if self.limit <= 0.0:
            return True
        axes = zip(self._cell(place), self.cells.tolist(), strict=True)
        around = set(itertools.product(*(((m - 1) % n, m, (m + 1) % n) for m, n in axes)))
        near = [i for cell in around for i in self.inside.get(cell, ())]
        if not near:
            return True
        separation = self.places[near] - place
        separation -= np.rint(separation * self.inverse) * self.box
        limits = self.squares[self.kinds[self.number], self.kinds[near]]
        return bool(((separation**2).sum(axis=1) > limits).all())

    def _cell(self, place: Floats) -> tuple[int, ...]:
        return tuple((np.floor(place / self.box * self.cells).astype(int) % self.cells).tolist())
