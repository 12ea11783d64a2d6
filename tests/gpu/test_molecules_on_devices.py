"""Fluids of molecules on a device: the bits of the processor's engine, without a card."""

import numpy as np
import pytest

from mesokit import (
    AT,
    FENE,
    WCA,
    Bending,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    RunError,
)
from tests.gpu.conftest import CHIPS, FURTHER, LONG
from tests.helpers.kinds_of_fluid import MOLECULES
from tests.helpers.on_devices import bulk, pair
from tests.helpers.small_fluids import assert_same

MEASURED = ("stress", "walls")
SHEARED = bulk(3) | {
    "density": 7, "molecule": Molecule(length=7, bond=FENE()),
    "thermostat": MaxwellBoltzmann(), "shear_rate": 0.2,
}  # fmt: skip
STIFF_RINGS = bulk(2) | {
    "density": 9, "timestep": 0.1, "thermostat": MaxwellBoltzmann(),
    "molecule": Molecule(topology="ring", length=3, bond=FENE(), pair=WCA(), substeps=30),
}  # fmt: skip
BENT = bulk(3) | {
    "collision": AT(),
    "molecule": Molecule(length=4, bond=Harmonic(K=1.0), bending=Bending(kappa=2.0)),
}  # fmt: skip
QUICK = {"sheared chains": SHEARED}
WIDE = ("sheared chains", "stiff rings")
OTHERS = {
    **{name: MOLECULES[name] for name in ("dimers in a slit", "stars about a disk")},
    "chains whose shear oscillates": MOLECULES["chains whose shear oscillates"],
    "exact dimers": bulk(3) | {"molecule": Molecule(bond=Harmonic(K=1.0), propagation="exact")},
    "stiff rings": STIFF_RINGS,
    "chains that bend": BENT,
}


def rows():
    """Every kind on a chip; that which is quick on the host alone."""
    yield from (pytest.param("host", kind, id=f"{name}, host") for name, kind in QUICK.items())
    for place, (name, kind) in enumerate((QUICK | OTHERS).items()):
        device = f"checked {CHIPS[place % len(CHIPS)]}"
        marks = LONG if name in WIDE else FURTHER
        yield pytest.param(device, kind, marks=marks, id=f"{name}, {device}")


def of_bonds(fluid) -> list:
    """Readings of molecules: bonds, whole positions, energies."""
    kind = slice(3, 20)
    sums = fluid.sums_of_bonds(lambda n, along: (n % 3, [along[:, 0]]), 3, [1.0], kind)
    return [fluid.bond_vectors(), fluid.whole_positions(), fluid.potential_energy(), sums]


@pytest.mark.parametrize(("device", "kind"), list(rows()))
def test_molecules_have_the_same_bits(devices, device, kind) -> None:
    parts = {name: part for name, part in kind.items() if name != "measures"}
    both = pair(devices(device), MEASURED, **parts)
    for steps in (12, 28):
        both.advance(steps, ("stress",))
        both.require_same()
        assert_same(of_bonds(both.cpu), of_bonds(both.on_device))
    assert getattr(devices(device), "faults", {}) == {}


def test_a_bond_that_tears_is_named_as_on_the_processor(devices) -> None:
    both = pair(devices("host"), MEASURED, **SHEARED)
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
