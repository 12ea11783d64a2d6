"""Cases and their shorthand."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from mesokit.box import Box
from mesokit.case import Case
from mesokit.mpcd.fluid import Fluid
from mesokit.run import Run

sys.path.insert(0, str(Path(__file__).parent))  # fake_fluid.py


@pytest.fixture
def make_case():
    """A case from a box, observables and what else differs from the defaults."""

    def make(size=(8, 8), observe=(), walls=(), shear_rate=0.0, **fluid):
        return Case(
            run=Run(steps=1),
            box=Box(size, shear_rate=shear_rate),
            fluid=Fluid(**fluid),
            walls=walls,
            observe=observe,
        )

    return make
