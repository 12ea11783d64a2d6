"""The store of compiled code: whatever is wrong with it costs time, never a run."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
import zlib
from collections.abc import Sequence
from pathlib import Path

import pytest

from mesokit.kernels.store import Code, Entry, Store, folder, on_network

LAW = """
import numpy as np
from numba import njit
from mesokit.kernels.kernel import kernel
from mesokit.scalar.jit import by_type, generic, scalar
from typing import NamedTuple

FACTOR = 3.0


class Line(NamedTuple):
    slope: float


class Curve(NamedTuple):
    power: float


@generic
def height(shape, x):
    '''Height of a shape at x.'''


@height.register(Line)
def _(shape, x):
    return shape.slope * x


@height.register(Curve)
def _(shape, x):
    return x**shape.power


@njit
def same(x):
    return x + 0.0


@scalar
def twice(x):
    return 2.0 * same(x)


@scalar
def scaled(x):
    return FACTOR * x


@scalar
def unused(x):
    return x + 1.0


def is_long(rows):
    return len(rows) > 1


@by_type
def reduced(rows, x):
    return (lambda rows, x: twice(x)) if is_long(rows) else (lambda rows, x: x)


@kernel
def add(shape, rows, out):
    for i in range(len(out)):
        out[i] = scaled(reduced(rows, height(shape, float(i))))


@kernel
def double(out):
    for i in range(len(out)):
        out[i] = twice(out[i])
"""
PROGRAM = """
import json, sys
import numpy as np
import law
from mesokit.kernels.kept import counts, kept

out = np.zeros(4)
law.add(law.Line(1.0), (1.0, 2.0), out)
law.double(out)
names = "parts_made", "parts_found", "kernels_made", "kernels_found"
print(json.dumps({"sum": float(out.sum()), "trouble": kept().trouble}
                 | {name: getattr(counts, name) for name in names}))
