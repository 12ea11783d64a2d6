"""The guide as pages by task: a page for each of its chapters, with a list of them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from case_reference import unfold
from markdown.extensions.toc import slugify
from mkdocs.structure.files import File, Files

SOURCE = Path(__file__).resolve().parents[1] / "guide.md"
INDEX = "guide/index.md"
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


def chapters() -> dict[str, str]:
    """The text of each chapter by its title; that before the first is the index's."""
    text = SOURCE.read_text(encoding="utf-8")
    starts = [found.start() for found in re.finditer(r"^## ", _blank(text), re.MULTILINE)]
    pieces = [text[a:b] for a, b in zip([0, *starts], [*starts, len(text)], strict=True)]
    return {piece.splitlines()[0].lstrip("# "): piece for piece in pieces}


def page_of(title: str) -> str:
    """Where a chapter is on the site."""
    return f"guide/{slugify(title, '-')}.md"


def anchors() -> dict[str, tuple[str, str]]:
    """Page and anchor there of every heading of the guide, by its anchor in the whole."""
    found = {}
    for number, (title, text) in enumerate(chapters().items()):
        page = INDEX if number == 0 else page_of(title)
        for depth, heading in re.findall(r"^(#+) (.*)$", _blank(text), re.MULTILINE):
            anchor = slugify(heading, "-")
            found[anchor] = (page, "" if len(depth) <= 2 else f"#{anchor}")
    return found


def on_files(files: Files, config: Any) -> Files:
    """Replace the one page by those of its chapters."""
    whole = files.get_file_from_path("guide.md")
    assert whole is not None
    files.remove(whole)
    (_, start), *rest = chapters().items()
    contents = "\n".join(
        f"- [{title}]({page_of(title).removeprefix('guide/')})" for title, _ in rest
    )
    files.append(File.generated(config, INDEX, content=f"{start}\n{contents}\n"))
    for title, text in rest:
        raised = _raised(text)
        files.append(File.generated(config, page_of(title), content=raised))
    unfold(config["nav"], INDEX, [{title: page_of(title)} for title, _ in rest])
    return files


def _raised(text: str) -> str:
    """Headings one level up: a chapter is a page here."""
    plain = _blank(text)
    lines = zip(text.splitlines(), plain.splitlines(), strict=True)
    return "\n".join(line[1:] if seen.startswith("##") else line for line, seen in lines)


def _blank(text: str) -> str:
    """The text without what is in code blocks, where # begins a comment; as many letters."""
    return FENCE.sub(lambda block: re.sub(r"[^\n]", " ", block[0]), text)
