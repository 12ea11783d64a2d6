"""What the tests of several folders share: laboratory, fake fluid and examples of shapes."""

import sys
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("same every time", derandomize=True)
settings.load_profile("same every time")

HERE = Path(__file__).parent
# laboratory.py, fake_fluid.py, flows.py, shapes.py, examples.py, ptx.py
sys.path[:0] = [str(HERE / name) for name in ("laws", "observe", "report", "geometry", "gpu")]


@pytest.fixture
def make_case():
    """A case from a box, observables and what else differs from the defaults."""
    from laboratory import make_case

    return make_case
