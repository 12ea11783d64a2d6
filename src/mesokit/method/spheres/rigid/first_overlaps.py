"""Starts from arrays, files and earlier runs: overlaps, and the step for the velocities."""

import dataclasses
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.start.first_state import given_state
from mesokit.method.spheres.common.start.lattice import shut
from mesokit.method.spheres.common.start.protocol import Array
from mesokit.method.spheres.rigid import scales

WARNED, REFUSED = 0.01, 0.1  # overlaps in diameters: of soft spheres at rest, and beyond all sense


def with_start(case: Case, arrays: Mapping[str, Any]) -> Case:
    """The case with a shorter `spheres.timestep` where grains of the start are fast.

    Overlaps of arrays and files stay for ever, unless `push_back` takes them back. Raises CaseError
    for those deeper than a tenth of a diameter, and warns of those beyond a hundredth.
    """
    if not (arrays or case.spheres.start.files()):
        return case
    section, own = case.spheres, made(case)
    known = given_state(case, own, arrays)
    diameters = own.diameters if known.diameters is None else known.diameters
    if section.push_back == 0:
        _check_overlaps(case, known.positions, diameters)
    if known.velocities is None or section.timestep is not None:
        return case
    fastest = float(np.linalg.norm(known.velocities, axis=1).max())
    step = scales.OF_SKIN * scales.longest_step(case, fastest)
    if step >= scales.timestep_of(case):
        return case
    return dataclasses.replace(case, spheres=dataclasses.replace(section, timestep=step))


def _check_overlaps(case: Case, places: Array, diameters: Array) -> None:
    depth, which = deepest(places, diameters, np.array(case.box.size, float), shut(case))
    said = f"positions: {which} overlap by {depth:.3g} diameters"
    if depth > REFUSED:
        raise CaseError(
            f"{said}, and rigid grains stay as deep; expected less than {REFUSED:g}, or "
            "spheres.push_back above 0"
        )
    if depth > WARNED:
        warnings.warn(
            f"{said}, which stays so; spheres.push_back = 0.1 takes overlaps back", stacklevel=3
        )


def deepest(
    places: Array, diameters: Array, size: Array, closed: NDArray[np.bool_]
) -> tuple[float, str]:
    """The largest overlap of two spheres, or of one with a plate, over the mean of their diameters;
    and which they are. 0 and no words where none overlap.

    >>> depth, which = deepest(np.array([[1.0, 1.0], [1.9, 1.0]]), np.ones(2), np.full(2, 9.0),
    ...                        np.array([False, False]))
    >>> round(depth, 6), which
    (0.1, 'grains 0 and 1')
    """
    beyond = 0.5 * diameters[:, None] - np.minimum(places, size - places)
    into = np.where(closed, beyond, 0.0).max(axis=1) / diameters
    depth, which = max(float(into.max()), 0.0), f"grain {int(into.argmax())} and a plate"
    one, other, distances = near_pairs(places, float(diameters.max()), np.where(closed, 0.0, size))
    touch = 0.5 * (diameters[one] + diameters[other])
    overlaps = (touch - distances) / touch
    if len(overlaps) and overlaps.max() > depth:
        k = int(overlaps.argmax())
        depth, which = float(overlaps[k]), f"grains {int(one[k])} and {int(other[k])}"
    return (depth, which) if depth > 0 else (0.0, "")
