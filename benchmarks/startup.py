"""Time to the first answer: of `check`, and of `run` to its first step, cold and warm."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Lines of the table; the demo's case, with one step."""
    yield "## Start-up"
    yield ""
    yield "Whole commands, in seconds; `run` does one step of the 2D channel and writes its files."
    yield ""
    yield "| command | first time ever (compiling) | after that |"
    yield "|---|---|---|"
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        _mesokit(["new", "poiseuille"], place, place / "kernels")
        for words in (
            ["check", "poiseuille.toml"],
            ["run", "poiseuille.toml", "--overwrite", "--quiet", "--set", "run.steps=1",
             "--set", "run.warmup=0"],
        ):  # fmt: skip
            cold = _mesokit(words, place, place / f"kernels-{words[0]}")
            warm = [_mesokit(words, place, place / f"kernels-{words[0]}") for _ in range(rounds)]
            yield f"| mesokit {words[0]} | {cold:.1f} | {median(warm):.2f} |"


def _mesokit(words: list[str], folder: Path, kernels: Path) -> float:
    """Seconds that a command takes, with compiled kernels kept in a folder of its own."""
    environment = dict(os.environ, NUMBA_CACHE_DIR=str(kernels))
    start = time.perf_counter()
    command = [sys.executable, "-m", "mesokit", *words]
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    return time.perf_counter() - start
