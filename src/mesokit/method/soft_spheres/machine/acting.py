"""What the loops ask of a law: the force on one sphere, and in which quanta it is counted."""

from mesokit.scalar.jit import generic


@generic
def act(law, i, time, step, world, mine, noted):
    """Find force and torque on a sphere, by neighbours and walls; contacts grow by a step."""


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
def tell(law, i, time, world, told):
    """Add up what readers ask of a sphere, in quanta, in a row of eight: twice its share of the
    potential energy, r F of its pairs (xx, yy, zz, xy, xz, yz), and how many touch it."""
