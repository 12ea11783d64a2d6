"""Laws of diffusion, growth, aggregation, reactions and sintering on lattices."""

import math

import numpy as np
import pytest
from scipy import ndimage
from scipy.optimize import brentq
from scipy.special import erfcx

from mesokit import Simulation
from mesokit.method.kinetic_monte_carlo.model.aggregation import Aggregation
from mesokit.method.kinetic_monte_carlo.model.eden import Eden
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.islands import Islands
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.model.random_deposition import RandomDeposition
from mesokit.method.kinetic_monte_carlo.model.sintering import Sintering
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.surface_diffusion import SurfaceDiffusion
from mesokit.method.kinetic_monte_carlo.observe.coverage import Coverage
from mesokit.method.kinetic_monte_carlo.observe.event_rates import EventRates
from mesokit.method.kinetic_monte_carlo.observe.lattice_energy import LatticeEnergy
from mesokit.method.kinetic_monte_carlo.observe.roughness import Roughness
from mesokit.method.kinetic_monte_carlo.start import (
    GrainsStart,
    NucleusStart,
    UniformStart,
)
from mesokit.method.kinetic_monte_carlo.summary import summary
from tests.helpers.lattices import lattice_case, lattice_engine


def results_of(case):
    simulation = Simulation(case)
    simulation.run()
    return simulation.results


def deviations(comparisons):
    """Deviations of what theory is known for, in standard errors, by name."""
    found = {one.what: one.deviation for one in comparisons if np.isfinite(one.expected)}
    assert np.isfinite(list(found.values())).all()
    return found


def row(case, what):
    """A row of `mesokit check`."""
    return next(value for name, value, _ in summary(case).rows if name == what)


def test_a_lone_adatom_diffuses_with_its_rate():
    """The mean square of its displacement along an axis is 2 D t, with D = rate a^2."""
    rate, wait, steps = 2.0 * math.exp(-1.5), 1.0, 40_000
    model = SurfaceDiffusion(attempt_rate=2.0, substrate_energy=0.75, kT=0.5)
    engine = lattice_engine((16, 16), model, timestep=wait, start=NucleusStart())
    passed = np.zeros((steps, 4))
    for step in range(steps):
        engine.advance(1)
        passed[step] = engine.happened()[0, :4]
    hops = np.diff(passed, axis=0)
    moved = np.concatenate([hops[:, 0] - hops[:, 1], hops[:, 2] - hops[:, 3]])
    square = moved**2
    found, error = square.mean() / (2 * wait), square.std() / (2 * wait * math.sqrt(len(square)))
    assert error < 0.01 * rate
    assert abs(found - rate) < 4 * error
    assert abs(moved.mean()) < 4 * moved.std() / math.sqrt(len(moved))


def test_hops_of_adatoms_follow_arrhenius():
    energy, found, kT = 0.5, [], np.array([0.05, 0.0625, 0.1])
    for seed, one in enumerate(kT):
        model = SurfaceDiffusion(attempt_rate=1e6, substrate_energy=energy, kT=one)
        wait = 2e5 / 4e6 * math.exp(energy / one)  # some 2e5 hops
        engine = lattice_engine((16, 16), model, timestep=wait, start=NucleusStart(), seed=seed)
        engine.advance(1)
        found.append(engine.happened().sum() / (4 * engine.time))
    slope, front = np.polyfit(1 / kT, np.log(found), 1)
    assert slope == pytest.approx(-energy, rel=0.01)
    assert front == pytest.approx(math.log(1e6), rel=0.01)


def test_adatoms_that_come_and_leave_have_the_coverage_of_langmuir():
    model = SurfaceDiffusion(attempt_rate=0.5, flux=1.0, desorption_rate=3.0)
    observe = [Coverage(every=1), EventRates(every=1)]
    found = results_of(lattice_case((64, 64), model, steps=200, warmup=10, observe=observe))
    parts = deviations(found["coverage"].comparisons)
    rates = deviations(found["event-rates"].comparisons)
    assert parts.keys() == {"mean part empty", "mean part adatom"}
    assert rates.keys() == {"rate of adsorb", "rate of hop", "rate of desorb"}
    assert max(map(abs, [*parts.values(), *rates.values()])) < 4
    assert found["coverage"].comparisons[1].measured == pytest.approx(0.25, rel=0.01)


