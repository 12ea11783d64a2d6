"""Parts that a package brings: they save compiling, and never end a run."""

from __future__ import annotations

import shutil
import sqlite3
import zlib
from pathlib import Path

import pytest

from tests.helpers.module_with_kernels import NOTHING_MADE, PROGRAM, Place, damage

BRINGS = """
from pathlib import Path
import mesokit.kernels.kept as stores
brought = Path("brought", stores.era() + ".sqlite").absolute()
stores.shipped_file = lambda: brought
"""
EXPORT = """
from mesokit.kernels.ship import export
from mesokit.kernels.kept import kept
print([export(brought), kept().own.counts()["parts"]])
"""


@pytest.fixture(scope="module")
def exported(made: Place) -> Path:
    """A folder with the file of parts."""
    number, parts = made.run(BRINGS, EXPORT)
    assert number == parts > 4
    return made.root / "brought"


@pytest.fixture
def shipped(exported: Path, tmp_path: Path) -> Place:
    """An empty store, and the parts that a package brings."""
    shutil.copytree(exported, tmp_path / "brought")
    return Place(tmp_path)


ONLY_LINKED = {"sum": 72.0, "trouble": "", "parts_made": 0, "kernels_made": 2}


def test_a_package_brings_parts_and_no_machine_code(exported: Path) -> None:
    (file,) = exported.iterdir()
    with sqlite3.connect(file) as disk:
        names = [name for (name,) in disk.execute("SELECT name FROM entries")]
        code = [zlib.decompress(body) for (body,) in disk.execute("SELECT body FROM code")]
    assert not [name for name in names if name.startswith(("kernel ", "kind "))]
    assert {one[:4] for one in code} == {b"BC\xc0\xde"}  # bitcode


def test_with_parts_that_a_package_brings_none_is_made(shipped: Place) -> None:
    assert shipped.run(BRINGS).items() >= ONLY_LINKED.items()
    assert shipped.run(BRINGS).items() >= NOTHING_MADE.items()


def test_parts_that_a_package_brings_are_for_every_processor(shipped: Place) -> None:
    found = shipped.run(BRINGS, NUMBA_CPU_NAME="generic", NUMBA_CPU_FEATURES="")
    assert found.items() >= ONLY_LINKED.items()
    assert shipped.run(BRINGS)["kernels_made"] == 2  # machine code is for one


def test_parts_that_a_package_brings_serve_where_nothing_can_be_written(shipped: Place) -> None:
    (shipped.root / "cache").write_text("a file where a folder should be")
    found = shipped.run(BRINGS)
    assert (
        found["trouble"] and found.items() >= (ONLY_LINKED | {"trouble": found["trouble"]}).items()
    )


def test_an_edit_remakes_what_a_package_brings(shipped: Place) -> None:
    shipped.edit("return FACTOR * x", "return x * FACTOR * 2.0")
    found = shipped.run(BRINGS)
    assert found["sum"] == 144.0 and found["parts_made"] == 2


@pytest.mark.parametrize("renamed", [False, True])
@pytest.mark.parametrize(
    "another",
    [
        "numba.__version__ = '0.99.0'",
        "llvmlite.__version__ = '0.99.0'",
        "numpy.__version__ = '2.99.0'",
        "sys.implementation.name = 'another'",
        "platform.machine = lambda: 'another'",
        "sysconfig.get_platform = lambda: 'another'",
    ],
)
def test_parts_of_another_version_are_passed_over_in_silence(
    shipped: Place, another: str, renamed: bool
) -> None:
    """Also where the file has the name of this version: keys tell."""
    this = f"import llvmlite, numba, numpy, platform, sys, sysconfig\n{another}\n{BRINGS}"
    if renamed:
        (file,) = (shipped.root / "brought").iterdir()
        this += f"\nbrought.parent.joinpath({file.name!r}).rename(brought)\n"
    found = shipped.run(this)
    assert found["sum"] == 72.0 and found["parts_made"] > 4 and not found["trouble"]
    assert found["kernels_made"] == 2


@pytest.mark.parametrize("how", ["empty", "cut", "foreign", "garbage", "flipped"])
def test_damaged_parts_of_a_package_are_passed_over_in_silence(shipped: Place, how: str) -> None:
    (file,) = (shipped.root / "brought").iterdir()
    damage(file, how)
    found = shipped.run(BRINGS)
    assert found["sum"] == 72.0 and found["kernels_made"] == 2 and not found["trouble"]


def test_parts_are_exported_whatever_was_imported(tmp_path: Path) -> None:
    """What a generic function chooses may be registered in a module of its own."""
    place = Place(tmp_path)
    (tmp_path / "more.py").write_text(
        "from law import Curve, height\n\n@height.register(Curve)\ndef _(shape, x):\n"
        "    return shape.power\n"
    )
    chosen = PROGRAM.replace("import law", "import law, more").replace("law.Line", "law.Curve")
    assert place.run(program=chosen)["sum"] == 4 * 2 * 3 * 2 * 1.0
    number, parts = place.run(BRINGS, EXPORT)
    assert number == parts


def test_what_another_version_of_the_package_wrote_is_not_exported(place: Place) -> None:
    with sqlite3.connect(place.store) as disk:
        lines = "UPDATE needs SET line = 'choice law:height word law:Line' WHERE line LIKE {}"
        assert disk.execute(lines.format("'choice %'")).rowcount == 1
    number, parts = place.run(BRINGS, EXPORT)
    assert 0 < number < parts


def test_parts_of_another_state_of_the_compiler_are_not_exported(place: Place) -> None:
    place.run(NUMBA_OPT="1")  # versions and options are part of every key
    number, parts = place.run(BRINGS, EXPORT)
    assert number == parts / 2 > 4
