"""The same fluid on a device: the bits of the processor's engine, without a card.

Checked devices run what NVIDIA's compiler made of a kernel on the processor, for several kinds of
chip, and look at every access to memory. Emulated ones do not look. The host runs the kernels'
sources, in order and shuffled.
"""

from __future__ import annotations

import functools

import pytest

from mesokit.devices.checked import Checked
from mesokit.devices.emulated import Emulated
from mesokit.devices.host import Host
from tests.helpers.on_devices import STEPS, kinds_of_bulk, pair

CHIPS = ((8, 0), (9, 0), (12, 0))
DEVICES = {
    "host in order": Host,
    "host shuffled": lambda: Host(7),
    **{f"checked {chip}": functools.partial(Checked, chip) for chip in CHIPS},
    "emulated": Emulated,
}
MEASURED = ("stress",)
QUICK = (
    "rule AT", "rule SRD", "rule SRDPlusA", "rule ATPlusA", "thermostat MaxwellBoltzmann",
    "force ScheduledForce", "shear OscillatingShear", "mixture",
)  # fmt: skip
SIMPLE = "thermostat MaxwellBoltzmann"
KINDS = {d: kinds_of_bulk(d) for d in (2, 3)}


@pytest.fixture(scope="module")
def devices():
    """Each device once: kernels are made for the first fluid that needs them."""
    made = {}
    return lambda name: made.setdefault(name, DEVICES[name]())


def rows():
    """Every kind in both dimensions on a chip, and the first of them on all devices.

    Those that are quick have one chip, for which kernels of sorts and readings are made once.
    """
    for d, kinds in KINDS.items():
        for place, kind in enumerate(kinds):
            quick = kind in QUICK and d == 2
            chip = f"checked {(9, 0) if quick else CHIPS[place % len(CHIPS)]}"
            for device in DEVICES if kind == SIMPLE else (chip,):
                marks = [] if quick and device == chip else [pytest.mark.long]
                yield pytest.param(device, d, kind, marks=marks, id=f"{d}D {kind}, {device}")


@pytest.mark.parametrize(("device", "dimension", "kind"), list(rows()))
def test_bulk_fluids_have_the_same_bits(devices, device, dimension, kind) -> None:
    both = pair(devices(device), MEASURED, **KINDS[dimension][kind])
    both.advance(STEPS, MEASURED)
    both.require_same()
    both.advance(STEPS, MEASURED)
    both.require_same()
    assert getattr(devices(device), "faults", {}) == {}
