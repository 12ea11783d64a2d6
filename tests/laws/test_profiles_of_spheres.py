"""Profiles, distributions and forces on walls of hard and soft spheres, beside theory."""

import numpy as np
import pytest

from mesokit import (
    WCA,
    Box,
    DensityProfile,
    Disk,
    FreeTimes,
    GranularTemperature,
    HardCollision,
    Kicks,
    Langevin,
    Plates,
    PouredStart,
    RadialDistribution,
    RandomStart,
    Rectangle,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
    TemperatureProfile,
    VelocityDistribution,
    VelocityProfile,
    WallForce,
    theory,
)
from mesokit.method.spheres.hard import window
from mesokit.method.spheres.hard.engine.groups import LAST
from tests.helpers.comparisons import comparisons
from tests.helpers.hard_spheres import gas, same
from tests.helpers.soft_spheres import soft


def observed(simulation, steps=None):
    """The results of its observables, after the run."""
    simulation.run(steps)
    return [simulation[observable.label] for observable in simulation.case.observe]


def soft_run(size, steps, warmup, observe, walls=(), threads=1, **spheres):
    """A simulation of soft spheres, not run."""
    return Simulation(
        run=Run(steps, warmup=warmup, method="soft-spheres"),
        box=Box(size),
        walls=list(walls),
        observe=observe,
        spheres=SoftSpheres(**spheres),
        threads=threads,
    )


class TestWallsOfSoftSpheres:
    WALLS = (
        [Plates("y")],
        [Plates("y"), Disk([10, 20], 3.0), Rectangle([5, 10], [6, 4], angle=20.0)],
    )
    GRAINS = SpringDashpot(restitution=0.8, contact_time=0.02, friction=0.3)

    @pytest.mark.parametrize(
        ("walls", "pair"), [(WALLS[0], GRAINS), (WALLS[1], GRAINS), (WALLS[0], WCA())]
    )
    def test_what_spheres_lose_walls_take(self, walls, pair):
        """Momentum, gravity and what walls take add up to zero; half a step of forces is at each
        end. The same bits on two threads and after a resume."""
        start = {"positions": lattice(150, 20, 40, walls)}
        given = {"number": 150, "gravity": (0, -1.0), "pair": pair, "start": RandomStart()}
        engines = [soft([20, 40], walls, start, threads, **given) for threads in (1, 2)]
        for engine in engines:
            engine.advance(100)
            before = engine.totals()[1], engine.forces().sum(axis=0), engine.wall_impulse
            engine.advance(1500)
            after = engine.totals()[1], engine.forces().sum(axis=0), engine.wall_impulse
            gained, ends, taken = (b - a for a, b in zip(before, after, strict=True))
            fallen = engine.masses().sum() * 1500 * engine.timestep * np.array([0.0, -1.0])
            left = gained - fallen + taken.sum(axis=0) + 0.5 * engine.timestep * ends
            assert abs(left).max() < 1e-9 and abs(taken).max() > 0.1
        one, two = engines
        assert same(one, two)
        again = soft([20, 40], walls, start, **given)
        again.restore(two.state())
        again.advance(20)
        one.advance(20)
        assert np.array_equal(again.wall_impulse, one.wall_impulse)

    def test_the_floor_carries_a_bed(self):
        """At rest it carries the weight at every moment."""
        law = SpringDashpot(restitution=0.3, contact_time=0.05, friction=0.5)
        given = {"number": 40, "gravity": (0, -1.0), "pair": law}
        (force,) = observed(
            soft_run([10, 12], 500, 60_000, [WallForce(every=100)], [Plates("y")], **given)
        )
        (total,) = force.comparisons
        assert total.expected == -40 and total.measured == pytest.approx(-40, rel=1e-4)
        assert force.select(surface="plates-1-upper", component="y")[0] == 0

    @pytest.mark.parametrize("spread", [0.0, 0.3])
    def test_a_heap_weighs_what_its_spheres_do(self, spread):
        """What they gain of momentum is missing on the floor; by chance, it is counted."""
        run = soft_run(
            [12, 20], 400, 1000, [WallForce()], [Plates("y")], number=40, gravity=[0, -1],
            kinds=[SphereKind(spread=spread)], start=PouredStart(), kT=0,
        )  # fmt: skip
        (result,) = observed(run)
        (force,), mass = result.comparisons, run.engine.masses().sum()
        assert force.expected == pytest.approx(-mass, rel=1e-12)
        gained = run.accumulators["wall-force"].blocks.mean()[-1] if force.approximate else 0.0
        # but for half a step of forces at each end
        assert force.measured + gained == pytest.approx(-mass, rel=1e-3)

    def test_spheres_that_fall_are_not_weighed(self):
        run = soft_run(
            [12, 20], 40, 0, [WallForce()], [Plates("y")], number=40, gravity=[0, -1], kT=0
        )
        (result,) = observed(run)
        assert result.comparisons[0].note.startswith("approximate: they gain")

    def test_a_disk_gives_each_wall_twice_its_momentum(self):
        """Between a plate and a solid of another shape, which are told apart."""
        walls = [Rectangle([5, 20], [9, 8]), Plates("y")]
        law = SpringDashpot(restitution=1.0, contact_time=0.01)
        start = {"positions": [[5.0, 3.0]], "velocities": [[0.0, 1.0]], "spins": [0.0]}
        engine = soft([10, 40], walls, start, number=1, pair=law, start=RandomStart())
        engine.advance(round(150.0 / engine.timestep))  # of a way of 15
        solid, lower, upper = engine.wall_impulse
        twice = 2 * engine.masses()[0]
        assert lower[1] == pytest.approx(-5 * twice, rel=1e-3)
        assert solid[1] == pytest.approx(5 * twice, rel=1e-3) and not upper.any()
        engine.end_warmup()
        assert not engine.wall_impulse.any()


