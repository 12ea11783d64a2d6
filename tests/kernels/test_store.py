"""The store of compiled code: processes at once, killed ones, full and closed disks, its bound."""

from __future__ import annotations

import json
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import pytest

from mesokit.kernels.store import Code, Entry, Store, folder, on_network
from tests.helpers.module_with_kernels import NOTHING_MADE, PROGRAM, Place


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


def test_a_place_that_is_named_from_here(place: Place) -> None:
    """A relative one means the same, also where it can only be read."""
    assert place.run(NUMBA_CACHE_DIR="cache").items() >= NOTHING_MADE.items()
    held = """
import sqlite3
from pathlib import Path
disk = sqlite3.connect("cache/mesokit/compiled-1.sqlite", isolation_level=None)
disk.execute("PRAGMA locking_mode = EXCLUSIVE")
disk.execute("BEGIN EXCLUSIVE")
"""
    found = place.run(held, NUMBA_CACHE_DIR="cache")
    assert found["sum"] == 72.0 and "locked" in found["trouble"]
    assert place.run().items() >= NOTHING_MADE.items()


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


@mounts
def test_a_disk_that_is_full_by_now_is_read(place: Place) -> None:
    cache, copy = place.root / "cache", place.root / "copy"
    shutil.copytree(cache, copy)
    mount = f"mount -t tmpfs -o size=2m none {cache} && cp -r {copy}/mesokit {cache}"
    fill = f"(dd if=/dev/zero of={cache}/fill bs=1k 2> /dev/null || true)"
    found = place.run(within=[*IN_OWN_MOUNTS, "sh", "-c", f'{mount} && {fill} && exec "$@"', "sh"])
    assert found.items() >= NOTHING_MADE.items() and not found["trouble"]


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


def test_a_store_full_of_one_hour_keeps_the_latest(tmp_path: Path) -> None:
    store = Store(tmp_path / "store.sqlite")
    for number in range(10):
        code = Code(f"code {number}", (), os.urandom(1000))
        store.keep(f"key {number}", Entry("name", frozenset(), b"", code.hash), [code])
    store.keep("kind", Entry("kind of case", frozenset(), b"", ""), [])
    store.shrink(5 * 1400)
    assert [number for number in range(10) if list(store.find(f"key {number}"))] == [6, 7, 8, 9]
    assert list(store.find("kind"))


@pytest.mark.skipif(os.name == "nt", reason="links of Windows need rights")
def test_a_folder_may_be_a_link_of_the_user(place: Place) -> None:
    """As to a larger disk of a cluster."""
    shutil.move(place.store.parent, place.root / "elsewhere")
    place.store.parent.symlink_to(place.root / "elsewhere")
    assert place.run().items() >= NOTHING_MADE.items()


def test_a_folder_where_the_file_should_be(tmp_path: Path) -> None:
    place = Place(tmp_path)
    place.store.mkdir(parents=True)
    found = place.run()
    assert found["sum"] == 72.0 and "is a folder" in found["trouble"]


def test_threads_of_a_process_share_its_store(tmp_path: Path) -> None:
    place = Place(tmp_path)
    threads = """
from threading import Thread
import law
from mesokit.kernels.kept import kept
from mesokit.kernels.store import Entry

def keep(thread):
    for number in range(50):
        name = f"{thread} {number}"
        kept().keep(name, lambda store: (Entry(name, frozenset(), b"", ""), []))
        assert kept().find(name)

kept()
threads = [Thread(target=keep, args=(number,)) for number in range(4)]
for one in threads:
    one.start()
for one in threads:
    one.join()
assert not kept().trouble and sum(kept().own.counts().values()) == 200
"""
    assert place.run(threads).items() >= {"sum": 72.0, "trouble": ""}.items()


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
