"""The schema of case files kept on disk, as it takes seconds to make: all methods are imported."""

import contextlib
import hashlib
import importlib.metadata
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pydantic

from mesokit.case.registry import FAMILIES

PACKAGE = Path(__file__).parents[2]


def kept_schema() -> dict[str, Any]:
    """The JSON schema of `schema`, from the user's cache if it is there.

    With parts of other packages it is always made, as their files may change.
    """
    file = None if _has_others() else _file()
    with contextlib.suppress(OSError, ValueError):
        if file is not None:
            found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
            return found
    from mesokit.case.describe.schema import schema

    made = schema()
    if file is not None:
        with contextlib.suppress(OSError):  # it costs time, no more
            file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            for old in file.parent.glob("schema-*.json"):  # of other sources
                old.unlink(missing_ok=True)
            temporary = file.with_suffix(f".{os.getpid()}")
            temporary.write_text(json.dumps(made), encoding="utf-8")
            temporary.replace(file)
    return made


def schema_text() -> str:
    """The schema as a file."""
    return json.dumps(kept_schema(), indent=1, ensure_ascii=False) + "\n"


def _has_others() -> bool:
    """Whether a script or an installed package has brought parts or methods."""
    known = (part for family in FAMILIES.values() for part in family.known.values())
    if any(not part.__module__.startswith("mesokit.") for part in known):
        return True
    groups = importlib.metadata.entry_points().groups
    return any(group.startswith("mesokit.") for group in groups)


def _file() -> Path | None:
    """Where it is kept: beside compiled code, under a name that each change of sources changes."""
    digest = hashlib.sha256(f"{sys.version} {pydantic.VERSION}\n".encode())
    digest.update("\n".join(sorted(_sources())).encode())
    named = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME")
    with contextlib.suppress(RuntimeError):  # there is no home
        place = Path(named or Path.home() / ".cache") / "mesokit"
        return place / f"schema-{digest.hexdigest()[:32]}.json"
    return None


def _sources() -> Iterator[str]:
    """Path, size and time of change of each source file of mesokit."""
    for folder, _, files in os.walk(PACKAGE):
        for name in files:
            if name.endswith(".py"):
                about = os.stat(path := os.path.join(folder, name))
                yield f"{path} {about.st_size} {about.st_mtime_ns}"