def lattice(n, width, height, walls):
    """Places of n disks off all walls."""
    x, y = np.meshgrid(np.arange(0.6, width, 1.2), np.arange(0.8, height - 0.7, 1.2))
    places = np.stack([x.ravel(), y.ravel()], axis=1)
    off = np.hypot(*(places - [10, 20]).T) > 3.6 if len(walls) > 1 else np.full(len(places), True)
    off &= (np.hypot(*(places - [5, 10]).T) > 4.3) | (len(walls) == 1)
    return places[off][:n]


class TestProfiles:
    def profiles(self, **keys):
        return [
            kind(every=1, bins_per_cell=1, **keys)
            for kind in (DensityProfile, VelocityProfile, TemperatureProfile)
        ]

    @pytest.mark.parametrize("axis", ["x", "y"])
    def test_a_uniform_gas(self, axis):
        run = gas([30, 24.5], 500, (), self.profiles(axis=axis), packing_fraction=0.2, timestep=1.0)
        run.engine.advance(30)
        density, velocity, temperature = observed(run)
        n = run.case.particles
        assert density.expected == pytest.approx(n / (30 * 24.5))
        assert (
            velocity.expected == 0
        ).all() and velocity.label == f"velocity v_{'yx'[axis == 'y']}"
        mean = temperature["mean temperature"]
        assert mean.measured == pytest.approx(1 - 1 / n, abs=1e-12) and mean.error == 0
        for result in (density, velocity, temperature):
            chi2 = result["chi-square"]
            assert abs(chi2.deviation) < 3.5 and chi2.error < 0.4

    def test_a_gas_in_gravity(self):
        """Barometric, as warm everywhere, at rest; between plates that keep centres off."""
        gravity = {"gravity": (0, -0.05), "timestep": 20.0}
        run = gas(
            [200, 60], 800, [Plates("y")], self.profiles(), number=400, packing_fraction=5e-4,
            **gravity,
        )  # fmt: skip
        run.engine.advance(100)
        density, velocity, temperature = observed(run)
        mean = density["mean y"]
        assert abs(mean.deviation) < 3.5 and mean.error < 0.004 * mean.expected
        for result in (density, velocity, temperature):
            assert abs(result["chi-square"].deviation) < 3.5
        # smooth plates leave all spheres the momentum along them that they began with
        assert velocity.theory == "drift"
        drift = run.engine.totals()[1][0] / run.engine.masses().sum()
        assert velocity.expected == pytest.approx(drift, rel=1e-9)
        assert density.value[0] == pytest.approx(density.expected[0], abs=4 * density.error[0])

    def test_heavy_spheres_lie_lower(self):
        """Each of two kinds by its own mass, in gravity that points up."""
        run = gas(
            [200, 60], 800, [Plates("y")],
            [DensityProfile(every=1, kind=k, name=f"kind-{k}") for k in (1, 2)],
            number=400, packing_fraction=5e-4, gravity=(0, 0.05), timestep=20.0,
            kinds=[SphereKind(1.0, mass=2.0), SphereKind(1.0, mass=0.5)],
        )  # fmt: skip
        run.engine.advance(100)
        heavy, light = (result["mean y"] for result in observed(run))
        for found in (heavy, light):
            assert abs(found.deviation) < 3.5 and found.error < 0.01 * found.expected
        assert heavy.expected > light.expected + 10

    def test_soft_spheres_in_a_bath(self):
        law = SpringDashpot(restitution=1.0, contact_time=0.2)
        observe = [
            DensityProfile(every=40, bins_per_cell=1),
            TemperatureProfile(every=40, bins_per_cell=1),
        ]
        given = {"number": 50, "gravity": (0, -0.1), "thermostat": Langevin(friction=0.3)}
        run = soft_run([200, 60], 150_000, 30_000, observe, [Plates("y")], pair=law, **given)
        density, temperature = observed(run)
        mean = temperature["mean temperature"]
        assert mean.expected == 1 and abs(mean.deviation) < 3.5 and mean.error < 0.03
        place = density["mean y"]
        # walls are soft: centres come nearer by less than 0.1
        assert abs(place.measured - place.expected) < 3.5 * place.error + 0.1
        assert place.error < 0.06 * place.expected


