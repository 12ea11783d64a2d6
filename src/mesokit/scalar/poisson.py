"""Poisson numbers, by inversion: chances are taken off a uniform number until it is used up."""

from mesokit.scalar.elementary import short_exp
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import unit_open, words

MOST_MEAN = 16.0  # drawn at a time: a sum of Poisson numbers is one
MOST_NUMBER = 64  # of such a mean: the chance of more is below 1e-17


@scalar
def none_found(word, mean):
    """The chance of 0, and what it leaves of a uniform number: 0 is found if that is negative."""
    chance = short_exp(-mean)
    return chance, unit_open(word) - chance


@scalar
def one_more(number, mean, chance, left):
    """The same for the next number, from the chance of the one before."""
    chance = chance * mean * (1.0 / number)
    return chance, left - chance


@scalar
def poisson(word, mean):
    """A Poisson number of a mean of at most MOST_MEAN."""
    number = 0
    chance, left = none_found(word, mean)
    while left > 0.0 and number < MOST_NUMBER:
        number += 1
        chance, left = one_more(number, mean, chance, left)
    return number


@scalar
def poisson_number(mean, counter, purpose, index):
    """A Poisson number of any mean, from the first word of draws 0, 1, ..."""
    number, draw, rest = 0, 0, mean
    while rest > 0.0:
        some = min(rest, MOST_MEAN)
        rest -= some
        a, _, _, _ = words(counter, purpose, index, draw)
        number += poisson(a, some)
        draw += 1
    return number
