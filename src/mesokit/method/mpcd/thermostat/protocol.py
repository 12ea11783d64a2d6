"""Protocol of thermostats: the kinetic energy that the particles of a cell should have.

Energies are those of the motion that a collision rule leaves free: relative to the cell's centre of
mass, and for the rules +a to its rotation too. The first argument is the thermostat's NamedTuple of
parameters; its class picks the implementation.
"""

import math
from abc import ABC, abstractmethod
from typing import Any, ClassVar

from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.scalar.jit import generic, scalar
from mesokit.theory.transport import Thermostat as Named


@family("thermostat", "rule", "mesokit.thermostat")
@component
class Thermostat(ABC):
    """Thermostat of the cells."""

    acts: ClassVar[bool] = True  # whether it holds the temperature
    needs_energy: ClassVar[bool] = True  # whether `stretch` needs the kinetic energy
    canonical: ClassVar[bool] = False  # whether it leaves the canonical distribution alone
    one_temperature: ClassVar[bool] = True  # of all kinds of particles in a mixture
    in_theory: ClassVar[Named | None] = None  # its name in `mesokit.theory`

    @abstractmethod
    def kernel(self, kT: float, floor: float) -> Any:
        """Parameters for the scalar functions below; an energy below the floor is noise."""


@generic
def guess(thermostat, chance, freedom):
    """A random number for `target` from two random words, and whether it may surely be used.

    Thermostats that register nothing use none.
    """


@generic
def draw(thermostat, counter, cell, freedom, attempt):
    """The same with a test that decides, where `guess` was not sure; if refused, try the next."""


guess.otherwise(lambda thermostat, chance, freedom: (0.0, True))
draw.otherwise(lambda thermostat, counter, cell, freedom, attempt: (0.0, True))


@generic
def target(thermostat, variate, freedom, energy):
    """Kinetic energy to reach, from the present one."""


@scalar
def root_of_ratio(wanted, present, freedom, floor):
    """sqrt(wanted / present), and 1 where there is nothing to scale.

    The present energy is a sum of rounded numbers: below the floor it is noise, which must not be
    stretched to the target.
    """
    ratio = wanted / max(present, floor)
    return math.sqrt(ratio) if freedom > 0.5 and wanted > 0.0 else 1.0


@generic
def stretch(thermostat, variate, freedom, energy):
    """Factor for the velocities that takes their energy to the target: (factor,) or ()."""


@stretch.otherwise
def _(thermostat, variate, freedom, energy):
    wanted = target(thermostat, variate, freedom, energy)
    return (root_of_ratio(wanted, energy, freedom, thermostat.floor),)
