"""What a run of spheres starts from: the start of its case, or arrays, all checked."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.given.outside_box import warn_outside
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start import thermal
from mesokit.method.spheres.common.start.lattice import shut
from mesokit.method.spheres.common.start.protocol import Array, Placed, Started

ROUNDING = 1e-5  # of a diameter: files keep places as float32
ARRAYS, RUN = ("positions", "velocities", "spins"), "spheres.start.run"


def first_state(case: Case, made: Made, arrays: Mapping[str, Any], spin_kT: float) -> Started:
    """Places, velocities and spins of all. Raises CaseError for arrays that do not fit.

    Velocities and spins that are not given are drawn. Only hard spheres must not overlap.
    """
    d, known = case.box.dimension, given_state(case, made, arrays)
    at_rest = not case.walls and not case.spheres.gravity
    kT, velocities, spins = case.spheres.kT, known.velocities, known.spins
    if velocities is None:
        velocities = thermal.velocities(case.run.seed, made, kT, d, at_rest)
    if spins is None:
        spins = thermal.spins(case.run.seed, made, spin_kT, d)
    if arrays.get("positions") is not None or case.spheres.start.files():
        own = made.diameters if known.diameters is None else known.diameters
        if case.spheres.hard:
            require_apart(known.positions, own, np.array(case.box.size, float), shut(case))
        warn_outside("positions", known.positions, case.box, closed_axes(case.walls))
    return Started(known.positions, velocities, spins, known.diameters)


def given_state(case: Case, made: Made, arrays: Mapping[str, Any]) -> Placed:
    """What arrays give, and else the start of the case. Raises CaseError for what does not fit."""
    d, n = case.box.dimension, len(made.diameters)
    shapes = {"positions": (n, d), "velocities": (n, d), "spins": (n,) if d == 2 else (n, 3)}
    given = {
        name: _checked(name, arrays[name], shape)
        for name, shape in shapes.items()
        if arrays.get(name) is not None
    }
    if "positions" in given:
        return Placed(**given)
    return case.spheres.start.place(case, made)._replace(**given)


def require_apart(places: Array, diameters: Array, size: Array, closed: NDArray[np.bool_]) -> None:
    """Raise CaseError for spheres that lie on one another, or on plates, by more than rounding."""
    largest = float(diameters.max())
    beyond = np.minimum(places, size - places) - 0.5 * diameters[:, None]
    lowest = np.where(closed, beyond, np.inf).min(axis=1)
    if (lowest < -ROUNDING * largest).any():
        raise CaseError(f"positions: sphere {int(lowest.argmin())} lies in a plate")
    one, two, distance = near_pairs(places, largest, np.where(closed, 0.0, size))
    gaps = distance - 0.5 * (diameters[one] + diameters[two])
    if len(gaps) and gaps.min() < -ROUNDING * largest:
        i, j = one[gaps.argmin()], two[gaps.argmin()]
        raise CaseError(f"positions: spheres {i} and {j} overlap by {-gaps.min():.3g}")


def _checked(name: str, given: Any, shape: tuple[int, ...]) -> Array:
    try:
        found = np.asarray(given, float)
    except (ValueError, TypeError):
        raise CaseError(f"{name}: expected an array of numbers") from None
    if found.shape != shape:
        raise CaseError(f"{name}: shape {found.shape}: expected {shape}")
    if not np.isfinite(found).all():
        raise CaseError(f"{name}: row {int(np.argwhere(~np.isfinite(found))[0][0])} is not finite")
    return found


def starts(case: Case) -> dict[str, Path]:
    """The files and folders of runs that a case starts from, by their keys."""
    return {f"spheres.start.{key}": path for key, path in case.spheres.start.files().items()}
