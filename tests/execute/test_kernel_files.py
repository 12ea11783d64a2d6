"""Kernels with parts from outside mesokit are kept apart, and never run when these have changed."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import namedtuple
from pathlib import Path
from typing import NamedTuple

import numba
import pytest

from mesokit.method.mpcd.collision.srd import SRD
from mesokit.scalar.cache import KernelFiles, classes, digest, folder

PART = "from typing import NamedTuple\nclass Mine(NamedTuple):\n    x: float\n"


class Inner(NamedTuple):
    x: float
    y: float


def loop(thread, threads, physics):
    return 0


def place(*arguments: object) -> str | None:
    """The folder of a kernel for these arguments."""
    cache = KernelFiles(loop)._cache(tuple(map(numba.typeof, arguments)))
    return None if cache is None else cache.cache_path


def test_all_classes_are_seen() -> None:
    group = namedtuple("group", "a b")(Inner(1.0, 2.0), (3, Inner(4.0, 5.0)))
    assert {c.__name__ for c in classes((numba.typeof(group),))} == {"group", "Inner"}


def test_a_change_of_any_file_that_kernels_are_made_of_is_another_folder(tmp_path: Path) -> None:
    """Also of one that names neither numba nor what compiles: a law that registers itself."""
    file = tmp_path / "method" / "law.py"
    file.parent.mkdir()
    file.write_text("from mesokit.method.protocol import force\n")
    before = digest(tmp_path)
    assert digest(tmp_path) == before
    file.write_text("from mesokit.method.protocol import force  # twice\n")
    assert digest(tmp_path) != before


def test_parts_of_mesokit_share_a_folder() -> None:
    found = place(0, 1, SRD().kernel(2, 1.0))
    assert found is not None and Path(found).parent == Path(folder())


def test_a_part_from_outside_has_a_folder_for_each_state_of_its_sources(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    file = tmp_path / "outside_part_of_a_test.py"
    file.write_text(PART)
    import outside_part_of_a_test as module

    try:
        first = place(0, 1, (SRD().kernel(2, 1.0), module.Mine(1.0)))
        assert first is not None and Path(first).parent.parent == Path(folder())
        assert place(0, 1, (SRD().kernel(2, 1.0), module.Mine(2.0))) == first
        file.write_text(PART + "FACTOR = 2.0\n")
        assert place(0, 1, (SRD().kernel(2, 1.0), module.Mine(1.0))) != first
    finally:
        del sys.modules["outside_part_of_a_test"]


def test_a_folder_of_the_users_own_is_divided_by_sources_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Many jobs share NUMBA_CACHE_DIR, also those of earlier and later versions."""
    usual = Path(folder())
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    folder.cache_clear()
    try:
        assert Path(folder()) == tmp_path / "mesokit" / usual.name
        found = place(0, 1, SRD().kernel(2, 1.0))
        assert found is not None and tmp_path / "mesokit" / usual.name in Path(found).parents
        assert str(tmp_path) == numba.config.CACHE_DIR
    finally:
        folder.cache_clear()


def test_what_no_other_process_can_name_is_not_kept() -> None:
    class Local(NamedTuple):
        x: float

    assert place(0, 1, Local(1.0)) is None


def test_of_processes_that_need_a_kernel_one_compiles(tmp_path: Path) -> None:
    """The ranks of a run all need the same ones; a lock that somebody left does not matter."""
    program = (
        "import mesokit\n"
        "from mesokit.geometry.solids.solids import Solids\n"
        "from mesokit.geometry.solids.survey import near_blocks\n"
        "Solids([mesokit.Disk(centre=[5, 5], radius=2)], mesokit.Box([10, 10]))\n"
        "print(sum(near_blocks.stats.cache_misses.values()))\n"
    )
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", program]
    some = [subprocess.Popen(command, stdout=subprocess.PIPE, env=environment) for _ in range(3)]
    assert sorted(int(one.communicate(timeout=300)[0]) for one in some) == [0, 0, 1]
    assert not [file for file in tmp_path.rglob("locks/*") if file.is_file()]
