"""Bodies whose places are known: given in rows or in files, or those of an earlier run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import one_of, show
from mesokit.case.given.array_file import EXPECTED, array_in_file
from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError, MesokitError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.method.mpcd.body.protocol import NEARLY_UNIT, RUN, Body, named
from mesokit.method.mpcd.checks.bodies import LONGEST_PATH
from mesokit.method.mpcd.start.snapshot import require_box

Floats = NDArray[np.float64]
ROUNDING = 1e-4  # of numbers in single precision


class KnownBodies(NamedTuple):
    """What is known of the bodies of a kind; None where it is to be drawn.

    Places (n, d), orientations (n, 4), velocities (n, d), and angular velocities (n, 3).
    """

    places: Floats | None
    turns: Floats | None
    velocities: Floats | None
    spins: Floats | None


def known_bodies(case: Case, number: int) -> KnownBodies:
    """What the start of a kind of bodies, by its number from 1, says of them.

    Raises CaseError, which names the key, for files and runs that do not fit.
    """
    kind, name = case.bodies[number - 1], named(case.bodies)[number - 1].name
    given, where = kind.start, f"bodies[#{number}].start"
    if not given.known_elsewhere:
        return _of_rows(case, kind, where)
    path = given.run if given.rule == RUN else given.file
    read = _of_run if given.rule == RUN else _of_file
    try:
        found = read(case, kind, given.kind or name)
        _require_inside(case, "positions: ", found.places)
        if given.moving:
            _require_slow(case, kind, found)
    except MesokitError as error:
        raise CaseError(f"{where}.{given.rule} = {show(path, 500)}: {error}") from None
    velocities, spins = found.velocities, found.spins
    if not given.moving:
        velocities = spins = None
    if velocities is not None:  # what is fixed now does not go on
        velocities = velocities * [axis not in kind.fixed for axis in case.box.axes]
    if spins is not None and kind.hinge is not None:
        axis = np.array(kind.hinge) / np.linalg.norm(kind.hinge)
        spins = (spins @ axis)[:, None] * axis
    if spins is not None and "orientation" in kind.fixed:
        spins = 0.0 * spins
    return found._replace(velocities=velocities, spins=spins)


# --- rows -----------------------------------------------------------------------------------------


def _of_rows(case: Case, kind: Body, where: str) -> KnownBodies:
    """Rows of the case, or of the files that it names."""
    d = case.box.dimension
    widths = {"positions": d, "orientations": 1 if d == 2 else 4, "velocities": d,
              "spins": 1 if d == 2 else 3}  # fmt: skip
    found: dict[str, Floats | None] = {}
    for key, width in widths.items():
        rows = getattr(kind.start, key)
        if isinstance(rows, str):
            rows = _in_file(f"{where}.{key}", rows, key, (kind.number, width))
            if key == "positions":
                _require_inside(case, f"{where}.{key} = {show(kind.start.positions, 500)}: ", rows)
        found[key] = None if rows is None else np.array(rows, float)
    turns, spins = found["orientations"], found["spins"]
    if turns is not None:
        turns = _about_z(np.radians(turns[:, 0])) if d == 2 else _units(f"{where}.", turns)
    if spins is not None and d == 2:
        spins = np.pad(spins, ((0, 0), (2, 0)))
    return KnownBodies(found["positions"], turns, found["velocities"], spins)


def _in_file(key: str, path: str, name: str, shape: tuple[int, int]) -> Floats:
    """Rows of a file of NumPy. Raises CaseError."""
    try:
        array = array_in_file(path, name, shape)
    except OSError as error:
        raise CaseError(f"{key} = {show(path, 500)}: {EXPECTED}: {error.strerror}") from None
    except ValueError as error:
        raise CaseError(f"{key} = {show(path, 500)}: {error}") from None
    if array.dtype.kind not in "iuf":
        raise CaseError(
            f"{key} = {show(path, 500)}: expected an array of numbers, not of {array.dtype.name}"
        )
    found = np.array(array, float)
    if not np.isfinite(found).all():
        row = int(np.argwhere(~np.isfinite(found))[0][0])
        raise CaseError(f"{key} = {show(path, 500)}: row {row} is not finite")
    return found


def _about_z(angle: Floats) -> Floats:
    """Quaternions (n, 4) of turns in the plane."""
    half = 0.5 * angle
    return np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)


def _units(key: str, turns: Floats) -> Floats:
    """Quaternions (n, 4), made unit ones where rounding has changed them. Raises CaseError."""
    size = np.linalg.norm(turns, axis=1)
    off = ~(np.abs(size - 1.0) <= NEARLY_UNIT)
    if off.any():
        row = int(np.argmax(off))
        raise CaseError(
            f"{key}orientations: row {row} = {show(turns[row].tolist())}: expected a unit "
            f"quaternion, not one of length {size[row]:.4g}"
        )
    unit: Floats = turns / size[:, None]
    return unit


def _require_inside(case: Case, key: str, places: Floats | None) -> None:
    """Refuse places outside the box."""
    size = np.array(case.box.size, float)
    assert places is not None
    outside = ~((places >= 0.0) & (places <= size))
    if outside.any():
        row, k = (int(n) for n in np.argwhere(outside)[0])
        raise CaseError(
            f"{key}row {row} = {show(places[row].tolist())} lies outside the box along "
            f"{case.box.axes[k]}; expected 0 to {size[k]:g}"
        )


def _require_slow(case: Case, kind: Body, found: KnownBodies) -> None:
    """Refuse velocities that are no numbers, or by which a surface goes too far in a timestep."""
    gaps, arm = kind.interaction.depth > 0, kind.solid(case.box.dimension).radius
    for name, rows, reach, limited in (
        ("velocities", found.velocities, 1.0, gaps),
        ("spins", found.spins, arm, True),
    ):
        if rows is None:
            continue
        path = np.linalg.norm(rows, axis=1) * reach * case.fluid.timestep
        wrong = ~np.isfinite(path)
        if limited:
            wrong |= path > LONGEST_PATH
        if wrong.any():
            row = int(np.argmax(wrong))
            why = "expected finite numbers"
            if np.isfinite(path[row]):
                fast = f"it moves by {path[row]:.3g} cells in a timestep"
                why = f"{fast}; expected at most {LONGEST_PATH:g}"
            raise CaseError(f"{name}: row {row} = {show(rows[row].tolist())}: {why}")


# --- earlier runs, and files ----------------------------------------------------------------------


def _of_run(case: Case, kind: Body, wanted: str) -> KnownBodies:
    """The bodies of a kind at the last checkpoint of an earlier run.

    Raises CaseError unless box, shape and number are those of the case.
    """
    from mesokit.method.mpcd.start.earlier import last_of_run

    d, start = case.box.dimension, kind.start
    assert start.run is not None
    numbers, state = last_of_run(case, start.run, lambda case: ("bodies", True))
    there = named(numbers.case.bodies)
    names = [one.name for one in there]
    if wanted not in names:
        have = f"; it has {one_of(names)}" if names else ""
        raise CaseError(f"that run has no bodies {show(wanted)}{have}")
    place = names.index(wanted)
    one = there[place].kind
    if one.number != kind.number:
        raise CaseError(f"that run has {one.number} bodies {show(wanted)}, this case {kind.number}")
    if one.solid(d).parts != kind.solid(d).parts:
        raise CaseError(f"its bodies {show(wanted)} have another shape or size than in this case")
    box = numbers.case.box
    slid = box.displacement(int(state["step"]) * numbers.timestep)
    slid -= float(box.size[0]) * round(slid / float(box.size[0]))
    if abs(slid) > ROUNDING:
        raise CaseError(
            f"its images have slid by {slid:.4g} along x, and at a start they have not; expected a "
            "run whose images are back, or 'mesokit resume', which goes on with it"
        )
    first = sum(other.kind.number for other in there[:place])
    rows = slice(first, first + kind.number)
    x, turns, v, spins = (
        state[f"body_{key}"][rows] for key in ("place", "turn", "velocity", "spin")
    )
    return KnownBodies(x[:, :d], turns, v[:, :d], spins)


def _of_file(case: Case, kind: Body, wanted: str) -> KnownBodies:
    """The bodies of a kind in a frame of a GSD file: particles of a type of its name, or all.

    Raises CaseError unless box and number are those of the case.
    """
    from mesokit.io import gsd_file
    from mesokit.method.mpcd.body.drawn import drawn_as

    d, start = case.box.dimension, kind.start
    assert start.file is not None
    if Path(start.file).suffix != ".gsd":
        raise CaseError(f"ending {show(Path(start.file).suffix)}: expected '.gsd'")
    there = gsd_file.read(start.file, start.frame)
    require_box(case, there)
    rows = _rows_of_kind(there, kind.number, wanted, start.kind is not None)
    assert there.kinds is not None
    name = there.kinds[rows[0]]
    drawn = there.shapes.get(name)
    if drawn and not _same_shape(drawn, drawn_as(kind.solid(d).parts, d)):
        raise CaseError(
            f"its particles of type {show(name)} have another shape or size than the bodies of "
            "this case"
        )
    closed = closed_axes(case.walls)
    size = np.array(case.box.size, float)
    places = (there.positions - there.low)[rows, :d]
    for k, axis in enumerate(case.box.axes):
        if axis not in closed:
            places[:, k] -= np.floor(places[:, k] / size[k]) * size[k]
    turns = None if there.orientations is None else _units("", there.orientations[rows])
    if d == 2 and turns is not None and np.abs(turns[:, 1:3]).max() > ROUNDING:
        raise CaseError("its particles are turned about other axes than z; expected a 2D box")
    velocities = None if there.velocities is None else there.velocities[rows, :d]
    return KnownBodies(
        places, turns, velocities, None if there.spins is None else there.spins[rows]
    )


def _same_shape(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Whether two entries of `particles/type_shapes` are equal but for rounding."""
    if one.keys() != other.keys() or one["type"] != other["type"]:
        return False
    pairs = [(np.array(one[key]), np.array(other[key])) for key in one.keys() - {"type"}]
    return all(a.shape == b.shape and np.allclose(a, b, atol=ROUNDING) for a, b in pairs)


def _rows_of_kind(there: Snapshot, number: int, wanted: str, sure: bool) -> NDArray[np.int64]:
    """Particles of a type of this name; without one, all of a single type, unless `sure` of it.

    Raises CaseError.
    """
    assert there.kinds is not None
    rows, of = np.flatnonzero(there.kinds == wanted), f" of type {show(wanted)}"
    if not len(rows):
        names = sorted(set(there.kinds.tolist()))
        if sure or len(names) > 1:
            raise CaseError(f"it has no particles{of}; it has {one_of(names)}")
        rows, of = np.arange(len(there.kinds)), ""
    if len(rows) != number:
        raise CaseError(f"it has {len(rows)} particles{of}, this case {number} bodies")
    return rows
