"""Checkpoints: a file that is always whole, and is refused by another case."""

import hashlib
import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CheckpointError
from mesokit.io import arrays_file

FORMAT = 5  # raise it when the contents change their meaning
_META = "meta"

Arrays = dict[str, NDArray[Any]]


def digest(text: str) -> str:
    """Fingerprint of a resolved case (its TOML), to tell cases apart.

    >>> digest("[run]")[:8]
    '8cb0a9c1'
    """
    return hashlib.sha256(text.encode()).hexdigest()


def digest_of_motion(text: str) -> str:
    """The same without the length of the run, on which a state does not depend.

    >>> digest_of_motion("[run]\\nsteps = 5\\n") == digest_of_motion("[run]\\nsteps = 10\\n")
    True
    """
    return digest(re.sub(r"^steps = \d+$", "", text, count=1, flags=re.MULTILINE))


def digest_of_file(path: str | Path) -> str:
    """Fingerprint of a file, of any size. Raises OSError."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def write(
    path: str | Path,
    arrays: Mapping[str, Any],
    meta: Mapping[str, Any],
    case: str = "",
    here: bool = True,
) -> None:
    """Replace the checkpoint at `path` by a new one, or leave the old one whole.

    `arrays`, by name, are the state; some may come in pieces (see `arrays_file`). `meta` has plain
    numbers and texts, such as `step`; `case` is the digest of the resolved case. Of several ranks
    that all call this, the one with `here` writes. Raises RunError if it cannot.

    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "checkpoint.npz"
    >>> write(path, {"x": np.arange(3)}, {"step": 7})
    >>> arrays, meta = read(path)
    >>> arrays["x"], meta["step"]
    (array([0, 1, 2]), 7)
    """
    if _META in arrays:
        raise ValueError(f"no array may be called {_META!r}")
    header = {"format": FORMAT, "case": case, "arrays": sorted(arrays), "meta": dict(meta)}
    arrays_file.save(path, {_META: np.array(json.dumps(header)), **arrays}, here)


def read(
    path: str | Path, case: str | None = None, start_key: str = "", large: float = math.inf
) -> tuple[Arrays, dict[str, Any]]:
    """Arrays and meta of the checkpoint at `path`; every byte is checked.

    `case` is the digest of the case that goes on; `start_key` is the key by which another case may
    start from this state. Arrays of at least `large` bytes stay in the file as maps. Raises
    CheckpointError for a file that is missing, truncated, damaged, of another format or case.
    """
    path = Path(path)
    arrays, header = _load(path, large=large)
    if sorted(arrays) != header["arrays"]:
        raise CheckpointError(f"{path}: damaged: its arrays are not those that it names")
    if case is not None and header["case"] != case:
        key = f"{start_key} = {str(path.parent)!r}"
        cure = f"; to start another case from this state, give it {key}" * bool(start_key)
        text = f"{path}: belongs to another case, or the case was changed since{cure}"
        raise CheckpointError(text)
    return arrays, header["meta"]


def part(arrays: Mapping[str, Any], start: str) -> dict[str, Any]:
    """The arrays whose names start so, without it."""
    return {key[len(start) :]: v for key, v in arrays.items() if key.startswith(start)}


def read_meta(path: str | Path) -> dict[str, Any]:
    """Meta alone, without the arrays. Raises CheckpointError as `read` does."""
    return dict(_load(Path(path), _META)[1]["meta"])


def fingerprint(path: str | Path) -> str:
    """Twelve hexadecimal digits made of the bits of all arrays of a checkpoint.

    They are made of the checksums (CRC-32) that the file has for them, and every byte is checked.
    Raises CheckpointError as `read` does.

    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "checkpoint.npz"
    >>> write(path, {"x": np.arange(3)}, {"step": 7})
    >>> fingerprint(path)
    '05e95011e448'
    """
    read_meta(path)
    try:
        sums = arrays_file.checksums(path)
    except Exception:  # zip, zlib and numpy have many errors for a damaged file
        raise CheckpointError(f"{path}: damaged: it is not a whole checkpoint") from None
    return digest(json.dumps([sums[name] for name in sorted(sums) if name != _META]))[:12]


def _load(
    path: Path, only: str | None = None, large: float = math.inf
) -> tuple[Arrays, dict[str, Any]]:
    """Arrays (all, or the only one) and header. Raises CheckpointError for another format."""
    try:
        arrays = {only: arrays_file.one(path, only)} if only else arrays_file.load(path, large)
        header = json.loads(str(arrays.pop(_META)))
        version = header["format"]
        header = {name: header[name] for name in ("case", "arrays", "meta")}
    except FileNotFoundError:
        raise CheckpointError(f"{path}: no such checkpoint") from None
    except OSError as error:
        reason = error.strerror or "it is damaged"
        raise CheckpointError(f"{path}: cannot be read: {reason.lower()}") from None
    except Exception:  # zip, zlib, json and numpy have many errors for a damaged file
        raise CheckpointError(f"{path}: damaged: it is not a whole checkpoint") from None
    if version != FORMAT:
        raise CheckpointError(
            f"{path}: format {version}; this version of mesokit reads format {FORMAT}"
        )
    meta = header["meta"]
    step = meta.get("step") if isinstance(meta, dict) else None
    if type(step) is not int or step < 0:
        raise CheckpointError(f"{path}: damaged: it does not say its step")
    return arrays, header
