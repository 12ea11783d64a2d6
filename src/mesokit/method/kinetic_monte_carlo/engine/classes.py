"""Choice by classes: sites of one class have one rate (Bortz, Kalos and Lebowitz 1975).

A class is a byte for each site, or each bond. How many of each class there are is known for each
tile of 256 and for all tiles: integers, which never drift. A class is drawn by its total rate, then
one of the tiles that have any of it, in proportion to how many it has, then one of these: the bytes
of the tile are compared 64 at a time. None of these steps takes longer in a larger lattice.

With more than some different rates a class is of all rates within a factor of two (Slepoy,
Thompson and Plimpton 2008): it counts as if all had the largest of them, and what is drawn happens
with the probability of its own rate over that one.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.engine.choice import (
    ANY,
    chance,
    choose,
    fetch,
    foresee,
    put,
    total_rate,
)
from mesokit.method.kinetic_monte_carlo.engine.stream import next_word, unit_of
from mesokit.method.kinetic_monte_carlo.lattice.grid import TILE, fetch_site
from mesokit.scalar.bits import bits_set, equal_bytes, high_product, nth_bit_in_table, table_of_bits
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.prefetch import LINE, prefetch

MOST = 256  # classes, as bytes have values
EARLY, LATE = 16, 8  # events ahead, when the classes of a tile and the rest of it are fetched
U = np.uint64


class Classes(NamedTuple):
    """What may happen, by class; the last class is of what cannot.

    A part of the lattice is what one thread works on at a time: all of it, or a sector.

    of: (n,) class of each site or bond. by_surroundings: (m,) class of sites with these. chances:
    (m,) rates over that of the class. rates: (classes,). parts: how many, nothing for one. home:
    (tiles,) part of each. numbers: (parts, classes) of each class. counts: (tiles, classes). lists:
    (classes, tiles) tiles that have any of a class, those of each part together. ranks: (tiles,
    classes) where a tile is in its list. lengths, first: (parts, classes) tiles in a list, and
    where it begins. highest: (parts, classes) no tile has more. refused: (parts, classes) tiles
    since that was found that were drawn in vain. bits: see `nth_bit_in_table`.
    """

    of: NDArray[np.uint8]
    by_surroundings: NDArray[np.uint8]
    chances: NDArray[np.float64]
    rates: NDArray[np.float64]
    parts: tuple[int, ...]
    home: NDArray[np.int32]
    numbers: NDArray[np.int64]
    counts: NDArray[np.uint16]
    lists: NDArray[np.int32]
    ranks: NDArray[np.int32]
    lengths: NDArray[np.int32]
    first: NDArray[np.int64]
    highest: NDArray[np.int32]
    refused: NDArray[np.int64]
    bits: NDArray[np.uint8]


def by_factors_of_two(rates: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rate of the class of each rate: the power of two above it.

    >>> by_factors_of_two(np.array([0.0, 0.3, 0.5, 3.0])).tolist()
    [0.0, 0.5, 0.5, 4.0]
    """
    mantissa, exponent = np.frexp(rates)
    return np.where(rates > 0, np.ldexp(1.0, exponent - (mantissa == 0.5)), 0.0)


def classes_of(
    rates: NDArray[np.float64], memory: int, home: NDArray[np.int32], grouped: bool
) -> Classes:
    """An empty choice, by the rates (m,) of sites by their surroundings, for so many places, with
    the part of each tile."""
    bound = by_factors_of_two(rates) if grouped else rates
    distinct = np.unique(bound[bound > 0])[::-1]  # the fastest first: most events are of these
    width = len(distinct) + 1
    if width > MOST:
        raise ValueError(f"{width} different rates; expected at most {MOST}")
    tiles, parts = memory // TILE, int(home.max()) + 1
    begins = np.searchsorted(np.sort(home), np.arange(parts))
    first = begins[:, None] + tiles * np.arange(width)
    found = len(distinct) - np.searchsorted(distinct[::-1], bound, side="right")
    return Classes(
        np.zeros(memory, np.uint8),
        np.where(bound > 0, found, width - 1).astype(np.uint8),
        np.divide(rates, bound, out=np.zeros_like(rates), where=bound > 0),
        np.append(distinct, 0.0),
        (parts,) if parts > 1 else (),
        home,
        np.zeros(parts * width, np.int64),
        np.zeros(tiles * width, np.uint16),
        np.zeros(width * tiles, np.int32),
        np.zeros(tiles * width, np.int32),
        np.zeros(parts * width, np.int32),
        first.astype(np.int64).ravel(),
        np.ones(parts * width, np.int32),
        np.zeros(parts * width, np.int64),
        table_of_bits(),
    )


