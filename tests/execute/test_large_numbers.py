"""More particles and cells than 32 bits can count, and sums over many: the arithmetic of them."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import Species
from mesokit.errors import RunError
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.domains.blocks.region import Region, Space, keys
from mesokit.method.mpcd.engine.domains.blocks.tree import divided
from mesokit.method.mpcd.engine.pieces import pieces
from mesokit.scalar.fixed_point import added_halves, halves, joined
from tests.helpers.small_fluids import make_case, make_fluid

HUGE = 2**20, 2**20


def test_a_bin_may_hold_more_particles_than_one_sum_of_64_bits():
    fluid = make_fluid(size=(400, 400), density=5)
    number, mass, momentum, _ = fluid.moments((0,), (1,))
    assert number[0] == mass[0] == fluid.n == 800_000
    _, total, energy = fluid.totals()
    np.testing.assert_allclose(momentum[:, 0], total, atol=1e-6)
    assert fluid.moments((0,), (1,))[3][0] == pytest.approx(2 * energy, rel=1e-9)


def test_halves_are_exact():
    rows = np.array([[2**62, -1], [2**62, -(2**62)], [2**62, 3]])
    whole = added_halves(np.stack([halves(rows), halves(rows[:1])]))
    np.testing.assert_array_equal(joined(whole, 1.0), [2.0**64, float(-(2**62) + 1)])


def test_masses_and_parts_of_many_particles():
    kinds = Species(mass=1.0, density=3), Species(mass=2.0, density=2)
    numbers = Numbers(make_case(size=HUGE, species=kinds))
    assert numbers.n == 5 * 2**40 and numbers.total_mass == 7 * 2**40
    who = np.array([0, 3 * 2**40 - 1, 3 * 2**40, numbers.n - 1])
    assert numbers.masses_of(who).tolist() == [1, 1, 2, 2]
    first = next(pieces(2**33, 2**34, 3))
    assert first[0] == 2**33 and (first[1] - first[0]) % 3 == 0


def test_one_process_refuses_what_it_cannot_number():
    with pytest.raises(RunError, match=r"^box\.size: 1099511627776 cells are more than one"):
        CPU(make_case(size=HUGE))
    with pytest.raises(RunError, match=r"^fluid\.density: 2200000000 particles are more than one"):
        CPU(make_case(size=(20_000, 20_000), density=5.5))


def test_ranks_number_cells_in_the_whole_box():
    cells = (4096, 4096, 4096)
    tree, space = divided(cells, 4096, (1.0,) * 3), Space(cells, (True,) * 3, False)
    block = tree.blocks[-1]
    assert block.high == cells and block.lengths == (256,) * 3
    last = Region(tuple(n - 2 for n in cells), (2, 2, 2))
    assert keys(last, space)[-1] == 4096**3 - 1
