"""Solutes: mechanics of their beads, and their part in the fluid's equilibrium."""

import dataclasses

import numpy as np
import pytest

from mesokit import (
    AT,
    FENE,
    SRD,
    WCA,
    ATPlusA,
    Bending,
    Conservation,
    Disk,
    Harmonic,
    LennardJones,
    MaxwellBoltzmann,
    MeanSquareDisplacement,
    Plates,
    ResidenceTime,
    SRDPlusA,
    Surface,
    theory,
)
from mesokit.errors import RunError
from mesokit.method.mpcd.fluid import Species
from mesokit.method.mpcd.solutes import Polymer, Solutes
from tests.helpers.small_fluids import make_fluid, mean

pytestmark = pytest.mark.long

STIFF = Solutes(
    (Polymer(4, length=10), Polymer(1, length=7, topology="star", arms=3), Polymer(10)),
    mass=5.0, bond=FENE(), bending=Bending(kappa=2.0), pair=WCA(), substeps=50,
)  # fmt: skip
WALLED = Solutes(
    (Polymer(6, length=4),), mass=3.0, bond=Harmonic(K=5.0), pair=WCA(sigma=0.6),
    wall=WCA(sigma=0.7), substeps=50,
)  # fmt: skip
SLIP = Surface("slip")
DISK = {"size": (12, 12), "walls": [Disk(centre=(6, 6), radius=2, surface=SLIP)], "density": 4}
SLIT = {"size": (10, 10), "walls": [Plates(axis="y", lower=SLIP, upper=SLIP)], "density": 4}
SHEAR = {"shear_rate": 0.3, "thermostat": MaxwellBoltzmann()}
CASES = {
    "polymers and monomers": {"solutes": STIFF, "size": (8, 8, 8), "density": 4},
    "between plates": SLIT | {"solutes": WALLED},
    "about a disk": DISK | {"solutes": WALLED},
}


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES.keys())
def case(request):
    return request.param


def refined(case, refine):
    solutes = case["solutes"]
    finer = dataclasses.replace(solutes, substeps=refine * solutes.substeps)
    return make_fluid(**case | {"solutes": finer})


def total_energy(fluid):
    return fluid.totals()[2] + fluid.potential_energy()


def test_energy_is_kept_to_second_order_in_the_substep(case):
    """Forces are minus the gradient of the energy, lists miss nobody, walls give back."""
    changes = []
    for refine in (1, 2, 4):
        fluid = refined(case, refine)
        first, worst = total_energy(fluid), 0.0
        for _ in range(8):
            fluid.advance(1)
            worst = max(worst, abs(total_energy(fluid) - first))
        changes.append(worst / len(fluid.solutes.places))
    assert changes[0] < 0.02
    assert changes[1] < 0.45 * changes[0] and changes[2] < 0.45 * changes[1]


def test_momentum_is_kept_to_rounding():
    fluid = make_fluid(**CASES["polymers and monomers"])
    fluid.advance(300)
    assert abs(fluid.totals()[1]).max() < 1e-9 * fluid.n


@pytest.mark.parametrize("name", ["between plates", "about a disk"])
def test_walls_take_what_beads_and_fluid_lose(name):
    fluid = make_fluid(**CASES[name], measures=("walls",))
    _, before, _ = fluid.totals()
    fluid.advance(200)
    taken = fluid.wall_impulse[:, :2].sum(axis=0)
    _, after, _ = fluid.totals()
    assert abs(before - after).max() > 1.0
    np.testing.assert_allclose(taken, before - after, atol=1e-8)


@pytest.mark.parametrize("potential", [None, WCA(sigma=0.7)], ids=["bounce", "repelled"])
def test_nobody_is_inside(potential):
    solutes = dataclasses.replace(WALLED, wall=potential)
    fluid = make_fluid(**DISK, solutes=solutes)
    for _ in range(100):
        fluid.advance(5)
        assert fluid.numbers.solids.distance(fluid.solutes.folded()[0]).min() >= 0.0


