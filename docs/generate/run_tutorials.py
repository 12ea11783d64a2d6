"""Run the notebooks of docs/tutorials, each in a folder of its own, and store what they show."""

from __future__ import annotations

import tempfile
from pathlib import Path

import nbclient
import nbformat

for path in sorted((Path(__file__).resolve().parents[1] / "tutorials").glob("*.ipynb")):
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        place = {"metadata": {"path": folder}}
        nbclient.NotebookClient(notebook, timeout=600, resources=place).execute()
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)  # times
    nbformat.write(notebook, path)
    print(path.name)
