"""What a run of spheres starts from: the start of its case, or arrays, all checked."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.spheres.made import Made
from mesokit.spheres.start import thermal
from mesokit.spheres.start.lattice import shut
from mesokit.spheres.start.protocol import Array, Started

if TYPE_CHECKING:
    from mesokit.case.case import Case

ROUNDING = 1e-5  # of a diameter: files keep places as float32
ARRAYS = ("positions", "velocities", "spins")


def first_state(case: Case, made: Made, arrays: Mapping[str, Any], spin_kT: float) -> Started:
    """Places, velocities and spins of all. Raises CaseError for arrays that do not fit.

    Velocities and spins that nobody gives are drawn. Only hard spheres must not overlap.
    """
    d, n = case.box.dimension, len(made.diameters)
    given = {name: arrays[name] for name in ARRAYS if arrays.get(name) is not None}
    placed = case.spheres.start.place(case, made) if "positions" not in given else None
    positions = placed.positions if placed else _checked("positions", given, (n, d))
    velocities = placed.velocities if placed else None
    spins = placed.spins if placed else None
    if "velocities" in given:
        velocities = _checked("velocities", given, (n, d))
    if "spins" in given:
        spins = _checked("spins", given, (n,) if d == 2 else (n, 3))
    at_rest = not case.walls and not case.spheres.gravity
    kT = case.spheres.kT
    if velocities is None:
        velocities = thermal.velocities(case.run.seed, made, kT, d, at_rest)
    if spins is None:
        spins = thermal.spins(case.run.seed, made, spin_kT, d)
    diameters = placed.diameters if placed else None
    if placed is None or case.spheres.start.files():
        own = made.diameters if diameters is None else diameters
        if case.spheres.hard:
            require_apart(positions, own, np.array(case.box.size, float), shut(case))
    return Started(positions, velocities, spins, diameters)


def require_apart(places: Array, diameters: Array, size: Array, closed: NDArray[np.bool_]) -> None:
    """Raise CaseError for spheres that lie on one another, or on plates, by more than rounding."""
    from scipy.spatial import cKDTree

    largest = float(diameters.max())
    beyond = np.minimum(places, size - places) - 0.5 * diameters[:, None]
    lowest = np.where(closed, beyond, np.inf).min(axis=1)
    if (lowest < -ROUNDING * largest).any():
        raise CaseError(f"positions: sphere {int(lowest.argmin())} lies in a plate")
    around = np.where(closed, 3 * size, size)
    tree = cKDTree(np.where(closed, places, np.mod(places, size)), boxsize=around)
    pairs = tree.query_pairs(largest, output_type="ndarray")
    way = places[pairs[:, 0]] - places[pairs[:, 1]]
    way -= around * np.rint(way / around)
    gaps = np.linalg.norm(way, axis=1) - 0.5 * (diameters[pairs[:, 0]] + diameters[pairs[:, 1]])
    if len(gaps) and gaps.min() < -ROUNDING * largest:
        i, j = pairs[gaps.argmin()]
        raise CaseError(f"positions: spheres {i} and {j} overlap by {-gaps.min():.3g}")


def _checked(name: str, given: Mapping[str, Any], shape: tuple[int, ...]) -> Array:
    try:
        found = np.asarray(given[name], float)
    except (ValueError, TypeError):
        raise CaseError(f"{name}: expected an array of numbers") from None
    if found.shape != shape or not np.isfinite(found).all():
        raise CaseError(f"{name}: expected finite numbers of shape {shape}, not {found.shape}")
    return found


def starts(case: Case) -> dict[str, Path]:
    """The files and folders of runs that a case starts from, by their keys."""
    return {f"spheres.start.{key}": path for key, path in case.spheres.start.files().items()}


def missing_files(case: Case) -> list[str]:
    """A line for each of them that is not there."""
    return [
        f"{key} = {show(str(path), 500)}: no such {'folder' if key.endswith('run') else 'file'}"
        for key, path in starts(case).items()
        if not path.exists()
    ]
