"""Fluids of molecules on a device: the bits of the processor's engine, without a card."""

import numpy as np
import pytest

from mesokit import (
    AT,
    FENE,
    WCA,
    Bending,
    Disk,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    Plates,
    RunError,
    Surface,
    Uniform,
)
from mesokit.devices.host import Host
from tests.helpers.on_devices import bulk, pair
from tests.helpers.small_fluids import assert_same

HOST, MEASURED = Host(7), ("stress", "walls")
SPRING = Harmonic(K=1.0)
PUSHED = {"thermostat": MaxwellBoltzmann(), "force": Uniform((0.05, -0.02))}
CHAINS = bulk(2) | {"density": 9, "molecule": Molecule(length=3, bond=SPRING, substeps=2)}
SHEARED = bulk(3) | {
    "density": 7, "molecule": Molecule(length=7, bond=FENE()),
    "thermostat": MaxwellBoltzmann(), "shear_rate": 0.2,
}  # fmt: skip
SLIT = bulk(2) | PUSHED | {
    "molecule": Molecule(bond=SPRING, substeps=2), "walls": [Plates("y", virtual="none")],
}  # fmt: skip
STIFF_RINGS = bulk(2) | {
    "density": 9, "timestep": 0.1, "thermostat": MaxwellBoltzmann(),
    "molecule": Molecule(topology="ring", length=3, bond=FENE(), pair=WCA(), substeps=30),
}  # fmt: skip
BENT = bulk(3) | {
    "collision": AT(), "molecule": Molecule(length=4, bond=SPRING, bending=Bending(kappa=2.0)),
}  # fmt: skip
STARS = {
    "size": (16, 12), "density": 8, "timestep": 0.5, **PUSHED,
    "molecule": Molecule(topology="star", length=4, arms=3, bond=SPRING, substeps=2),
    "walls": [Disk(centre=(8, 6), radius=3, virtual="none", surface=Surface("diffuse"))],
}  # fmt: skip
QUICK = {
    "sheared chains": SHEARED,
}
LONG = {
    "dimers in a slit": SLIT,
    "exact dimers": bulk(2) | PUSHED | {"molecule": Molecule(bond=SPRING, propagation="exact")},
    "chains": CHAINS,
    "exact dimers in 3D": bulk(3) | {"molecule": Molecule(bond=SPRING, propagation="exact")},
    "stiff rings": STIFF_RINGS,
    "chains that bend": BENT,
    "chains whose shear oscillates": SHEARED | {"shear_frequency": 0.3},
    "stars about a disk": STARS,
}
KINDS = [
    *(pytest.param(kind, id=name) for name, kind in QUICK.items()),
    *(pytest.param(kind, id=name, marks=pytest.mark.long) for name, kind in LONG.items()),
]


def of_bonds(fluid) -> list:
    """Readings of molecules: bonds, whole positions, energies."""
    kind = slice(3, 20)
    sums = fluid.sums_of_bonds(lambda n, along: (n % 3, [along[:, 0]]), 3, [1.0], kind)
    return [fluid.bond_vectors(), fluid.whole_positions(), fluid.potential_energy(), sums]


@pytest.mark.parametrize("kind", KINDS)
def test_molecules_have_the_same_bits(kind) -> None:
    both = pair(HOST, MEASURED, **kind)
    for steps in (12, 28):
        both.advance(steps, ("stress",))
        both.require_same()
        assert_same(of_bonds(both.cpu), of_bonds(both.on_device))


def test_a_bond_that_tears_is_named_as_on_the_processor() -> None:
    both = pair(HOST, MEASURED, **SHEARED)
    whole, state = both.cpu.state(), both.cpu.state()
    for bead in (0, 90, 91, 306):  # far from the others of their molecules
        state["positions"][bead] += 5.0
    lines = []
    for engine in both:
        engine.restore(state)
        with pytest.raises(RunError, match="the bond of particles") as torn:
            engine.advance(1)
        lines.append(str(torn.value))
    assert lines[0] == lines[1]
    np.testing.assert_array_equal(
        both.cpu.memory.faults[:1, :3], both.on_device.memory.faults[:1, :3]
    )
    both.on_device.restore(whole)
    both.on_device.advance(1)  # those are forgotten
