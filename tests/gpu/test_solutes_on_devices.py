"""Solutes on a device: the bits of the processor's engine, without a card."""

import numpy as np
import pytest

from mesokit import (
    FENE,
    WCA,
    ATPlusA,
    Bending,
    Disk,
    Harmonic,
    MagneticField,
    MaxwellBoltzmann,
    Plates,
    Polymer,
    Pull,
    RunError,
    Solutes,
    Species,
    Surface,
    Trap,
    Uniform,
)
from mesokit.method.mpcd.engine.beads.neighbours import CROWDED
from tests.gpu.conftest import CHIPS, FURTHER, LONG
from tests.helpers.kinds_of_fluid import AMONG_MOLECULES, EMBEDDED, SEVERAL_KINDS
from tests.helpers.on_devices import bulk, pair
from tests.helpers.small_fluids import assert_same

HELD = {"thermostat": MaxwellBoltzmann()}
CHAINS = Solutes(
    (Polymer(6, length=5), Polymer(10)), mass=4.0, bond=FENE(), bending=Bending(kappa=2.0),
    pair=WCA(), substeps=100,
)  # fmt: skip
AT_WALLS = Solutes(
    (Polymer(12, length=3),), mass=4.0, bond=Harmonic(K=2.0), wall=WCA(sigma=0.5), substeps=20
)
BALLS = Solutes((Polymer(10),), mass=3.0, substeps=8)
DRIVEN = Solutes(
    (Polymer(5, length=4),), mass=3.0, bond=Harmonic(K=1.0), substeps=8,
    pulls=(Pull((0.3, 0.0, 0.1), bead=-1),), traps=(Trap((2.0, 2.5, 3.0), k=2.0, bead=1),),
    magnetic=(MagneticField((0.5, 0.2, 1.0), charge=2.0),),
)  # fmt: skip
SLIT = {"size": (13, 7), "density": 10, "timestep": 0.3, "force": Uniform((0.05, -0.02)), **HELD}
MOVING = [Plates("y", upper=Surface(velocity=(0.3, 0.0)))]
MEASURED = ("stress", "walls")
SHEARED = bulk(2) | HELD | {"shear_rate": 0.2, "solutes": CHAINS}
QUICK = {"sheared chains with lists": SHEARED}
OTHERS = {
    "beads and a rule that draws": bulk(2) | {"collision": ATPlusA(), "solutes": BALLS},
    "chains from outside": bulk(3) | {"solutes": DRIVEN},
    "chains that plates repel": SLIT | {"walls": MOVING, "solutes": AT_WALLS},
    "chains that a disk repels": SLIT | {
        "size": (16, 12), "walls": [Disk(centre=(8, 6), radius=3)], "solutes": AT_WALLS,
    },
    "several kinds": {"size": (8, 8, 8), "density": 5, **HELD, "solutes": SEVERAL_KINDS},
    "random solvent": bulk(3) | HELD | {
        "solutes": Solutes((Polymer(30),), mass=3.0, solvent="random", substeps=4),
    },
    **{f"among molecules: {name}": kind for name, kind in AMONG_MOLECULES.items()},
}  # fmt: skip

WIDE = ("sheared chains with lists", "among molecules: slit", "around a disk")


def rows(kinds):
    """Every kind on a chip."""
    for place, (name, kind) in enumerate(kinds.items()):
        device = f"checked {CHIPS[place % len(CHIPS)]}"
        marks = LONG if name in WIDE else FURTHER
        yield pytest.param(device, kind, marks=marks, id=f"{name}, {device}")


ON_HOST = [pytest.param("host", kind, id=f"{name}, host") for name, kind in QUICK.items()]


def of_beads(fluid) -> list:
    """Readings of solutes."""
    beads = fluid.solutes
    moving = beads.places, beads.velocities, *beads.folded(), beads.motion()
    return [*moving, fluid.potential_energy(), fluid.bond_vectors()]