class TestSkin:
    """However far lists reach, the same bits: they are made anew before they miss anybody."""

    def test_of_beads_with_more_neighbours_than_room(self):
        """Soft beads that attract one another gather in one place."""
        deep = Solutes((Polymer(100),), pair=LennardJones(epsilon=4.0, sigma=0.3, cutoff=4.0))
        fluid = make_fluid((6, 6, 6), solutes=deep, density=2)
        lists = fluid.memory.solutes.neighbours[0]
        fluid.solutes.places[:] = 3.0 + 0.05 * np.arange(100)[:, None] * np.array([1.0, 0, 0])
        crowded = fluid.potential_energy()
        assert (lists.count >= 0).all() or lists.near.shape[1] < 99
        apart = 0.05 * np.abs(np.subtract.outer(np.arange(100), np.arange(100)))
        apart = apart[np.triu_indices(100, 1)]
        apart = np.minimum(apart, 6 - apart)
        energy = 16 * ((0.3 / apart) ** 12 - (0.3 / apart) ** 6)
        energy -= 16 * (4.0**-12 - 4.0**-6)
        closest = np.sqrt(1e-3) * 0.3
        assert crowded == pytest.approx(energy[(apart < 1.2) & (apart > closest)].sum())


def test_beads_repel_one_another_over_the_sliding_boundary():
    """Two beads that move with the flow part in the same way in the middle and over the edge."""
    ways = []
    for y in (5.0, 9.5):
        pair = Solutes((Polymer(2),), mass=2.0, pair=WCA(sigma=3.0), substeps=20)
        fluid = make_fluid((12, 10, 12), solutes=pair, density=2 / 1440, shear_rate=0.2)
        fluid.advance(7)
        fluid.solutes.places[:] = [[6.0, y - 1.2, 6.0], [6.3, y + 1.4, 6.2]]
        fluid.solutes.velocities[:] = 0.0
        fluid.solutes.velocities[:, 0] = 0.2 * (fluid.solutes.places[:, 1] - 5.0)
        fluid.solutes.forget_lists()
        fluid.advance(12)
        one, other = fluid.solutes.places
        ways.append(other - one)
    assert np.linalg.norm(ways[0] - [0.3, 2.6, 0.2]) > 0.5
    np.testing.assert_allclose(ways[0], ways[1], atol=1e-9)


def thermal(fluid, samples=150, every=4):
    """Mean 2 E_kin/(d n) of the beads; without the share that a whole at rest takes from them."""
    whole = fluid.masses(np.arange(fluid.totals()[0])).sum()
    share = 1.0 - fluid.memory.solutes.mass / whole
    found, beads = [], fluid.solutes
    for _ in range(samples):
        fluid.advance(every)
        n, energy = beads.shape[0], 0.5 * beads.motion()[-1]
        found.append(2 * energy / (fluid.dimension * n * share))
    return mean(found)


@pytest.mark.parametrize(
    ("rule", "bath"),
    [(SRDPlusA(), MaxwellBoltzmann()), (ATPlusA(), None)],
    ids=["srd+a", "at+a"],
)
def test_beads_have_the_temperature_of_the_fluid(rule, bath):
    """Monomers of five masses and more, by every rule; those that conserve energy keep it."""
    parts = {"thermostat": bath} if bath else {}
    solutes = Solutes((Polymer(60),), mass=20.0)
    fluid = make_fluid((10, 10), solutes=solutes, density=5, collision=rule, kT=2.0, **parts)
    fluid.advance(200)
    found, expected = thermal(fluid), 2.0
    if bath is None and "energy" in rule.conserves:
        number, _, energy = fluid.totals()
        expected = energy / (number - 1)
    assert found.agrees(expected) and found.error < 0.02 * expected


def test_beads_in_a_mixture_have_its_temperature():
    kinds = (Species(mass=1.0, density=3), Species(mass=8.0, density=2))
    fluid = make_fluid(
        (10, 10), species=kinds, solutes=Solutes((Polymer(60),), mass=5.0),
        thermostat=MaxwellBoltzmann(),
    )  # fmt: skip
    fluid.advance(100)
    found = thermal(fluid)
    assert found.agrees(1.0) and found.error < 0.02