def test_adatoms_that_attract_are_in_equilibrium():
    """Against a sum over all states of 3 x 3 sites, weighted by bonds and by flux/desorption."""
    bond, kT, ratio, sites = 0.8, 0.9, 0.3, np.arange(9).reshape(3, 3)
    states = (np.arange(2**9)[:, None] >> np.arange(9)) & 1
    bonds = sum(
        (states * states[:, np.roll(sites, 1, axis).ravel()]).sum(axis=1) for axis in (0, 1)
    )
    weight = np.exp(bond * bonds / kT) * ratio ** states.sum(axis=1)
    weight /= weight.sum()
    energy = weight @ (-bond * bonds - kT * math.log(ratio) * states.sum(axis=1)) / 9
    model = SurfaceDiffusion(bond_energy=bond, kT=kT, flux=ratio, desorption_rate=1.0)
    observe = [LatticeEnergy(every=1), Coverage(every=1)]
    case = lattice_case((3, 3), model, steps=30_000, timestep=5.0, observe=observe)
    found = results_of(case)
    measured = found["lattice-energy"].comparisons[0]
    assert abs(measured.measured - energy) < 4 * measured.error
    full, part = found["coverage"].comparisons[1], weight @ states.sum(axis=1) / 9
    assert abs(full.measured - part) < 4 * full.error
    assert full.measured == pytest.approx(part, rel=0.02)


def islands_of(grid, smallest=2):
    """How many clusters there are of at least so many sites, with periodic ends."""
    label, number = ndimage.label(grid)
    alike = np.arange(number + 1)
    for one, other in np.concatenate([label[[0, -1]].T, label[:, [0, -1]]]):
        if one and other:
            alike[alike == alike[other]] = alike[one]
    sizes = np.bincount(alike[label].ravel())[1:]
    return int((sizes >= smallest).sum())


# stable islands of a site at a dose of 0.1, where an atom has 1e4 to 1e7 hops while one comes down,
# and their standard errors
ISLANDS = {
    1e4: (0.01551, 0.00011),
    1e5: (0.00815, 0.00009),
    1e6: (0.00400, 0.00007),
    1e7: (0.00183, 0.00003),
}


@pytest.mark.parametrize(
    "hops", [1e4, 1e5, *(pytest.param(one, marks=pytest.mark.long) for one in (1e6, 1e7))]
)
def test_islands_are_as_many_as_are_known(hops):
    found, (known, uncertain) = [], ISLANDS[hops]
    model, covered = Islands(flux=1.0, hop_rate=hops / 4), 1 - math.exp(-0.1)
    for seed in range(4):
        engine = lattice_engine(
            (320, 320), model, timestep=0.1, start=UniformStart(), seed=seed + 1
        )
        engine.advance(1)
        assert abs(engine.sites().mean() - covered) < 4 * math.sqrt(covered / engine.n)
        found.append(islands_of(engine.sites().reshape(320, 320)) / engine.n)
    error = math.hypot(np.std(found, ddof=1) / 2, uncertain)
    assert error < 0.03 * known
    assert abs(np.mean(found) - known) < 4 * error
    assert np.mean(found) == pytest.approx(known, rel=0.03)


def test_what_follows_from_the_rates_of_islands_is_said():
    case = lattice_case((32, 32), Islands(flux=0.01, hop_rate=25.0), kind="triangular")
    assert row(case, "diffusion coefficient") == "37.5 a^2/time"  # 6 rate a^2 / 4
    assert row(case, "D/F") == "3750"
    growth = SolidOnSolid(flux=2.0, attempt_rate=1e3, substrate_energy=0.0)  # in all directions
    assert row(lattice_case((32, 32), growth), "D/F") == "125"


def rough(size, times, seed=1):
    """Widths of a surface that grows, at some doses."""
    model = SolidOnSolid(flux=1.0, attempt_rate=1e3, bond_energy=-math.log(0.3))
    engine, found = lattice_engine(size, model, timestep=0.5, seed=seed), []
    for _ in range(times):
        engine.advance(1)
        found.append(engine.sites().std())
    return found


def test_a_surface_with_bonds_is_as_rough_as_is_known():
    found = [rough((96, 96), 1, seed)[0] for seed in range(1, 17)]
    error = np.std(found, ddof=1) / 4
    assert error < 0.01
    assert abs(np.mean(found) - 0.889) < 4 * error
    assert np.mean(found) == pytest.approx(0.889, rel=0.02)


