"""The record of a run as rows and sentences of a page."""

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesokit.case.amounts import duration_text
from mesokit.seam.method import Row

PROGRAMS = ("mesokit", "__main__.py")  # by which the command line is called


def when(text: str) -> str:
    """A time of the record without its seconds."""
    return text[:16].replace("T", " ") + " UTC" * text.endswith("+00:00")


def origin_rows(record: Mapping[str, Any]) -> list[Row]:
    """Versions, machine and times, so far as they are on record."""
    versions = ", ".join(f"{name} {v}" for name, v in record.get("versions", {}).items())
    rows = [("versions", versions, "")] if versions else []
    sources = record.get("sources") or {}
    if sources.get("commit"):
        changed = "changed since" * (sources["changed"] == "true")
        rows.append(("commit", sources["commit"], changed))
    if sources.get("digest"):
        rows.append(("sources", f"sha256 {sources['digest']}", ""))
    for run in record.get("merged") or ():
        rows.append(("pooled from", str(run["run"]), f"seed {run['seed']}, to step {run['step']}"))
    of_each = ("seed", "threads", "started") if record.get("merged") else ()
    for key in ("seed", "case_digest", "host", "system", "processor", "cores",
                "threads", "device", "started", "ended", "failed"):  # fmt: skip
        if record.get(key) is not None and key not in of_each:
            rows.append((key.replace("_", " "), str(record[key]), ""))
    for key in ("resumed", "parts"):
        if record.get(key):
            rows.append((key, ", ".join(map(str, record[key])), ""))
    for key, parent in (record.get("starts_from") or {}).items():
        rows.append((key, str(parent.get("path", "")), f"sha256 {parent.get('sha256', 'unknown')}"))
    if record.get("command"):
        program, *words = map(str, record["command"])
        name = "mesokit" if Path(program).name in PROGRAMS else Path(program).name
        rows.append(("command", shlex.join([name, *words]), ""))
    return rows


def timing_rows(seconds: Mapping[str, float]) -> list[tuple[str, str, str]]:
    """Stages of the run, longest first, with their share."""
    total = sum(seconds.values())
    if not total > 0:
        return []
    longest = sorted(seconds.items(), key=lambda item: -item[1])
    rows = [(name, f"{s:.2f}", f"{100 * s / total:.1f} %") for name, s in longest]
    return [*rows, ("together", f"{total:.2f}", duration_text(total))]


def citation(record: Mapping[str, Any]) -> str:
    """The program as a reference, with the version that made the numbers."""
    version = record.get("versions", {}).get("mesokit", "")
    commit = (record.get("sources") or {}).get("commit")
    of_it = f", version {version}" * bool(version) + f", commit {commit}" * bool(commit)
    return f"The mesokit developers, mesokit: mesoscale particle simulation in Python{of_it}."


def install(record: Mapping[str, Any]) -> str:
    """The command that installs the sources which made the numbers, and which these are.

    >>> install({"versions": {"mesokit": "0.2"}, "sources": {"commit": "ab1", "digest": "cd2"}})
    'pip install .  # in a clone of mesokit: version 0.2, commit ab1, sources sha256 cd2'
    """
    sources = record.get("sources") or {}
    version, commit = record.get("versions", {}).get("mesokit", ""), sources.get("commit")
    changed = ", changed since" * (sources.get("changed") == "true")
    known = [
        f"version {version}" * bool(version),
        f"commit {commit}{changed}" * bool(commit),
        f"sources sha256 {sources.get('digest')}" * bool(sources.get("digest")),
    ]
    found = ", ".join(filter(None, known))
    return f"pip install .  # in a clone of mesokit{f': {found}' * bool(found)}"
