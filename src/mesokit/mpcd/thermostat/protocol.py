"""What a thermostat answers: the kinetic energy that the particles of a cell should have.

Energies are those of the motion that a collision rule leaves free: relative to the cell's centre of
mass, and for the rules +a to its rotation too. The first argument is the thermostat's NamedTuple of
parameters; its class picks the implementation.
"""

import math

from mesokit.scalar import generic, scalar


@generic
def draw(thermostat, counter, cell, attempt, freedom):
    """A random number for `target`, and whether it may be used (if not, try the next attempt)."""
    raise NotImplementedError


@generic
def guess(thermostat, counter, cell, freedom):
    """The same number for attempt 0, made fast, and whether it may be used; if not, `draw` it."""
    raise NotImplementedError


@generic
def target(thermostat, variate, freedom, energy):
    """Kinetic energy to reach, from the present one."""
    raise NotImplementedError


@generic
def stretch(thermostat, variate, freedom, energy):
    """Factor for the velocities that takes their energy to the target: (factor,) or ()."""
    raise NotImplementedError


@scalar
def root_of_ratio(wanted, present, freedom):
    """sqrt(wanted / present), and 1 where there is nothing to scale.

    The present energy is a sum of rounded numbers: below a billionth of the target it is noise.
    """
    ratio = wanted / max(present, 1e-9 * wanted)
    return math.sqrt(ratio) if freedom > 0.5 and wanted > 0.0 else 1.0
