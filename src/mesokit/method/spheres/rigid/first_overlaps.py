"""Starts from arrays, files and earlier runs: overlaps, and the step for the velocities."""

import dataclasses
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.start.first_state import deepest, given_state
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
