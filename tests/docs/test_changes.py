"""Changes are kept one a file, and a release collects them."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import mesokit

ROOT = Path(__file__).resolve().parents[2]
changes = runpy.run_path(str(ROOT / "docs" / "generate" / "changes.py"))


def test_a_release_collects_them(tmp_path: Path) -> None:
    folder = tmp_path / "docs" / "changes"
    folder.mkdir(parents=True)
    (folder / "README.md").touch()
    (folder / "b.new.md").write_text("Second.\n")
    (folder / "a.new.md").write_text("First.\n")
    (folder / "c.fixed.md").write_text("Third.\n")
    (tmp_path / "CHANGELOG.md").write_text("# Changelog\n\nWords.\n\n## 0.2.0 (then)\n\n- Old.\n")
    changes["collect"](tmp_path, "0.3.0", "now")
    assert (tmp_path / "CHANGELOG.md").read_text() == (
        "# Changelog\n\nWords.\n\n## 0.3.0 (now)\n\n### New\n\n- First.\n- Second.\n\n"
        "### Fixed\n\n- Third.\n\n## 0.2.0 (then)\n\n- Old.\n"
    )
    assert [path.name for path in folder.iterdir()] == ["README.md"]


def test_each_is_one_short_text_of_a_known_kind() -> None:
    for path in (ROOT / "docs" / "changes").iterdir():
        if path.name != "README.md":
            kinds = "|".join(changes["KINDS"])
            assert re.fullmatch(rf"[a-z0-9-]+\.({kinds})\.md", path.name), path.name
            text = path.read_text(encoding="utf-8").strip()
            assert text and "\n\n" not in text and not text.startswith("-"), path.name


def test_the_changelog_has_this_version_in_few_lines() -> None:
    sections = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").split("\n## ")[1:]
    assert sections[0].startswith(f"{mesokit.__version__} (")
    assert all(len(section.strip().splitlines()) <= 40 for section in sections)