@pytest.mark.parametrize(("device", "kind"), [*ON_HOST, *rows(QUICK | OTHERS)])
def test_solutes_have_the_same_bits(devices, device, kind) -> None:
    parts = {name: part for name, part in kind.items() if name != "measures"}
    both = pair(devices(device), MEASURED, **parts)
    for steps in (12, 18):
        both.advance(steps, ("stress",))
        assert_same(of_beads(both.cpu), of_beads(both.on_device))
        one, other = (engine.state() for engine in both)
        assert_same(one.values(), other.values())
        assert_same(both.cpu.stress.values(), both.on_device.stress.values())
    both.on_device.restore(one)  # beads moved by hand
    both.on_device.advance(2)
    both.cpu.advance(2)
    assert_same(of_beads(both.cpu), of_beads(both.on_device))
    assert getattr(devices(device), "faults", {}) == {}


@pytest.mark.long
def test_beads_with_more_neighbours_than_a_list_has_room_for_look_at_all(devices) -> None:
    crowd = Solutes((Polymer(121),), mass=1e6, pair=WCA(sigma=0.2), substeps=60)
    both = pair(devices("host"), **bulk(2) | {"solutes": crowd, "timestep": 0.01})
    side = np.linspace(3.0, 4.0, 11)
    places = np.stack(np.meshgrid(side, side), axis=-1).ravel()
    state = both.cpu.state() | {"solute_r": places, "solute_v": 0.0 * places}
    for engine in both:
        engine.restore(state)
        engine.advance(1)
    counts = both.on_device.memory.row(both.on_device.memory.beads.lists.count, np.int32, 0, 121)
    assert (counts == CROWDED).any()
    assert_same(of_beads(both.cpu), of_beads(both.on_device))


def test_a_bond_of_beads_that_tears_is_named_as_on_the_processor(devices) -> None:
    both = pair(devices("host"), MEASURED, **SHEARED)
    whole, torn = both.cpu.state(), both.cpu.state()
    torn["solute_r"][[2 * 7, 2 * 20]] += 5.0
    lines = []
    for engine in both:
        engine.restore(torn)
        with pytest.raises(RunError, match="the bond of beads") as error:
            engine.advance(1)
        lines.append(str(error.value))
    assert lines[0] == lines[1]
    both.on_device.restore(whole)
    both.on_device.advance(1)  # that is forgotten


IN_SLIT = {
    "size": (20, 12), "density": 5, "walls": [Plates("y", virtual="none")], "solutes": EMBEDDED,
    "force": Uniform((0.02, 0.0)), **HELD,
}  # fmt: skip
AROUND = {
    "in a slit": IN_SLIT,
    "in a box in 3D": {"size": (12, 11, 10), "density": 5, "solutes": EMBEDDED, **HELD},
    "in a mixture": {
        "size": (20, 20), "solutes": EMBEDDED, **HELD,
        "species": (Species(mass=1, density=3), Species(mass=2, density=2)),
    },
    "around a disk": IN_SLIT | {
        "size": (20, 20), "walls": [Disk(centre=(10, 10), radius=3, virtual="none")],
    },
}  # fmt: skip


IN_SLIT_ON_HOST = pytest.param("host", IN_SLIT, marks=pytest.mark.long, id="in a slit, host")


@pytest.mark.parametrize(("device", "kind"), [IN_SLIT_ON_HOST, *rows(AROUND)])
def test_solutes_that_act_by_a_potential_have_the_same_bits(devices, device, kind) -> None:
    both = pair(devices(device), ("walls",), **kind)
    for steps in (12, 18):
        both.advance(steps)
        one, other = (engine.state() for engine in both)
        assert_same(one.values(), other.values())
        assert both.cpu.potential_energy() == both.on_device.potential_energy() > 0.0
    assert both.on_device.memory.row(both.on_device.memory.beads.near.number, np.int32, 0, 1) > 0
    assert getattr(devices(device), "faults", {}) == {}


@pytest.mark.long
def test_a_bead_that_goes_too_far_is_named_as_on_the_processor(devices) -> None:
    both = pair(devices("host"), ("walls",), **IN_SLIT)
    fast = both.cpu.state()
    fast["solute_v"] = fast["solute_v"].copy()
    fast["solute_v"][2 * 3] = 100.0
    lines = []
    for engine in both:
        engine.restore(fast)
        with pytest.raises(RunError, match="bead 4 went farther than") as error:
            engine.advance(1)
        lines.append(str(error.value))
    assert lines[0] == lines[1]