@pytest.mark.parametrize(
    "model", [RandomDeposition(flux=2.0), Family(flux=2.0), SolidOnSolid(flux=2.0)]
)
def test_a_surface_on_which_all_atoms_stay_grows_with_the_flux(model):
    case = lattice_case((64, 64), model, steps=40, observe=[Roughness(every=2)])
    speed = results_of(case)["roughness"].comparisons[0]
    assert (speed.what, speed.expected) == ("speed of growth", 2.0)
    assert abs(speed.measured - 2.0) < 4 * math.sqrt(2.0 / (20 * 64**2))


@pytest.mark.long
def test_the_width_of_a_surface_with_bonds_grows_as_is_known():
    assert rough((256, 256), 4) == pytest.approx([0.889, 0.937, 0.955, 0.971], rel=0.02)


def reaction(y):
    """Ziff, Gulari and Barshad: CO comes with the probability y, O2 with 1 - y."""
    return LatticeGas(
        species=["empty", "CO", "O"],
        process=[
            GasProcess(name="CO adsorbs", site="empty -> CO", rate=y),
            GasProcess(
                name="O2 adsorbs", site="empty -> O", neighbour="empty -> O", rate=(1 - y) / 4
            ),
            GasProcess(name="react", site="CO -> empty", neighbour="O -> empty", rate=1e4),
        ],
    )


@pytest.mark.parametrize(
    ("y", "length", "poison"),
    [(0.382, 64, "O"), (0.392, 128, None), (0.5206, 64, None), (0.5306, 64, "CO")],
)
def test_a_reaction_stops_beyond_the_known_transitions(y, length, poison):
    """Of y1 = 0.387 and y2 = 0.5256 both sides, 0.005 apart."""
    engine = lattice_engine(
        (length, length), reaction(y), timestep=100.0, start=UniformStart(state="empty")
    )
    engine.advance(20 if poison is None else 60)
    before = engine.happened()[2].sum()
    engine.advance(2)
    if poison is None:
        assert (engine.happened()[2].sum() - before) / (200 * engine.n) > 0.01
    else:
        covered = np.bincount(engine.sites(), minlength=3) / engine.n
        assert covered[("empty", "CO", "O").index(poison)] > 0.98