class TestVelocities:
    def test_elastic_spheres_have_those_of_maxwell(self):
        run = gas([30, 30], 300, (), [VelocityDistribution()], packing_fraction=0.3, timestep=1.0)
        (result,) = observed(run, 3000)
        assert result.theory == "Maxwell"
        for found in comparisons(result):
            assert abs(found.deviation) < 3.5 and found.error < 0.03 * found.expected

    def test_soft_spheres_of_two_masses_have_them_too(self):
        kinds = [SphereKind(1.0, mass=5.0), SphereKind(1.0, mass=1.0)]
        observe = [VelocityDistribution(every=25), VelocityDistribution(every=25, kind=1, name="1")]
        law = SpringDashpot(restitution=1.0, contact_time=0.05)
        run = soft_run([20, 20], 10_000, 2000, observe, kinds=kinds, pair=law, number=200)
        for result in observed(run):
            for found in comparisons(result):
                assert abs(found.deviation) < 3.5 and found.error < 0.08 * found.expected

    def test_kicked_spheres_have_the_tails_of_the_sonine_polynomial(self):
        """More are fast, and more slow, than Maxwell has it: by first order in a_2."""
        run = gas(
            [40, 40, 40], 150, (), [VelocityDistribution(every=1)], packing_fraction=0.05,
            collision=HardCollision(0.2), heating=Kicks(1.0), timestep=0.5,
        )  # fmt: skip
        run.engine.advance(30)
        (result,) = observed(run)
        edges, speeds, error = result.extra["edges"][1], result.value[1], result.error[1]
        fast = edges[:-1] >= 3.0
        share, bar = (speeds * 0.1)[fast].sum(), np.hypot.reduce((error * 0.1)[fast])
        expected = (result.expected[1] * 0.1)[fast].sum()
        maxwell = 1 - theory.maxwell_speed_cdf(3.0, 3)
        assert bar < 0.03 * share
        assert abs(share - expected) < 3.5 * bar + 0.03 * expected
        assert share - maxwell > 8 * bar


