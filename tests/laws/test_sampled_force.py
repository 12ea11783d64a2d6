"""A force given at nodes: what it is between them, and what the fluid makes of it."""

import dataclasses

import numpy as np
import pytest
from numba import njit
from scipy import special

import mesokit
from mesokit import AT, Box, CaseError, DensityProfile, Plates, SampledForce, Simulation, Uniform
from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.method.mpcd.field.sampled import interval
from mesokit.method.mpcd.field.sinusoidal import Sinusoidal
from tests.helpers.small_fluids import make_case, make_fluid

pull = njit(lambda field, r: acceleration(field, r))


def at(force, size, places):
    field = force.kernel(size)
    return np.array([pull(field, tuple(r)) for r in places])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("nodes")


@pytest.mark.parametrize("size", [(8, 6), (4, 6, 5)])
def test_a_sampled_sine_is_the_sinusoidal_force(folder, size):
    """But for the curvature between nodes, h^2 k^2/8; also far from the box."""
    d, k, per_cell = len(size), 2 * np.pi / size[1], 4
    exact = Sinusoidal(amplitude=0.3)
    force = SampledForce.from_function(
        lambda *r: (0.3 * np.sin(k * r[1]), *(0.0,) * (d - 1)),
        Box(size), folder / f"sine{d}.npy", per_cell=per_cell,
    )  # fmt: skip
    places = np.random.default_rng(1).uniform(-30, 30, (200, d))
    off = np.abs(at(force, size, places) - at(exact, size, places)).max()
    bound = 0.3 * (k / per_cell) ** 2 / 8
    assert 0.5 * bound < off < bound
    assert force.largest_in(size) == pytest.approx(0.3, rel=1e-9)


def test_a_sampled_sine_drives_kolmogorov_flow(folder):
    """As the sinusoidal force does, while both fluids still meet the same chances."""
    size, k = (6, 12, 6), 2 * np.pi / 12
    sine = SampledForce.from_function(
        lambda x, y, z: (0.3 * np.sin(k * y), 0.0, 0.0), Box(size), folder / "k.npy", per_cell=8
    )
    waves = []
    for force in (Sinusoidal(amplitude=0.0), Sinusoidal(amplitude=0.3), sine):
        fluid = make_fluid(size, collision=AT(), force=force)
        fluid.advance(10)
        _, momentum = fluid.modes(np.array([[0.0, k, 0.0]]))
        waves.append(momentum[0, 0] / fluid.n)
    rest, driven, sampled = waves
    assert abs(driven - rest) > 0.05
    assert abs(sampled - driven) < 0.02 * abs(driven - rest), waves


@pytest.mark.parametrize("d", [2, 3])
def test_a_linear_potential_is_a_uniform_force(folder, d):
    """To rounding, also beyond plates; so is the same acceleration at all nodes."""
    size, g = (6, 5, 4)[:d], (0.0, -0.25, 0.0)[:d]
    fall = SampledForce.from_function(
        lambda *r: 0.25 * r[1], Box(size), folder / f"fall{d}.npy", of="potential"
    )
    same = SampledForce.from_array(
        np.broadcast_to(np.array(g).reshape(d, *(1,) * d), (d, *(3,) * d)), folder / f"same{d}.npy"
    )
    places = np.random.default_rng(2).uniform(-1, 6, (100, d))
    for force in (fall, same):
        np.testing.assert_allclose(at(force, size, places), np.tile(g, (100, 1)), atol=1e-14)
    case = make_case(size, walls=[Plates("y")], force=fall, density=10)
    assert case.fluid.force is fall
    with pytest.raises(CaseError, match=r"first and last nodes along x differ, and no wall"):
        turned = SampledForce.from_function(
            lambda *r: 0.25 * r[0], Box(size), folder / f"turned{d}.npy", of="potential"
        )
        make_case(size, walls=[Plates("y")], force=turned)


def test_the_gradient_of_a_potential(folder):
    """By splines: far nearer at the nodes than a difference of neighbours would be."""
    size, k = (8, 6), 2 * np.pi / np.array([8, 6])
    force = SampledForce.from_function(
        lambda x, y: np.cos(k[0] * x) * np.cos(k[1] * y),
        Box(size), folder / "hills.npy", of="potential",
    )  # fmt: skip
    x, y = np.meshgrid(np.linspace(0, 8, 17), np.linspace(0, 6, 13), indexing="ij")
    exact = k[0] * np.sin(k[0] * x) * np.cos(k[1] * y)
    off = np.abs(force.nodes(size)[..., 0] - exact).max()
    assert off < 0.2 * k[0] * (0.5 * k[0]) ** 2 / 6


@pytest.fixture(scope="module")
def trap(folder):
    """One wave of a potential, u kT high to either side."""
    u, length = 0.7, 12
    force = SampledForce.from_function(
        lambda x, y, z: u * np.cos(2 * np.pi * x / length),
        Box((length, 5, 6)), folder / "trap.npy", per_cell=4, of="potential",
    )  # fmt: skip
    return u, (length, 5, 6), force


