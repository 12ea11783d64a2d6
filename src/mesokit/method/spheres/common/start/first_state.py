"""The first state of a run of spheres: by the start of its case or by arrays, all checked."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.given.outside_box import warn_outside
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.draws import normal_rows
from mesokit.method.spheres.common.made import Made, made
from mesokit.method.spheres.common.start.lattice import shut
from mesokit.method.spheres.common.start.protocol import Array, Placed

ROUNDING = 1e-5  # of a diameter: files keep places as float32
ARRAYS, RUN = ("positions", "velocities", "spins"), "spheres.start.run"
VELOCITIES, SPINS = 61, 62  # purposes of random numbers, above METHOD


class Started(NamedTuple):
    """The first state by particle number: positions and velocities (n, d), spins ((n,) in 2D,
    (n, 3) in 3D), and diameters (n,) where they are not those of the case."""

    positions: Array
    velocities: Array
    spins: Array
    diameters: Array | None = None


def first_state(case: Case, arrays: Mapping[str, Any]) -> Started:
    """Places, velocities and spins of all. Raises CaseError for arrays that do not fit.

    Velocities and spins that are not given are drawn, about the flow of a sheared box. Only hard
    spheres must not overlap.
    """
    section, d, own = case.spheres, case.box.dimension, made(case)
    known = given_state(case, own, arrays)
    velocities, spins = known.velocities, known.spins
    if velocities is None:
        at_rest = not case.walls and not section.gravity
        velocities = thermal_velocities(case.run.seed, own, section.kT, d, at_rest)
        if case.box.sheared:
            length = case.box.size[1]
            height = known.positions[:, 1] % length - 0.5 * length
            velocities[:, 0] += case.box.first_rate * height
    if spins is None:
        spins = thermal_spins(case.run.seed, own, section.first_spin_kT, d)
    if arrays.get("positions") is not None or section.start.files():
        diameters = own.diameters if known.diameters is None else known.diameters
        if section.hard:
            require_apart(known.positions, diameters, np.array(case.box.size, float), shut(case))
        warn_outside("positions", known.positions, case.box, closed_axes(case.walls))
    return Started(known.positions, velocities, spins, known.diameters)


def given_state(case: Case, made: Made, arrays: Mapping[str, Any]) -> Placed:
    """The state by arrays, and else by the start of the case. Raises CaseError for a bad array."""
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


def require_apart(places: Array, diameters: Array, size: Array, closed: NDArray[np.bool_]) -> None:
    """Raise CaseError for spheres that overlap one another, or plates, by more than rounding."""
    depth, which = deepest(places, diameters, size, closed)
    if depth > ROUNDING:
        raise CaseError(
            f"positions: {which} overlap by {depth:.3g} diameters; expected none of hard spheres; "
            f"spheres.start.shrink = {2 * depth:.1g} of a file or run makes them smaller"
        )


def deepest(
    places: Array, diameters: Array, size: Array, closed: NDArray[np.bool_]
) -> tuple[float, str]:
    """The largest overlap of two spheres, or of one with a plate, over the mean of their diameters;
    and which they are. 0 and no words where none overlap.

    >>> depth, which = deepest(np.array([[1.0, 1.0], [1.9, 1.0]]), np.ones(2), np.full(2, 9.0),
    ...                        np.array([False, False]))
    >>> round(depth, 6), which
    (0.1, 'spheres 0 and 1')
    """
    beyond = 0.5 * diameters[:, None] - np.minimum(places, size - places)
    into = np.where(closed, beyond, 0.0).max(axis=1) / diameters
    depth, which = max(float(into.max()), 0.0), f"sphere {int(into.argmax())} and a plate"
    one, other, distances = near_pairs(places, float(diameters.max()), np.where(closed, 0.0, size))
    touch = 0.5 * (diameters[one] + diameters[other])
    overlaps = (touch - distances) / touch
    if len(overlaps) and overlaps.max() > depth:
        k = int(overlaps.argmax())
        depth, which = float(overlaps[k]), f"spheres {int(one[k])} and {int(other[k])}"
    return (depth, which) if depth > 0 else (0.0, "")


def thermal_velocities(
    seed: int, made: Made, kT: float, dimension: int, at_rest: bool = True
) -> Array:
    """Maxwellian velocities (n, d); of zero total momentum if `at_rest`, with exactly the thermal
    energy that these degrees of freedom have: m v^2 adds up to (n - 1) d kT, or n d kT.
    """
    n = len(made.masses)
    v = normal_rows(seed, 0, VELOCITIES, n, dimension) / np.sqrt(made.masses)[:, None]
    degrees = n * dimension
    if at_rest and n > 1:
        v -= made.masses @ v / made.masses.sum()
        degrees -= dimension
    return _scaled(v, made.masses, degrees, kT)


def thermal_spins(seed: int, made: Made, kT: float, dimension: int) -> Array:
    """Maxwellian angular velocities, (n,) in 2D and (n, 3) in 3D."""
    n, axes = len(made.masses), 1 if dimension == 2 else 3
    drawn = normal_rows(seed, 0, SPINS, n, 3)[:, :axes] / np.sqrt(made.inertia)[:, None]
    w = _scaled(drawn, made.inertia, n * axes, kT)
    return w[:, 0] if dimension == 2 else w


def _scaled(v: Array, weights: Array, degrees: int, kT: float) -> Array:
    twice = float(weights @ (v * v).sum(axis=1))
    return v * np.sqrt(kT * degrees / twice) if twice > 0 else v


def starts(case: Case) -> dict[str, Path]:
    """The files and folders of runs that a case starts from, by their keys."""
    return {f"spheres.start.{key}": path for key, path in case.spheres.start.files().items()}
