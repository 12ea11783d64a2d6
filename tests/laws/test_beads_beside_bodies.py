"""Beads of solutes beside bodies that move: conservation, equilibrium, the same bits."""

import numpy as np
import pytest

from mesokit import FENE, WCA, MaxwellBoltzmann, Plates, Polymer, Solutes, SRDPlusA
from mesokit.errors import RunError
from mesokit.method.mpcd.body.protocol import BodyStart
from mesokit.method.mpcd.engine.beads.neighbours import MADE, OFFSET
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.start.fluid import start
from tests.helpers.bodies import PLANAR, ROOM, SOME, blocks, body, pressures_in_time
from tests.helpers.small_fluids import assert_same, make_case, make_fluid, mean

HELD = {"timestep": 0.1, "thermostat": MaxwellBoltzmann(), "measures": ("stress",)}
RANGE, DIAMETER = 0.5, 0.5 / 2 ** (1 / 6)  # of the gap between a bead and a surface


def free(number, **keys):
    """Beads without bonds; with HELD and bodies in 2D they are one compiled kind."""
    return Solutes([Polymer(number=number)], mass=5.0, **keys)


def gaps(fluid):
    """From each bead to the surface of each disk (beads, bodies)."""
    away = fluid.solutes.places[:, None] - fluid.bodies.places()[None]
    away -= np.rint(away / fluid.box) * fluid.box
    return np.hypot(away[..., 0], away[..., 1]) - 2.0


def test_beads_and_bodies_of_all_shapes_keep_momentum():
    every = [body(name, 2) for name in PLANAR]
    fluid = make_fluid((26, 24), bodies=every, solutes=free(300), **HELD)
    speeds = fluid.solutes.velocities.copy()
    for _ in range(10):
        fluid.advance(20)
        assert not fluid.bodies.inside(fluid.solutes.places, 0.3).any()
        fluid.bodies.check()
        fluid.solutes.check()
    assert abs(fluid.totals()[1]).max() < 1e-12 * fluid.n
    assert abs(fluid.solutes.velocities - speeds).max() > 1.0


def boltzmann(first, last):
    """The area of exp(-U/kT) between two gaps around a disk."""
    edges = np.linspace(first, last, 2001)
    gap = (edges[1:] + edges[:-1]) / 2
    x = (DIAMETER / gap) ** 6
    energy = np.where(gap < RANGE, 4.0 * (x * x - x + 0.25), 0.0)
    return (2 * np.pi * (2.0 + gap) * np.exp(-energy)).mean() * (last - first)


def test_beads_and_bodies_are_in_equilibrium():
    """Beads are as dense around disks as their energy says; both have the temperature of the
    fluid."""
    disks = [body("disk", 2, number=4)]
    fluid = make_fluid((20, 20), bodies=disks, solutes=free(400), **HELD)
    fluid.advance(200)
    near, motion, spin, warm = [], [], [], []
    for _ in range(3000):
        fluid.advance(3)
        gap = gaps(fluid)
        near.append([(gap < RANGE).sum(), ((gap > RANGE) & (gap < 2 * RANGE)).sum()])
        motion.append(fluid.bodies.masses[0] * (fluid.bodies.velocities**2).mean())
        spin.append(fluid.bodies.inertia(0)[2, 2] * (fluid.bodies.spins[:, 2] ** 2).mean())
        warm.append(5.0 * (fluid.solutes.velocities**2).mean())
    masses = fluid.bodies.masses
    part = 1 - masses[0] / (masses.sum() + 5.0 * 400 + fluid.numbers.total_mass)
    held, beyond = np.transpose(near)
    fraction = mean(blocks(held) / blocks(beyond))
    expected = boltzmann(0.2, RANGE) / boltzmann(RANGE, 2 * RANGE)
    for found, wanted in (
        (fraction, expected),
        (mean(blocks(motion) / part), 1.0),
        (mean(blocks(spin)), 1.0),
        (mean(blocks(warm)), 1.0),
    ):
        assert found.agrees(wanted, systematic=0.01), (str(found), wanted)
        assert found.error < 0.03 * wanted  # the test can tell


