"""What observables ask of the beads of solutes, and what a checkpoint keeps of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.box import fold
from mesokit.errors import RunError
from mesokit.execute.cache import kernel
from mesokit.execute.neighbours import CROWDED, apart, refresh
from mesokit.execute.rows import fetch, put
from mesokit.geometry.protocol import facing
from mesokit.potential.angle import bend
from mesokit.potential.protocol import central
from mesokit.scalar import added_scaled, by_type, dot, scaled

if TYPE_CHECKING:
    from mesokit.execute.readings import Readings

Floats = NDArray[np.float64]


class SoluteReadings:
    """The beads of a fluid in memory, by their numbers from 0."""

    def __init__(self, fluid: Readings) -> None:
        assert fluid.case.solutes is not None and fluid.solutes
        self.fluid, self.given = fluid, fluid.case.solutes
        self.state_of: Any = fluid.solutes
        self.shape = self.given.beads, fluid.dimension
        self.bonds = self.given.bonds()

    @property
    def places(self) -> Floats:
        """Places (beads, d), every molecule whole, as if the box had no bounds; a view."""
        return self.state_of.r.reshape(self.shape)

    @property
    def velocities(self) -> Floats:
        """Velocities (beads, d) in the images of `places`; a view."""
        return self.state_of.v.reshape(self.shape)

    def folded(self) -> tuple[Floats, Floats, NDArray[np.int32]]:
        """Places in the box, velocities there, and boxes that each bead is away."""
        r, v = self.places.copy(), self.velocities.copy()
        boxes = np.zeros(self.shape)
        fold_beads(self.fluid.box_kernel, r.reshape(-1), v.reshape(-1), boxes.reshape(-1),
                   self.fluid.like)  # fmt: skip
        return r, v, boxes.astype(np.int32)

    def whole(self) -> Floats:
        """Places (beads, d) with the first bead of each molecule in the box."""
        first = self.first_beads()
        return self.folded()[0][first] + (self.places - self.places[first])

    def first_beads(self) -> NDArray[np.int64]:
        """The first bead of the molecule of each bead."""
        found = []
        for kind, polymer in enumerate(self.given.polymers):
            start = self.given.first_bead(kind)
            starts = start + polymer.length * np.arange(polymer.number)
            found.append(np.repeat(starts, polymer.length))
        return np.concatenate(found)

    def masses(self) -> Floats:
        """Masses (beads,)."""
        return np.full(self.shape[0], self.given.mass)

    def kinds(self) -> NDArray[np.int64]:
        """The place of each bead's polymer in solutes.polymers."""
        count = [polymer.number * polymer.length for polymer in self.given.polymers]
        return np.repeat(np.arange(len(count)), count)

    def bond_vectors(self) -> Floats:
        """From the first to the second bead of each bond (bonds, d)."""
        return self.places[self.bonds[:, 1]] - self.places[self.bonds[:, 0]]

    def totals(self) -> tuple[int, Floats, float]:
        """Number of beads, their momentum (d,) and kinetic energy."""
        v, m = self.folded()[1], self.given.mass
        return len(v), m * v.sum(axis=0), 0.5 * m * float((v**2).sum())

    def potential_energy(self) -> float:
        """Of bonds, angles, pairs and walls."""
        return float(energy(self.state_of, self.fluid.box_kernel, self.fluid.like))

    def state(self) -> dict[str, NDArray[Any]]:
        """Places and velocities."""
        return {"solute_r": self.state_of.r.copy(), "solute_v": self.state_of.v.copy()}

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.state_of.r[:], self.state_of.v[:] = state["solute_r"], state["solute_v"]
        self.state_of.faults[:] = 0
        self.forget_lists()

    def forget_lists(self) -> None:
        """Neighbours are found anew at the next step."""
        for lists in self.state_of.neighbours:
            lists.offset[1] = 0.0

    def check(self) -> None:
        """That no bond was torn, and no bead lost, in the last steps. Raises RunError."""
        faults, substeps = self.state_of.faults, self.state_of.potentials.substeps
        torn = faults[faults[:, 0] > 0]
        if len(torn):
            step, first, second = min(map(tuple, torn[:, :3].tolist()))
            assert self.given.bond is not None
            raise RunError(
                f"step {step}: the bond of beads {first + 1} and {second + 1} is longer than the "
                f"{self.given.bond.longest:g} that it can be; take more sub-steps than "
                f"{substeps} (solutes.substeps), or a stiffer bond"
            )
        sound = np.isfinite(self.state_of.r) & np.isfinite(self.state_of.v)
        if not sound.all():
            bead = int(np.argmin(sound)) // self.shape[1]
            raise RunError(
                f"step {self.fluid.step}: bead {bead + 1} is lost: the forces on it are too large "
                f"for the sub-step; take more sub-steps than {substeps} (solutes.substeps)"
            )


