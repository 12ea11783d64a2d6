"""Devices of tests. The compiler for GPUs is not on every system: without it nothing is asked."""

import functools
from importlib.util import find_spec

import pytest

from mesokit.devices.checked import Checked
from mesokit.devices.emulated import Emulated
from mesokit.devices.host import Host

collect_ignore_glob = [] if find_spec("numba_cuda") else ["test_*.py"]
CHIPS = ((9, 0), (8, 0), (12, 0))
LONG = (pytest.mark.long,)
FURTHER = (pytest.mark.long, pytest.mark.further)
DEVICES = {
    "host": functools.partial(Host, 7),
    "host in order": Host,
    "emulated": Emulated,
    **{f"checked {chip}": functools.partial(Checked, chip) for chip in CHIPS},
}


@pytest.fixture(scope="module")
def devices():
    """Devices by name, each once: kernels are made for the first fluid that needs them."""
    made = {}
    return lambda name: made.setdefault(name, DEVICES[name]())
