"""Pages from notebooks with the outputs that they were stored with, and the notebooks."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File, Files

FOLDER = Path(__file__).resolve().parents[1] / "tutorials"


def on_files(files: Files, config: Any) -> Files:
    """Add a page for each notebook, and its pictures."""
    for path in sorted(FOLDER.glob("*.ipynb")):
        pictures: dict[str, bytes] = {}
        text = "\n\n".join(_blocks(path, pictures))
        files.append(File.generated(config, f"tutorials/{path.stem}.md", content=text))
        for name, data in pictures.items():
            files.append(File.generated(config, f"tutorials/{name}", content=data))
    return files


def _blocks(path: Path, pictures: dict[str, bytes]) -> Iterator[str]:
    notebook = json.loads(path.read_text(encoding="utf-8"))
    for number, cell in enumerate(notebook["cells"]):
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            yield source
            if number == 0:  # as HTML: links in Markdown lead to pages
                yield f'<a href="{path.name}" download>Take this page along as a notebook</a>'
        elif cell["cell_type"] == "code":
            yield f"```python\n{source}\n```"
            for i, output in enumerate(cell["outputs"]):
                yield _shown(output, f"{path.stem}-{number}-{i}.png", pictures)


def _shown(output: dict[str, Any], picture: str, pictures: dict[str, bytes]) -> str:
    """An output as Markdown: its richest form."""
    data = output.get("data", {"text/plain": output.get("text", "")})
    if "image/png" in data:
        pictures[picture] = base64.b64decode("".join(data["image/png"]))
        return f"![What the lines above draw]({picture})"
    if "text/html" in data:
        return f'<div class="output">{"".join(data["text/html"])}</div>'
    text = "".join(data.get("text/plain", "")).rstrip()
    return f"```text\n{text}\n```" if text else ""
