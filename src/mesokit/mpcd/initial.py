"""How a fluid starts."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.box import AXES
from mesokit.component import FileName, component, param
from mesokit.errors import CaseError, MesokitError
from mesokit.geometry.contact import MARGIN
from mesokit.mpcd.conformation import connected, drawn
from mesokit.mpcd.solute_start import start_solutes
from mesokit.random import INITIAL_POSITION, INITIAL_VELOCITY
from mesokit.solids import solids_of

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.execute.cpu import CPU

Floats = NDArray[np.float64]
State = Callable[["Case", str], tuple[Any, Any]]
MOST_IMAGES = 2**30  # boxes away from the primary one: image counts are 32-bit


@component
class Start:
    """Where positions and velocities come from; without files they are drawn from the seed.

    Drawn positions are uniform; drawn velocities are Maxwellian with zero total momentum.
    """

    positions: FileName | None = param(None, doc="file .npy or .npz with an (n, d) array", unit="a")
    velocities: FileName | None = param(
        None, doc="file .npy or .npz with an (n, d) array", unit="a/time"
    )
    run: FileName | None = param(None, doc="folder of an earlier run: go on from its last state")
    file: FileName | None = param(
        None, doc="GSD file (its last frame) or LAMMPS data file, with the bonds of the molecules"
    )


def read_arrays(
    case: Case, owner: str, positions: Any, velocities: Any, **states: State
) -> tuple[Any, Any]:
    """The arrays to start from: those given, or those that the case names; None where none.

    `owner` is "fluid" or "solutes". `states` gives for each key that names a whole state (`run`,
    `file`) what reads positions and velocities that suit the case. Raises CaseError if an array is
    given twice, holds no real numbers, has the wrong shape, is not finite, or has particles outside
    the walls or too far away.
    """
    given: Start = getattr(case, owner).start
    where = f"{owner}.start"
    _once(where, given, positions=positions, velocities=velocities)
    keys = f"{where}.positions", f"{where}.velocities"
    for name, read in states.items():
        if getattr(given, name) is None:
            continue
        key = f"{where}.{name} = {getattr(given, name)!r}"
        try:
            positions, velocities = read(case, getattr(given, name))
        except MesokitError as error:
            raise CaseError(f"{key}: {error}") from None
        keys = f"{key}: positions", f"{key}: velocities"
        break
    else:
        if positions is None and given.positions is not None:
            positions = _load(where, "positions", given.positions)
        if velocities is None and given.velocities is not None:
            velocities = _load(where, "velocities", given.velocities)
    if positions is not None:
        _no_conformation(case)
        positions = _checked(case, owner, keys[0], positions)
        _inside(case, keys[0], positions)
        _near(case, keys[0], positions)
    if velocities is not None:
        velocities = _checked(case, owner, keys[1], velocities)
    return positions, velocities


def _once(where: str, given: Start, **arrays: Any) -> None:
    """No array beside a file or run that says the same."""
    for name, array in arrays.items():
        for key in ("run", "file", name):
            said = getattr(given, key)
            if array is not None and said is not None:
                raise CaseError(f"{where}.{key} = {said!r}: not with an array of {name} beside")


def _no_conformation(case: Case) -> None:
    """Nothing about how molecules are drawn where they are not."""
    molecule = case.fluid.molecule
    if molecule is not None and molecule.conformation != "thermal":
        raise CaseError(
            f"fluid.molecule.conformation = {molecule.conformation!r}: no effect beside positions "
            "to start from; leave it out"
        )


def _load(where: str, name: str, path: str) -> Any:
    """An array from a .npy file, or the only one (or the one of that name) from a .npz file."""
    key = f"{where}.{name} = {path!r}"
    try:
        found = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        reason = f": {error.strerror}" if isinstance(error, OSError) and error.strerror else ""
        raise CaseError(f"{key}: expected a .npy or .npz file of numbers{reason}") from None
    if isinstance(found, np.ndarray):
        return found
    if name not in found.files and len(found.files) != 1:
        raise CaseError(f"{key}: expected one array, or one named {name!r}")
    return found[name if name in found.files else found.files[0]]


def start(
    cpu: CPU,
    positions: Any = None,
    velocities: Any = None,
    beads: Any = None,
    bead_velocities: Any = None,
) -> None:
    """Give the particles their first positions and velocities.

    Parameters
    ----------
    cpu : CPU
        The fluid in memory; its case says how to draw what is not given.
    positions, velocities : array (n, d), optional
        In cells, and in cells per unit of time, by particle id, as `read_arrays` has checked them.
    beads, bead_velocities : array (n, d), optional
        The same of the beads of solutes.
    """
    case, d = cpu.case, cpu.dimension
    random = np.random.Generator(np.random.Philox(key=(case.run.seed, int(INITIAL_POSITION))))
    mass = cpu.masses()
    _put_masses(cpu, mass)
    molecule = case.fluid.molecule
    if molecule is not None and positions is not None:
        positions = connected(positions, molecule, periods(cpu))
    elif molecule is not None:
        positions = drawn(molecule, cpu.n, case.fluid.kT, cpu.box, random, stays_out(cpu))
    elif positions is None:
        positions = _uniform(cpu, random)
    for k in range(d):
        cpu.put(k, positions[:, k])
    random = np.random.Generator(np.random.Philox(key=(case.run.seed, int(INITIAL_VELOCITY))))
    for k in range(d):
        if velocities is None:
            v = random.standard_normal(cpu.n)
            v *= np.sqrt(case.fluid.kT / mass)
            whole = max(mass.sum(), 1e-300)
            v -= np.sum(mass * v) / whole  # np.dot would depend on the threads of BLAS
        else:
            v = velocities[:, k]
        cpu.put(d + k, v)
    if case.solutes is not None:
        start_solutes(cpu, case.solutes, beads, bead_velocities, velocities is None)
    if velocities is None and case.box.shear_rate != 0.0:
        cpu.row(d)[...] += case.box.shear_rate * (cpu.row(1) - 0.5 * cpu.box[1])
    cpu.sort()


def _uniform(cpu: CPU, random: np.random.Generator) -> Floats:
    """Places (n, d) uniform in the fluid: those that lie in a solid are drawn again."""
    places = np.stack([random.random(cpu.n) * length for length in cpu.box], axis=1)
    if cpu.solids is None or cpu.slit is not None:
        return places
    left = np.arange(cpu.n)
    while len(left):
        left = left[cpu.solids.distance(places[left]) < MARGIN]
        places[left] = random.random((len(left), cpu.dimension)) * cpu.box
    return places


def stays_out(cpu: CPU, clear: float = 0.0) -> Callable[[Floats], NDArray[np.bool_]]:
    """Which of places (..., d) are in the fluid, so far from its surfaces."""
    if cpu.solids is None:
        return lambda places: np.ones(places.shape[:-1], bool)
    if cpu.slit is not None:
        axis, length = AXES.index(cpu.slit.axis), cpu.box[AXES.index(cpu.slit.axis)]
        return lambda places: (places[..., axis] > clear) & (places[..., axis] < length - clear)
    solids, d = cpu.solids, cpu.dimension

    def outside(places: Floats) -> NDArray[np.bool_]:
        inside_box = places.reshape(-1, d).copy()
        good = np.ones(len(inside_box), bool)
        for k, shut in enumerate(cpu.closed):
            x = inside_box[:, k]
            if shut:
                good &= (x > clear) & (x < cpu.box[k] - clear)
            else:
                x -= np.floor(x / cpu.box[k]) * cpu.box[k]
        good[good] = solids.distance(inside_box[good]) >= max(clear, MARGIN)
        return good.reshape(places.shape[:-1])

    return outside


def periods(cpu: CPU) -> Floats:
    """Lengths of the box, infinite where walls close it."""
    return np.where(cpu.closed, np.inf, cpu.box)


def _put_masses(cpu: CPU, mass: Floats) -> None:
    """Write the row of masses, where there is one; virtual particles get them in proportion."""
    if cpu.rows == 2 * cpu.dimension:
        return
    cpu.put(2 * cpu.dimension, mass)
    sample = mass[(np.arange(cpu.n_virtual) * 7919) % cpu.n]
    virtual = cpu.virtual_row(2 * cpu.dimension)
    virtual[...] = mass[0]
    for j, m in enumerate(sample):
        virtual[j // virtual.shape[1], j % virtual.shape[1]] = m


def _checked(case: Case, owner: str, key: str, values: Any) -> Floats:
    """Numbers for each particle."""
    if np.ma.isMaskedArray(values):
        raise CaseError(f"{key}: expected an array of numbers without a mask")
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        raise CaseError(f"{key}: expected an array of numbers") from None
    if array.dtype.kind not in "iuf":
        raise CaseError(f"{key}: expected an array of numbers, not of {array.dtype.name}")
    array = array.astype(float)
    beads = case.solutes.beads if owner == "solutes" and case.solutes else case.particles
    shape = beads, case.box.dimension
    if array.shape != shape:
        raise CaseError(
            f"{key}: shape {array.shape}: expected {shape}, one row for each of the "
            + ("solutes' beads" if owner == "solutes" else "fluid's particles")
        )
    if not np.isfinite(array).all():
        row = int(np.argwhere(~np.isfinite(array))[0][0])
        raise CaseError(f"{key}: row {row} is not finite")
    return array


def _inside(case: Case, key: str, positions: Floats) -> None:
    """Nobody in a wall."""
    if not case.walls:
        return
    outside = solids_of(case).distance(positions) < 0
    if outside.any():
        row = int(np.argmax(outside))
        raise CaseError(f"{key}: row {row} = {positions[row].tolist()} lies in a wall")


def _near(case: Case, key: str, positions: Floats) -> None:
    """Nobody so far away that the boxes between cannot be counted."""
    far = np.abs(positions / case.box.size) >= MOST_IMAGES
    if far.any():
        row = int(np.argmax(far.any(axis=1)))
        raise CaseError(
            f"{key}: row {row} = {positions[row].tolist()} is 2^30 boxes away or more; expected "
            "positions nearer to the box"
        )