def test_a_cluster_in_a_line_grows_as_stefan_has_it():
    """Walkers of density c: an end advances as 2 x sqrt(D t), with sqrt(pi) x exp(x^2) erfc(x) = c,
    for the exclusion process too (Chayes and Swindle 1996)."""
    clusters, apart, c = 400, 100, 0.5
    x = brentq(lambda x: math.sqrt(math.pi) * x * erfcx(x) - c, 0.0, 5.0)
    states = (np.random.default_rng(1).random((clusters, apart)) < c).astype(int)
    states[:, apart // 2] = 2
    case = lattice_case((clusters * apart,), Aggregation(), "chain", timestep=50.0)
    engine = Simulation(case, states=states.ravel()).engine
    grown = []
    for _ in range(2):
        sizes = (engine.sites().reshape(clusters, apart) == 2).sum(axis=1)
        engine.advance(1 + 2 * len(grown))
        grown.append((engine.sites().reshape(clusters, apart) == 2).sum(axis=1) - sizes)
    late = grown[1] / 2  # between the times 50 and 200, of each end
    expected = 2 * x * (math.sqrt(200) - math.sqrt(50))
    error = late.std() / math.sqrt(clusters)
    assert abs(late.mean() - expected) < 4 * error
    assert late.mean() == pytest.approx(expected, rel=0.05)
    everyone = (engine.sites() > 0).sum()
    assert everyone == (states > 0).sum()


def test_a_walker_sticks_with_its_probability():
    """Between two walls it has two neighbours that are empty, or one: it hops on, or it sticks."""
    sticking, runs = 0.3, 4000
    model = Aggregation(sticking=sticking)
    lone = np.zeros((runs, 8), int)
    lone[:, 0], lone[:, 1] = 2, 1
    case = lattice_case((runs * 8,), model, "chain", timestep=1e6)
    engine = Simulation(case, states=lone.ravel()).engine
    engine.advance(1)
    sites = engine.sites().reshape(runs, 8)
    assert (sites == 1).sum() == 0
    # gambler's ruin: a try at each visit of the left end, from which the right one is 6 hops away
    out = 1 - sticking
    reach = out * (1 / 6) / (sticking + out * (1 / 6))  # of the right end before it sticks
    left = (1 - reach) / (1 - reach**2)
    part = (sites[:, 1] == 2).mean()
    assert abs(part - left) < 4 * math.sqrt(left * (1 - left) / runs)


def test_a_cluster_is_connected_and_walkers_come_from_outside():
    model = Aggregation(reservoir=0.05)
    engine = lattice_engine((48, 48), model, timestep=400.0, ends=["x", "y"], start=NucleusStart())
    engine.advance(1)
    cluster = engine.sites().reshape(48, 48) == 2
    _, pieces = ndimage.label(cluster)
    assert pieces == 1 and cluster[24, 24] and cluster.sum() > 20
    entered, left = engine.happened()[:, :].sum(axis=1)[[0, 3]]
    assert entered - left == (engine.sites() > 0).sum() - 1


@pytest.mark.long
def test_a_cluster_has_the_fractal_dimension_of_witten_and_sander():
    """The number of its sites is a power of its radius of gyration."""
    found, walkers = [], 0.1 * 128**2
    for seed in range(6):
        start = NucleusStart(fractions=[0.9, 0.1, 0.0])
        engine = lattice_engine((128, 128), Aggregation(), timestep=20.0, start=start, seed=seed)
        sizes, radii = [1], [0.0]
        while sizes[-1] < 0.8 * walkers:
            engine.advance(4)
            places = np.argwhere(engine.sites().reshape(128, 128) == 2)
            sizes.append(len(places))
            radii.append(math.sqrt(places.var(axis=0).sum()))
        # with equal weights of equal ratios of sizes
        late = np.searchsorted(sizes, np.geomspace(30, sizes[-1], 8))
        slope = np.polyfit(np.log(np.array(radii)[late]), np.log(np.array(sizes)[late]), 1)[0]
        found.append(slope)
    error = np.std(found, ddof=1) / math.sqrt(len(found))
    assert error < 0.08
    assert abs(np.mean(found) - 1.71) < 4 * error
    assert np.mean(found) == pytest.approx(1.71, abs=0.15)


def test_a_cluster_of_eden_grows_from_its_line():
    engine = lattice_engine(
        (256, 64), Eden(version="B"), timestep=8.0, ends=["y"], start=NucleusStart(axis="y")
    )
    engine.advance(1)
    cells = engine.sites().reshape(256, 64)
    _, pieces = ndimage.label(cells)
    assert pieces == 1 and cells[:, 0].all()
    assert cells.sum() - 256 == engine.happened().sum()


@pytest.mark.long
def test_the_edge_of_a_cluster_of_eden_widens_as_kardar_parisi_and_zhang_have_it():
    found, times = [], np.array([8, 12, 20, 32, 48, 72, 100])
    for seed in range(8):
        engine = lattice_engine(
            (16_384, 180),
            Eden(version="C"),
            timestep=4.0,
            ends=["y"],
            start=NucleusStart(axis="y"),
            seed=seed + 1,
        )
        widths = []
        for steps in np.diff(times, prepend=0) // 4:
            engine.advance(int(steps))
            widths.append(engine.sites().reshape(-1, 180).sum(axis=1).std())
        found.append(np.polyfit(np.log(times), np.log(widths), 1)[0])
    error = np.std(found, ddof=1) / math.sqrt(len(found))
    assert error < 0.012
    assert np.mean(found) == pytest.approx(1 / 3, abs=0.03)


def test_two_grains_grow_together():
    """No atom is lost, the neck widens, and the energy falls."""
    model = Sintering(kT=0.25)
    engine = lattice_engine(
        (64, 48), model, "triangular", timestep=5e5, start=GrainsStart(radius=10)
    )

    def energy():
        return -0.5 * engine.pairs()[1, 1]

    def neck():
        return engine.sites().reshape(64, 48)[31:33].sum(axis=1).min()

    atoms, first, narrow = engine.sites().sum(), energy(), neck()
    found, necks = [], []
    for _ in range(20):
        engine.advance(1)
        found.append(energy())
        necks.append(neck())
    assert engine.sites().sum() == atoms
    early, late = np.array(found[:5]), np.array(found[-5:])
    assert late.mean() < early.mean() < first
    assert np.mean(necks[-5:]) > 2 * narrow
