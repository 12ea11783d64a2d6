"""Seam of choices: how the next site, or bond, is chosen by its rate.

The first argument is the choice; its class picks the implementation. All draw the same law. A part
of the lattice is what one thread works on at a time: all of it, or a sector.
"""

from mesokit.scalar.jit import generic


@generic
def put(choice, part, i, around):
    """Set the surroundings of the site or bond at a place; none of another part than this one."""


@generic
def total_rate(choice, part):
    """Rate of all that may be chosen in a part."""


@generic
def choose(choice, sites, part, total, u, word):
    """The place of a site or bond, drawn by its rate by a number u uniform in [0, 1) and a random
    word of 64 bits; and another such number."""


@generic
def chance(choice, around):
    """The probability that what was chosen happens, by its surroundings."""


@generic
def keeps(choice):
    """Whether the surroundings of all sites are kept, to choose by."""
