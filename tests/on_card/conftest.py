"""Tests that need a card: `make test-gpu`. All others skip them, in one line.

With DEVICE=emulated they run on the processor, slowly: a rehearsal of the tests, not of a card.
"""

import functools
import os

import pytest

from mesokit.devices.named import opened
from mesokit.errors import RunError

NAME = os.environ.get("MESOKIT_TEST_DEVICE", "")


@functools.cache
def reason() -> str:
    """Why these tests cannot run, or nothing."""
    if not NAME:
        return "tests of a card: expected `make test-gpu`"
    try:
        opened(NAME)
    except RunError as error:
        return str(error)
    return ""


def pytest_runtest_setup() -> None:
    """Skip what is in this folder where there is no card; from one place, so in one line."""
    if reason():
        pytest.skip(reason())


@pytest.fixture(scope="session")
def name() -> str:
    """The name of the device, as users give it."""
    return NAME


@pytest.fixture(scope="session")
def card(name):
    """The device, once: kernels are made for the first fluid that needs them."""
    return opened(name)
