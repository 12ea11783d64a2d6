"""For every registered potential the force is minus the gradient of the energy."""

import math

import numpy as np
import pytest
from numba import njit

from mesokit import FENE, Harmonic, LennardJones, Spring
from mesokit.potential import ANGLES, BONDS, PAIRS
from mesokit.potential.angle import bend
from mesokit.potential.protocol import central
from mesokit.potential.thermal import lengths, mean_square, stiffness

PARAMETERS = {"K": 0.7, "k": 3.0, "length": 1.2, "R0": 1.5, "kappa": 4.0, "epsilon": 1.3}
STEP = 1e-5


@pytest.fixture(scope="module", autouse=True)
def table(tmp_path_factory):
    """What a potential of a file is given."""
    file = tmp_path_factory.mktemp("tables") / "pair.txt"
    r = np.linspace(0.8, 3.2, 50)
    np.savetxt(file, np.column_stack([r, np.cos(r) + r**-6]))
    PARAMETERS["file"] = str(file)


def example(component):
    names = component.__pydantic_fields__
    return component(**{key: value for key, value in PARAMETERS.items() if key in names})


@pytest.mark.parametrize("component", [*BONDS, *PAIRS], ids=lambda c: c.__name__)
def test_force_is_minus_the_gradient(component):
    potential = example(component)
    kernel = potential.kernel()
    for r in np.linspace(0.85, 0.98 * min(getattr(potential, "longest", 3.0), 3.0), 37):
        above, below = (central(kernel, (r + s) ** 2)[0] for s in (STEP, -STEP))
        cut = abs(r - getattr(potential, "cutoff", 2 ** (1 / 6))) < 2 * STEP
        push = central(kernel, r * r)[1]
        slope = (above - below) / (2 * STEP)
        assert cut or push * r == pytest.approx(-slope, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("component", [*BONDS, *PAIRS], ids=lambda c: c.__name__)
def test_compiled_and_plain_are_the_same_and_finite_at_no_distance(component):
    kernel = example(component).kernel()
    for square in (0.0, 0.7, 1.9):
        compiled, plain = central(kernel, square), central.plain(kernel, square)
        assert compiled == pytest.approx(plain, rel=1e-14)
        assert np.isfinite(compiled[1] * 0.0)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("component", ANGLES, ids=lambda c: c.__name__)
def test_forces_of_an_angle_are_minus_the_gradient(component, d):
    kernel, random = example(component).kernel(), np.random.default_rng(3)
    run = njit(lambda k, a, b: bend(k, a, b))
    for _ in range(10):
        r = random.normal(size=(3, d))

        def energy(r):
            return run(kernel, tuple(r[1] - r[0]), tuple(r[2] - r[1]))[0]

        _, first, last = run(kernel, tuple(r[1] - r[0]), tuple(r[2] - r[1]))
        force = np.array([first, -np.add(first, last), last])
        for bead in range(3):
            for k in range(d):
                moved = np.zeros((3, d))
                moved[bead, k] = STEP
                slope = (energy(r + moved) - energy(r - moved)) / (2 * STEP)
                assert force[bead, k] == pytest.approx(-slope, abs=1e-6)


def test_an_angle_without_length_pulls_nowhere():
    kernel = example(ANGLES[0]).kernel()
    run = njit(lambda k, a, b: bend(k, a, b))
    _, first, last = run(kernel, (0.0, 0.0), (0.0, 0.0))
    assert first == last == (0.0, 0.0)


def test_both_conventions_of_the_harmonic_bond():
    """K r^2 is (k/2) r^2 with k = 2K; l = 3 in 3D is K = 1/6."""
    square, half = Harmonic(K=1 / 6).kernel(), Spring(k=1 / 3).kernel()
    assert central(square, 4.0) == pytest.approx(central(half, 4.0))
    assert mean_square([square], 3, 1.0, math.inf) == pytest.approx(9.0, rel=1e-6)
    assert mean_square([square], 2, 1.0, math.inf) == pytest.approx(6.0, rel=1e-6)
    assert stiffness([square], 1.0, math.inf) == pytest.approx(1 / 3)


def test_the_energy_is_zero_at_the_cutoff():
    kernel = LennardJones(cutoff=2.5).kernel()
    assert central(kernel, 2.4999999**2)[0] == pytest.approx(0, abs=1e-6)
    assert central(LennardJones(cutoff=2.5, shift=False).kernel(), 2.4999999**2)[0] < -0.01


@pytest.mark.parametrize(("d", "mean", "rms"), [(3, 0.97012, 0.97069), (2, 0.96898, 0.96955)])
def test_bond_of_kremer_and_grest(d, mean, rms):
    """FENE and WCA together: values of an independent quadrature."""
    kernels = [FENE().kernel(), PAIRS[0]().kernel()]
    radii, energy, density = lengths(kernels, d, 1.0, 1.5)
    assert radii[np.argmin(energy)] == pytest.approx(0.96090, abs=2e-4)
    assert np.trapezoid(radii * density, radii) == pytest.approx(mean, abs=1e-5)
    assert mean_square(kernels, d, 1.0, 1.5) ** 0.5 == pytest.approx(rms, abs=1e-5)
