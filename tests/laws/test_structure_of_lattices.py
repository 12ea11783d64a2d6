"""Laws of correlations, waves and domains on lattices."""

import numpy as np
import pytest

from mesokit import Simulation, theory
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.potts import Potts
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import relative
from mesokit.method.kinetic_monte_carlo.observe.shared.separations import Separations
from mesokit.method.kinetic_monte_carlo.observe.shared.waves import Waves
from mesokit.method.kinetic_monte_carlo.observe.site_correlation import SiteCorrelation
from mesokit.method.kinetic_monte_carlo.observe.site_structure_factor import SiteStructureFactor
from mesokit.method.kinetic_monte_carlo.start import RandomStart
from mesokit.seam.estimate import Estimate
from tests.helpers.lattices import FakeLattice, lattice_case, near, results_of

SIZES = {1: (12,), 2: (8, 6), 3: (4, 6, 4)}


def deviations(result):
    """Of all values whose theory is known, in standard errors."""
    use = np.isfinite(result.deviation)
    assert use.sum() > 3
    return result.deviation[use]


@pytest.mark.parametrize("name", KINDS)
def test_waves_are_sums_over_the_true_places_of_sites(name):
    kind, field = KINDS[name], np.random.default_rng(1).normal(size=SIZES[KINDS[name].dimension])
    waves = Waves(lattice_case(field.shape, Ising(), name))
    length = np.array(field.shape) * kind.spacing
    numbers = np.meshgrid(*(np.rint(n * np.fft.fftfreq(n)) for n in field.shape), indexing="ij")
    k = 2 * np.pi * np.stack(numbers, axis=-1) / length
    sums = np.exp(-1j * (k @ kind.places(field.shape).T)) @ field.ravel()
    np.testing.assert_allclose(waves.power(field), abs(sums) ** 2 / field.size, atol=1e-12)
    np.testing.assert_allclose(waves.lengths, np.linalg.norm(k, axis=-1), atol=1e-12)
    inside = waves.ring == 1
    assert waves.by_ring(waves.power(field))[0] == pytest.approx(
        (abs(sums) ** 2 / field.size)[inside].mean()
    )


@pytest.mark.parametrize("name", sorted(set(KINDS) - {"honeycomb"}))
def test_all_waves_together_have_the_square_of_the_field(name):
    """Parseval's theorem; a honeycomb has two sites in a cell and a larger zone."""
    field = np.random.default_rng(2).normal(size=SIZES[KINDS[name].dimension])
    waves = Waves(lattice_case(field.shape, Ising(), name))
    assert waves.power(field).mean() == pytest.approx((field**2).mean())


@pytest.mark.parametrize("ends", [(), ("x",)])
@pytest.mark.parametrize("name", KINDS)
def test_pairs_are_those_within_each_shell(name, ends):
    kind, field = KINDS[name], np.random.default_rng(3).normal(size=SIZES[KINDS[name].dimension])
    pairs = Separations(lattice_case(field.shape, Ising(), name, ends=ends), "radius")
    places, length = kind.places(field.shape), np.array(field.shape) * kind.spacing
    apart = places[:, None] - places
    folded = apart - length * np.rint(apart / length)
    if ends:
        folded[..., 0] = apart[..., 0]
    distance = np.linalg.norm(folded, axis=-1)
    use = distance <= 0.5 * length.min() + 1e-9
    shell, both = np.rint(distance[use]).astype(int), np.outer(field, field)[use]
    shell[(shell == 1) & (distance[use] > 1 + 1e-6)] = 2  # only neighbours are in the first
    number = np.bincount(shell)
    np.testing.assert_array_equal(pairs.pairs, number)
    np.testing.assert_allclose(
        pairs.mean_products(field), np.bincount(shell, both) / number, atol=1e-12
    )
    np.testing.assert_allclose(pairs.distance, np.bincount(shell, distance[use]) / number)


@pytest.mark.parametrize("name", ["square", "bcc", "triangular", "honeycomb"])
def test_the_nearest_sites_are_those_of_the_energy(name):
    case = lattice_case((12, 8, 6)[: KINDS[name].dimension], Ising(), name)
    engine = Simulation(case).engine
    made = SiteCorrelation().accumulator(case)
    made.observe(engine)
    nearest, pairs = made.result().comparisons[0], engine.pairs()
    alike = (pairs[0, 0] + pairs[1, 1] - pairs[0, 1] - pairs[1, 0]) / pairs.sum()
    square = (2 * engine.sites().mean() - 1) ** 2
    assert nearest.measured == pytest.approx((alike - square) / (1 - square), abs=1e-12)


