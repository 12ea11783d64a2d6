"""Parameters of all parts of the physics, whose types pick the compiled code."""

from typing import Any, NamedTuple

from mesokit.geometry.protocol import Nothing
from mesokit.kernels.group import by_address, replaced, without
from mesokit.method.mpcd.field.protocol import field_at
from mesokit.scalar.jit import by_type, scalar


@by_address(in_words=True)
class Physics(NamedTuple):
    """Parameters of the parts, and tuples as long as what is kept for particles and cells."""

    rule: tuple
    thermostat: tuple
    field: tuple
    solid: tuple
    masses: tuple  # (mass,) or () for a row of masses in each strip
    energy: tuple  # how the kinetic energy of cells is found
    timestep: float
    kT: float
    molecule: Any  # what holds the beads of molecules together, or () for single particles
    zero: tuple  # the zero vector
    coefficients: tuple  # as long as what a particle needs of its cell in order to collide
    terms: tuple  # as long as what it adds to the sums of its cell
    scales: tuple  # whole numbers per unit of each of these terms; momentum comes first
    momentum_scale: float  # whole numbers per unit of momentum
    stress_scale: float  # whole numbers per unit of m v^2 in the stress


# Fields are hidden from stages without use for them: kinds of case that differ in them share these.
of_particles = without("thermostat")
of_cells = without("field", "solid", "molecule")
of_walls = without("thermostat", "field", "molecule")
_OF_CELLS = "rule", "thermostat", "coefficients", "terms", "scales"
of_bodies = without(*_OF_CELLS, "molecule", "energy")
of_gas = without(*_OF_CELLS, "molecule", "field", "solid")


@scalar
def momentum_scale(physics):
    """Whole numbers per unit of momentum in fixed-point sums."""
    return physics.momentum_scale


with_field = replaced("field")


@by_type
def field_of_step(physics, done):
    """The field in the middle of the step after so many; None if it does not change in time."""
    if field_of(physics, "field").instance_class in field_at.implementations:
        return lambda physics, done: field_at(physics.field, (done + 0.5) * physics.timestep)
    return lambda physics, done: None


def kind_of_solid(physics: Any) -> type:
    """The class of the solid, from the numba type of `Physics`."""
    return field_of(physics, "solid").instance_class


def has_solid(physics: Any) -> bool:
    """Whether there are solids, from the same."""
    return kind_of_solid(physics) is not Nothing


def field_of(group: Any, name: str) -> Any:
    """The numba type of a field, from that of a named tuple."""
    return group.types[group.fields.index(name)]
