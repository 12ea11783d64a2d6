"""A fluid on a card has the bits of the processor's engine, also where many threads run at once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mesokit import (
    FENE,
    SRD,
    WCA,
    Bending,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    Plates,
    Polymer,
    Solutes,
    Species,
    Sphere,
    SRDPlusA,
    Uniform,
)
from mesokit.devices.device import words_of
from mesokit.devices.recorded import Tape
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import put_real, real
from tests.helpers.on_devices import STEPS, kinds_of_bulk, pair, record

BULK = kinds_of_bulk()
HELD = {"collision": SRD(angle=130.0), "thermostat": MaxwellBoltzmann(), "timestep": 0.4}
DRIVEN = HELD | {"force": Uniform((0.02, 0.0, 0.0)), "density": 8}
MIXED = {"species": (Species(mass=1, density=3), Species(mass=2.5, density=5))}
WALLS = {
    "plates": {"walls": [Plates("y")]},
    "plates, top-up": {"walls": [Plates("y", virtual="top-up")]},
    "sphere": {"walls": [Sphere(centre=(6.1, 6.0, 6.0), radius=3.8)]},
    "plates, mixture": {"walls": [Plates("y")], **MIXED},
    "sphere, SRD+a": {
        "walls": [Sphere(centre=(6.1, 6.0, 6.0), radius=3.8)],
        "collision": SRDPlusA(angle=130.0),
    },
}
BEADS = {
    "chains": {"molecule": Molecule(length=4, bond=Harmonic(K=1.0), substeps=2)},
    "stiff rings": {
        "molecule": Molecule(topology="ring", length=4, bond=FENE(), pair=WCA(), substeps=20),
        "timestep": 0.1,
    },
    "chains between plates": {
        "molecule": Molecule(length=4, bond=Harmonic(K=1.0), substeps=2),
        "walls": [Plates("y")],
    },
}
CHAINS = Solutes(
    (Polymer(40, length=5),),
    mass=4.0,
    bond=FENE(),
    pair=WCA(),
    bending=Bending(kappa=2.0),
    substeps=50,
)
TAPES = ("2D AT", "3D SRD", "2D mixture")
NUMBERS = 10_001


@scalar
def ratios_and_roots(i, place):  # type: ignore[no-untyped-def]
    """What the hardware could round in another way than the standard says."""
    x = 1.0 + i
    put_real(place, i, math.sqrt(x) / (x + 2.0) + real(place, i) * x)


def test_arithmetic_is_rounded_as_on_the_processor(card) -> None:
    given = np.random.default_rng(5).standard_normal(NUMBERS)
    place, found = card.allocate(given.nbytes), np.empty_like(given)
    card.write(place, given)
    card.launch(card.kernel(ratios_and_roots, (place,)), words_of(NUMBERS, place))
    card.read(place, found)
    card.free(place)
    x = 1.0 + np.arange(NUMBERS)
    np.testing.assert_array_equal(found, np.sqrt(x) / (x + 2.0) + given * x)


@pytest.mark.parametrize("kind", BULK)
def test_bulk_fluids_have_the_same_bits(card, kind) -> None:
    both = pair(card, ("stress",), **BULK[kind])
    both.advance(STEPS, ("stress",))
    both.require_same()


@pytest.mark.parametrize("kind", BEADS)
def test_molecules_have_the_same_bits(card, kind) -> None:
    both = pair(card, ("stress",), size=(8, 8, 8), **(DRIVEN | BEADS[kind]))
    both.advance(40, ("stress",))
    both.require_same()


def test_solutes_have_the_same_bits(card) -> None:
    both = pair(card, ("stress",), size=(10, 10, 10), solutes=CHAINS, **DRIVEN)
    both.advance(40, ("stress",))
    both.require_same()


@pytest.mark.parametrize("kind", WALLS)
def test_walls_have_the_same_bits(card, kind) -> None:
    both = pair(card, ("walls",), size=(12, 12, 12), **(DRIVEN | WALLS[kind]))
    both.advance(40)
    both.require_same()
    assert (both.cpu.wall_impulse != 0.0).any()


def test_a_million_particles_have_the_same_bits(card) -> None:
    """Threads meet in the sums of cells, and in the list of flights, as in no small box."""
    walls = [Plates("y"), Sphere(centre=(24.0, 24.0, 24.0), radius=9.0)]
    both = pair(card, ("walls",), size=(48, 48, 48), walls=walls, **(DRIVEN | {"density": 10}))
    assert both.cpu.n > 10**6
    both.advance(40)
    both.require_same()


@pytest.mark.parametrize("kind", TAPES)
def test_tapes_made_without_the_card_replay_to_the_same_bits(card, kind, tmp_path) -> None:
    record(tmp_path / "fluid.tape", card.chip, **BULK[kind])
    assert Tape(tmp_path / "fluid.tape").play(card).expected == []
