"""The beads of solutes in the memory of a device, and copies of what changes for readings."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import Device
from mesokit.method.mpcd.engine.beads.external import External
from mesokit.method.mpcd.engine.beads.interactions import SHARED, shared_fault
from mesokit.method.mpcd.engine.beads.state import Beads, KindsOfLinks
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.cuda.kernels.beads.embedded import NearBeads, ReachOfBeads
from mesokit.method.mpcd.engine.cuda.kernels.beads.meetings import Meetings
from mesokit.method.mpcd.engine.cuda.kernels.beads.solutes import DeviceLists
from mesokit.method.mpcd.engine.cuda.tables import Tables, copied
from mesokit.method.mpcd.engine.embedded.state import PARTNERS
from mesokit.scalar.pointer import WORD

WHOLE = 4  # bytes of an int32 number


class BeadMemory:
    """Beads on a device, of those in the memory of this process.

    `group` has addresses where `beads` has arrays. Places and velocities of both agree between
    runs of steps.
    """

    def __init__(
        self,
        beads: Beads,
        numbers: Numbers,
        device: Device,
        tables: Tables,
        room: Callable[[int], int],
    ) -> None:
        self._device, self._room, self._beads = device, room, beads
        self._particles, cells = numbers.n, numbers.number_of_cells
        self.number, n = beads.number, beads.number
        potentials: Any = beads.potentials
        self.substeps: int = potentials.substeps
        self._known: tuple[NDArray[np.float64], ...] = ()  # places and velocities there
        self.lists = self._lists()
        mass = beads.mass if isinstance(beads.mass, float) else self._copied(beads.mass)
        self.group = Beads(
            number=n,
            mass=mass,
            potentials=tables.there(beads.potentials),
            kinds=self._kinds(beads.kinds),
            neighbours=() if self.lists is None else (self.lists,),
            r=room(beads.r.nbytes),
            v=room(beads.v.nbytes),
            bond_starts=self._copied(beads.bond_starts),
            bonds=self._copied(beads.bonds),
            angle_starts=self._copied(beads.angle_starts),
            angles=self._copied(beads.angles),
            near_wall=tables.there(beads.near_wall),
            faults=room(SHARED * WORD),
            cell=room(n * WHOLE),
            head=(),
            following=(),
            given=room(beads.given.nbytes),
            terms=beads.terms,
            answers=room(beads.answers.nbytes),
            leads=(),
            solvent=beads.solvent,
            tensor=room(beads.tensor.nbytes),
            embedded=(),
            external=tuple(External(*map(self._copied, one)) for one in beads.external),
            halo=(),
        )
        self.near: Any = self._near(tables)
        self.met = Meetings(
            cells=cells,
            count=room((cells + 1) * WHOLE),
            start=room((cells + 1) * WHOLE),
            members=room(n * WHOLE),
            rank=room(n * WHOLE),
            taken=room(WHOLE),
        )

    def _near(self, tables: Tables) -> NearBeads | None:
        """Memory for the particles near beads that act by a potential."""
        for given in self._beads.embedded:
            room, n, d = self._room, self.number, len(self._beads.r) // self.number
            most = given.lane.shape[1]
            return NearBeads(
                potential=tables.there(given.potential),
                reach=given.reach,
                skin=given.skin,
                travel=given.travel,
                further=given.further,
                grid=given.grid,
                marked=room(given.marked.nbytes),
                lists=ReachOfBeads(given.lists.reach),
                most=most,
                candidates=room(self._particles * WHOLE),
                waiting=room(WHOLE),
                particle=room(most * WHOLE),
                partners=room(most * WHOLE),
                beads=room(most * PARTNERS * WHOLE),
                start=room(most * d * WORD),
                bound=room(most * WORD),
                number=room(WHOLE),
                origin=room(n * d * WORD),
                taken=room(n * d * WORD),
                faults=room(SHARED * WORD),
            )
        return None

    def _copied(self, table: Any) -> int:
        """The address of a table of float64 or int32 numbers on the device."""
        return copied(self._device, self._room, table, np.int32)

    def _kinds(self, kinds: Any) -> KindsOfLinks | tuple[()]:
        if not kinds:
            return ()
        bonds, angles, beads = map(self._copied, kinds[:3])
        return KindsOfLinks(bonds, angles, beads, kinds.number)

    def _lists(self) -> DeviceLists | None:
        for lists in self._beads.neighbours:
            n, d = self.number, len(self._beads.r) // self.number
            return DeviceLists(
                reach=lists.reach,
                skin=lists.skin,
                most=lists.most,
                count=self._room(n * WHOLE),
                near=self._room(n * lists.most * WHOLE),
                made_at=self._room(n * d * WORD),
                boxes=self._room(n * WORD),
                offsets=self._room(n * WORD),
                moved=self._room(WORD),
            )
        return None

    def send(self, what: int) -> None:
        """Bring beads to the device, if they are not as they were there; forget faults."""
        device, beads, group = self._device, self._beads, self.group
        device.clear(group.faults, SHARED * WORD)
        if self.near is not None:
            device.clear(self.near.faults, SHARED * WORD)
        if what & MEASURE_STRESS:
            device.clear(group.tensor, beads.tensor.nbytes)
        here = beads.r, beads.v
        if self._known and all(map(np.array_equal, here, self._known)):
            return
        device.write(group.r, beads.r)
        device.write(group.v, beads.v)
        if self.near is not None:  # the step may be an earlier one
            device.clear(self.near.marked, self._beads.embedded[0].marked.nbytes)
        if self.lists is not None:  # none holds: all have moved by more than any number
            device.write(self.lists.made_at, np.full(len(beads.r), np.nan))

    def fetch(self, what: int) -> None:
        """Bring beads back, with their part in the stress, if that was measured, and faults."""
        device, beads, group = self._device, self._beads, self.group
        device.read(group.r, beads.r)
        device.read(group.v, beads.v)
        self._known = beads.r.copy(), beads.v.copy()
        if what & MEASURE_STRESS:
            device.read(group.tensor, beads.tensor)
        noted = np.zeros(SHARED, np.int64)
        device.read(group.faults, noted)
        beads.faults[0, :3] = shared_fault(noted)
        for embedded in beads.embedded:
            device.read(self.near.faults, noted)
            embedded.faults[0, :3] = shared_fault(noted)
