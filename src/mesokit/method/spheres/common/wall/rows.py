"""A wall of spheres as a row of numbers, and how it vibrates."""

import math

from mesokit.scalar.jit import scalar

# columns: kind, place of three, unit vector of three (normal of a plane, axis of a cylinder),
# radius, velocity of three, amplitude, frequency, phase at the start of the window
KIND, PLACE, AXIS, ROUND, MOVES = 0, 1, 4, 7, 8
AMPLITUDE, FREQUENCY, PHASE, COLUMNS = 11, 12, 13, 14
PLANE, OUTSIDE, INSIDE = 0.0, 1.0, -1.0  # kinds: a plane; fluid outside or inside of a round wall


@scalar
def vibration(walls, w, time):
    """How far a wall has moved along its normal, how fast it does, and the bound of its
    acceleration."""
    amplitude, frequency = walls[w, AMPLITUDE], walls[w, FREQUENCY]
    if amplitude == 0.0:
        return 0.0, 0.0, 0.0
    phase = frequency * time + walls[w, PHASE]
    return (
        amplitude * math.sin(phase),
        amplitude * frequency * math.cos(phase),
        amplitude * frequency * frequency,
    )