def test_beads_add_their_pressure_to_that_of_the_fluid():
    """Each bead adds kT over the area that bodies leave: what these give beads is in the stress."""
    disks = [body("disk", 2, number=6, virtual="none")]
    fluid = make_fluid((24, 24), bodies=disks, solutes=free(1500), **HELD)
    pressures = pressures_in_time(fluid)
    found = mean(blocks(np.sum(pressures, axis=1)))
    # an area is left to beads as if disks ended where exp(-U/kT) has half of its rise
    reach = 2.0 + 2 * RANGE
    taken = np.pi * reach**2 - boltzmann(0.2, 2 * RANGE)
    expected = 10 + 6 / 576 + 1500 / (576 - 6 * taken)
    assert found.agrees(expected, systematic=0.005), (str(found), expected)
    assert found.error < 0.1


def state_of(fluid):
    """All that a checkpoint has, by name."""
    return [np.asarray(array) for _, array in sorted(fluid.state().items())]


def look(fluid):
    """Read the energy, for which one thread makes lists that hold for all threads.

    Otherwise some threads make them in the next step, and wait there for ever for the others.
    """
    assert np.isfinite(fluid.potential_energy())
    (lists,) = fluid.memory.solutes.neighbours
    known = lists.noted[:, [OFFSET, MADE]]
    assert len(known) == fluid.threads.size and (known == known[0]).all() and known[0, 1] == 1


def same_bits(steps, look=CPU.potential_energy, **parts):
    """Compare one thread with two and, from a checkpoint on, three; the one after the last step.

    Looks at the energy of the others change nothing.
    """
    parts.pop("measures", None)
    case = make_case(**parts)
    alone, two, three = (CPU(case, threads) for threads in (1, 2, 3))
    start(alone)
    alone.advance(steps)
    half = alone.state()
    alone.advance(steps)
    start(two)
    look(two)
    two.advance(steps)
    look(two)
    three.restore(two.state())
    look(three)
    three.advance(steps)
    assert_same(state_of(alone), state_of(three))
    assert abs(half["body_spin"] - alone.state()["body_spin"]).max() > 1e-3
    assert not alone.bodies.inside(alone.solutes.places, 0.2).any()
    return alone


def test_threads_and_restarts_change_no_bit():
    same_bits(60, size=ROOM[2], bodies=SOME[2], solutes=free(900), **HELD)


CHAINS = Solutes(
    [Polymer(number=8, length=12), Polymer(number=30, length=1)], bond=FENE(), pair=WCA(), mass=5.0
)
KINDS = {
    "sheared": {
        "size": ROOM[3], "bodies": SOME[3], "shear_rate": 0.05, "collision": SRDPlusA(angle=90),
    },
    "slit": {"size": ROOM[2], "bodies": SOME[2], "walls": [Plates(axis="y")]},
}  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_polymers_in_shear_and_between_plates(kind):
    held = {"timestep": 0.1, "thermostat": MaxwellBoltzmann()}
    fluid = same_bits(40, look, solutes=CHAINS, **held, **KINDS[kind])
    if kind == "sheared":  # momentum along x comes in across the ends of the box
        before = fluid.totals()[1]
        fluid.advance(100)
        assert abs(fluid.totals()[1] - before)[1:].max() < 1e-11 * fluid.n


@pytest.mark.parametrize("place", [(10.0, 10.0), (12.25, 10.0)])
def test_a_bead_that_starts_in_a_body_is_refused(place):
    there = BodyStart(rule="given", positions=((10, 10),))
    case = make_case((20, 20), bodies=[body("disk", 2, start=there)], solutes=free(2), timestep=0.1)
    with pytest.raises(RunError, match=r"solutes\.start\.positions: bead 2 lies in a body"):
        start(CPU(case, 1), beads=np.array([(12.4, 10.0), place]))
