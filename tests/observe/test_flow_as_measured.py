"""What a run says of its flow: how fast it was, and how far the density differed."""

import numpy as np

from mesokit import DensityField, Plates, Uniform, VelocityField
from mesokit.method.mpcd.expected.setting import transport
from tests.helpers.fake_fluid import FakeFluid
from tests.helpers.small_fluids import make_case

SIZE = (16, 10)


class Streaming(FakeFluid):
    """Twice as many particles at the left, and a flow along x that is 0.6 in the upper half."""

    def positions(self, ids=None, unwrapped=False):
        r = super().positions(ids, unwrapped)
        r[:, 0] = np.where(np.arange(len(r)) % 3 == 0, 8 + r[:, 0] / 2, r[:, 0] / 2)
        return r

    def velocities(self, ids=None):
        v = super().velocities(ids)
        v[:, 0] += 0.6 * (self.positions(ids)[:, 1] > 5)
        return v


def measured(observable, **parts):
    case = make_case(SIZE, [observable], **parts)
    accumulator, fluid = observable.accumulator(case), Streaming(case)
    for _ in range(200):
        fluid.jump(10)
        accumulator.observe(fluid)
    return case, accumulator.result().comparisons


def test_the_mach_number_is_that_of_the_fastest_place():
    driven = {"walls": [Plates("y")], "force": Uniform([0.01, 0]), "density": 20}
    case, (mach,) = measured(VelocityField(), **driven)
    expected = 0.6 / transport(case).sound_speed
    assert abs(mach.measured - expected) < 0.15 * expected
    assert measured(VelocityField(), density=20)[1] == ()  # nothing flows


def test_the_spread_of_the_density_is_that_of_the_halves():
    driven = {"walls": [Plates("y")], "force": Uniform([0.01, 0]), "density": 20}
    _, (spread,) = measured(DensityField(), **driven)
    assert abs(spread.measured - 100 / 3) < 3  # 4/3 and 2/3 of the mean