class TestRandomSolvent:
    """Without a fluid the theory of a bead that meets a bath at each step is exact."""

    @pytest.mark.parametrize("rule", [SRD(), AT()], ids=["srd", "at"])
    def test_a_bead_diffuses_as_molecular_chaos_says(self, rule):
        solutes = Solutes((Polymer(2000),), mass=4.0, solvent="random")
        fluid = make_fluid(
            (100, 100, 100), solutes=solutes, density=6, timestep=0.2, collision=rule
        )
        assert fluid.n == 0
        fluid.advance(100)
        squares = []
        for _ in range(12):
            before = fluid.solutes.places.copy()
            fluid.advance(100)
            squares.append(((fluid.solutes.places - before) ** 2).sum(axis=1).mean())
        found = mean(squares)
        angle = getattr(rule, "angle", None)
        D = theory.bead_diffusion(rule.rule, 3, 6, 0.2, angle, 4.0, 1.0, 1.0, (2e-3, 4.0))
        # exact for steps of velocities that decay by a share at each collision
        kept = 1.0 - 1.0 / (D * 4.0 / 0.2 + 0.5)
        n = 100
        decayed = kept * (1 - kept**n) / (1 - kept) ** 2
        expected = 3 * 0.2**2 / 4.0 * (n * (1 + kept) / (1 - kept) - 2 * decayed)
        assert found.agrees(expected) and found.error < 0.02 * expected

    def test_beads_that_share_cells_diffuse_more_slowly(self):
        """0.3 in a cell: 7 % more slowly than alone, and by pairs 6 %."""
        solutes = Solutes((Polymer(2400),), mass=4.0, solvent="random")
        fluid = make_fluid(
            (20, 20, 20), solutes=solutes, density=6, timestep=0.2, collision=SRD(),
            observe=[MeanSquareDisplacement(of="beads", max_lag=60)],
        )  # fmt: skip
        accumulator = fluid.case.observe[0].accumulator(fluid.case)
        for _ in range(80):
            fluid.advance(10)
            accumulator.observe(fluid)
        found = accumulator.result()["diffusion coefficient"]
        alone = theory.bead_diffusion("srd", 3, 6, 0.2, 130.0, 4.0)
        assert found.approximate and found.expected < 0.95 * alone
        # 1 %: three in a cell
        assert abs(found.measured - found.expected) < 3.5 * found.error + 0.01 * found.expected
        assert found.error < 0.006 * alone

    def test_a_bead_leaves_a_slab_in_the_mean_exit_time(self):
        observable = ResidenceTime(region=[(0, 6), (0, 20), (0, 20)], every=10)
        fluid = make_fluid(
            (20, 20, 20), solutes=Solutes((Polymer(100),), mass=4.0, solvent="random"), density=6,
            timestep=0.2, collision=SRD(), observe=[observable],
        )  # fmt: skip
        accumulator = observable.accumulator(fluid.case)
        for _ in range(1200):
            fluid.advance(10)
            accumulator.observe(fluid)
        found = accumulator.result()
        time, share = found["mean time until exit"], found["share of the time"]
        assert abs(share.deviation) < 3.5 and share.error < 0.02
        # 1 %: a bead remembers its velocity
        assert abs(time.measured - time.expected) < 3.5 * time.error + 0.01 * time.expected
        assert time.error < 0.05 * time.expected

    def test_it_takes_momentum_and_keeps_the_temperature(self):
        """Few beads wander about: a total momentum of zero is not theirs to keep."""
        solutes = Solutes((Polymer(20),), mass=4.0, solvent="random")
        fluid = make_fluid((9, 9, 9), solutes=solutes, density=6, timestep=0.2, collision=SRD())
        accumulator = Conservation().accumulator(fluid.case)
        for _ in range(400):
            fluid.advance(10)
            accumulator.observe(fluid)
        (found,) = accumulator.result().comparisons
        assert found.what == "temperature" and found.expected == 1.0
        assert abs(found.measured - 1.0) < 3.5 * found.error < 0.1

    def test_chains_have_the_size_of_their_temperature(self):
        """Kremer and Grest's chains of 10: R^2 = 18.06(4), R_g^2 = 2.773(4)."""
        solutes = Solutes(
            (Polymer(60, length=10),), mass=1.0, bond=FENE(), pair=WCA(), solvent="random",
        )  # fmt: skip
        fluid = make_fluid((60, 60, 60), solutes=solutes, density=5, timestep=0.2, seed=3)
        fluid.advance(300)
        found = []
        for _ in range(20):
            fluid.advance(100)
            r = fluid.solutes.places.reshape(60, 10, 3)
            end = ((r[:, -1] - r[:, 0]) ** 2).sum(axis=1).mean()
            arm = r - r.mean(axis=1, keepdims=True)
            found.append((end, (arm**2).sum(axis=2).mean()))
        for values, expected in zip(np.transpose(found), (18.06, 2.773), strict=True):
            size = mean(values)
            assert size.agrees(expected) and size.error < 0.04 * expected


