"""Pages from files outside docs/: README is the front page, and every example has a page.

Links between these files are as in the repository; here they are made those of the site.
"""

from __future__ import annotations

import os
import posixpath
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
PAGES = {  # file of the repository: page of the site
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "CODE_OF_CONDUCT.md": "code_of_conduct.md",
    "examples/README.md": "examples/index.md",
}
STATIC = ("CITATION.cff",)
LINK = re.compile(r"""(\]\(|src=")([^)"#:\s]*)(#[^)"\s]*)?(\)|")""")

FENCE = re.compile(r"^(```\w+) [\w-]+$", re.MULTILINE)  # blocks that tests know by a name


def on_files(files: Files, config: Any) -> Files:
    """Add the pages, and the files that the examples need."""
    for source, page in PAGES.items():
        if (ROOT / source).exists():
            files.append(File.generated(config, page, content=_text(source)))
    for path in sorted((ROOT / "examples").rglob("*.*")):
        source = path.relative_to(ROOT).as_posix()
        if path.suffix == ".toml":
            text = f"# {path.name}\n\n```toml\n{_text(source)}```\n"
            files.append(File.generated(config, _page(source), content=text))
        elif path.suffix != ".md":
            files.append(File.generated(config, source, abs_src_path=str(path)))
    for source in STATIC:
        files.append(File.generated(config, source, abs_src_path=str(ROOT / source)))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Files) -> str:
    """Links of the repository as links of the site."""
    here = page.file.src_uri
    source = next((s for s, p in PAGES.items() if p == here), f"docs/{here}")

    def changed(link: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(posixpath.dirname(source), link[2]))
        if not link[2] or not (ROOT / target).exists():
            return link[0]
        anchor = link[3] or ""
        place = os.path.relpath(_page(target), posixpath.dirname(here)).replace(os.sep, "/")
        return f"{link[1]}{place}{anchor}{link[4]}"

    return FENCE.sub(r"\1", LINK.sub(changed, markdown))


def _text(source: str) -> str:
    return (ROOT / source).read_text(encoding="utf-8")


def _page(source: str) -> str:
    """Where a file of the repository is on the site."""
    if source in PAGES:
        return PAGES[source]
    if (ROOT / source).is_dir() and source.startswith("examples"):
        return PAGES["examples/README.md"]
    if source.startswith("examples/"):
        return re.sub(r"\.toml$", ".md", source)
    return re.sub(r"\.ipynb$", ".md", source.removeprefix("docs/"))
