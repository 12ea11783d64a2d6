"""Diameter, mass, moment of inertia and kind of each sphere of a case."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.spheres.common.draws import uniform_rows
from mesokit.seam.engine import Array

SIZES = 60  # purpose of the random numbers of diameters, above METHOD
INERTIA = {2: 1 / 8, 3: 1 / 10}  # moment of inertia over m diameter^2 of a disk and a sphere


class Made(NamedTuple):
    """By particle number: diameters, masses, moments of inertia (n,), and kinds (n,) from 0."""

    diameters: Array
    masses: Array
    inertia: Array
    kinds: NDArray[np.int64]


def made(case: Case) -> Made:
    """The spheres of a case; diameters are drawn by the seed where kinds have a spread.

    Given number and packing fraction, the fraction is met exactly.
    """
    section, box = case.spheres, case.box
    d, counts = box.dimension, section.counts(box)
    kinds = np.repeat(np.arange(len(counts)), counts)
    uniform = uniform_rows(case.run.seed, 0, SIZES, len(kinds))
    middle = np.array([kind.diameter for kind in section.kinds])[kinds]
    spread = np.array([kind.spread for kind in section.kinds])[kinds]
    relative = 1 + spread * (2 * uniform - 1)
    mass = np.array([kind.mean_mass(d) for kind in section.kinds])[kinds] * relative**d
    diameters = middle * relative * section.scale(box)
    return Made(diameters, mass, INERTIA[d] * mass * diameters**2, kinds)