def test_density_is_that_of_boltzmann(trap):
    """The wave of exp(-u cos kx) is -I_1(u)/I_0(u), and nothing flows."""
    u, size, force = trap
    waves = []
    for seed in range(1, 5):
        fluid = make_fluid(size, collision=AT(), force=force, seed=seed, density=5)
        fluid.advance(200)
        for _ in range(20):
            fluid.advance(10)
            mass, _ = fluid.modes(np.array([[2 * np.pi / size[0], 0.0, 0.0]]))
            waves.append(mass[0] / fluid.n)
    each = np.array(waves).reshape(4, 20).mean(axis=1)
    error = max(each.real.std(ddof=1) / 2, 0.002)
    expected = -special.iv(1, u) / special.iv(0, u)
    assert error < 0.02
    assert abs(each.real.mean() - expected) < 3.5 * error, (each, expected)
    assert abs(each.imag.mean()) < 3.5 * error


def test_a_run_keeps_its_force(trap, tmp_path):
    """It may be moved, and goes on whatever becomes of the file."""
    _, size, force = trap
    file = tmp_path / "mine.npy"
    file.write_bytes(force.contents)
    case = make_case(size, collision=AT(), density=5, force=SampledForce(str(file), of="potential"))
    case = dataclasses.replace(case, run=dataclasses.replace(case.run, steps=20))
    whole = Simulation(case, threads=1)
    whole.run()
    Simulation(case, output=tmp_path / "run", threads=1)
    file.write_bytes(b"nothing")
    (tmp_path / "run").rename(tmp_path / "moved")
    again = Simulation.resume(tmp_path / "moved", threads=1)
    again.run()
    np.testing.assert_array_equal(again.engine.velocities(), whole.engine.velocities())
    assert 'file = "part-force.npy"' in (tmp_path / "moved" / "case.toml").read_text()
    assert mesokit.open(tmp_path / "moved").case.fluid.force.of == "potential"


def test_what_theory_cannot_know_it_does_not_say(trap):
    _, size, force = trap
    case = make_case(size, force=force, density=5, observe=[DensityProfile("x")])
    assert Simulation(case, threads=1)["density-profile"].expected is None
    sine = make_case(size, force=Sinusoidal(0.1), density=5, observe=[DensityProfile("x")])
    assert Simulation(sine, threads=1)["density-profile"].expected is not None
    assert mesokit.derive(case).flow_speed is None


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (b"x", r"fluid.force.file = .*bad.npy': expected a .npy file of numbers"),
        (np.zeros((3, 4, 4)), r"array of shape \[3, 4, 4\]; expected \(2, nx, ny\) in 2D"),
        (np.zeros((3, 4, 4, 4)), r"expected \(2, nx, ny\) in 2D"),
        (np.zeros((2, 4, 1)), r"expected 2 nodes or more"),
        (np.full((2, 4, 4), np.nan), r"expected finite numbers"),
        (np.zeros((2, 4, 4), complex), r"expected numbers at nodes"),
    ],
)
def test_bad_files_are_refused(values, words, tmp_path):
    file = tmp_path / "bad.npy"
    if isinstance(values, bytes):
        file.write_bytes(values)
    else:
        np.save(file, values)
    with pytest.raises(CaseError, match=words):
        make_case((8, 8), force=SampledForce(str(file)))


def test_what_is_no_force_is_refused(tmp_path):
    box, file = Box([8, 8]), tmp_path / "f.npy"
    for make, words in (
        (lambda: SampledForce(str(file)).values, r"f.npy': no such file"),
        (lambda: SampledForce.from_array(np.zeros((2, 3, 3)), "f.txt"), r"ending in .npy"),
        (lambda: SampledForce.from_function(3, box, file), r"function = 3: expected a function"),
        (lambda: SampledForce.from_function(lambda x, y: 1.0, box, file), r"expected 2 numbers"),
        (
            lambda: SampledForce.from_function(lambda x, y: (x, "a"), box, file),
            r"not shape|numbers",
        ),
    ):
        with pytest.raises(CaseError, match=words):
            make()


def test_coarse_grids_and_strong_forces_are_warned_of(folder):
    box = Box([8, 8])
    rough = SampledForce.from_function(
        lambda x, y: (5.0 * np.sin(np.pi * y), 0.0), box, folder / "rough.npy", per_cell=3
    )
    said = make_case((8, 8), force=rough)
    text = "\n".join(said._method.summary(said, 1).warnings)
    assert "between its nodes the force may be off by" in text
    assert "it changes velocities by up to 0.43 thermal velocities" in text
    plain = make_case((8, 8), force=Uniform((0.01, 0.0)))
    assert "fluid.force: in a timestep" not in "\n".join(plain._method.summary(plain, 1).warnings)


def test_no_place_leads_beyond_the_table(tmp_path):
    """Lanes of a strip in which nobody is hold anything, and are looked up with the others."""
    force = SampledForce.from_array(np.ones((2, 3, 5)), tmp_path / "a.npy")
    nodes = force.kernel((4, 8))
    for x in (np.nan, np.inf, -np.inf, 1e300, -1e300, 4.0):
        for axis in (0, 1):
            place, _ = interval(nodes, axis, x)
            last = nodes.intervals[axis] - 1
            assert 0 <= place <= last * nodes.strides[axis]
