"""The parameters of a fluid's physics as compiled code takes them, and the tables behind them."""

from typing import Any, NamedTuple

from mesokit.geometry.protocol import Nothing
from mesokit.geometry.solids.clearance import Held
from mesokit.method.mpcd.engine.bodies.allocate import balancing_pull
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.cpu.physics import Physics
from mesokit.method.mpcd.engine.virtual.allocate import with_clearance
from mesokit.method.mpcd.field.uniform import Uniform


class Parameters(NamedTuple):
    """Parameters, and what keeps the tables alive whose addresses these have."""

    physics: Physics
    tables: tuple


def parameters_of(numbers: Numbers, held: Held | None = None) -> Parameters:
    """Parameters of a case; distances from solids are known in the cells that are `held`."""
    fluid, d, molecule, links = numbers.case.fluid, numbers.dimension, (), ()
    rule, (solid, tables) = fluid.collision.kernel(d, fluid.kT), _solid(numbers, held)
    if fluid.molecule is not None:
        molecule, links = fluid.molecule.kernel(d, fluid.timestep, fluid.kT, fluid.mass)
    physics = Physics(
        rule=fluid.collision.among(rule, tuple(numbers.counts), fluid.mass),
        thermostat=fluid.thermostat.kernel(fluid.kT, numbers.least_energy),
        field=_field(numbers),
        solid=solid,
        masses=(numbers.heaviest,) if numbers.uniform else (),
        energy=numbers.energy,
        timestep=fluid.timestep,
        kT=fluid.kT,
        molecule=molecule,
        zero=(0.0,) * d,
        coefficients=(0.0,) * numbers.coefficient_count,
        terms=(0,) * len(numbers.scales),
        scales=numbers.scales,
        momentum_scale=numbers.scales[0],
        stress_scale=numbers.units["stress"],
    )
    return Parameters(physics, (links, tables))


def _field(numbers: Numbers) -> Any:
    """The force on the fluid, and the uniform acceleration that balances forces on bodies."""
    case, d = numbers.case, numbers.dimension
    force, pull = case.fluid.force, balancing_pull(case) if case.bodies else ()
    if pull:
        given = force.uniform(d) or (0.0,) * d
        force = Uniform([x + y for x, y in zip(given, pull, strict=True)])
    return force.kernel(case.box.size)


def _solid(numbers: Numbers, held: Held | None) -> tuple[Any, Any]:
    """Parameters of the solids, and their tables; plates alone have a kernel of their own."""
    if numbers.solids is None:
        return Nothing(), ()
    if numbers.slit is not None:
        return numbers.slit.kernel(numbers.case.box.size), ()
    return with_clearance(numbers.case, numbers.solids, held)
