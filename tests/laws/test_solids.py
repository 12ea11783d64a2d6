"""What solids take the fluid loses, to rounding; rest and temperature stay up to the surface."""

import numpy as np
import pytest

from mesokit import (
    AT,
    SRD,
    ATPlusA,
    Capsule,
    Cylinder,
    Disk,
    MaxwellBoltzmann,
    NoThermostat,
    Plates,
    Rectangle,
    Species,
    Sphere,
    SRDPlusA,
    Surface,
    Uniform,
)
from tests.helpers.small_fluids import make_fluid

RULES = [SRD(), AT(), SRDPlusA(), ATPlusA()]
SURFACES = [
    Surface(),
    Surface("slip"),
    Surface("diffuse"),
    Surface(rotation=0.5),
    Surface("diffuse", rotation=-0.5),
]
STILL = Surface()
REST = {d: Uniform([0.0] * d) for d in (2, 3)}  # no force, in the kernels of a force


def obstacles(dimension, surface=STILL, virtual="extrapolate"):
    """Two solids in a channel, the first of which may turn."""
    still = Surface(surface.rule)
    if dimension == 2:
        return [
            Plates(axis="y", virtual=virtual),
            Disk(centre=[4, 5], radius=2.3, surface=surface, virtual=virtual),
            Capsule(start=[10, 3], end=[12.5, 5], radius=0.9, surface=still, virtual=virtual),
        ]
    return [
        Cylinder(centre=[3, 4, 0], radius=1.7, surface=surface, virtual=virtual),
        Sphere(centre=[8, 4, 3], radius=1.6, surface=still, virtual=virtual),
    ]


def bath(rule):
    """A thermostat where the rule is none itself."""
    return NoThermostat() if rule.rule.startswith("at") else MaxwellBoltzmann()


def balance(fluid, steps, pull):
    """Momentum gained, taken and given, (d,) each, and angular momentum taken by each body."""
    fluid.advance(3)
    before, at_first = fluid.totals()[1], fluid.wall_impulse
    fluid.advance(steps)
    d, time = fluid.dimension, steps * fluid.numbers.timestep
    taken = fluid.wall_impulse - at_first
    given = np.zeros(d)
    given[0] = fluid.masses().sum() * pull * time
    return fluid.totals()[1] - before, taken[:, :d].sum(axis=0), given, taken[:, d:]


# every rule with the default, every kind of virtual particles with one rule: each compiles a step;
# SRD with the default in two dimensions has the test of every surface
COMBINATIONS = [(rule, 2, "extrapolate") for rule in RULES[1:]]
COMBINATIONS += [(rule, 3, "extrapolate") for rule in (SRD(), ATPlusA())]
COMBINATIONS += [(SRD(), 2, virtual) for virtual in ("fill", "top-up", "none")]
COMBINATIONS += [(ATPlusA(), 2, "top-up")]


@pytest.mark.parametrize(("rule", "dimension", "virtual"), COMBINATIONS, ids=str)
def test_what_the_force_gives_the_solids_take(rule, dimension, virtual):
    """Momentum balance of the fluid, to rounding."""
    pull = 0.02
    fluid = make_fluid(
        (16, 10) if dimension == 2 else (11, 8, 6),
        collision=rule,
        density=5,
        thermostat=bath(rule),
        force=Uniform([pull] + [0] * (dimension - 1)),
        walls=obstacles(dimension, virtual=virtual),
        measures=("walls",),
        threads=2,
    )
    gained, taken, given, _ = balance(fluid, 25, pull)
    np.testing.assert_allclose(gained + taken, given, atol=1e-7)


@pytest.mark.parametrize("surface", SURFACES, ids=lambda s: f"{s.rule} {s.rotation}")
@pytest.mark.parametrize("dimension", [2, 3])
def test_every_surface_takes_what_the_fluid_loses(dimension, surface):
    """The same, for surfaces that slip, scatter and turn."""
    fluid = make_fluid(
        (16, 10) if dimension == 2 else (11, 8, 6),
        density=5,
        thermostat=MaxwellBoltzmann(),
        force=REST[dimension],
        walls=obstacles(dimension, surface),
        measures=("walls",),
    )
    gained, taken, given, torque = balance(fluid, 25, 0.0)
    np.testing.assert_allclose(gained + taken, given, atol=1e-7)
    body = 2 if dimension == 2 else 0  # the plates come first
    if surface.rotation:  # the fluid holds it back
        assert torque[body, -1] * surface.rotation < 0


def test_solids_take_what_a_mixture_loses():
    """Virtual particles of a mixture come one by one."""
    fluid = make_fluid(
        (16, 10),
        species=[Species(mass=1, density=4), Species(mass=3, density=2)],
        walls=obstacles(2),
        measures=("walls",),
    )
    gained, taken, given, _ = balance(fluid, 25, 0.0)
    np.testing.assert_allclose(gained + taken, given, atol=1e-7)


@pytest.mark.parametrize(
    ("rule", "virtual"),
    [*((rule, "extrapolate") for rule in RULES), (SRD(), "fill"), (SRD(), "none")],
    ids=str,
)
def test_density_and_temperature_are_the_same_up_to_the_surface(rule, virtual):
    """In shells about a square, whose corners stick out; errors from 40 independent samples."""
    fluid = make_fluid(
        (14, 14),
        collision=rule,
        thermostat=bath(rule),
        force=REST[2],
        walls=[Rectangle(centre=[7, 7], size=[5, 5], angle=20, virtual=virtual)],
    )
    edges = np.array([0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0])
    grid = (np.arange(14 * 40) + 0.5) / 40
    points = np.stack(np.meshgrid(grid, grid), -1).reshape(-1, 2)
    volume = np.histogram(fluid.numbers.solids.distance(points), edges)[0] / 1600
    number, energy = [], []
    for _ in range(40):
        fluid.advance(25)
        shell = fluid.numbers.solids.distance(fluid.positions())
        v = fluid.velocities()
        number.append(np.histogram(shell, edges)[0])
        energy.append(np.histogram(shell, edges, weights=0.5 * (v**2).sum(axis=1))[0])
    number, energy = np.array(number), np.array(energy)
    density = number.mean(axis=0) / volume
    error = number.std(axis=0, ddof=1) / np.sqrt(40) / volume
    assert (np.abs(density - fluid.case.fluid.density) < 4.5 * error).all()
    temperature = energy.sum(axis=0) / number.sum(axis=0)
    known = 0.012 if rule.rule == "srd+a" else 0.0  # what the thermostat of +a rules is off by
    assert (np.abs(temperature - 1) < 4.5 / np.sqrt(number.sum(axis=0)) + known).all()


@pytest.mark.parametrize("length", [26, 27])
def test_a_round_vessel_at_rest_feels_no_torque(length):
    """Also where it comes so near to the end of the box that cut cells reach over it."""
    fluid = make_fluid(
        (length, length),
        thermostat=MaxwellBoltzmann(),
        force=REST[2],
        walls=[Disk(centre=[length / 2, length / 2], radius=12, fluid="inside")],
        measures=("walls",),
    )
    fluid.advance(100)
    turned = [fluid.wall_impulse[0, 2]]
    for _ in range(20):
        fluid.advance(50)
        turned.append(fluid.wall_impulse[0, 2])
    torque = np.diff(turned)
    assert abs(np.mean(torque)) < 4.5 * np.std(torque, ddof=1) / np.sqrt(20)