"""


class Place:
    """A module with two kernels, and a store for it."""

    def __init__(self, root: Path) -> None:
        self.root, self.law = root, root / "law.py"
        self.law.write_text(LAW)
        self.store = root / "cache" / "mesokit" / "compiled-1.sqlite"

    def run(
        self, before: str = "", program: str = PROGRAM, within: Sequence[str] = (), **more: str
    ) -> dict:
        """What a process that calls both kernels says.

        `before`: lines that come first; `within`: a command that runs it.
        """
        done = subprocess.run(
            [*within, sys.executable, "-c", before + program], env=self.environment | more,
            cwd=self.root, capture_output=True, text=True, timeout=300,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert not done.stderr
        return json.loads(done.stdout)

    @property
    def environment(self) -> dict[str, str]:
        """Variables of the process."""
        return os.environ | {"NUMBA_CACHE_DIR": str(self.root / "cache")}

    def edit(self, before: str, after: str) -> None:
        """Change the module."""
        text = self.law.read_text()
        assert text.count(before) == 1
        self.law.write_text(text.replace(before, after))
        shutil.rmtree(self.root / "__pycache__", ignore_errors=True)


@pytest.fixture(scope="module")
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


NOTHING_MADE = {"kernels_made": 0, "kernels_found": 2, "parts_made": 0}


def test_a_second_process_makes_nothing(place: Place) -> None:
    assert place.run().items() >= NOTHING_MADE.items()


@pytest.mark.parametrize(
    ("before", "after", "kernels", "parts", "factor"),
    [
        # twice, what was chosen for reduced, and the bodies of both kernels; 2 is there twice
        ("return 2.0 * same(x)", "return 4.0 * same(x)", 2, 4, 4.0),
        ("return FACTOR * x", "return x * FACTOR * 2.0", 1, 2, 2.0),
        ("FACTOR = 3.0", "FACTOR = 6.0", 1, 2, 2.0),
        ("return shape.slope * x", "return shape.slope * x * 2.0", 1, 2, 2.0),
        ("len(rows) > 1", "len(rows) > 2", 1, 2, 0.5),  # only what chooses has changed
        ("out[i] = twice(out[i])", "out[i] = twice(twice(out[i]))", 1, 1, 2.0),  # a kernel itself
        ("x + 0.0", "x + x", 2, 4, 4.0),  # of a function of numba's own kind
        ("return x + 1.0", "return x + 2.0", 0, 0, 1.0),
        ("return x**shape.power", "return x**shape.power + 1.0", 0, 0, 1.0),
        ("'''Height of a shape at x.'''", "'''Height.'''\n    # of what", 0, 0, 1.0),
    ],
)
def test_an_edit_remakes_what_contains_it_and_nothing_else(
    place: Place, before: str, after: str, kernels: int, parts: int, factor: float
) -> None:
    place.edit(before, after)
    found = place.run()
    assert found["kernels_made"] == kernels and found["parts_made"] == parts
    assert found["sum"] == 72.0 * factor
    assert place.run().items() >= NOTHING_MADE.items()


def test_both_states_of_a_source_are_kept(place: Place) -> None:
    """As when branches of a repository are changed back and forth."""
    place.edit("FACTOR = 3.0", "FACTOR = 6.0")
    assert place.run()["kernels_made"] == 1
    place.edit("FACTOR = 6.0", "FACTOR = 3.0")
    assert place.run().items() >= NOTHING_MADE.items()


def damage(file: Path, how: str) -> None:
    """What happens to files."""
    data = bytearray(file.read_bytes())
    if how == "empty":
        data = bytearray()
    elif how == "cut":
        data = data[: len(data) // 2]
    elif how == "foreign":
        data = bytearray(b"these are my notes\n" * 1000)
    elif how == "garbage":
        data[4096:] = os.urandom(len(data) - 4096)
    else:  # bits that flip in rows of code
        for at in range(5000, len(data), 997):
            data[at] ^= 16
    file.write_bytes(data)
    for end in ("-wal", "-shm"):
        file.with_name(file.name + end).unlink(missing_ok=True)


@pytest.mark.parametrize("how", ["empty", "cut", "foreign", "garbage", "flipped"])
def test_a_damaged_store_is_made_anew(place: Place, how: str) -> None:
    damage(place.store, how)
    first = place.run()
    assert first["sum"] == 72.0 and first["kernels_made"] > 0
    assert place.run()["sum"] == 72.0  # where damage was seen late, the store is new only now
    assert place.run().items() >= NOTHING_MADE.items()


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE code SET body = NULL",
        "UPDATE code SET called = NULL",
        "UPDATE entries SET needs = NULL",
        "UPDATE entries SET about = 7",
        "UPDATE needs SET line = CAST(CAST(line AS BLOB) || x'ff20' AS TEXT)",  # no text any more
    ],
)
def test_rows_of_other_kinds_are_made_anew(place: Place, change: str) -> None:
    disk = sqlite3.connect(place.store)
    with disk:
        assert disk.execute(change).rowcount > 0
    disk.close()
    first = place.run()
    assert first["sum"] == 72.0 and first["kernels_made"] > 0
    assert place.run()["sum"] == 72.0  # where damage was seen late, the store is new only now
    assert place.run().items() >= NOTHING_MADE.items()


@pytest.mark.skipif(os.name == "nt", reason="folders of Windows have no mode")
def test_a_file_that_others_could_write_is_not_run(place: Place) -> None:
    place.store.parent.chmod(0o777)
    assert place.run()["kernels_made"] == 2
    assert place.run().items() >= NOTHING_MADE.items()


@pytest.mark.skipif(not hasattr(os, "chown") or os.geteuid() != 0, reason="only root gives away")
def test_a_file_of_another_user_is_not_run(place: Place) -> None:
    os.chown(place.store, 12345, 12345)
    assert place.run()["kernels_made"] == 2


def test_the_store_is_not_exported_to_itself(place: Place) -> None:
    export = f"""
