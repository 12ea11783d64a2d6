"""The tutorial notebooks run from top to bottom, and are stored with what they show."""

import os
from pathlib import Path

import pytest

import mesokit

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "tutorials"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


@pytest.mark.long
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    sources = str(Path(mesokit.__file__).parents[1])  # the kernel is a process of its own
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([sources, os.environ.get("PYTHONPATH", "")]))
    monkeypatch.delenv("MPLBACKEND", raising=False)  # which commands in this process have set
    notebook = nbformat.read(path, as_version=4)
    kept = [kinds(cell)[-1:] for cell in notebook.cells]  # before it there may be progress
    place = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(notebook, timeout=300, resources=place).execute()
    assert [kinds(cell)[-1:] for cell in notebook.cells] == kept


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_stored_with_its_outputs(path: Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    assert any("image/png" in kinds(cell) for cell in code)
    words = "".join(cell.source for cell in notebook.cells)
    assert "## Exercises" in words
    assert "/tmp" not in path.read_text(encoding="utf-8")


def test_every_tutorial_is_on_the_site() -> None:
    pages = (FOLDER.parents[1] / "mkdocs.yml").read_text(encoding="utf-8")
    assert NOTEBOOKS
    for path in NOTEBOOKS:
        assert f"tutorials/{path.stem}.md" in pages


def kinds(cell: dict) -> list[str]:
    """What a cell shows, by its sort: the richest of each output."""
    shown = [output.get("data", {"text/plain": ""}) for output in cell.get("outputs", ())]
    return [next(k for k in ("image/png", "text/html", "text/plain") if k in s) for s in shown]