def parts_of(classes: Classes) -> int:
    """How many parts of the lattice there are."""
    return classes.parts[0] if classes.parts else 1


def clear(classes: Classes) -> None:
    """Let nothing be able to happen, at any place of the memory."""
    width, tiles = len(classes.rates), len(classes.home)
    idle = width - 1
    classes.of.fill(idle)
    for array in (classes.numbers, classes.counts, classes.lengths, classes.refused):
        array.fill(0)
    classes.highest.fill(1)
    members = np.bincount(classes.home, minlength=parts_of(classes))
    classes.numbers[idle::width] = TILE * members
    classes.counts[idle::width] = TILE
    classes.lengths[idle::width] = members
    order = np.argsort(classes.home, kind="stable")
    classes.lists[idle * tiles :] = order
    classes.ranks[order * width + idle] = np.concatenate([np.arange(m) for m in members])


def rank(classes: Classes) -> None:
    """Find where each tile is in its lists."""
    width = len(classes.rates)
    for k, length in enumerate(classes.lengths):
        c, begin = k % width, int(classes.first[k])
        members = classes.lists[begin : begin + length]
        classes.ranks[members * width + c] = np.arange(length)


@put.register(Classes)
def _(choice, part, i, around):
    old, new = np.int64(choice.of[U(i)]), np.int64(choice.by_surroundings[U(around)])
    tile = i >> 8
    if len(choice.parts) > 0 or part == ANY:
        home = np.int64(choice.home[U(tile)])
        if old == new or (part != home and part != ANY):
            return
        part = home
    choice.of[U(i)] = new
    width = len(choice.rates)
    row, own = tile * width, part * width
    left = np.int64(choice.counts[U(row + old)]) - 1
    choice.counts[U(row + old)] = left
    choice.numbers[U(own + old)] -= 1
    if left == 0:
        _leave_list(choice, own, tile, old)
    there = np.int64(choice.counts[U(row + new)]) + 1
    choice.counts[U(row + new)] = there
    choice.numbers[U(own + new)] += 1
    if there > choice.highest[U(own + new)] or there == 1:
        if there == 1:
            _join_list(choice, own, tile, new)
        choice.highest[U(own + new)] = max(there, np.int64(choice.highest[U(own + new)]))


@scalar
def _join_list(classes, own, tile, c):
    length = np.int64(classes.lengths[U(own + c)])
    classes.lists[U(classes.first[U(own + c)] + length)] = tile
    classes.ranks[U(tile * len(classes.rates) + c)] = length
    classes.lengths[U(own + c)] = length + 1


@scalar
def _leave_list(classes, own, tile, c):
    length, begin = np.int64(classes.lengths[U(own + c)]) - 1, classes.first[U(own + c)]
    last = np.int64(classes.lists[U(begin + length)])
    rank = np.int64(classes.ranks[U(tile * len(classes.rates) + c)])
    classes.lists[U(begin + rank)] = last
    classes.ranks[U(last * len(classes.rates) + c)] = rank
    classes.lengths[U(own + c)] = length


@total_rate.register(Classes)
def _(choice, part):
    total, own = 0.0, part * len(choice.rates)
    for c in range(len(choice.rates) - 1):
        total += choice.numbers[U(own + c)] * choice.rates[U(c)]
    return total


@scalar
def _class(choice, part, total, u):
    own, left, c = part * len(choice.rates), u * total, 0
    for k in range(len(choice.rates) - 1):
        rate = choice.numbers[U(own + k)] * choice.rates[U(k)]
        if rate > 0.0:
            c = k
            if left < rate:
                break
            left -= rate
    return c


