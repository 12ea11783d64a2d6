"""Where the numbers of a run come from: case, versions, host, and the sources of mesokit."""

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


def provenance(case: Case, threads: int, ranks: int = 1) -> dict[str, Any]:
    """Where the numbers of a run come from, as it starts: case, versions, host, time.

    `sources` is the state of mesokit, `starts_from` that of the files and runs it starts from.
    `units` says what a reduced unit is in SI, None if the case does not; `parts` which classes come
    from outside mesokit, and from where.
    `threads` are those of each rank. `ended` and `failed` (why) are None, `timings` (of rank 0) and
    `shared_work` (how several ranks have shared it) empty until someone fills them in.
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
        "device": "cpu",
        "command": sys.argv,
        "started": now(),
        "resumed": [],
        "ended": None,
        "failed": None,
        "timings": {},
        "shared_work": {},
    }


def recorded_case(case: Case) -> dict[str, Any]:
    """What a record says of the case itself, and of its units."""
    text = case.to_toml()
    return {"case": text, "case_digest": digest(text), "units": _units(case)}


def _units(case: Case) -> dict[str, Any] | None:
    convert = method_of(case).si
    if case.units is None or convert is None:
        return None
    return dict(convert(case).record())


def now() -> str:
    """The time, as texts sort."""
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
    """A digest of all sources of mesokit, and the commit they are of, if anything says so.

    The digest tells any two states apart, committed or not; `changed` says whether they are
    still those of the commit.

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
    """The commit of the folder that the package lies in, None if it is no clone."""
    root = PACKAGE.parents[1]
    if not (root / ".git").exists():
        return None
    said = [_git(root, "rev-parse", "HEAD"), _git(root, "status", "--porcelain", "--", "src")]
    if said[0] is None:
        return None
    return {"commit": said[0], "changed": None if said[1] is None else str(bool(said[1])).lower()}


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
    """The commit that pip installed, where it did so from a repository."""
    commit = None
    with contextlib.suppress(metadata.PackageNotFoundError, ValueError, AttributeError, TypeError):
        text = metadata.distribution("mesokit").read_text("direct_url.json")
        commit = json.loads(text or "{}").get("vcs_info", {}).get("commit_id")
    return {"commit": commit, "changed": None}


def parents(starts: Mapping[str, Path]) -> dict[str, dict[str, Any]]:
    """What a case starts from, by key: the path, and digests that tell its state from any other.

    Of a run: of its last checkpoint, its case, and the sources that it was made with.
    """
    found: dict[str, dict[str, Any]] = {}
    for key, path in starts.items():
        record: dict[str, Any] = {"path": str(path)}
        file = path / "checkpoint.npz" if path.is_dir() else path
        with contextlib.suppress(OSError):
            record["sha256"] = digest_of_file(file)
        if path.is_dir():
            with contextlib.suppress(OSError, ValueError, AttributeError):
                earlier = json.loads((path / "provenance.json").read_text(encoding="utf-8"))
                for name in ("case_digest", "sources"):
                    record[name] = earlier.get(name)
        found[key] = record
    return found
