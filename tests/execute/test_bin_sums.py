"""Exact sums in bins: whoever adds, in whatever order and lots."""

from fractions import Fraction

import numpy as np

from mesokit.scalar import bin_sums
from mesokit.scalar.bin_sums import BinSums

UNIT, BINS = 3.0, 5


def limbs(place, terms):
    sums = BinSums(BINS, [UNIT])
    sums.add(place, [terms])
    return sums


def some(n=4000):
    rng = np.random.default_rng(1)
    sizes = 10.0 ** rng.uniform(-6, 12, n)
    return rng.integers(0, BINS, n), rng.normal(size=n) * sizes


def test_sums_are_those_of_fractions():
    place, terms = some()
    quantum = Fraction(2) ** (2 - bin_sums.QUANTA)  # 3 is told by 2^2
    whole = [round(Fraction(float(term)) / quantum) for term in terms]
    exact = [sum(q for q, at in zip(whole, place, strict=True) if at == k) for k in range(BINS)]
    found = limbs(place, terms).values()[0]
    np.testing.assert_allclose(found, [float(q * quantum) for q in exact], rtol=3e-16)


def test_bits_do_not_depend_on_who_adds(monkeypatch):
    place, terms = some()
    monkeypatch.setattr(bin_sums, "AT_ONCE", 64)
    order = np.random.default_rng(2).permutation(len(terms))
    parts = [limbs(place[lot], terms[lot]).limbs for lot in np.array_split(order, 7)]
    together = BinSums(BINS, [UNIT]).values(lambda nothing: nothing + sum(parts))
    monkeypatch.undo()
    assert together.tobytes() == limbs(place, terms).values().tobytes()
    naive = sum(np.bincount(place[lot], terms[lot], BINS) for lot in np.array_split(order, 7))
    assert naive.tobytes() != np.bincount(place, terms, BINS).tobytes()  # as floats are not


def test_what_is_no_number_or_beyond_all_is_nan_in_its_bin_alone():
    for beyond in (np.nan, np.inf, UNIT * 2.0**46):
        found = limbs(np.array([0, 1, 1]), np.array([1.5, beyond, 2.0])).values()[0]
        assert found[0] == 1.5 and np.isnan(found[1]) and (found[2:] == 0).all()
