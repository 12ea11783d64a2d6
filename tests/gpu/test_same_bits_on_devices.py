"""The same fluid on a device: the bits of the processor's engine, without a card.

Checked devices run what NVIDIA's compiler made of a kernel on the processor, for several kinds of
chip, and look at every access to memory. Emulated ones do not look. The host runs the kernels'
sources, in order and shuffled.
"""

from __future__ import annotations

import pytest

from tests.gpu.conftest import CHIPS, DEVICES, FURTHER, LONG
from tests.helpers.on_devices import STEPS, kinds_of_bulk, pair

MEASURED = ("stress",)
SIMPLE = "2D SRD"
QUICK = ("2D AT", SIMPLE)
WIDE = (SIMPLE, "3D mixture that demixes", "3D ATPlusA")  # most of the parts are in these
KINDS = kinds_of_bulk()


def rows():
    """Every kind on a chip, and one of them on all devices.

    Those that are quick have one chip, for which kernels of sorts and readings are made once.
    """
    for place, kind in enumerate(KINDS):
        chip = f"checked {(9, 0) if kind in QUICK else CHIPS[place % len(CHIPS)]}"
        for device in DEVICES if kind == SIMPLE else (chip,):
            quick = kind in QUICK and device == chip
            marks = () if quick else LONG if kind in WIDE else FURTHER
            yield pytest.param(device, kind, marks=marks, id=f"{kind}, {device}")


@pytest.mark.parametrize(("device", "kind"), list(rows()))
def test_bulk_fluids_have_the_same_bits(devices, device, kind) -> None:
    both = pair(devices(device), MEASURED, **KINDS[kind])
    both.advance(STEPS, MEASURED)
    both.require_same()
    both.advance(STEPS, MEASURED)
    both.require_same()
    assert getattr(devices(device), "faults", {}) == {}
