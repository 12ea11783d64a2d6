"""What a collision rule answers: a few questions, each for one particle or one cell.

Over the particles of a cell the execution layer sums, for every rule, their number, mass, momentum
m v and m v^2; a rule adds sums of its own. `r` is a position relative to the centre of the shifted
cell. The first argument is the rule's NamedTuple of parameters; its class picks the implementation.
"""

from mesokit.scalar import generic


@generic
def contribute(rule, counter, who, m, v, r):
    """The velocity that a particle keeps until it collides, and what it adds to the rule's sums.

    `who` is the index and the draw of its random words: no two particles of a step share them.
    """


@generic
def freedom(rule, n):
    """Degrees of freedom that n particles have beside the conserved ones of their cell."""


@generic
def coefficients(rule, thermostat, variate, chance, n, mass, momentum, energy, sums):
    """What every particle of a cell needs in order to collide.

    n particles of total `mass` and `momentum`, `energy` the sum of m v^2, `sums` the rule's own,
    `variate` the thermostat's random number, `chance` two random words.
    """


@generic
def collide(rule, c, v, r):
    """Velocity after the collision, from the coefficients c of the cell."""
