"""A store that is damaged, foreign or another user's costs time, never a run."""

from __future__ import annotations

import os
import sqlite3

import pytest

from tests.helpers.module_with_kernels import NOTHING_MADE, Place, damage


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


@pytest.mark.parametrize(
    "change", ["CREATE TABLE entries (a TEXT)", "ALTER TABLE entries RENAME COLUMN used TO other"]
)
def test_tables_of_another_program_are_made_anew(place: Place, change: str) -> None:
    if change.startswith("CREATE"):
        place.store.unlink()
    disk = sqlite3.connect(place.store)
    with disk:
        disk.execute(change)
    disk.close()
    assert place.run()["sum"] == 72.0
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
