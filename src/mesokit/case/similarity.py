"""Dimensionless numbers: how far two fluids, in any units, flow alike."""

import math
from collections.abc import Callable
from typing import NamedTuple


class Properties(NamedTuple):
    """Properties that give the numbers of a fluid, in any one system of units; nan: unknown."""

    density: float
    dynamic_viscosity: float
    kT: float
    diffusion: float = math.nan
    sound_speed: float = math.nan
    mean_free_path: float = math.nan


class Flow(NamedTuple):
    """Speed and size of a flow, length and volume of a cell, in the units of the properties."""

    speed: float
    size: float
    cell: float
    volume: float


class Number(NamedTuple):
    """A dimensionless number of the simulated and of the real fluid, at the same flow.

    `factor` is real over simulated, the same for any flow. None where there is no number.
    """

    name: str
    simulated: float | None
    real: float | None
    factor: float | None
    meaning: str

    @property
    def matched(self) -> bool:
        """Whether both are the same."""
        return self.factor is not None and math.isclose(self.factor, 1, rel_tol=1e-9)

    @property
    def verdict(self) -> str:
        """`matched`, or by how much not."""
        if self.factor is None:
            return "not compared"
        return "matched" if self.matched else f"not matched (factor {self.factor:.3g})"


class Law(NamedTuple):
    """Formula and meaning of a number, and the dimensions in which there is one."""

    formula: Callable[[Flow, Properties], float]
    meaning: str
    dimensions: tuple[int, ...] = (2, 3)


LAWS = {
    "Reynolds": Law(
        lambda f, p: f.speed * f.size * p.density / p.dynamic_viscosity, "inertia over friction"
    ),
    "Mach": Law(
        lambda f, p: f.speed / p.sound_speed, "flow over sound; nothing is compressed below 0.1"
    ),
    "Schmidt": Law(
        lambda f, p: p.dynamic_viscosity / (p.density * p.diffusion),
        "diffusion of momentum over that of particles; no units change it",
    ),
    "Peclet": Law(
        lambda f, p: f.speed * f.size / p.diffusion, "flow over diffusion of the fluid's particles"
    ),
    "colloid Peclet": Law(
        lambda f, p: 6 * math.pi * p.dynamic_viscosity * f.cell * f.speed * f.size / p.kT,
        "flow over diffusion of a sphere, its radius a cell",
        (3,),  # in 2D a disc has no diffusion coefficient of its own (Stokes' paradox)
    ),
    "thermal noise": Law(
        lambda f, p: math.sqrt(p.kT / (p.density * f.volume)) / f.speed,
        "thermal velocity of a cell of fluid over the flow",
    ),
    "Knudsen": Law(
        lambda f, p: p.mean_free_path / f.size, "mean free path over size; a continuum below 0.1"
    ),
}


def compare(
    simulated: tuple[Flow, Properties], real: tuple[Flow, Properties], dimension: int, flows: bool
) -> tuple[Number, ...]:
    """All numbers of two fluids.

    Parameters
    ----------
    simulated, real : (Flow, Properties)
        Each in units of its own; one flow is the other in those units.
    dimension : int
        2 or 3.
    flows : bool
        Whether there is such a flow; if not (any speed and size), only the factors and what is of
        the fluids alone.

    Examples
    --------
    >>> water = Properties(997.0, 8.9e-4, 4.1e-21, diffusion=2.3e-9, sound_speed=1497.0)
    >>> flow = Flow(speed=0.01, size=1e-4, cell=1e-6, volume=1e-18)
    >>> numbers = compare((flow, water), (flow, water), dimension=3, flows=True)
    >>> numbers[0].name, round(numbers[0].real, 2), numbers[0].verdict
    ('Reynolds', 1.12, 'matched')
    """
    found = []
    for name, law in LAWS.items():
        if dimension in law.dimensions:
            here, there = law.formula(*simulated), law.formula(*real)
            known = flows or name == "Schmidt"
            values = here if known else math.nan, there if known else math.nan, there / here
            one, other, factor = (x if math.isfinite(x) else None for x in values)
            found.append(Number(name, one, other, factor, law.meaning))
    return tuple(found)