def test_a_ring_of_spins_has_the_correlation_of_its_transfer_matrix():
    observe = [SiteCorrelation(every=1), SiteStructureFactor(every=1)]
    case = lattice_case(
        (24,), Ising(kT=1.0), "chain", steps=8000, warmup=50, timestep=2.0, observe=observe
    )
    found = results_of(case)
    g, s = found["site-correlation"], found["site-structure-factor"]
    assert near(g.comparisons) == {"correlation of the nearest sites", "distance at which g is 1/e"}
    assert near(s.comparisons) == {"structure factor of the longest waves", "mean structure factor"}
    assert abs(deviations(g)).max() < 4.5 and abs(deviations(s)).max() < 4.5
    assert g.comparisons[1].expected == pytest.approx(-1 / np.log(np.tanh(1.0)), rel=0.02)


def test_a_plane_of_spins_has_the_exact_correlation_along_a_row():
    observe = [SiteCorrelation(every=2, direction="x"), SiteCorrelation(every=2, name="all")]
    case = lattice_case((64, 64), Ising(kT=3.0), steps=600, warmup=60, observe=observe)
    found = results_of(case)
    row = found["site-correlation"]
    assert abs(deviations(row)).max() < 4.5
    assert row.value[1] == pytest.approx(-theory.onsager_energy(1.0, 3.0) / 2, rel=0.01)
    assert row.value[2] == pytest.approx(theory.row_correlation(2, 1.0, 3.0), rel=0.03)
    assert found["all"].expected is None
    assert found["all"].value[1] < row.value[1]  # diagonals are in the first shell too


def test_before_the_first_sample_there_is_nothing():
    case = lattice_case((12,), Ising(), "chain")
    for observable in (SiteCorrelation(), SiteStructureFactor()):
        result = observable.accumulator(case).result()
        assert np.isnan(result.value).all() and result.comparisons == ()


def test_particles_of_a_ring_know_only_their_number():
    start = RandomStart(fractions=[0.75, 0.25], exact=True)
    observe = [SiteCorrelation(every=5), SiteStructureFactor(every=5)]
    case = lattice_case((20,), Exclusion(), "chain", steps=20_000, start=start, observe=observe)
    found = results_of(case)
    g, s = found["site-correlation"], found["site-structure-factor"]
    assert abs(deviations(g)).max() < 4.5 and abs(deviations(s)).max() < 4.5
    assert g.expected[1:] == pytest.approx(-1 / 19) and s.expected == pytest.approx(20 / 19)
    assert 2 * g.value[1:10].sum() + g.value[10] == pytest.approx(-1)  # their number is kept


def test_each_of_three_states_correlates_by_hand():
    """Stripes of the states 0, 1 and 2: sites three apart are alike, others never are."""
    sites = np.tile([0, 1, 2], (4, 4))
    case = lattice_case((4, 12), Potts(q=3))
    for state in (None, "state 1"):
        made = SiteCorrelation(direction="y", state=state).accumulator(case)
        made.observe(FakeLattice(sites))
        assert made.result().value == pytest.approx([1, -0.5, -0.5, 1, -0.5, -0.5, 1])


@pytest.mark.parametrize("connected", [True, False])
def test_errors_follow_from_all_that_a_correlation_depends_on(connected):
    """A small change of each mean, in turn, moves the result by as much as its slope says."""
    means = Estimate(np.array([0.7, 0.45, 0.3, 0.25]), 1e-6 * np.eye(4), np.ones(4))
    found = relative(means, 2, connected)
    moved = [
        relative(means._replace(value=means.value + change), 2, connected).value - found.value
        for change in means.residuals
    ]
    np.testing.assert_allclose(found.residuals, moved, rtol=1e-4, atol=1e-12)


def test_one_wave_has_its_own_ring():
    heights = np.rint(1000 * np.cos(2 * np.pi * 3 * np.arange(32) / 32)).astype(int)
    made = SiteStructureFactor().accumulator(lattice_case((32,), Family(), "chain"))
    made.observe(FakeLattice(heights))
    value = made.result().value
    assert value[2] == pytest.approx(32 * 1000**2 / 4, rel=1e-3)
    assert np.delete(value, 2).max() < 1e-4 * value[2]
