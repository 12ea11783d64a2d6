"""A case, its fake fluid and its results."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from mesokit.box import Box
from mesokit.case import Case
from mesokit.mpcd.fluid import Fluid
from mesokit.run import Run

sys.path.insert(0, str(Path(__file__).parents[1] / "observe"))  # fake_fluid.py


@pytest.fixture
def make_case():
    """A case from a box, and what else differs from the defaults."""

    def make(size=(6, 6, 6), **rest):
        shear_rate = rest.pop("shear_rate", 0.0)
        box = Box(size, shear_rate=shear_rate)
        return Case(run=Run(steps=1), box=box, fluid=rest.pop("fluid", Fluid(density=2)), **rest)

    return make