class TestFreeTimes:
    @pytest.mark.parametrize(("size", "tau"), [([500, 500], 110.0), ([54, 54, 54], 37.0)])
    def test_dilute_spheres_fly_as_molecular_chaos_says(self, size, tau):
        run = gas(size, 250, (), [FreeTimes()], packing_fraction=0.002, timestep=tau / 3)
        run.engine.advance(30)
        run.engine.end_warmup()
        (result,) = observed(run)
        mean, spread, flights = result.comparisons
        assert mean.expected == pytest.approx(tau, rel=0.1)
        assert abs(mean.deviation) < 3.5 and mean.error < 0.01 * tau
        assert abs(spread.deviation) < 3.5 and spread.error < 0.02
        # of an exponential it is 2
        assert flights.measured > 4e4 and spread.measured - 2 > 4 * spread.error
        use = result.error > 0
        deviation = ((result.value - result.expected) / result.error)[use]
        assert abs(deviation).max() < 5 and (deviation**2).mean() < 1.6

    def test_dense_ones_as_often_as_their_pressure_says(self):
        run = gas([30, 30], 300, (), [FreeTimes(bins=32)], packing_fraction=0.5, timestep=0.2)
        run.engine.advance(20)
        run.engine.end_warmup()
        (result,) = observed(run)
        mean, spread, _ = result.comparisons
        assert abs(mean.deviation) < 3.5 and mean.error < 4e-3 * mean.expected
        assert spread.note.startswith("approximate")
        assert spread.measured == pytest.approx(spread.expected, rel=0.05)

    def test_flights_and_what_has_passed_of_those_that_go_on_fill_the_time(self, monkeypatch):
        """Exactly, and over many windows of the clock."""
        monkeypatch.setattr(window, "COLLISIONS", 3.0)
        engine = gas([12, 12], 0, (), [FreeTimes()], packing_fraction=0.3, timestep=0.1).engine

        def under_way():
            return engine.n * engine.system.now - engine.system.spheres.body[:, LAST].sum()

        engine.advance(50)
        engine.end_warmup()
        before = under_way()
        engine.advance(100)
        assert engine.system.windows > 10
        flown = engine.free_times[2][0]
        assert flown + under_way() - before == pytest.approx(engine.n * 10.0, rel=1e-12)

    def test_a_solid_is_not_judged_by_the_law_of_the_fluid(self):
        run = gas([12, 12], 20, (), [FreeTimes(), RadialDistribution(every=5)],
                  packing_fraction=0.75)  # fmt: skip
        times, around = observed(run)
        (contact,) = comparisons(around, "g at contact")
        for found in (times.comparisons[0], contact):
            assert "freezing is near" in found.note and not np.isfinite(found.deviation)

    def test_who_asks_changes_no_bit(self):
        asked, plain = (
            gas([12, 12], 40, (), observe, packing_fraction=0.4, collision=HardCollision(0.9))
            for observe in ([FreeTimes()], [])
        )
        for one in (asked, plain):
            one.engine.advance(37)
        told, state = asked.engine.state(), plain.engine.state()
        assert all(np.array_equal(told[name], array) for name, array in state.items())
        assert told["tally/flights"].sum() > 100
        again = gas([12, 12], 40, (), [FreeTimes()], packing_fraction=0.4,
                    collision=HardCollision(0.9))  # fmt: skip
        again.engine.restore(told)
        for one in (asked, again):
            one.engine.advance(20)
        assert same(asked.engine, again.engine)


class TestCooling:
    def test_soft_spheres_cool_as_haff_says(self):
        """Four gases; contacts that take two per cent of the time make it by as much slower, and so
        do velocities that are no chaos any more."""
        law = SpringDashpot(restitution=0.9, contact_time=0.02)
        observe = [GranularTemperature(every=200)]
        run = Simulation(
            run=Run(10_000, warmup=2000, method="soft-spheres", replicas=4),
            box=Box([40, 40]),
            observe=observe,
            spheres=SoftSpheres(number=400, pair=law, timestep=0.001),
            threads=1,
        )
        (result,) = observed(run)
        (end,) = result.comparisons
        assert result.theory == "Haff" and end.note.startswith("approximate")
        assert end.expected < 0.5
        assert end.measured == pytest.approx(end.expected, rel=0.05)

    def test_a_bath_holds_the_temperature(self):
        law = SpringDashpot(restitution=1.0, contact_time=0.05)
        given = {"number": 300, "pair": law, "thermostat": Langevin(kT=2.0, friction=3.0)}
        run = soft_run([30, 30], 8000, 2000, [GranularTemperature(every=100)], **given)
        (result,) = observed(run)
        (end,) = result.comparisons
        assert end.expected == 2 and abs(end.deviation) < 3.5
        assert end.error == pytest.approx(np.std(result.value), rel=0.4)
        assert "collisions" not in result.extra
