"""The size of domains of two species, of places whose waves are known."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import CaseError, DomainSize, Plates, Species
from mesokit.report import plot
from tests.helpers.whole_fluid import AtOnce

SIZE, SMALL = (48, 32), (12, 8, 16)
TWO = (Species(mass=1, density=5), Species(mass=1, density=5))


class Places(AtOnce):
    def __init__(self, time, places):
        self.time, self.places, self.n = time, places, len(places)

    def positions(self, ids):
        return self.places[ids]


def measured(make_case, places, size=SIZE, **parts):
    each = len(places) / (2 * np.prod(size))
    kinds = (Species(mass=1, density=each), Species(mass=1, density=each))
    case = make_case(size, [DomainSize(**parts)], species=kinds)
    accumulator = DomainSize(**parts).accumulator(case)
    for time in range(2):
        accumulator.observe(Places(float(time), places))
    return accumulator.result()


def sorted_places(probability, size, density=10):
    """Uniform places, the first half of which are where the probability of the first kind is."""
    random = np.random.default_rng(1)
    n = density * int(np.prod(size)) // 2
    r = random.uniform(0, 1, (8 * n, len(size))) * size
    first = random.uniform(size=len(r)) < probability(r)
    return np.concatenate([r[first][:n], r[~first][:n]])


@pytest.mark.parametrize(("size", "axis", "waves"), [(SIZE, 0, 4), (SIZE, 1, 2), (SMALL, 2, 2)])
def test_a_wave_is_as_large_as_it_is_long(make_case, size, axis, waves):
    long = size[axis] / waves
    places = sorted_places(lambda r: 0.5 + 0.5 * np.cos(2 * np.pi * r[:, axis] / long), size)
    found = measured(make_case, places, size)
    assert found.value == pytest.approx(long, rel=0.02)
    assert found["size of domains"].measured == pytest.approx(long, rel=0.02)
    assert plot(found).axes[0].get_legend_handles_labels()[1] == ["measured"]  # no error bars


def test_waves_are_weighed_by_their_power(make_case):
    """Amplitudes 0.4 and 0.3 of 16 and 6 cells: powers as 16 to 9, noise taken off."""

    def colour(r):
        x = 2 * np.pi * r[:, 0]
        return 0.5 + 0.2 * np.cos(x / 16) + 0.15 * np.cos(x / 6)

    found = measured(make_case, sorted_places(colour, SIZE, 200))
    assert found.value == pytest.approx((16 + 9) / (16 / 16 + 9 / 6), rel=0.03)
    # what is shorter than the shortest wave does not count
    found = measured(make_case, sorted_places(colour, SIZE, 200), largest=0.8)
    assert found.value == pytest.approx(16, rel=0.03)


def test_a_mixture_has_no_domains(make_case):
    found = measured(make_case, sorted_places(lambda r: 0.5, SIZE))
    assert np.isnan(found.value).all()


def test_what_it_cannot_tell_is_refused(make_case):
    with pytest.raises(CaseError, match=r"0 fluid\.species; expected 2"):
        make_case(SIZE, [DomainSize()])
    with pytest.raises(CaseError, match="not with walls"):
        make_case(SIZE, [DomainSize()], species=TWO, walls=[Plates(axis="y")])
    with pytest.raises(CaseError, match=r"largest = 0\.1: expected 0\.1309"):
        make_case(SIZE, [DomainSize(largest=0.1)], species=TWO)
