"""What kernels need of a card, by its assembler: more registers would leave it half empty."""

from __future__ import annotations

import re

import pytest

from benchmarks.gpu_kernels import CASES, CHIPS, kernels_of, needs
from mesokit.devices.cubins import made
from tests.gpu.conftest import FURTHER, LONG

QUICK = ("3D SRD, thermostat",)
WIDE = ("3D slit, thermostat", "3D SRD+a, thermostat")
# Registers of a thread: with 64 a multiprocessor has 1024 threads, with 104 half of these.
MOST = {"sweep": 64, "sweep_in_fluid": 64, "sweep_molecule": 88, "collide_cell": 64}
MOST_WITH_ANGULAR_MOMENTUM = {"sweep": 104, "collide_cell": 100}
# What all threads do in these is what they do in others.
AS_OTHERS = ("3D slit, SRD+a, thermostat", "3D chains, thermostat")
ROWS = [
    pytest.param(name, marks=() if name in QUICK else LONG if name in WIDE else FURTHER)
    for name in CASES
    if name not in AS_OTHERS
]


@pytest.mark.parametrize("name", ROWS)
def test_what_all_threads_do_fits_in_few_registers(name) -> None:
    most = MOST_WITH_ANGULAR_MOMENTUM if "+a" in name else MOST
    kernels = {chip: kernels_of(name, chip) for chip in CHIPS}
    assert all("collide_cell" in asked for asked in kernels.values())
    found = {
        (kernel, chip): needs(*asked[kernel], chip)
        for chip, asked in kernels.items()
        for kernel in most.keys() & asked
    }
    too_many = {key: one for key, one in found.items() if one.registers > most[key[0]]}
    assert too_many == {}
    assert {key: one for key, one in found.items() if one.spills or one.own_memory} == {}


@pytest.mark.parametrize("name", ROWS)
def test_every_rounding_is_named(name) -> None:
    texts = {k: made(*kernel, (9, 0)).ptx for k, kernel in kernels_of(name, (9, 0)).items()}
    assert "collide_cell" in texts
    unnamed = {k: re.findall(r"(?:add|sub|mul|div|sqrt)\.f64", text) for k, text in texts.items()}
    assert unnamed == {key: [] for key in texts}
