"""What events carry along an axis: sites in a state that hop to a neighbour, or over an end."""

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import name_of, show
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.model.table import Process, TableModel, in_order
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import Array, state_number


class Carried:
    """Rows that a particle, a site in a state, moves along an axis in each process.

    rows: (processes, directions) by the direction of the neighbour. over: the same for processes
    over an end of the lattice alone. planes: between rows, and at ends that particles cross.
    across: sites of a row.
    """

    def __init__(self, case: Case, state: str | None, axis: str) -> None:
        model, kind = case.lattice.model, case.lattice.lattice
        along = case.box.index(axis, "axis")
        if not isinstance(model, TableModel):
            raise CaseError(f"model {show(name_of(model))} has no particles that hop; leave it out")
        outside = len(model.states())
        wanted = 1 if state is None else state_number(case, state)
        steps = _rows(kind.shifts, along, kind.parity, kind.shift[along] / kind.spacing[along])
        if np.ptp(steps, axis=0).any():
            raise CaseError(
                f"axis = {show(axis)}: even and odd sites of lattice.kind = "
                f"{show(case.lattice.kind)} have opposite neighbours; expected another axis"
            )
        ordered = in_order(model.processes())
        signs = np.array([_sign(one, wanted, outside) for one in ordered])
        if not signs.any():
            raise CaseError(
                f"model {show(name_of(model))}: no process moves {show(model.states()[wanted])} "
                "to a neighbour; leave it out"
            )
        self.rows = np.multiply.outer(signs, steps[0])
        ends = np.array(
            [one.neighbour is not None and outside in one.neighbour[0] for one in ordered]
        )
        self.over = np.where(ends[:, None], self.rows, 0.0)
        self.kept = all(
            sign or not _changes(one, wanted) for sign, one in zip(signs, ordered, strict=True)
        )
        length = case.box.size[along]
        self.ends = axis in case.lattice.ends
        self.planes = float(length)
        if self.ends:
            open_at = [
                any(
                    end and one.rate and (one.directions is None or k in one.directions)
                    for end, one in zip(ends, ordered, strict=True)
                    for k in np.flatnonzero(steps[0] * side > 0)
                )
                for side in (-1, 1)
            ]
            self.planes = length - 1.0 + sum(open_at)
        self.across = case.particles / length


def _rows(shifts: Array, along: int, parity: tuple[int, ...], shift: float) -> Array:
    """Rows (2, neighbours) along an axis to each neighbour of even and odd sites."""
    changes = (shifts @ np.array(parity)) % 2
    return np.asarray(shifts[:, :, along] + np.array([[1.0], [-1.0]]) * changes * shift)


def _sign(one: Process, state: int, outside: int) -> int:
    """1 where a particle goes to the neighbour, -1 where it comes from there, else 0."""
    if one.neighbour is None:
        return 0
    there, after = one.neighbour
    gains, loses = one.site[0] != state == one.site[1], one.site[0] == state != one.site[1]
    if there == (outside,):
        return int(loses) - int(gains)
    if loses and state not in there and after == state:
        return 1
    return -1 if gains and there == (state,) and after != state else 0


def _changes(one: Process, state: int) -> bool:
    """Whether a process changes the number of sites in a state, or may do so."""
    before, after = [one.site[0]], [one.site[1]]
    if one.neighbour is not None:
        before.append(one.neighbour[0][0])
        after.append(one.neighbour[1])
    return before.count(state) != after.count(state)
