"""How fast spheres move that start with the velocities of arrays, files and earlier runs."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.near import near_pairs
from mesokit.method.spheres.common.start.first_state import given_state
from mesokit.method.spheres.common.start.protocol import Array, Placed
from mesokit.method.spheres.common.walls import room_of
from mesokit.method.spheres.soft import scales
from mesokit.method.spheres.soft.pair.protocol import ContactLaw

HOT = 2.0  # of the energy that the step is made for, from which it is shorter
TAIL = 5.0  # thermal velocities of the fastest of many


def with_speed(case: Case, arrays: Mapping[str, Any]) -> Case:
    """The case with `spheres.speed`, where arrays or the start of the case decide on it; with a
    potential, with `spheres.timestep`.

    They do where they give velocities: the two fastest may meet head-on; and where spheres overlap
    by more than collisions at the usual speed would press them, which drives them apart. Nothing
    changes where velocities are drawn. Raises CaseError for arrays and files that do not fit.
    """
    section = case.spheres
    usual = scales.speed_of_collision(case)
    if not isinstance(section.pair, ContactLaw):
        return _with_step(case, arrays)
    if section.speed is not None:
        return case
    if usual > 0 and not arrays and not section.start.files():
        return case
    known = given_state(case, made(case), arrays)
    overlap = _largest_overlap(case, known)
    driven = scales.speed_of_overlap(case, overlap) if overlap > 0 else 0.0
    speed = usual
    if known.velocities is not None and (arrays or section.start.files()):
        others = scales.speed_of_heat(case, 0.0), scales.speed_of_fall(case)
        speed = max(_head_on(case, known.velocities), *others) + scales.speed_of_walls(case)
    elif driven <= usual:
        return case
    speed = max(speed, driven)
    if speed == 0:
        return case
    return dataclasses.replace(case, spheres=dataclasses.replace(section, speed=speed))


def _with_step(case: Case, arrays: Mapping[str, Any]) -> Case:
    """The case with a shorter step, where spheres start hotter than it says."""
    section = case.spheres
    if section.timestep is not None or not (arrays or section.start.files()):
        return case
    spheres = made(case)
    v = given_state(case, spheres, arrays).velocities
    if v is None:
        return case
    kT = _energy(case, v, spheres.masses)
    if kT <= HOT * scales.expected_kT(case):
        return case
    step = scales.step_of_flight(case, kT)
    return dataclasses.replace(case, spheres=dataclasses.replace(section, timestep=step))


def _energy(case: Case, velocities: Array, masses: Array) -> float:
    """kT of what moves about the mean velocity, at least that of which the fastest is the tail."""
    v = velocities if case.walls else velocities - velocities.mean(axis=0)
    twice = masses * (v**2).sum(axis=1)
    return float(max(twice.mean() / case.box.dimension, twice.max() / TAIL**2))


def _head_on(case: Case, velocities: Array) -> float:
    """The sum of the two largest speeds, against the mean velocity where no walls are."""
    v = velocities if case.walls else velocities - velocities.mean(axis=0)
    return math.fsum(np.sort(np.linalg.norm(v, axis=1))[-2:])


def _largest_overlap(case: Case, known: Placed) -> float:
    """The largest overlap of two spheres, 0 where none overlap."""
    diameters = made(case).diameters if known.diameters is None else known.diameters
    size, closed = np.array(case.box.size, float), np.array(room_of(case).closed)
    pairs, distances = near_pairs(known.positions, size, closed, float(diameters.max()))
    return float(np.max(0.5 * diameters[pairs].sum(axis=1) - distances, initial=0.0))
