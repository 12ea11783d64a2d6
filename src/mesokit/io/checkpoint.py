"""Checkpoints: one file that is always whole, and refuses to continue another case."""

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
    """The same of all but how long the case runs: a state does not depend on what comes after.

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
    """Replace the checkpoint at `path` by a new one, or leave it as it is.

    Parameters
    ----------
    path: the file.
    arrays: what the run needs to go on, by name; some may come in pieces (see `arrays_file`).
    meta: plain numbers and texts that go with them: `step`, and others.
    case: `digest` of the resolved case.
    here: whether this rank, of several that all call this, is the one that writes.

    Raises RunError if it cannot be written, with the old checkpoint untouched.

    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "checkpoint.npz"
    >>> write(path, {"x": np.arange(3)}, {"step": 7})
    >>> arrays, meta = read(path)
    >>> arrays["x"], meta["step"]
    (array([0, 1, 2]), 7)
    """
    if _META in arrays:
        raise ValueError(f"no array may be called {_META!r}")
    header = json.dumps(
        {"format": FORMAT, "case": case, "arrays": sorted(arrays), "meta": dict(meta)}
    )
    arrays_file.save(path, {_META: np.array(header), **arrays}, here)


def read(
    path: str | Path, case: str | None = None, start_key: str = "", large: float = math.inf
) -> tuple[Arrays, dict[str, Any]]:
    """Arrays and meta of the checkpoint at `path`; every byte is checked.

    With `case`, the digest of the case to go on with, and the key by which another case may start
    from this state, if there is one. Arrays of so many bytes (`large`) stay in the file, which is
    read where they are asked. Raises CheckpointError for a file that is missing, truncated,
    corrupted, of another format or of another case.
    """
    path = Path(path)
    arrays, header = _load(path, large=large)
    if sorted(arrays) != header["arrays"]:
        raise CheckpointError(f"{path}: damaged: its arrays are not those that it names")
    if case is not None and header["case"] != case:
        cure = f"; to start another case from this state, give it {start_key} = "
        cure = cure + repr(str(path.parent)) if start_key else ""
        raise CheckpointError(
            f"{path}: belongs to another case, or the case was changed since{cure}"
        )
    return arrays, header["meta"]


def part(arrays: Mapping[str, Any], start: str) -> dict[str, Any]:
    """The arrays whose names start so, without it."""
    return {key[len(start) :]: v for key, v in arrays.items() if key.startswith(start)}


def read_meta(path: str | Path) -> dict[str, Any]:
    """Meta alone, without the arrays. Raises CheckpointError as `read` does."""
    return dict(_load(Path(path), _META)[1]["meta"])


def _load(
    path: Path, only: str | None = None, large: float = math.inf
) -> tuple[Arrays, dict[str, Any]]:
    """Arrays (all, or the only one) and header. Raises CheckpointError for another format."""
    try:
        if only is None:
            arrays = arrays_file.load(path, large)
        else:
            arrays = {only: arrays_file.one(path, only)}
        header = json.loads(str(arrays.pop(_META)))
        version = header["format"]
        header = {name: header[name] for name in ("case", "arrays", "meta")}
    except FileNotFoundError:
        raise CheckpointError(f"{path}: no such checkpoint") from None
    except OSError as error:
        reason = error.strerror or "it is damaged"
        raise CheckpointError(f"{path}: cannot be read: {reason.lower()}") from None
    except Exception:  # zip, zlib, json and numpy have many words for a damaged file
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


__all__ = ["FORMAT", "digest", "digest_of_motion", "read", "read_meta", "write"]
