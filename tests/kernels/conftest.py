"""A store with the kernels of a module in it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.helpers.module_with_kernels import Place


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Place:
    """A store with both kernels in it."""
    place = Place(tmp_path_factory.mktemp("made"))
    first = place.run()
    assert first["sum"] == 2 * 3 * 2 * (0 + 1 + 2 + 3)
    assert first["kernels_made"] == 2 and first["parts_made"] > 4
    return place


@pytest.fixture
def place(made: Place, tmp_path: Path) -> Place:
    """A copy of it."""
    mine = Place(tmp_path)
    shutil.copytree(made.root / "cache", tmp_path / "cache")
    return mine
