"""Free Brownian particles: <dr^2> = 2 d D t, Gaussian, without memory, the same on any threads."""

import numpy as np
import pytest
from scipy import stats

import mesokit
from mesokit import Box, Case, CaseError, MeanSquareDisplacement, Run, Simulation
from mesokit.method.brownian import Brownian

D, TIMESTEP, STEPS = 0.7, 0.02, 60
UNLIKELY = 1e-4


def make(size=(9, 7), steps=STEPS, seed=1, threads=1, positions=None, **parts):
    given = Brownian(density=50, diffusion=D, timestep=TIMESTEP)
    return Simulation(
        run=Run(steps=steps, seed=seed, method="brownian"),
        box=Box(size),
        brownian=given,
        threads=threads,
        positions=positions,
        **parts,
    )


@pytest.fixture(scope="module", params=[(9, 7), (6, 5, 7)], ids=["2D", "3D"])
def walks(request):
    """Displacements (steps, n, d) of single steps."""
    engine = make(request.param).engine
    places = [engine.positions(unwrapped=True)]
    for _ in range(STEPS):
        engine.advance(1)
        places.append(engine.positions(unwrapped=True))
        assert ((engine.positions() >= 0) & (engine.positions() < engine.box)).all()
    return np.diff(places, axis=0)


def test_every_step_is_gaussian_of_variance_2_D_dt(walks):
    scaled = walks / np.sqrt(2 * D * TIMESTEP)
    for k in range(walks.shape[2]):
        assert stats.kstest(scaled[:, :, k].ravel(), "norm").pvalue > UNLIKELY


def test_the_whole_way_is_gaussian_of_variance_2_D_t(walks):
    scaled = walks.sum(axis=0) / np.sqrt(2 * D * TIMESTEP * STEPS)
    assert stats.kstest(scaled.ravel(), "norm").pvalue > UNLIKELY


def test_steps_particles_and_axes_do_not_know_of_one_another(walks):
    scaled = walks / np.sqrt(2 * D * TIMESTEP)
    pairs = [(scaled[1:], scaled[:-1]), (scaled[:, 1:], scaled[:, :-1])]
    pairs += [(scaled[..., 1:], scaled[..., :-1])]
    for one, other in pairs:
        product = one * other
        assert abs(product.mean()) < 4 / np.sqrt(product.size)


@pytest.mark.parametrize("size", [(12, 10), (6, 5, 7)], ids=["2D", "3D"])
def test_mean_square_displacement_grows_as_2_d_D_t(size):
    observe = [MeanSquareDisplacement(every=2, max_lag=40, particles=100_000)]
    simulation = make(size, steps=400, threads=2, observe=observe)
    simulation.run()
    result = simulation["mean-square-displacement"]
    time = result.x["time"]
    np.testing.assert_allclose(result.expected, 2 * len(size) * D * time)
    off = (result.value[1:] - result.expected[1:]) / result.error[1:]
    assert np.abs(off).max() < 4.5
    (slope,) = result.comparisons
    assert slope.expected == D
    assert 0 < slope.error < 0.02 * D
    assert abs(slope.measured - D) < 4 * slope.error


def test_the_start_is_uniform():
    places = make((9, 7)).engine.positions()
    for k, length in enumerate((9, 7)):
        assert stats.kstest(places[:, k] / length, "uniform").pvalue > UNLIKELY


def test_another_seed_gives_another_walk():
    one, other = make(seed=1).engine, make(seed=2).engine
    assert not np.isin(one.positions(), other.positions()).any()


def test_given_positions_are_those_of_the_particles():
    n = make().engine.n
    places = np.random.default_rng(0).normal(0, 30, (n, 2))
    engine = make(positions=places).engine
    np.testing.assert_allclose(engine.positions(unwrapped=True), places, atol=1e-13)
    engine.advance(1)
    moved = engine.positions(unwrapped=True) - places
    assert moved.std() == pytest.approx(np.sqrt(2 * D * TIMESTEP), rel=0.05)


def test_other_programs_read_the_trajectory(tmp_path):
    MDAnalysis = pytest.importorskip("MDAnalysis")
    simulation = make(output=tmp_path / "run", trajectory=mesokit.Trajectory(every=20))
    simulation.run()
    universe = MDAnalysis.Universe.empty(simulation.engine.n, trajectory=True)
    universe.load_new(str(tmp_path / "run" / "run.h5"), format="H5MD", convert_units=False)
    assert len(universe.trajectory) == STEPS // 20 + 1
    read = universe.trajectory[-1].positions[:, :2]
    np.testing.assert_allclose(read, simulation.engine.positions(), atol=1e-5)
    files = mesokit.open(tmp_path / "run")
    gsd = pytest.importorskip("gsd.hoomd")
    with gsd.open(files.export(tmp_path / "run.gsd")) as frames:
        middle = np.array([4.5, 3.5])
        np.testing.assert_allclose(frames[-1].particles.position[:, :2] + middle, read, atol=1e-5)
    assert files.export(tmp_path / "run.xyz").read_text().startswith(str(simulation.engine.n))


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"fluid": mesokit.Fluid()}, "fluid: unknown key of method 'brownian'"),
        ({"brownain": Brownian()}, "did you mean 'brownian'"),
        ({"box": Box((9, 7), shear_rate=0.1)}, "box.shear_rate = 0.1: not with method"),
        ({"brownian": Brownian(density=1e-3)}, "brownian.density = 0.001: 0 particles"),
        ({"brownian": Brownian(diffusion=1e30)}, "brownian.diffusion = 1e+30: in 1 steps"),
        ({"trajectory": mesokit.Trajectory(every=1, fields=["velocity"])}, "no 'velocity'"),
        ({"trajectory": mesokit.Trajectory(every=1, of="fluid")}, "'all' or 'particles'"),
        ({"observe": [MeanSquareDisplacement(of="centres")]}, "expected 'particles'"),
        ({"observe": [mesokit.VelocityProfile()]}, "observe[#1]"),
        ({"units": mesokit.Units(1e-6, "thermal")}, "units: method 'brownian'"),
    ],
    ids=str,
)
def test_what_has_no_meaning_is_refused(parts, words):
    given = {"run": Run(steps=1, method="brownian"), "box": Box((9, 7))} | parts
    with pytest.raises(CaseError) as refused:
        Case(**given)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_section_of_this_method_is_refused_in_a_case_of_another():
    with pytest.raises(CaseError, match="brownian: unknown key of method 'mpcd'"):
        Case(run=Run(steps=1), box=Box((9, 7)), brownian=Brownian())
