"""First places and headings of birds: drawn, or given by arrays, files and earlier runs."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.given.array_file import EXPECTED, array_in_file
from mesokit.case.given.outside_box import warn_outside
from mesokit.errors import CaseError, MesokitError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.contact import MARGIN
from mesokit.geometry.solids.solids import solids_of
from mesokit.io.earlier_run import earlier_state
from mesokit.io.snapshot_file import read_snapshot
from mesokit.method.flock.engine.step import scatter_headings, scatter_places
from mesokit.scalar.random import Counter
from mesokit.seam.engine import Array

TRIES = 10_000  # of places before there is no room
MOST_BOXES = 2.0**30
UNIT = 1e-14  # rounding of the length of a heading
ROUNDING = 1e-5  # relative, of numbers in single precision and in texts


class FirstState(NamedTuple):
    """Places and unit headings (n, d)."""

    positions: Array
    headings: Array


def first_state(case: Case, arrays: Mapping[str, Any]) -> FirstState:
    """State to start from. Raises CaseError for arrays and files that do not fit the case."""
    start, found = case.flock.start, dict(arrays)
    keys = {name: name for name in ("positions", "velocities")}
    whole = [key for key in ("run", "file") if getattr(start, key) is not None]
    given = [*whole, *(name for name in keys if getattr(start, name) is not None)]
    for key in given:
        if arrays and (key in whole or key in arrays):
            raise CaseError(f"flock.start.{key}: not with arrays")
        if whole and key != whole[0]:
            raise CaseError(f"flock.start.{key}: not with flock.start.{whole[0]}")
    for key in given:
        where = f"flock.start.{key} = {show(getattr(start, key), 500)}"
        try:
            if key in whole:
                read = _last_of_run if key == "run" else _snapshot
                found["positions"], found["velocities"] = read(case, getattr(start, key))
                keys = {name: f"{where}: {name}" for name in keys}
            else:
                shape = case.particles, case.box.dimension
                found[key] = array_in_file(getattr(start, key), key, shape, start.scale)
                keys[key] = where
        except OSError as error:
            raise CaseError(f"{where}: {EXPECTED}: {error.strerror}") from None
        except (MesokitError, ValueError) as error:
            raise CaseError(f"{where}: {error}") from None
    positions, velocities = found.get("positions"), found.get("velocities")
    if velocities is not None and start.headings != "random":
        raise CaseError("flock.start.headings: not with velocities; leave it out")
    return FirstState(
        _drawn_places(case) if positions is None else _places(case, keys["positions"], positions),
        _drawn_headings(case)
        if velocities is None
        else _headings(case, keys["velocities"], velocities),
    )


def _drawn_places(case: Case) -> Array:
    """Places uniform in the box, outside of solids. Raises CaseError if there is no room."""
    size = tuple(float(length) for length in case.box.size)
    counter = Counter(np.uint64(case.run.seed), np.uint64(0))
    places = np.zeros((case.particles, len(size)))
    left, draw = np.arange(case.particles), 0
    while len(left):
        if draw == TRIES:
            raise CaseError("wall: found no room for the birds")
        some = np.zeros((len(left), len(size)))
        scatter_places(counter, draw, size, left, some)
        good = np.ones(len(left), bool)
        if case.walls:
            good = np.asarray(solids_of(case).distance(some) >= MARGIN)
        places[left[good]] = some[good]
        left, draw = left[~good], draw + 1
    return places


def _drawn_headings(case: Case) -> Array:
    """Headings in all directions, or all along x."""
    headings = np.zeros((case.particles, case.box.dimension))
    if case.flock.start.headings == "aligned":
        headings[:, 0] = 1.0
    else:
        counter = Counter(np.uint64(case.run.seed), np.uint64(0))
        scatter_headings(counter, (0.0,) * case.box.dimension, headings)
    return headings


def _places(case: Case, key: str, given: Any) -> Array:
    places = _numbers(case, key, given)
    if case.walls:
        size, shut = np.array(case.box.size, float), closed_axes(case.walls)
        closed = np.array([axis in shut for axis in case.box.axes])
        beyond = (closed & ((places < 0) | (places > size))).any(axis=1)
        folded = np.where(closed, np.clip(places, 0, size), np.mod(places, size))
        _refuse(key, places, beyond | (solids_of(case).distance(folded) < 0), "lies in a wall")
    far = (np.abs(places / np.array(case.box.size)) >= MOST_BOXES).any(axis=1)
    _refuse(key, places, far, "is 2^30 boxes away or more")
    if not case.flock.start.run:  # where birds have flown out of the box
        warn_outside(key, np.asarray(places, float), case.box, closed_axes(case.walls))
    return places


def _headings(case: Case, key: str, given: Any) -> Array:
    velocities = _numbers(case, key, given)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        length = np.linalg.norm(velocities, axis=1, keepdims=True)
        # those of an earlier run are unit vectors: the same bits
        headings = np.where(np.abs(length - 1) < UNIT, velocities, velocities / length)
    wrong = ~(np.abs(np.linalg.norm(headings, axis=1) - 1) < 1e-9)
    _refuse(key, velocities, wrong, "has no direction")
    return np.asarray(headings)


def _refuse(key: str, rows: Array, wrong: NDArray[np.bool_], why: str) -> None:
    if wrong.any():
        row = int(np.argmax(wrong))
        raise CaseError(f"{key}: row {row} = {rows[row].tolist()} {why}")


def _numbers(case: Case, key: str, given: Any) -> Array:
    shape = case.particles, case.box.dimension
    try:
        array = np.asarray(given)
    except (TypeError, ValueError):
        raise CaseError(f"{key}: expected an array of numbers") from None
    if array.dtype.kind not in "iuf":
        raise CaseError(f"{key}: expected an array of numbers, not of {array.dtype.name}")
    if array.shape != shape:
        raise CaseError(f"{key}: shape {array.shape}: expected {shape}, a row for each bird")
    array = array.astype(float)
    if not np.isfinite(array).all():
        row = int(np.argwhere(~np.isfinite(array))[0][0])
        raise CaseError(f"{key}: row {row} is not finite")
    return array


def _last_of_run(case: Case, path: str) -> tuple[Array, Array]:
    """Places and headings at the last checkpoint of an earlier run with this box and as many."""
    state = earlier_state(case, path)
    return state["places"] + state["images"] * np.array(case.box.size, float), state["headings"]


def _snapshot(case: Case, path: str) -> tuple[Any, Any]:
    """Places and velocities, if it has any, of a file that another program has written.

    Raises CaseError unless it has the box of the case, and as many particles.
    """
    there, d = read_snapshot(path, case.flock.start.scale), case.box.dimension
    lengths, wanted = there.lengths[:d], np.array(case.box.size, float)
    if not np.allclose(lengths, wanted, rtol=ROUNDING) or there.tilts.any():
        raise CaseError(
            f"it has a box of {show(lengths.tolist())}, this case {show(wanted.tolist())}"
        )
    if len(there.positions) != case.particles:
        raise CaseError(
            f"it has {len(there.positions)} particles, this case {case.particles} birds"
        )
    places = (there.positions - there.low)[:, :d]
    return places, None if there.velocities is None else there.velocities[:, :d]
