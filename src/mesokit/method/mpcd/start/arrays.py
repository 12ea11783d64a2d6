"""Arrays to start from: given, or read from files of the case, and checked."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.given.array_file import EXPECTED, array_in_file, is_plain
from mesokit.case.given.outside_box import warn_outside
from mesokit.errors import CaseError, MesokitError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import solids_of
from mesokit.method.mpcd.start.section import Start

if TYPE_CHECKING:
    from mesokit.processes.world import World


class OfFirst:
    """An array (n, d) that is `rows` on rank 0, which deals it to the others; None there."""

    def __init__(self, rows: Any) -> None:
        self.rows = rows


def read_by_first(here: World, read: Callable[[], tuple[Any, ...]]) -> tuple[Any, ...]:
    """Arrays, or None, as one process reads them; of several ranks rank 0 does, and keeps them.

    Raises its MesokitError on all ranks.
    """
    if here.size == 1:
        return read()
    found: list[Any] = []

    def kept() -> list[bool]:
        found.extend(read())
        return [array is not None for array in found]

    there = here.on_root(kept)
    found = found or [None] * len(there)
    return tuple(
        OfFirst(rows) if is_one else None for is_one, rows in zip(there, found, strict=True)
    )


def rows_of(array: Any) -> Any:
    """The rows that are here; None if another rank has them."""
    return array.rows if isinstance(array, OfFirst) else array


Floats = NDArray[np.float64]
State = Callable[["Case", str], tuple[Any, Any]]
PIECE = 2**18  # rows that are looked at together
MOST_IMAGES = 2**30  # boxes away from the primary one: image counts are 32-bit


def read_arrays(
    case: Case, owner: str, positions: Any, velocities: Any, here: World, **states: State
) -> tuple[Any, Any]:
    """The arrays to start from: those given, or those that the case names; None where none.

    Rows of a .npy file without a scale or of an earlier run are read where they are needed. Of
    several ranks (`here`) each checks its share of what all have, and all raise the same error.
    Other files rank 0 reads alone (`OfFirst`), but for those of solutes, whose beads all ranks
    have.

    `owner` is "fluid" or "solutes". `states` gives for each key that names a whole state (`run`,
    `file`) what reads positions and velocities that suit the case. Raises CaseError if an array is
    given twice, holds no real numbers, has the wrong shape, is not finite, or has particles outside
    the walls or too far away.
    """
    given: Start = getattr(case, owner).start
    where = f"{owner}.start"
    for name, array in (("positions", positions), ("velocities", velocities)):
        for key in ("run", "file", name):
            said = getattr(given, key)
            if array is not None and said is not None:
                raise CaseError(f"{where}.{key} = {said!r}: not with an array of {name}")
    keys = f"{where}.positions", f"{where}.velocities"

    def taken(read: Callable[[], tuple[Any, ...]]) -> tuple[Any, ...]:
        if owner == "fluid":
            return read_by_first(here, read)
        return here.on_root(lambda: tuple(None if x is None else np.asarray(x) for x in read()))

    def mapped(path: str) -> bool:  # a file whose rows each rank may read by itself
        try:
            return is_plain(path)
        except OSError:
            return False

    def loaded(name: str, path: str) -> Any:
        def load() -> Any:
            try:
                return array_in_file(path, name, _shape(case, owner), given.scale)
            except (OSError, ValueError) as error:
                reason = str(error)
                if isinstance(error, OSError):
                    reason = f"{EXPECTED}: {error.strerror}"
                raise CaseError(f"{where}.{name} = {path!r}: {reason}") from None

        if owner == "fluid" and given.scale is None and here.on_root(lambda: mapped(path)):
            return here.each(load)
        return taken(lambda: (load(),))[0]

    for name, read in states.items():
        if getattr(given, name) is None:
            continue
        key = f"{where}.{name} = {getattr(given, name)!r}"
        try:
            positions, velocities = taken(partial(read, case, getattr(given, name)))
        except MesokitError as error:
            raise CaseError(f"{key}: {error}") from None
        keys = f"{key}: positions", f"{key}: velocities"
        break
    else:
        if positions is None and given.positions is not None:
            positions = loaded("positions", given.positions)
        if velocities is None and given.velocities is not None:
            velocities = loaded("velocities", given.velocities)
    if positions is not None:
        molecule = case.fluid.molecule
        if owner == "fluid" and molecule is not None and molecule.conformation != "thermal":
            raise CaseError(
                f"fluid.molecule.conformation = {molecule.conformation!r}: no effect with "
                "positions to start from; leave it out"
            )
        positions = here.each(partial(_checked, case, owner, keys[0], positions, here))
        here.each(partial(_require_room, case, keys[0], positions, here))
    if velocities is not None:
        velocities = here.each(partial(_checked, case, owner, keys[1], velocities, here))
    return positions, velocities


def _shape(case: Case, owner: str) -> tuple[int, int]:
    beads = case.solutes.beads if owner == "solutes" and case.solutes else case.particles
    return beads, case.box.dimension


def _checked(case: Case, owner: str, key: str, given: Any, here: World) -> Any:
    """Numbers for each particle; those of the fluid stay where they are, which may be a file."""
    values = rows_of(given)
    if values is None:  # rank 0 has them
        return given
    if np.ma.isMaskedArray(values):
        raise CaseError(f"{key}: expected an array of numbers without a mask")
    try:
        array = values if hasattr(values, "state") else np.asarray(values)
    except (TypeError, ValueError):
        raise CaseError(f"{key}: expected an array of numbers") from None
    if array.dtype.kind not in "iuf":
        raise CaseError(f"{key}: expected an array of numbers, not of {array.dtype.name}")
    shape = _shape(case, owner)
    if array.shape != shape:
        raise CaseError(
            f"{key}: shape {array.shape}: expected {shape}, one row for each of the "
            + ("solutes' beads" if owner == "solutes" else "fluid's particles")
        )
    for first, rows in _pieces(array, here, isinstance(given, OfFirst)):
        if not np.isfinite(rows).all():
            row = first + int(np.argwhere(~np.isfinite(rows))[0][0])
            raise CaseError(f"{key}: row {row} is not finite")
    if isinstance(given, OfFirst):
        return given
    return array if owner == "fluid" else np.array(array, float)


def _pieces(array: Any, here: World, alone: bool) -> Iterator[tuple[int, Floats]]:
    """Some rows after the other, as floats, and the number of the first: all if this rank `alone`
    has them, else its share."""
    first, last = (len(array) * (here.rank + k) // here.size for k in (0, 1))
    first, last = (0, len(array)) if alone else (first, last)
    for start in range(first, last, PIECE):
        yield start, np.asarray(array[start : min(start + PIECE, last)], float)


def _require_room(case: Case, key: str, given: Any, here: World) -> None:
    """Refuse positions in walls, and those so far away that image counts overflow."""
    array = rows_of(given)
    for first, rows in () if array is None else _pieces(array, here, isinstance(given, OfFirst)):
        solid = solids_of(case).distance(rows) < 0 if case.walls else np.zeros(len(rows), bool)
        if solid.any():
            row = int(np.argmax(solid))
            raise CaseError(f"{key}: row {first + row} = {rows[row].tolist()} lies in a wall")
        far = (np.abs(rows / case.box.size) >= MOST_IMAGES).any(axis=1)
        if far.any():
            row = int(np.argmax(far))
            raise CaseError(
                f"{key}: row {first + row} = {rows[row].tolist()} is 2^30 boxes away or more; "
                "expected positions nearer to the box"
            )
        if key.endswith(".positions") and case.fluid.molecule is None:  # which may cross edges
            warn_outside(key, rows, case.box, [*closed_axes(case.walls), *case.box.open], first)