@scalar
def _try(choice, own, c, length, highest, word):
    """A tile of those with any of a class, and the rank of a site in it, which there may not be:
    so each is taken as often as it has sites of the class."""
    # the high part of a product with a random word is random, and its low part is as random again
    k = np.int64(high_product(word, length))
    tile = np.int64(choice.lists[U(choice.first[U(own + c)] + k)])
    return tile, np.int64(high_product(word * length, highest))


@choose.register(Classes)
def _(choice, sites, part, total, u, word):
    own, c, stream = part * len(choice.rates), _class(choice, part, total, u), word
    length, highest = U(choice.lengths[U(own + c)]), U(choice.highest[U(own + c)])
    while True:
        tile, rank = _try(choice, own, c, length, highest, word)
        if rank < np.int64(choice.counts[U(tile * len(choice.rates) + c)]):
            break
        choice.refused[U(own + c)] += 1
        if choice.refused[U(own + c)] > 4 * np.int64(length) + 64:
            highest = U(_find_highest(choice, own, c))
        word, stream = next_word(stream)
    return _nth(choice, tile << 8, c, rank), unit_of(next_word(stream)[0])


@foresee.register(Classes)
def _(choice, sites, total, numbers):
    for k in range(len(numbers.hints)):
        c, stream = _class(choice, 0, total, numbers.units[U(k)]), numbers.streams[U(k)]
        word = stream
        length, highest = U(choice.lengths[U(c)]), U(choice.highest[U(c)])
        tile, rank = _try(choice, 0, c, length, highest, word)
        tries = 0
        while rank >= np.int64(choice.counts[U(tile * len(choice.rates) + c)]) and tries < 8:
            word, stream = next_word(stream)
            tile, rank = _try(choice, 0, c, length, highest, word)
            tries += 1
        numbers.hints[U(k)] = (((tile << 8) | c) << 8) | rank
        if k < EARLY:
            _fetch_tile(choice, tile)
    for k in range(LATE):
        _fetch_hint(choice, sites, numbers.hints[U(k)])


@scalar
def _fetch_hint(choice, sites, hint):
    place = _nth(choice, (hint >> 16) << 8, (hint >> 8) & 255, hint & 255)
    fetch_site(sites, place % len(sites.states))


@scalar
def _fetch_tile(choice, tile):
    for line in range(4):
        prefetch(choice.of, tile << 8, LINE * line)


@fetch.register(Classes)
def _(choice, sites, numbers, k):
    # first the classes of its tile, then what is kept of the site that these tell
    if k + EARLY < len(numbers.hints):
        _fetch_tile(choice, numbers.hints[U(k + EARLY)] >> 16)
    if k + LATE < len(numbers.hints):
        _fetch_hint(choice, sites, numbers.hints[U(k + LATE)])


@seldom
def _find_highest(classes, own, c):
    """The largest count of a class in a tile: with a larger number tiles are drawn in vain."""
    highest, begin = 1, classes.first[own + c]
    for k in range(classes.lengths[own + c]):
        tile = np.int64(classes.lists[begin + k])
        highest = max(highest, int(classes.counts[tile * len(classes.rates) + c]))
    classes.highest[own + c] = highest
    classes.refused[own + c] = 0
    return highest


@scalar
def _nth(choice, i, c, rank):
    """The place of the site with this rank among those of its class in the tile that begins at a
    place: four words have a bit for each site, and no branch depends on where it is."""
    address, c = U(choice.of.ctypes.data) + U(i), U(c)
    a, b = equal_bytes(address, c), equal_bytes(address + U(64), c)
    d, e = equal_bytes(address + U(128), c), equal_bytes(address + U(192), c)
    up_to_a = np.int64(bits_set(a))
    up_to_b = up_to_a + np.int64(bits_set(b))
    up_to_d = up_to_b + np.int64(bits_set(d))
    word, before = (a, 0) if rank < up_to_a else (b, up_to_a)
    word, before = (word, before) if rank < up_to_b else (d, up_to_b)
    word, before = (word, before) if rank < up_to_d else (e, up_to_d)
    line = (rank >= up_to_a) + (rank >= up_to_b) + (rank >= up_to_d)
    return i + 64 * line + np.int64(nth_bit_in_table(choice.bits, word, rank - before))


@chance.register(Classes)
def _(choice, around):
    return choice.chances[U(around)]