@kernel
def fold_beads(box, r, v, boxes, like):
    """Bring beads into the box."""
    d, none = len(like), scaled(0.0, like)
    for i in range(len(r) // d):
        at = np.uint64(i * d)
        folded = fold(box, fetch(r, at, like), fetch(v, at, like), none)
        put(r, at, folded[0])
        put(v, at, folded[1])
        put(boxes, at, folded[2])


@kernel
def energy(solutes, box, like):
    """Potential energy of all beads."""
    beads = len(solutes.cell)
    gate = np.zeros(1, np.int64)
    refresh(solutes.neighbours, box, 0, 1, gate, solutes.r, 0, beads, like)
    total = 0.0
    for i in range(beads):
        r = fetch(solutes.r, np.uint64(i * len(like)), like)
        total += bond_energy(solutes.potentials.bond, solutes, i, r, like)
        total += angle_energy(solutes.potentials.angle, solutes, i, like)
        total += pair_energy(solutes.potentials.pair, solutes, i, box, r, like)
        total += wall_energy(solutes.potentials.wall, solutes, r)
    return total


@by_type
def bond_energy(bond, solutes, i, r, like):
    """Of the bonds of bead i with beads after it."""
    return _bond_energy if len(bond) else lambda bond, solutes, i, r, like: 0.0


def _bond_energy(bond, solutes, i, r, like):
    total = 0.0
    for n in range(solutes.bond_starts[i], solutes.bond_starts[i + 1]):
        j = solutes.bonds[n]
        way = added_scaled(r, -1.0, fetch(solutes.r, np.uint64(j * len(like)), like))
        total += central(bond[0], dot(way, way))[0] if j > i else 0.0
    return total


@by_type
def angle_energy(angle, solutes, i, like):
    """Of the angles in the middle of which is bead i."""
    return _angle_energy if len(angle) else lambda angle, solutes, i, like: 0.0


def _angle_energy(angle, solutes, i, like):
    total, d = 0.0, len(like)
    for n in range(solutes.angle_starts[i], solutes.angle_starts[i + 1]):
        if solutes.angles[n, 3] == 1:
            a = fetch(solutes.r, np.uint64(solutes.angles[n, 0] * d), like)
            b = fetch(solutes.r, np.uint64(solutes.angles[n, 1] * d), like)
            c = fetch(solutes.r, np.uint64(solutes.angles[n, 2] * d), like)
            total += bend(angle[0], added_scaled(b, -1.0, a), added_scaled(c, -1.0, b))[0]
    return total


@by_type
def pair_energy(pair, solutes, i, box, r, like):
    """Of bead i with beads after it."""
    return _pair_energy if len(pair) else lambda pair, solutes, i, box, r, like: 0.0


def _pair_energy(pair, solutes, i, box, r, like):
    lists, total, d = solutes.neighbours[0], 0.0, len(like)
    count = lists.count[i]
    for n in range(count if count != CROWDED else len(lists.count)):
        j = lists.near[i, n] if count != CROWDED else n
        way = apart(box, fetch(solutes.r, np.uint64(j * d), like), r)
        total += central(pair[0], dot(way, way))[0] if j > i else 0.0
    return total


@by_type
def wall_energy(wall, solutes, r):
    """Of a bead and the nearest surface."""
    return _wall_energy if len(wall) else lambda wall, solutes, r: 0.0


def _wall_energy(wall, solutes, r):
    solid, reach = solutes.near_wall
    distance, _, _, _ = facing(solid, reach, r)
    return central(wall[0], distance * distance)[0]
