"""What a run was made from: the sources of mesokit, and the files and runs that it starts from."""

import contextlib
import functools
import hashlib
import json
import subprocess
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from mesokit.io.checkpoint import digest_of_file

PACKAGE = Path(__file__).parents[1]
SECONDS = 5  # for git to answer


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
