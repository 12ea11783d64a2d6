"""Seam of choices: how the next site, or bond, is chosen by its rate.

The first argument is the choice; its class picks the implementation. All draw the same law. A part
of the lattice is what one thread works on at a time: all of it, or a sector. A place is that of a
site, or of a bond.
"""

from mesokit.scalar.jit import generic

ANY = -1  # in place of a part: that which a place is in


@generic
def put(choice, part, i, around):
    """Set the rate of what is at a place by its surroundings, if it lies in a part, or in ANY."""


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


@generic
def foresee(choice, sites, total, numbers):
    """Note where the events to come will be, if little changes until then."""


@generic
def fetch(choice, sites, numbers, k):
    """Have memory fetch what the event k of those to come will read."""


@generic
def planes_of(choice):
    """How many places there are at a site."""


@planes_of.otherwise
def _(choice):
    return 1


# of exact choices that draw what happens at once, and bring no memory before
@chance.otherwise
def _(choice, around):
    return 1.0


@keeps.otherwise
def _(choice):
    return True


@foresee.otherwise
def _(choice, sites, total, numbers):
    pass


@fetch.otherwise
def _(choice, sites, numbers, k):
    pass
