"""Random numbers are Philox4x32-10, told apart by everything that they are for, and even."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit
from scipy import stats

from mesokit.scalar import random as rng
from mesokit.scalar.random import Counter, grid_shift, normals, philox, unit, unit_open, words

# Random123, examples/kat_vectors: philox4x32 10, counter, key, result
KNOWN_ANSWERS = [
    ("00000000 00000000 00000000 00000000", "00000000 00000000",
     "6627e8d5 e169c58d bc57ac4c 9b00dbd8"),
    ("ffffffff ffffffff ffffffff ffffffff", "ffffffff ffffffff",
     "408f276d 41c83b0e a20bc7c6 6d5451fd"),
    ("243f6a88 85a308d3 13198a2e 03707344", "a4093822 299f31d0",
     "d16cfe09 94fdcceb 5001e420 24126ea1"),
]  # fmt: skip
PURPOSES = {
    name: value for name, value in vars(rng).items()
    if name.isupper() and not name.startswith("_") and isinstance(value, np.uint64)
}  # fmt: skip
COUNT = 200_000
UNLIKELY = 1e-3


def hexadecimal(text):
    return [np.uint64(int(word, 16)) for word in text.split()]


@pytest.mark.parametrize(("counter", "key", "answer"), KNOWN_ANSWERS)
def test_published_known_answers(counter, key, answer):
    got = philox(*hexadecimal(counter), *hexadecimal(key))
    assert [int(word) for word in got] == [int(word) for word in hexadecimal(answer)]


def test_purposes_differ():
    assert len(PURPOSES) >= 9
    assert len(set(PURPOSES.values())) == len(PURPOSES)
    assert max(PURPOSES.values()) < 256  # eight bits of the key


use = st.tuples(
    st.integers(0, 2**56 - 1),
    st.integers(0, 2**62),
    st.sampled_from(sorted(PURPOSES.values())),
    st.integers(0, 2**32 - 1),
    st.integers(0, 2**31),
)


def drawn(use):
    seed, step, purpose, index, draw = use
    counter = Counter(np.uint64(seed), np.uint64(step))
    return tuple(int(w) for w in words(counter, np.uint64(purpose), index, draw))


@given(use, st.data())
@settings(max_examples=200)
def test_every_part_of_the_key_counts(first, data):
    second = list(first)
    place = data.draw(st.integers(0, 4))
    second[place] = data.draw(use)[place]
    assert (drawn(first) == drawn(second)) == (tuple(second) == first)
    assert all(0 <= word < 2**32 for word in drawn(first))


@njit
def samples(count, seed, purpose):
    out = np.empty((count, 6))
    for i in range(count):
        a, b, c, d = words(Counter(np.uint64(seed), np.uint64(3)), purpose, i, 0)
        out[i, 0] = unit(a, b)
        out[i, 1] = unit_open(c)
        out[i, 2] = unit_open(d)
        x = normals((0.0, 0.0, 0.0), a, b, c, d)
        out[i, 3], out[i, 4], out[i, 5] = x
    return out


@pytest.fixture(scope="module")
def sample():
    return samples(COUNT, 12, rng.CELL)


def test_uniform_numbers(sample):
    for column in sample.T[:3]:
        assert column.min() >= 0 and column.max() < 1
        assert stats.kstest(column, "uniform").pvalue > UNLIKELY
    low_bits = sample[:, 0] * 2**40 % 1  # twelve bits that only the second word gives
    assert stats.kstest(low_bits, stats.uniform(0, 1 - 2**-12).cdf).pvalue > UNLIKELY
    assert unit_open(np.uint64(0)) > 0 and unit_open(np.uint64(2**32 - 1)) < 1
    assert unit(np.uint64(2**32 - 1), np.uint64(0)) < 1
    assert unit(np.uint64(0), np.uint64(0)) == 0


def test_normal_numbers_are_normal_and_independent(sample):
    x = sample[:, 3:]
    for column in x.T:
        assert stats.kstest(column, "norm").pvalue > UNLIKELY
    error = 1 / np.sqrt(COUNT)
    assert abs(np.corrcoef(x.T) - np.eye(3)).max() < 4 * error
    assert abs(np.corrcoef((x**2).T) - np.eye(3)).max() < 4 * error
    assert abs((x**4).mean() - 3) < 4 * np.sqrt(96 / x.size)


def test_neighbours_in_index_step_and_purpose_are_independent():
    many = samples(COUNT, 12, rng.CELL)[:, 0] - 0.5
    other_purpose = samples(COUNT, 12, rng.CELL_DOUBT)[:, 0] - 0.5
    other_seed = samples(COUNT, 13, rng.CELL)[:, 0] - 0.5
    for a, b in ((many[1:], many[:-1]), (many, other_purpose), (many, other_seed)):
        assert abs(np.mean(12 * a * b)) < 4 / np.sqrt(len(a))


def test_grid_shift_is_uniform_and_as_strong_as_asked():
    counters = [Counter(np.uint64(4), np.uint64(step)) for step in range(5000)]
    full = np.array([grid_shift(c, (0.0, 0.0, 0.0), 1.0) for c in counters])
    half = np.array([grid_shift(c, (0.0, 0.0, 0.0), 0.5) for c in counters])
    np.testing.assert_array_equal(half, 0.5 * full)
    for column in full.T:
        assert stats.kstest(column + 0.5, "uniform").pvalue > UNLIKELY
    assert abs(np.corrcoef(full.T) - np.eye(3)).max() < 4 / np.sqrt(5000)
