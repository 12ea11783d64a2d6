"""Origin of the numbers of a run: case, versions, host, and the sources of mesokit."""

import contextlib
import functools
import hashlib
import json
import os
import platform
import subprocess
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from mesokit.case.case import Case
from mesokit.case.outside import outside_parts
from mesokit.io.checkpoint import digest, digest_of_file
from mesokit.seam.method import method_of

LIBRARIES = ("mesokit", "numpy", "scipy", "numba", "h5py", "matplotlib", "pydantic")
PACKAGE = Path(__file__).parents[1]
SECONDS = 5  # for git to answer


def provenance(case: Case, threads: int, ranks: int = 1, device: str = "cpu") -> dict[str, Any]:
    """Record of a run at its start: case, versions, host, time.

    `sources` is the state of mesokit, `starts_from` that of files and runs of the first state.
    `units` has reduced units in SI, None without them in the case; `parts` are classes from outside
    mesokit. `threads` are those of each rank, `device` is what the steps run on. Later `ended`,
    `failed` (the reason), `timings` (of rank 0) and `shared_work` (of several ranks) are filled in.
    """
    return {
        **recorded_case(case),
        "seed": case.run.seed,
        "sources": sources(),
        "starts_from": parents(method_of(case).initial.files(case)),
        "parts": outside_parts(case),
        "versions": {"python": platform.python_version()} | _versions(),
        "host": platform.node(),
        "system": platform.platform(),
        "processor": _processor(),
        "cores": os.cpu_count(),
        "threads": threads,
        "ranks": ranks,
        "device": device,
        "command": sys.argv,
        "started": now(),
        "resumed": [],
        "ended": None,
        "failed": None,
        "timings": {},
        "shared_work": {},
    }


def recorded_case(case: Case) -> dict[str, Any]:
    """The part of a record about the case and its units."""
    text, convert = case.to_toml(), method_of(case).si
    units = None if case.units is None or convert is None else dict(convert(case).record())
    return {"case": text, "case_digest": digest(text), "units": units}


def now() -> str:
    """The present time as a text; later ones are sorted behind it."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def _versions() -> dict[str, str]:
    found = {}
    for name in LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "not installed as a package"
    return found


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if "model name" in line)
    except (OSError, StopIteration, UnicodeDecodeError):
        return platform.processor()


@functools.cache
def sources() -> dict[str, str | None]:
    """A digest of all sources of mesokit, and their commit if it is known.

    The digest differs between any two states, committed or not; `changed` is "true" if they differ
    from the commit.

    >>> len(sources()["digest"])
    64
    """
    code = hashlib.sha256()
    files = {path.relative_to(PACKAGE).as_posix(): path for path in PACKAGE.rglob("*.py")}
    for name, path in sorted(files.items()):
        if name.startswith("examples/"):  # in a wheel alone
            continue
        code.update(name.encode() + b"\0")
        code.update(path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return {"digest": code.hexdigest(), **(_checked_out() or _installed())}


def _checked_out() -> dict[str, str | None] | None:
    """The commit of the folder of the package, None if it is no clone."""
    root = PACKAGE.parents[1]
    if not (root / ".git").exists() or (commit := _git(root, "rev-parse", "HEAD")) is None:
        return None
    status = _git(root, "status", "--porcelain", "--", "src")
    return {"commit": commit, "changed": None if status is None else str(bool(status)).lower()}


def _git(root: Path, *words: str) -> str | None:
    try:
        done = subprocess.run(
            ["git", "-C", str(root), "--no-optional-locks", *words],
            capture_output=True,
            text=True,
            timeout=SECONDS,
            stdin=subprocess.DEVNULL,
        )
    except (OSError, subprocess.SubprocessError, ValueError):
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def _installed() -> dict[str, str | None]:
    """The commit that pip installed from a repository, if it did."""
    commit = None
    with contextlib.suppress(metadata.PackageNotFoundError, ValueError, AttributeError, TypeError):
        text = metadata.distribution("mesokit").read_text("direct_url.json")
        commit = json.loads(text or "{}").get("vcs_info", {}).get("commit_id")
    return {"commit": commit, "changed": None}


def parents(starts: Mapping[str, Path]) -> dict[str, dict[str, Any]]:
    """Files and runs of the first state of a case, by key: path and digests of the contents.

    The digests of a run are those of its last checkpoint, its case, and its sources of mesokit.
    """
    found: dict[str, dict[str, Any]] = {}
    for key, path in starts.items():
        found[key] = record = {"path": str(path)}
        file = path / "checkpoint.npz" if path.is_dir() else path
        with contextlib.suppress(OSError):
            record["sha256"] = digest_of_file(file)
        if path.is_dir():
            with contextlib.suppress(OSError, ValueError, AttributeError):
                earlier = json.loads((path / "provenance.json").read_text(encoding="utf-8"))
                record |= {name: earlier.get(name) for name in ("case_digest", "sources")}
    return found
