"""Protocol of collision rules: a few functions, each of one particle or one cell.

`CollisionRule` is the part of a case: parameters, and properties of the rule. Over the
particles of a cell the execution layer sums, for every rule, their number, mass, momentum m v and
m v^2; a rule adds sums of its own. `r` is a position relative to the centre of the shifted cell.
The first argument is the rule's NamedTuple of parameters; its class picks the implementation.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

from mesokit import theory
from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.scalar.jit import generic
from mesokit.theory.transport import Thermostat as NamedThermostat


class Gas(NamedTuple):
    """A fluid of single particles of one mass, as theory takes it.

    `thermostat` is the name that `mesokit.theory` has for it, None if it has none.
    """

    dimension: int
    density: float
    timestep: float
    kT: float
    mass: float
    thermostat: NamedThermostat | None


@family("collision rule", "rule", "mesokit.collision")
@component
class CollisionRule(ABC):
    """How the particles of a cell exchange momentum."""

    acts: ClassVar[bool] = True  # False: particles never meet
    conserves: ClassVar[tuple[str, ...]] = ()  # "mass", "momentum", "energy", "angular momentum"
    needs_energy: ClassVar[bool] = False  # whether `coefficients` needs the sum of m v^2
    isothermal: ClassVar[bool] = False  # whether it holds the temperature itself
    one_temperature: ClassVar[bool] = True  # of all kinds of particles in a mixture
    # which of its own sums `coefficients` is to have the gradient of, over neighbouring cells
    gradient_of: ClassVar[int | None] = None
    kinds: ClassVar[int | None] = None  # how many species it is for, None for any number
    ideal: ClassVar[bool] = True  # whether any mixture is an ideal gas at rest
    # million particle-steps per second of one thread, by dimension: for estimates of the run time
    rates: ClassVar[Mapping[int, float]] = {2: 60.0, 3: 33.0}

    # double precision operations of a particle-step in 3D, from machine code of cards
    operations: ClassVar[float] = 310.0

    @abstractmethod
    def kernel(self, dimension: int, kT: float) -> Any:
        """Parameters for the scalar functions below: a NamedTuple, whose class picks them."""

    @abstractmethod
    def own_sums(self, dimension: int) -> tuple[str, ...]:
        """Kind of each of its sums: "momentum" (of a component), "mass" or "energy"."""

    @abstractmethod
    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        """Number of results of `coefficients`; `stretched`: a thermostat acts."""

    def among(self, kernel: Any, counts: tuple[int, ...], mass: float) -> Any:
        """The kernel for so many particles of each species, numbered in turn; mean mass."""
        return kernel

    def problems(self, dimension: int) -> Iterator[str]:
        """The error in this dimension, key first; "" if there is none."""
        yield from ()

    def in_theory(self) -> dict[str, Any] | None:
        """Its name and angle in `mesokit.theory`; None without a theory."""
        return None

    def transport(self, gas: Gas) -> theory.Transport | None:
        """Transport coefficients; None without a theory. May raise ValueError for odd numbers."""
        known = self.in_theory() if gas.thermostat is not None else None
        return None if known is None else theory.transport(**known, **gas._asdict())

    def shear_warming(self, gas: Gas) -> float | None:
        """Rise of the temperature of a held gas, over mass and squared shear rate."""
        known = self.in_theory() if gas.thermostat is not None else None
        return None if known is None else theory.shear_warming(**known, **gas._asdict())

    def heat_at_walls(self, gas: Gas) -> theory.HeatAtWalls | None:
        """Conductivity of heat, and jump of the temperature at walls, of a gas that is not held."""
        return None

    def temperature_offset(self, gas: Gas, mean_free_path: float) -> float:
        """Largest known (T - kT)/kT of the gas at rest."""
        known = self.in_theory()
        if known is None or gas.thermostat is None:
            return 0.0
        return theory.temperature_offset(
            known["rule"], gas.thermostat, gas.dimension, gas.density, mean_free_path
        )

    def bead_diffusion(
        self, gas: Gas, mass: float, others: Sequence[tuple[float, float]] = ()
    ) -> float | None:
        """Diffusion coefficient of a bead of this mass in the gas, among `others`: how many of each
        kind in a cell, and their mass. None without a theory."""
        return None


class Cell(NamedTuple):
    """Sums over the particles of a cell.

    Their number, mass and momentum, `energy` the sum of m v^2, `sums` those of the rule: its
    own sums, and after them the gradient of the one with number `gradient_of`, per cell of length.
    """

    number: float
    mass: float
    momentum: tuple[float, ...]
    energy: float
    sums: tuple[float, ...]


@generic
def contribute(rule, counter, key, m, v, r):
    """The velocity that a particle keeps until it collides, and what it adds to the rule's sums.

    `key` is the index and the draw of its random words: no two particles of a step share them.
    """


@generic
def freedom(rule, n):
    """Degrees of freedom that n particles have beside the conserved ones of their cell."""


@generic
def coefficients(rule, thermostat, variate, chance, cell):
    """Coefficients of a cell by which each of its particles collides.

    `cell` is what they add up to (see `Cell`), `variate` the thermostat's random number, `chance`
    two random words.
    """


@generic
def collide(rule, c, v, r):
    """Velocity after the collision, from the coefficients c of the cell."""
