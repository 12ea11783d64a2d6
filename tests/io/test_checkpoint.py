"""A checkpoint is whole or it is refused, and the old one survives whatever happens."""

from __future__ import annotations

import errno
import json
import subprocess
import sys

import numpy as np
import pytest

from mesokit.errors import CheckpointError, RunError
from mesokit.io import checkpoint

ARRAYS = {
    "position": np.random.default_rng(1).random((500, 3)),
    "observe/velocity-profile/blocks/sums": np.arange(6).reshape(2, 3),
    "empty": np.zeros((0, 3)),
    "number": np.array(7),
}


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "checkpoint.npz"
    checkpoint.write(path, ARRAYS, {"step": 100, "time": 0.1}, case="mine")
    return path


def test_it_comes_back_as_it_was(path):
    arrays, meta = checkpoint.read(path, case="mine")
    assert meta == {"step": 100, "time": 0.1}
    assert list(arrays) == list(ARRAYS)
    for name, array in ARRAYS.items():
        assert arrays[name].dtype == array.dtype
        np.testing.assert_array_equal(arrays[name], array)
    assert [p.name for p in path.parent.iterdir()] == ["checkpoint.npz"]


def test_its_fingerprint_is_that_of_every_bit(path, tmp_path):
    """Neither the order of the arrays matters nor what is written beside them."""
    other = tmp_path / "other.npz"
    checkpoint.write(other, dict(reversed(ARRAYS.items())), {"step": 100, "time": 0.2})
    assert checkpoint.fingerprint(other) == checkpoint.fingerprint(path)
    changed = ARRAYS["position"].copy()
    changed.view(np.uint64)[123, 1] ^= 1
    renamed = {"numbers" if name == "number" else name: one for name, one in ARRAYS.items()}
    found = {checkpoint.fingerprint(path)}
    for arrays in (ARRAYS | {"position": changed}, ARRAYS | {"empty": np.zeros((0, 2))}, renamed):
        checkpoint.write(other, arrays, {"step": 100})
        found.add(checkpoint.fingerprint(other))
    assert len(found) == 4


@pytest.mark.parametrize("left", [0, 1, 100, 5000, -200, -1])
def test_truncated(path, left):
    path.write_bytes(path.read_bytes()[:left])
    with pytest.raises(CheckpointError, match=r"^[^\n]*checkpoint.npz: damaged[^\n]*$"):
        checkpoint.read(path)


def test_no_flipped_bit_goes_unnoticed(path):
    whole = path.read_bytes()
    for place in np.random.default_rng(1).integers(0, len(whole), 200):
        broken = bytearray(whole)
        broken[place] ^= 0x10
        path.write_bytes(broken)
        try:
            arrays, meta = checkpoint.read(path, case="mine")
        except CheckpointError as error:
            assert "\n" not in str(error)
            with pytest.raises(CheckpointError):
                checkpoint.fingerprint(path)
            continue
        assert checkpoint.fingerprint(path)
        # dates of the archive's entries are not covered by a checksum, all else is
        assert meta == {"step": 100, "time": 0.1}
        for name in ARRAYS:
            np.testing.assert_array_equal(arrays[name], ARRAYS[name])


def test_missing_and_other_kinds_of_file(path, tmp_path):
    with pytest.raises(CheckpointError, match="no such checkpoint"):
        checkpoint.read(tmp_path / "none.npz")
    for content in (b"", b"hello", b"\x93NUMPY"):
        path.write_bytes(content)
        with pytest.raises(CheckpointError, match="damaged"):
            checkpoint.read(path)
    np.savez(path, position=np.zeros(3))
    with pytest.raises(CheckpointError, match="damaged"):
        checkpoint.read(path)
    np.savez(path, meta=np.array({"a": 1}, dtype=object))  # must not be unpickled
    with pytest.raises(CheckpointError, match="damaged"):
        checkpoint.read(path)
    with pytest.raises(CheckpointError, match="cannot be read"):
        checkpoint.read(tmp_path)


def test_another_case_and_another_format(path):
    with pytest.raises(CheckpointError, match="belongs to another case"):
        checkpoint.read(path, case="yours")
    header = {"format": checkpoint.FORMAT + 1, "case": "mine", "arrays": [], "meta": {}}
    np.savez(path, meta=np.array(json.dumps(header)))
    said = (
        f"format {checkpoint.FORMAT + 1}; this version of mesokit reads format {checkpoint.FORMAT}"
    )
    with pytest.raises(CheckpointError, match=said):
        checkpoint.read(path)


@pytest.mark.parametrize("where", ["write", "fsync", "replace"])
def test_full_disk_leaves_the_old_one(path, where, monkeypatch):
    before = path.read_bytes()

    def full(*args, **kwargs):
        raise OSError(errno.ENOSPC, "No space left on device")

    target = {"write": "zipfile.ZipFile.open", "fsync": "os.fsync", "replace": "os.replace"}[where]
    monkeypatch.setattr(target, full)
    with pytest.raises(RunError, match=r"cannot write .*checkpoint\.npz: no space left on device"):
        checkpoint.write(path, ARRAYS, {"step": 200})
    monkeypatch.undo()
    assert path.read_bytes() == before
    assert [p.name for p in path.parent.iterdir()] == ["checkpoint.npz"]


def test_really_running_out_of_space(path):
    """A limit on the size of files stands for a full disk."""
    pytest.importorskip("resource")
    before = path.read_bytes()
    code = """
import resource, sys
import numpy as np
from mesokit.errors import RunError
from mesokit.io import checkpoint
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
try:
    checkpoint.write(sys.argv[1], {"x": np.zeros(100_000)}, {"step": 1})
except RunError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)
    assert "cannot write" in done.stdout and done.stdout.count("\n") == 1
    assert done.returncode == 0 and done.stderr == ""
    assert path.read_bytes() == before
    assert [p.name for p in path.parent.iterdir()] == ["checkpoint.npz"]


def test_leftovers_of_a_killed_write_do_no_harm(path):
    path.with_name(".checkpoint.npz.tmp").write_bytes(b"half")
    checkpoint.write(path, ARRAYS, {"step": 200}, case="mine")
    assert checkpoint.read(path)[1] == {"step": 200}
    assert [p.name for p in path.parent.iterdir()] == ["checkpoint.npz"]
