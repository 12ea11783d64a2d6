"""First states of lattices: where they are, and how many sites they have."""

import numpy as np
import pytest

from mesokit import CaseError
from mesokit.method.kinetic_monte_carlo.model.aggregation import Aggregation
from mesokit.method.kinetic_monte_carlo.model.rsos import RestrictedSolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.sintering import Sintering
from mesokit.method.kinetic_monte_carlo.start import GrainsStart, NucleusStart, TerraceStart
from tests.helpers.lattices import lattice_case


def states(size, model, start, kind="square", **given):
    case = lattice_case(size, model, kind, start=start, **given)
    return start.states(case).reshape(size)


def test_grains_are_two_disks_that_touch():
    found = states((64, 40), Sintering(), GrainsStart(radius=12.0))
    assert found.sum() == pytest.approx(2 * np.pi * 12.0**2, rel=0.02)
    assert (found == found[::-1]).all() and (found == found[:, ::-1]).all()
    middle = found[31:33].sum(axis=1)
    assert (middle > 0).all()  # they have bonds
    assert (middle < 10).all()  # and no neck


def test_grains_are_balls_in_space_along_any_axis():
    found = states((24, 24, 40), Sintering(), GrainsStart(radius=8.0, axis="z"), "cubic")
    assert found.sum() == pytest.approx(2 * 4 / 3 * np.pi * 8.0**3, rel=0.03)
    assert found[:, :, 19:21].sum() > 0
    assert found[12, 12].sum() == 32


def test_grains_have_their_size_on_a_lattice_of_shifted_rows():
    found = states((64, 48), Sintering(), GrainsStart(radius=10.0), "triangular")
    assert found.sum() == pytest.approx(2 * np.pi * 10.0**2 / (0.5 * 3**0.5), rel=0.02)


def test_grains_that_do_not_fit_are_refused():
    with pytest.raises(CaseError, match="two grains need"):
        states((64, 40), Sintering(), GrainsStart(radius=12.0, axis="y"))


def test_a_nucleus_is_one_site_among_walkers():
    start = NucleusStart(fractions=[0.8, 0.2, 0.0])
    found = states((50, 40), Aggregation(), start)
    assert np.argwhere(found == 2).tolist() == [[25, 20]]
    assert (found == 1).mean() == pytest.approx(0.2, abs=4 * np.sqrt(0.16 / 2000))


@pytest.mark.parametrize(("axis", "line"), [("x", np.s_[0]), ("y", np.s_[:, 0])])
def test_a_nucleus_is_a_line(axis, line):
    found = states((5, 4), Aggregation(), NucleusStart(axis=axis, state="walker"))
    assert (found[line] == 1).all()
    assert found.sum() == found[line].size


def test_a_terrace_is_higher():
    found = states((10, 4), RestrictedSolidOnSolid(), TerraceStart(height=3, part=0.4))
    assert (found[:4] == 3).all() and (found[4:] == 0).all()
    assert found.dtype == np.int32
