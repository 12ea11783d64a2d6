"""Self-diffusion with the flow that a particle stirs up."""

import numpy as np
import pytest

from mesokit import theory

FLUID = {"chaos": 0.0514, "viscosity": 0.8705, "density": 10.0}


def by_hand(sides, viscosity, density, chaos):
    """D by adding up all waves of a periodic box, solved by putting it in again and again."""
    d = len(sides)
    waves = [2 * np.pi * np.arange(-int(3 * side), int(3 * side) + 1) / side for side in sides]
    square = sum(k * k for k in np.meshgrid(*waves, indexing="ij"))
    square[tuple(len(k) // 2 for k in waves)] = np.inf
    total = (np.exp(-square / 6) / square).sum() * (d - 1) / (d * density * np.prod(sides))
    found = chaos
    for _ in range(100):
        found = chaos + total / (viscosity + found)
    return found


@pytest.mark.parametrize("sides", [(10, 10), (40, 10), (3, 3, 3), (8, 12, 30)])
def test_it_is_the_sum_over_the_waves_of_the_box(sides):
    found = theory.self_diffusion(len(sides), box=sides, **FLUID)
    assert found == pytest.approx(by_hand(sides, 0.8705, 10.0, 0.0514), rel=1e-10)


def test_images_of_the_box_take_what_they_take_of_any_particle():
    """2.837 kT/(6 pi eta L), with nu + D in place of nu (Dunweg and Kremer 1993)."""
    free = theory.self_diffusion(3, **FLUID)
    for side in (20, 60):
        boxed = theory.self_diffusion(3, box=[side] * 3, **FLUID)
        eta = 10.0 * (0.8705 + boxed)
        images = free - theory.diffusion_in_box(free, side, eta)
        assert free - boxed == pytest.approx(images, rel=0.02)


def test_in_two_dimensions_it_grows_with_the_logarithm_of_the_box():
    found = [theory.self_diffusion(2, box=[side] * 2, **FLUID) for side in (20, 40, 80)]
    stirred = [(D - FLUID["chaos"]) * (FLUID["viscosity"] + D) for D in found]
    assert np.diff(stirred) == pytest.approx(np.log(2) / (4 * np.pi * 10), rel=5e-3)
    with pytest.raises(ValueError, match="box = None: expected the sides of the box"):
        theory.self_diffusion(2, **FLUID)
    with pytest.raises(ValueError, match="expected 2 sides"):
        theory.self_diffusion(2, box=[10, 10, 10], **FLUID)


# independent simulations of srd, density 10, 2.27 rad, timestep 0.1, in cubes of these sides
MEASURED = {10: (0.05824, 0.00025), 20: (0.05858, 0.00023), 32: (0.05870, 0.00007)}


@pytest.mark.parametrize("side", MEASURED)
def test_it_meets_simulations_without_a_number_of_its_own(side):
    measured, error = MEASURED[side]
    alone = theory.transport("srd", 3, density=10, timestep=0.1, angle=np.degrees(2.27))
    found = theory.self_diffusion(3, alone.diffusion, alone.viscosity, 10, [side] * 3)
    assert abs(found - measured) < 3 * error + 0.005 * measured
    assert measured - alone.diffusion > 10 * error  # molecular chaos does not