def test_a_broken_bond_stops_the_run():
    solutes = dataclasses.replace(STIFF, polymers=(Polymer(2, length=3),), mass=1.0)
    fluid = make_fluid((8, 8, 8), solutes=solutes, density=2)
    fluid.solutes.places[4] = fluid.solutes.places[3] + [1.6, 0.0, 0.0]
    with pytest.raises(RunError, match=r"step 1: the bond of beads 4 and 5 is longer than"):
        fluid.advance(3)


def test_a_lost_bead_stops_the_run():
    solutes = Solutes((Polymer(2),), mass=1.0, pair=WCA(), substeps=20)
    fluid = make_fluid((8, 8, 8), solutes=solutes, density=2)
    fluid.solutes.velocities[1] = np.nan
    with pytest.raises(RunError, match=r"step 1: bead 2 is lost"):
        fluid.advance(1)


class TestStress:
    """Beads carry momentum and hand it over: the whole has the pressure of its molecules."""

    def test_pressure_of_ideal_chains(self):
        solutes = Solutes(
            (Polymer(60, length=7),), mass=3.0, bond=Harmonic(K=2.0), bending=Bending(kappa=1.0),
            substeps=20,
        )  # fmt: skip
        fluid = make_fluid(
            (7, 7, 7), solutes=solutes, density=3, measures=("stress",),
            thermostat=MaxwellBoltzmann(),
        )  # fmt: skip
        fluid.advance(100)
        found = {"kinetic": [], "collisional": [], "bond": []}
        for _ in range(600):
            fluid.advance(3, measure=["stress"])
            for name, values in found.items():
                values.append(-np.trace(fluid.stress[name]) / 3)
        beads, molecules = 420 / 343, 60 / 343
        total = mean(np.sum(list(found.values()), axis=0).reshape(60, -1).mean(axis=1))
        kinetic = mean(np.reshape(found["kinetic"], (60, -1)).mean(axis=1))
        assert kinetic.agrees(3 + beads) and kinetic.error < 0.01
        assert total.agrees(3 + molecules) and total.error < 0.03

    def test_pairs_push_by_the_virial(self):
        """Two beads that fly apart: the mean over the flight of way times force."""
        pair = Solutes((Polymer(2),), mass=2.0, pair=WCA(sigma=3.0), substeps=20)
        fluid = make_fluid((12, 10, 12), solutes=pair, density=2 / 1440, measures=("stress",))
        places = np.array([[6.0, 8.7, 6.0], [6.3, 11.8, 6.2]])  # over the boundary
        fluid.solutes.places[:], fluid.solutes.velocities[:] = places, 0.0
        fluid.solutes.forget_lists()
        fluid.advance(1, measure=["stress"])
        way = places[1] - places[0]
        sixth = (9.0 / (way @ way)) ** 3
        force = 24.0 * (2 * sixth**2 - sixth) / (way @ way) * way
        expected = -np.outer(way, force) / 1440
        np.testing.assert_allclose(fluid.stress["bond"], expected, rtol=0.05, atol=1e-6)
