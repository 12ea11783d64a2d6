"""What the loops ask of a law: the force on one sphere, and in which quanta it is counted."""

from mesokit.scalar.jit import generic


@generic
def act(law, mine, time, step, world, noted, room):
    """Find forces and torques on the spheres of a thread, from `mine[0]` to before `mine[1]`, by
    neighbours and walls; contacts grow by a step. `room` is for the loops here alone."""


@generic
def quantum(law):
    """The force that is counted as one."""


@generic
def turns(law):
    """Whether it makes spheres turn, as a literal."""


@generic
def ahead(law):
    """How far beyond the reach a pair is looked at."""


@generic
def beside(solid, law, i, step, world, room):
    """Add what a solid does to a sphere; a bound of it."""


@generic
def tell_beside(solid, law, i, world, told):
    """Add to what is told of a sphere what a solid adds."""


@generic
def tell(law, i, time, world, told):
    """Add up what readers ask of a sphere, in quanta, in a row of eight: twice its share of the
    potential energy, r F of its pairs (xx, yy, zz, xy, xz, yz), and how many touch it."""
