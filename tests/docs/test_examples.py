"""Every example is a valid case, ends in a comparison, and is shown in the gallery."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.toml"))
SHORT = ["--set", "run.steps=100", "--set", "run.warmup=20"]


def mesokit(*words: str | Path) -> str:
    """What a command prints."""
    done = subprocess.run(
        [sys.executable, "-m", "mesokit", *map(str, words)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


@pytest.mark.parametrize("case", EXAMPLES, ids=lambda case: case.stem)
def test_the_example_runs_and_compares(case: Path, tmp_path: Path) -> None:
    """As its first lines say, but shorter: check, run, and the picture of the flow."""
    mesokit("check", case)
    run = tmp_path / case.stem
    said = mesokit("run", case, "--output", run, *SHORT)
    assert "expected" in said
    plots = [line[1:].split() for line in case.read_text().splitlines() if "mesokit plot" in line]
    assert plots
    for _, _, name, *options in plots:
        assert name == case.stem
        mesokit("plot", run, *options, "--output", tmp_path / "flow.png")
        assert (tmp_path / "flow.png").stat().st_size > 10_000


@pytest.mark.parametrize("page", ["examples/README.md", "docs/gallery.md"])
def test_every_example_is_listed_with_a_picture(page: str) -> None:
    text = (ROOT / page).read_text()
    for case in EXAMPLES:
        assert f"{case.name}" in text
        assert f"images/{case.stem}.png" in text
        assert (ROOT / "docs" / "images" / f"{case.stem}.png").exists()


def test_the_picture_of_the_junction_is_what_the_script_draws(tmp_path: Path) -> None:
    folder = ROOT / "examples"
    shutil.copy(folder / "draw_junction.py", tmp_path)
    subprocess.run([sys.executable, tmp_path / "draw_junction.py"], check=True)
    from PIL import Image

    drawn, kept = (Image.open(f / "junction.png") for f in (tmp_path, folder))
    assert drawn.size == kept.size
    assert drawn.tobytes() == kept.tobytes()
