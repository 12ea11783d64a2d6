"""Positions to start from that lie outside of the box: their images are taken, which is told."""

import warnings

import numpy as np
import pytest

from mesokit import Box, Case, Flock, HardSpheres, Plates, Run, Simulation

SIZE = np.array([9.0, 8.0])
PARTS = {
    "event-driven": {"spheres": HardSpheres(number=4)},
    "flock": {"flock": Flock(number=4)},
    "brownian": {},
    "mpcd": {},
}


def simulated(method, positions, **parts):
    from mesokit import Fluid
    from mesokit.method.brownian.section import Brownian

    density = 4 / SIZE.prod()
    given = {"mpcd": {"fluid": Fluid(density=density)}, "brownian": {"brownian": Brownian(density)}}
    case = Case(
        run=Run(0, method=method), box=Box(SIZE), **PARTS[method], **given.get(method, {}), **parts
    )
    return Simulation(case, threads=1, positions=positions)


@pytest.mark.parametrize("method", PARTS)
def test_it_is_told(method):
    inside = np.array([[1.0, 1.0], [3.0, 6.0], [8.99, 4.0], [5.0, 7.99]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulated(method, inside)
    outside = inside + np.array([[0, 0], [0, 0], [9000, 0], [0, -8]])
    said = r"positions: 2 of 4 lie outside of the box, such as row 2 = \[9008\.99, 4\.0\]"
    with pytest.warns(UserWarning, match=said):
        simulation = simulated(method, outside)
    np.testing.assert_allclose(simulation.engine.positions(), inside, atol=1e-9)


def test_axes_that_walls_close_have_no_images():
    places = np.array([[1.0, 1.0], [3.0, 6.0], [8.0, 4.0], [-5.0, 7.0]])
    with pytest.warns(UserWarning, match=r"positions: 1 of 4 .* row 3"):
        simulated("event-driven", places, walls=[Plates("y")])