from pathlib import Path
from mesokit.kernels.ship import export
export(Path({str(place.store)!r}))
"""
    done = subprocess.run(
        [sys.executable, "-c", export], env=place.environment, capture_output=True, text=True
    )
    assert "is the store itself" in done.stderr
    assert place.run().items() >= NOTHING_MADE.items()


def test_code_that_was_changed_is_not_run(place: Place) -> None:
    with sqlite3.connect(place.store) as disk:
        disk.execute("UPDATE code SET body = zeroblob(length(body))")
    assert place.run()["sum"] == 72.0
    assert place.run().items() >= NOTHING_MADE.items()


@pytest.mark.parametrize("column", ["body", "about"])
def test_whole_code_in_the_wrong_place_is_not_run(place: Place, column: str) -> None:
    """Rows that are sound in themselves, but not where they belong: only digests tell."""
    with sqlite3.connect(place.store) as disk:
        kernels = disk.execute(
            "SELECT code, id FROM entries WHERE name LIKE 'kernel %' ORDER BY name"
        ).fetchall()
        (add, first), (double, second) = kernels
        if column == "body":
            row = disk.execute("SELECT body FROM code WHERE hash = ?", (add,)).fetchone()
            disk.execute("UPDATE code SET body = ? WHERE hash = ?", (*row, double))
        else:
            row = disk.execute("SELECT about FROM entries WHERE id = ?", (first,)).fetchone()
            disk.execute("UPDATE entries SET about = ? WHERE id = ?", (*row, second))
    found = place.run()
    assert found["sum"] == 72.0 and found["kernels_made"] > 0
    place.run()
    assert place.run().items() >= NOTHING_MADE.items()


def test_code_that_is_gone_is_made_anew(place: Place) -> None:
    with sqlite3.connect(place.store) as disk:
        disk.execute("DELETE FROM code WHERE hash IN (SELECT hash FROM code LIMIT 4)")
        disk.execute("DELETE FROM entries WHERE name LIKE 'kernel %'")
    found = place.run()
    assert found["sum"] == 72.0 and found["kernels_made"] == 2


def test_entries_of_another_version_are_not_found(place: Place) -> None:
    """Each version has keys of its own; what is changed here is an option of numba."""
    assert place.run(NUMBA_OPT="1")["kernels_made"] == 2
    assert place.run().items() >= NOTHING_MADE.items()


@pytest.mark.skipif(os.name == "nt", reason="folders of Windows have no mode")
def test_a_folder_is_closed_to_others(place: Place) -> None:
    assert place.store.parent.stat().st_mode & 0o777 == 0o700
    place.store.parent.chmod(0o755)
    assert place.run().items() >= NOTHING_MADE.items()
    assert place.store.parent.stat().st_mode & 0o777 == 0o700


@pytest.mark.skipif(not hasattr(os, "chown") or os.geteuid() != 0, reason="only root gives away")
def test_a_folder_of_another_user_is_not_used(place: Place) -> None:
    os.chown(place.store.parent, 12345, -1)
    found = place.run()
    assert found["sum"] == 72.0 and found["kernels_made"] == 2
    own = place.root / "cache" / f"mesokit-{os.getuid()}" / place.store.name
    assert own.exists() and place.run().items() >= NOTHING_MADE.items()


def test_a_place_that_cannot_be_written(place: Place) -> None:
    shutil.rmtree(place.root / "cache")
    (place.root / "cache").write_text("a file where a folder should be")
    found = place.run()
    assert found["sum"] == 72.0 and found["kernels_made"] == 2 and found["trouble"]


def test_a_store_that_can_only_be_read_is_read(place: Place) -> None:
    """Root may write everywhere, but not in a file that is open as read-only."""
    store = Store(place.store, writes=False)
    with pytest.raises(sqlite3.OperationalError, match="readonly"):
        store.keep("key", Entry("name", frozenset(), b"", ""), [])
    assert sum(store.counts().values()) > 6


def test_a_full_disk_ends_writing_not_the_run(place: Place) -> None:
    """SQLite says so itself where a file may not grow."""
    place.edit("FACTOR = 3.0", "FACTOR = 6.0")
    program = PROGRAM.replace(
        "out = np.zeros(4)",
        "kept().own._disk.execute('PRAGMA max_page_count = 1')\nout = np.zeros(4)",
    )
    done = subprocess.run(
        [sys.executable, "-c", program], env=place.environment, cwd=place.root,
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["sum"] == 144.0 and "full" in found["trouble"]
    assert place.run()["kernels_made"] == 1


IN_OWN_MOUNTS = ["unshare", "--map-root-user", "--mount"]
mounts = pytest.mark.skipif(
    shutil.which("unshare") is None or subprocess.run([*IN_OWN_MOUNTS, "true"]).returncode != 0,
    reason="users may not mount here",
)


@mounts
def test_a_store_on_a_disk_that_is_read_only(place: Place) -> None:
    """As in the image of a container."""
    cache = place.root / "cache"
    mount = f"mount --bind {cache} {cache} && mount -o remount,bind,ro {cache}"
    found = place.run(within=[*IN_OWN_MOUNTS, "sh", "-c", f'{mount} && exec "$@"', "sh"])
    assert found.items() >= NOTHING_MADE.items() and not found["trouble"]
    place.edit("FACTOR = 3.0", "FACTOR = 6.0")
    found = place.run(within=[*IN_OWN_MOUNTS, "sh", "-c", f'{mount} && exec "$@"', "sh"])
    assert found["sum"] == 144.0 and found["kernels_made"] == found["kernels_found"] == 1


@mounts
@pytest.mark.parametrize("kilobytes", [4, 40, 120])
def test_a_disk_that_is_full(tmp_path: Path, kilobytes: int) -> None:
    place = Place(tmp_path)
    cache = place.root / "cache"
    cache.mkdir()
    mount = f"mount -t tmpfs -o size={kilobytes}k none {cache}"
    found = place.run(within=[*IN_OWN_MOUNTS, "sh", "-c", f'{mount} && exec "$@"', "sh"])
    assert found["sum"] == 72.0 and found["kernels_made"] == 2 and found["trouble"]


def test_two_processes_at_once(tmp_path: Path) -> None:
    """Of two that need the same kernels, one makes each."""
    place = Place(tmp_path)
    some = [
        subprocess.Popen(
            [sys.executable, "-c", PROGRAM], env=place.environment, cwd=place.root,
            stdout=subprocess.PIPE, text=True,
        )
        for _ in range(3)
    ]  # fmt: skip
    found = [json.loads(one.communicate(timeout=300)[0]) for one in some]
    assert [one["sum"] for one in found] == [72.0] * 3
    assert sum(one["kernels_made"] for one in found) == 2
    assert not [file for file in tmp_path.rglob("locks/*") if file.is_file()]


@pytest.mark.skipif(os.name == "nt", reason="no such signal")
def test_killed_in_the_middle(tmp_path: Path) -> None:
    """What was whole is kept; the next process makes the rest."""
    place = Place(tmp_path)
    one = subprocess.Popen([sys.executable, "-c", PROGRAM], env=place.environment, cwd=place.root)
    for _ in range(3000):
        if place.store.exists() and _parts(place.store) >= 3:
            break
        time.sleep(0.01)
    one.send_signal(signal.SIGKILL)
    one.wait()
    found = place.run()
    assert found["sum"] == 72.0
    assert place.run().items() >= NOTHING_MADE.items()


def _parts(file: Path) -> int:
    try:
        with sqlite3.connect(file) as disk:
            return disk.execute("SELECT COUNT(*) FROM entries").fetchone()[0]
    except sqlite3.Error:
        return 0


def test_what_was_not_used_for_longest_goes_first(tmp_path: Path) -> None:
    store = Store(tmp_path / "store.sqlite")
    for number in range(10):
        code = Code(f"code {number}", (), os.urandom(1000))
        store.keep(
            f"key {number}",
            Entry("name", frozenset({f"function m:f{number} word"}), b"", code.hash),
            [code],
        )
        store._disk.execute("UPDATE entries SET used = ? WHERE key = ?", (number, f"key {number}"))
        store._disk.execute("UPDATE code SET used = ? WHERE hash = ?", (number, code.hash))
    before = store.size
    store.shrink(5 * 1400)
    left = [number for number in range(10) if list(store.find(f"key {number}"))]
    assert left == [6, 7, 8, 9] or left == [5, 6, 7, 8, 9]
    lines = store._disk.execute("SELECT line FROM needs ORDER BY line").fetchall()
    assert lines == [(f"function m:f{number} word",) for number in left]
    assert store.size < before


def test_a_store_keeps_to_its_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mesokit.kernels.store.BOUND", 10**6)
    store = Store(tmp_path / "store.sqlite")
    for hour in range(30):
        monkeypatch.setattr("mesokit.kernels.store._hour", lambda hour=hour: hour)
        code = Code(f"code {hour}", (), os.urandom(100_000))
        store.keep(f"key {hour}", Entry("name", frozenset(), b"", code.hash), [code])
        assert list(store.find("key 0"))  # what is used again and again stays
        [first] = store.find("key 0")
        assert store.code(first.code)
        store.note_used()
        assert store.size <= 10**6 and list(store.find(f"key {hour}"))
    assert not list(store.find("key 1"))


def test_a_home_on_the_network(tmp_path: Path) -> None:
    mounts = tmp_path / "mounts"
    mounts.write_text("disk / ext4 rw 0 0\nserver:/home /home nfs4 rw 0 0\n")
    assert on_network(Path("/home/physicist/.cache"), mounts)
    assert not on_network(Path("/homeland"), mounts)
    assert not on_network(Path("/tmp"), tmp_path / "no such file")


def test_a_folder_that_jobs_share(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import numba

    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    assert folder() == tmp_path / "mesokit"


# --- parts that a package brings ------------------------------------------------------------------

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
