"""Speeds and steps for starts with the velocities of arrays, files and earlier runs."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.start.first_state import given_state
from mesokit.method.spheres.common.start.protocol import Array, Placed
from mesokit.method.spheres.common.walls import room_of
from mesokit.method.spheres.soft import scales
from mesokit.method.spheres.soft.pair.protocol import ContactLaw

HOT = 2.0  # of the energy that the step is made for, from which it is shorter
TAIL = 5.0  # thermal velocities of the fastest of many spheres


def with_speed(case: Case, arrays: Mapping[str, Any]) -> Case:
    """The case with `spheres.speed` from the velocities and overlaps of arrays or files; with a
    potential, with `spheres.timestep`.

    The two fastest spheres may meet head-on. Overlaps larger than those of collisions at the usual
    speed drive spheres apart. Nothing changes where velocities are drawn. Raises CaseError for
    arrays and files that do not fit.
    """
    section, given = case.spheres, bool(arrays or case.spheres.start.files())
    if not isinstance(section.pair, ContactLaw):
        return _with_step(case, arrays) if given and section.timestep is None else case
    usual = scales.speed_of_collision(case)
    if section.speed is not None or (usual > 0 and not given):
        return case
    known = given_state(case, made(case), arrays)
    overlap = _largest_overlap(case, known)
    driven = scales.speed_of_overlap(case, overlap) if overlap > 0 else 0.0
    speed = usual
    if known.velocities is not None and given:
        speeds = np.linalg.norm(_about_mean(case, known.velocities), axis=1)
        head_on = math.fsum(np.sort(speeds)[-2:])  # of the two fastest
        speed = max(head_on, scales.speed_of_heat(case, 0.0), scales.speed_of_fall(case))
        speed += scales.speed_of_walls(case)
    elif driven <= usual:
        return case
    speed = max(speed, driven)
    if speed == 0:
        return case
    return dataclasses.replace(case, spheres=dataclasses.replace(section, speed=speed))


def _with_step(case: Case, arrays: Mapping[str, Any]) -> Case:
    """The case with a shorter step, where the velocities are hotter than its kT."""
    spheres = made(case)
    velocities = given_state(case, spheres, arrays).velocities
    if velocities is None:
        return case
    twice = spheres.masses * (_about_mean(case, velocities) ** 2).sum(axis=1)
    kT = float(max(twice.mean() / case.box.dimension, twice.max() / TAIL**2))
    if kT <= HOT * scales.expected_kT(case):
        return case
    step = scales.step_of_flight(case, kT)
    return dataclasses.replace(case, spheres=dataclasses.replace(case.spheres, timestep=step))


def _about_mean(case: Case, velocities: Array) -> Array:
    """Velocities about their mean, which has no effect where no walls are."""
    return velocities if case.walls else velocities - velocities.mean(axis=0)


def _largest_overlap(case: Case, known: Placed) -> float:
    """The largest overlap of two spheres, 0 where none overlap."""
    diameters = made(case).diameters if known.diameters is None else known.diameters
    period = np.where(room_of(case).closed, 0.0, case.box.size)
    one, other, distances = near_pairs(known.positions, float(diameters.max()), period)
    touch = 0.5 * (diameters[one] + diameters[other])
    return float(np.max(touch - distances, initial=0.0))
