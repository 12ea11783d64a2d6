"""Every example is a valid case, ends in a comparison, and is shown in the gallery."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mesokit.cli import main

pytestmark = pytest.mark.long

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.toml"))
SCRIPTS = {  # of some seconds, and what they draw and say
    "draw_catalyst": (
        "catalyst",
        r"y = 0\.360: CO 0\.000, O 1\.000[^$]*y = 0\.535: CO 1\.000, O 0\.000",
    ),
    "draw_chains": (
        "chains",
        r"0\.6096. at time 5, -0\.462.. at 20[^$]* K 0\.817 holds bonds, bond length 1\.665",
    ),
    "draw_clock": (
        "clock",
        r"right clock: drift (0\.99|1\.00)\d [^$]*wrong clock: drift 0\.(49|50)\d ",
    ),
    "draw_collapse": ("collapse_1d", r"(\d) on a wall: .*\(law"),
    "draw_column": ("column", r"largest difference from \(N - i\) m g: \d\.\de-05"),
    "draw_escape": (
        "escape",
        r"rate from \d+ escapes: 0\.012\d\d [^$]*mean time: 0\.01236; Kramers: 0\.01339",
    ),
    "draw_islands": ("islands", r"exponent of the last two 0\.3\d, rate equations 1/3"),
    "draw_ping_pong": ("ping_pong", ""),
    "draw_chain": ("chain", r"5 sweeps: front at 1\.99\d [^$]*100 sweeps: front at 8\.9\d\d "),
    "draw_sintering": ("sintering", r"atoms \{2352\}; neck 7\.8 to 2\d\.\d a"),
    "draw_solver": ("solver", r"grows by (1\.99\d|2\.00\d) in a sweep"),
    "draw_two_grains": ("two_grains", r"Hertz: restitution 1\.00000 \(theory 1\.00000\)"),
}
SHORT, WARMUP = ["--set", "run.steps=100"], 20
WARMUPS = {"compress": 2200}  # until plates have come to the grains


@pytest.mark.parametrize("case", EXAMPLES, ids=lambda case: case.stem)
def test_the_example_runs_and_compares(
    case: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As its first lines say, but shorter: check, run, and the picture of the flow."""

    def mesokit(*words: str | Path) -> str:
        with pytest.raises(SystemExit) as end:
            main([str(word) for word in words])
        said = "".join(capsys.readouterr())
        assert end.value.code == 0, said
        return said

    mesokit("check", case)
    run = tmp_path / case.stem
    warmup = ["--set", f"run.warmup={WARMUPS.get(case.stem, WARMUP)}"]
    short = [*SHORT, *(warmup if "warmup" in case.read_text() else ())]
    said = mesokit("run", case, "--output", run, *short)
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


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_draws_what_it_says(script: str, tmp_path: Path) -> None:
    picture, words = SCRIPTS[script]
    file = ROOT / "examples" / f"{script}.py"
    done = subprocess.run(
        [sys.executable, file], cwd=tmp_path, check=True, capture_output=True, text=True
    )
    assert re.search(words, done.stdout), done.stdout
    assert (tmp_path / f"{picture}.png").stat().st_size > 20_000
    for page in ("examples/README.md", "docs/gallery.md"):
        text = (ROOT / page).read_text()
        assert f"{script}.py" in text and f"images/{picture}.png" in text
