"""What a source of energy is."""

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, option
from mesokit.case.registry import family

Array = NDArray[np.float64]


class Motion(NamedTuple):
    """velocities (n, d), to be changed; masses (n,); all by particle number; the seed of the run,
    and how many times it has been done before."""

    velocities: Array
    masses: Array
    seed: int
    turn: int


@family("heating of hard spheres", "rule", "mesokit.sphere_heating")
@component
class Heating(ABC):
    """Changes velocities at fixed times."""

    interval: float | None = option(
        default=None,
        doc="time between two turns (a quarter of that between two collisions unless said)",
        unit="time",
        kw_only=True,
        gt=0,
        le=1e9,
    )

    @property
    def bath_kT(self) -> float | None:
        """Thermal energy of the bath that it couples spheres to, None where it is none."""
        return None

    @property
    def white_noise(self) -> bool:
        """Whether it is a force without memory, of zero mean, on each sphere."""
        return False

    @abstractmethod
    def act(self, motion: Motion, interval: float) -> None:
        """Change the velocities, after so much time."""
