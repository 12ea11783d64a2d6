"""Readings of the beads of solutes for observables, and their state for checkpoints."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import fold
from mesokit.errors import RunError
from mesokit.kernels.kernel import kernel
from mesokit.loops.threads import Worker
from mesokit.method.mpcd.engine.beads.external import external_energy
from mesokit.method.mpcd.engine.beads.interactions import Energy, first_fault, refuse_broken
from mesokit.method.mpcd.engine.beads.neighbours import MADE, OFFSET, refresh
from mesokit.method.mpcd.engine.beads.state import load_place
from mesokit.method.mpcd.engine.beads.traverse import each_on_bead
from mesokit.method.mpcd.engine.cpu.memory import Memory
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values, store_values
from mesokit.method.mpcd.engine.embedded.readings import refuse_faults
from mesokit.scalar.fixed_point import total
from mesokit.scalar.vector import scaled

Floats = NDArray[np.float64]
ALONE = Worker(0, 1, np.zeros(1, np.int64), np.zeros(1, np.int64))


class SoluteReadings:
    """The beads of a fluid in memory, by their numbers from 0."""

    def __init__(self, memory: Memory) -> None:
        case = memory.numbers.case
        assert case.solutes is not None and memory.solutes
        self.memory, self.given = memory, case.solutes
        self.state_of: Any = memory.solutes
        self.shape = self.given.beads, memory.numbers.dimension
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
        return self.folded_of(self.places, self.velocities)

    def folded_of(self, r: Floats, v: Floats) -> tuple[Floats, Floats, NDArray[np.int32]]:
        """The same of beads with these places and velocities."""
        r, v = r.copy(), v.copy()
        boxes = np.zeros(self.shape)
        rows = (array.reshape(-1) for array in (r, v, boxes))
        fold_beads(self.memory.box, *rows, self.memory.physics.zero)
        return r, v, boxes.astype(np.int32)

    def whole(self) -> Floats:
        """Places (beads, d) with the first bead of each molecule in the box."""
        starts = [
            np.repeat(
                self.given.first_bead(kind) + polymer.length * np.arange(polymer.number),
                polymer.length,
            )
            for kind, polymer in enumerate(self.given.polymers)
        ]
        first = np.concatenate(starts)  # the first bead of the molecule of each bead
        return self.folded()[0][first] + (self.places - self.places[first])

    def masses(self) -> Floats:
        """Masses (beads,)."""
        return np.array(self.given.masses)[self.given.kinds()]

    def kinds(self) -> NDArray[np.int64]:
        """The place of each bead's polymer in solutes.polymers."""
        return self.given.kinds()

    def bond_vectors(self) -> Floats:
        """From the first to the second bead of each bond (bonds, d)."""
        return self.places[self.bonds[:, 1]] - self.places[self.bonds[:, 0]]

    def motion(self) -> Floats:
        """Momentum and sum of m v^2 of the beads (d + 1,)."""
        (_, v, _), m = self.folded(), self.masses()
        scales = np.array(self.memory.numbers.scales_of_motion)
        terms = np.column_stack([m[:, None] * v, m * (v**2).sum(axis=1)]) * scales
        return total(np.rint(terms).astype(np.int64), scales)

    def potential_energy(self) -> float:
        """Of bonds, angles, pairs and walls, and of beads that act on the fluid."""
        return energy_in(self.memory, self.state_of, self.places)

    def begin(self, places: Floats, velocities: Floats) -> None:
        """Give the beads their first places and velocities (beads, d)."""
        self.places[:], self.velocities[:] = places, velocities
        self.forget_lists()

    def state(self) -> dict[str, NDArray[Any]]:
        """Places and velocities."""
        return {"solute_r": self.state_of.r.copy(), "solute_v": self.state_of.v.copy()}

    def restore(self, state: dict[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.state_of.r[:], self.state_of.v[:] = state["solute_r"], state["solute_v"]
        self.state_of.faults[:] = 0
        for embedded in self.state_of.embedded:
            embedded.faults[:] = 0
        self.forget_lists()

    def forget_lists(self) -> None:
        """Neighbours are found anew at the next step."""
        for lists in self.state_of.neighbours:
            lists.noted[:, MADE] = 0.0

    def check(self) -> None:
        """That no bond was broken, no bead lost or too fast in the last steps. Raises RunError."""
        substeps = self.state_of.potentials.substeps
        if found := first_fault(self.state_of.faults):
            advice = f"take more sub-steps than {substeps} (solutes.substeps), or a stiffer bond"
            bond = self.given.bond_of(int(self.given.kinds()[found[1] - 1]))
            assert bond is not None
            refuse_broken(self.state_of.faults, bond.longest, "beads", advice)
        for embedded in self.state_of.embedded:
            refuse_faults(embedded.faults, embedded.skin, substeps)
        sound = np.isfinite(self.state_of.r) & np.isfinite(self.state_of.v)
        if not sound.all():
            bead = int(np.argmin(sound)) // self.shape[1]
            raise RunError(
                f"step {self.memory.step}: bead {bead + 1} is lost: the forces on it are too large "
                f"for the sub-step; take more sub-steps than {substeps} (solutes.substeps)"
            )


def energy_in(memory: Memory, beads: Any, places: Floats) -> float:
    """Potential energy of beads, also of forces from outside and of those on the fluid."""
    energy = float(energy_of(ALONE, beads, memory.box, memory.physics.zero))
    for lists in beads.neighbours:  # what one thread has made holds for all
        lists.noted[:, [OFFSET, MADE]] = lists.noted[0, [OFFSET, MADE]]
    energy += external_energy(beads.external, places)
    return energy + (memory.energy_in_fluid() if beads.embedded else 0.0)


@kernel
def fold_beads(box, r, v, boxes, zero):
    """Bring beads into the box."""
    d, none = len(zero), scaled(0.0, zero)
    for i in range(len(r) // d):
        at = np.uint64(i * d)
        old, u = load_values(r, at, zero), load_values(v, at, zero)
        place, velocity, crossed = fold(box, old, u, none)
        store_values(r, at, place)
        store_values(v, at, velocity)
        store_values(boxes, at, crossed)


@kernel
def energy_of(worker, beads, box, zero):
    """Potential energy of all beads."""
    total = (0.0,)
    refresh(worker, beads.neighbours, (), box, beads.r, zero)
    for i in range(len(beads.cell)):
        total = each_on_bead(Energy(), total, beads, i, load_place(beads, i, zero), box)
    return total[0]
