"""What a collision rule declares to conserve it conserves in every cell; the rest it does not."""

import numpy as np
import pytest

from mesokit.method.mpcd.collision import RULES
from mesokit.method.mpcd.fluid import Species
from tests.helpers.small_fluids import cells, conserved_sums, make_fluid

EVERYTHING = ("mass", "momentum", "energy", "angular momentum")
ROUNDING = 1e-9  # fixed-point sums of some ten terms, each rounded to 2^-36 or finer
# A rule that restores both takes the energy from what two rotations leave of it: where a cell has
# one or three degrees of freedom left, that may be a small difference of rounded sums.
ILL_CONDITIONED = 1e-9

UNEQUAL = (Species(mass=1, density=4), Species(mass=5, density=3))


def one_collision(rule, size, **parts):
    """Cell sums before and after, in cells that do not move."""
    fluid = make_fluid(size, collision=rule(), timestep=1e-6, grid_shift=0.0, **parts)
    before = fluid.velocities()
    fluid.advance(1)
    return fluid, conserved_sums(fluid, before), conserved_sums(fluid, fluid.velocities())


@pytest.mark.parametrize(
    ("size", "parts"),
    [((9, 6), {"species": UNEQUAL}), ((5, 6, 4), {"density": 3})],
    ids=["2D mixture", "3D"],
)
@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_each_cell_keeps_what_the_rule_declares(rule, size, parts):
    fluid, before, after = one_collision(rule, size, **parts)
    assert set(rule.conserves) <= set(EVERYTHING)
    # Two particles of one cell exchange a lot; one alone keeps all, so only full cells tell.
    full = np.bincount(cells(fluid)) >= 4
    for name in EVERYTHING:
        change = abs(after[name] - before[name])
        if name in rule.conserves:
            assert change[full].max() < ROUNDING, name
            both = name == "energy" and "angular momentum" in rule.conserves
            assert change.max() < (ILL_CONDITIONED if both else ROUNDING), name
        else:
            assert np.median(change[full]) > 0.1, f"{name} is conserved, which is not declared"


@pytest.mark.parametrize("size", [(9, 6), (5, 6, 4)], ids=["2D", "3D"])
@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_totals_do_not_drift(rule, size):
    parts = {"species": UNEQUAL} if len(size) == 2 else {"density": 3}
    fluid = make_fluid(size, collision=rule(), **parts)
    number, momentum, energy = fluid.totals()
    fluid.advance(500)
    later, momentum_later, energy_later = fluid.totals()
    assert later == number
    assert abs(momentum_later - momentum).max() < 1e-9 * number
    if "energy" in rule.conserves:
        both = "angular momentum" in rule.conserves
        assert energy_later == pytest.approx(energy, rel=ILL_CONDITIONED if both else 1e-10)
