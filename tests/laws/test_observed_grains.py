"""Observables of grains in runs: energy of bounces, flow out of a silo, friction of a flow."""

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    EnergyBudget,
    GranularTemperature,
    HardCollision,
    HardSpheres,
    Outflow,
    Plates,
    RandomStart,
    Rectangle,
    RigidContact,
    RigidSpheres,
    Run,
    ShearRheology,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
    Surface,
    SurfaceContact,
)
from tests.helpers.comparisons import comparison


@pytest.mark.parametrize("e", [1.0, 0.8])
def test_a_ball_loses_what_its_bounces_take(e):
    case = Case(
        run=Run(12, method="event-driven"),
        box=Box([4, 8]),
        walls=[Plates("y", lower=Surface(contact=SurfaceContact(restitution=e)))],
        observe=[EnergyBudget(every=1)],
        spheres=HardSpheres(
            number=1,
            gravity=[0, -1],
            timestep=0.5,
            collision=HardCollision(restitution=e),
        ),
    )
    still = {"positions": [[1, 1.5]], "velocities": [[0, 0]]}
    simulation = Simulation(case, **still)
    simulation.run()
    result = simulation["energy-budget"]
    bounces = simulation.engine.collisions[1]
    mass = simulation.engine.masses()[0]
    lost = mass * 1.0 * (1 - e ** (2 * bounces))  # fallen from 1 at first
    assert bounces >= 2
    assert result["energy lost"].measured == pytest.approx(lost, abs=1e-12)
    assert (result["energy lost"].expected == 0.0) == (e == 1.0)
    assert result.value[:, :4].sum(axis=1) == pytest.approx(1.5 * mass, rel=1e-12)


GRAINS = {"kinds": [SphereKind(1.0, spread=0.1)], "start": RandomStart()}


@pytest.mark.long
def test_a_silo_flows_as_beverloo_says():
    shelf = [Rectangle(centre=[x, 20], size=[7, 2]) for x in (3.5, 16.5)]
    case = Case(
        run=Run(16000, method="soft-spheres"),
        box=Box([20, 60]),
        walls=[Plates("y"), *shelf],
        observe=[Outflow(at=20, width=6, every=25)],
        spheres=SoftSpheres(
            number=600,
            gravity=[0, -1],
            kT=0.01,
            pair=SpringDashpot(0.5, contact_time=0.04, friction=0.5),
            **GRAINS,
        ),
    )
    x, y = np.meshgrid(np.arange(17) * 1.15 + 0.8, 22 + np.arange(36) * 1.03)
    simulation = Simulation(case, positions=np.stack([x.ravel(), y.ravel()], 1)[:600])
    simulation.run()
    found = comparison(simulation["outflow"], "while it flows")
    assert abs(found.measured / found.expected - 1) < 0.25  # constants of the law are known to 15 %
    assert 0 < found.error < 0.2 * found.measured


@pytest.mark.long
def test_disks_between_plates_rub_as_da_cruz_and_others_say():
    plates = Plates("y", lower=Surface(velocity=(-1.0, 0.0)), upper=Surface(velocity=(1.0, 0.0)))
    case = Case(
        run=Run(30000, warmup=10000, method="soft-spheres"),
        box=Box([20, 20]),
        walls=[plates],
        observe=[ShearRheology()],
        spheres=SoftSpheres(
            packing_fraction=0.8,
            kT=0.1,
            kinds=[SphereKind(1.0, spread=0.2)],
            start=RandomStart(),
            pair=SpringDashpot(stiffness=1000, damping=10, friction=0.4),
        ),
    )
    simulation = Simulation(case)
    simulation.run()
    result = simulation["shear-rheology"]
    ratio, fraction = (comparison(result, name) for name in ("over pressure", "packing fraction"))
    assert abs(ratio.measured / ratio.expected - 1) < 0.15
    assert abs(fraction.measured / fraction.expected - 1) < 0.03
    assert 1e-3 < result["inertial number"].measured < 0.1


def test_rigid_grains_cool_by_haffs_law_and_their_books_close():
    case = Case(
        run=Run(2500, method="contact-dynamics"),
        box=Box([40, 40]),
        observe=[GranularTemperature(every=20), EnergyBudget(every=20)],
        spheres=RigidSpheres(
            packing_fraction=0.1,
            kT=1.0,
            start=RandomStart(),
            timestep=0.01,
            contact=RigidContact(friction=0.0, restitution=0.8),
        ),
    )
    simulation = Simulation(case)
    simulation.run()
    found = comparison(simulation["granular-temperature"], "temperature at t = ")
    assert abs(found.measured - found.expected) < 3 * found.error
    budget = simulation["energy-budget"]
    books = comparison(budget, "over that at first")
    assert books.measured == pytest.approx(1.0, rel=1e-9)
    held = simulation.engine.energies()
    assert budget.value[-1, 0] == held["translation"] and held["rotation"] == 0.0
    assert budget["energy lost to impact"].measured == budget["energy lost"].measured > 100
