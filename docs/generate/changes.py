"""Collect the files of docs/changes as a version in CHANGELOG.md: `changes.py 0.3.0 2027-01-31`."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KINDS = {"new": "New", "changed": "Changed", "refused": "Refused or renamed", "fixed": "Fixed"}


def collect(root: Path, version: str, date: str) -> None:
    """Put the section before the last one, and remove the files."""
    changelog, folder = root / "CHANGELOG.md", root / "docs" / "changes"
    lines = [f"## {version} ({date})\n"]
    for kind, title in KINDS.items():
        files = sorted(folder.glob(f"*.{kind}.md"))
        texts = [file.read_text(encoding="utf-8").strip() for file in files]
        lines += [f"### {title}\n", *(f"- {text}" for text in texts), ""] if files else []
        for file in files:
            file.unlink()
    head, first, rest = changelog.read_text(encoding="utf-8").partition("\n## ")
    changelog.write_text(head + "\n" + "\n".join(lines) + first + rest, encoding="utf-8")


if __name__ == "__main__":
    collect(ROOT, *sys.argv[1:])
