"""Solids of every shape, built once."""

import pytest

from tests.helpers.shapes import EVERY, example, solids_of, walls_of


@pytest.fixture(scope="session", params=EVERY, ids=lambda case: "-".join(map(str, case)))
def every(request, tmp_path_factory):
    """Name, dimension and side of the fluid of every shape, with its example in a box."""
    name, d, side = request.param
    folder = tmp_path_factory.getbasetemp()
    walls = walls_of(example(name, d, side, folder), d)
    return name, d, side, solids_of(walls, d)
