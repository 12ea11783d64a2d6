"""The state that a case starts from; `check` and `run` refuse the same here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.io.snapshot_file import read_snapshot
from mesokit.method.mpcd.solute.free import FreeMolecule
from mesokit.method.mpcd.start.arrays import read_arrays
from mesokit.method.mpcd.start.bodies import first_places
from mesokit.method.mpcd.start.earlier import last_of_run
from mesokit.method.mpcd.start.snapshot import fitted, fitted_beads
from mesokit.processes.alone import Alone

if TYPE_CHECKING:
    from mesokit.processes.world import World

ALONE = Alone()


class FirstState(NamedTuple):
    """Positions and velocities (n, d) of the fluid and of the beads of solutes; None: drawn."""

    positions: Any
    velocities: Any
    beads: Any
    bead_velocities: Any


def first_state(
    case: Case,
    positions: Any = None,
    velocities: Any = None,
    beads: Any = None,
    bead_velocities: Any = None,
    here: World = ALONE,
) -> FirstState:
    """Arrays to start from: those given, or those that the case names; None: to be drawn.

    All ranks (`here`) call it at the same time; an `OfFirst` is on rank 0 for all.

    Raises CaseError for arrays that do not fit the case, for bodies that overlap or find no room,
    and for files and runs that cannot be read.
    """
    fluid = read_arrays(
        case,
        "fluid",
        positions,
        velocities,
        here,
        run=_last_state,
        file=lambda case, path: fitted(case, read_snapshot(path, case.fluid.start.scale)),
    )
    if case.bodies:
        here.each(lambda: first_places(case))
    if case.solutes is None:
        for name, array in (("beads", beads), ("bead_velocities", bead_velocities)):
            if array is not None:
                raise CaseError(f"{name}: there are no solutes in this case")
        return FirstState(*fluid, None, None)
    solutes = read_arrays(
        case,
        "solutes",
        beads,
        bead_velocities,
        here,
        run=_last_beads,
        file=lambda case, path: fitted_beads(case, read_snapshot(path, case.solutes.start.scale)),
    )
    for kind in range(len(case.solutes.polymers)) if solutes[0] is None else ():
        molecule = case.solutes.molecule(kind)
        if isinstance(molecule, FreeMolecule) and molecule.bond.spring() is None:
            if molecule.loops == 0 and molecule.tree:
                continue
            why = "close loops" if molecule.loops else "lead to beads before those they start from"
            raise CaseError(
                f"solutes.start.positions: missing; bonds of solutes.polymers[#{kind + 1}] {why}, "
                "and only springs without a length of their own can then be drawn"
            )
    return FirstState(*fluid, *solutes)


def _last_beads(case: Case, path: str) -> tuple[Any, Any]:
    """Places and velocities of beads at the last checkpoint of an earlier run.

    Raises CaseError unless that run has the box and the polymers of the case.
    """

    def polymers(case: Case) -> tuple[str, Any]:
        kinds = case.solutes.polymers if case.solutes is not None else ()
        rows = [(k.number, k.length, k.topology, k.arms, *k.pairs_of_beads) for k in kinds]
        return "solutes.polymers", rows

    _, state = last_of_run(case, path, polymers)
    shape = -1, case.box.dimension
    return state["solute_r"].reshape(shape), state["solute_v"].reshape(shape)


def _last_state(case: Case, path: str) -> tuple[Any, Any]:
    """Positions and velocities, by particle id, of the last checkpoint of an earlier run.

    Raises CaseError unless that run has the box and the species of the case.
    """
    from mesokit.method.mpcd.engine.measure.earlier import EarlierRows

    def kinds(case: Case) -> tuple[str, Any]:
        rows = [(kind.mass, kind.number) for kind in case.groups[0].kinds]
        return "particles of (mass, number)", rows

    fluid = last_of_run(case, path, kinds)
    return EarlierRows(*fluid, "positions"), EarlierRows(*fluid, "velocities")
