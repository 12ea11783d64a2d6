"""Base of the sources of energy for hard spheres."""

from abc import ABC, abstractmethod
from typing import NamedTuple

from mesokit.case.component import component, option
from mesokit.case.registry import family
from mesokit.seam.engine import Array


class Heated(NamedTuple):
    """velocities (n, d), to be changed, and masses (n,), by particle number; seed of the run;
    turn: number of earlier calls."""

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
    def act(self, heated: Heated, interval: float) -> None:
        """Change the velocities of `heated` in place; `interval`: time since the last call."""
