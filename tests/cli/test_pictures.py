"""`mesokit plot --kind` and `mesokit animate`."""

from __future__ import annotations

from pathlib import Path

import pytest
from imageio_ffmpeg import count_frames_and_secs

import mesokit
from mesokit.cli import main

Captured = pytest.CaptureFixture[str]
CASE = """
[run]
steps = 60
[box]
size = [12, 8]
[fluid]
density = 5
thermostat = { rule = "maxwell-boltzmann" }
force = { rule = "uniform", acceleration = [0.01, 0] }
[[wall]]
shape = "plates"
axis = "y"
[[observe]]
quantity = "flow-frames"
window = 20
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run in it."""
    folder = tmp_path_factory.mktemp("pictures")
    (folder / "case.toml").write_text(CASE)
    mesokit.Simulation(folder / "case.toml", output=folder / "run", threads=1).run()
    return folder


@pytest.fixture(autouse=True)
def there(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Work beside the run."""
    monkeypatch.chdir(place)


def ends(*arguments: str) -> int:
    """Exit status of a command."""
    with pytest.raises(SystemExit) as end:
        main(list(arguments))
    return int(end.value.code or 0)


def test_a_run_draws_its_frames(capsys: Captured) -> None:
    assert ends("plot", "run") == 0
    assert capsys.readouterr().out.split() == ["run/flow-frames.png"]


def test_a_picture_goes_to_the_run_or_where_it_is_told(capsys: Captured) -> None:
    assert ends("plot", "run", "--kind", "four") == 0
    assert capsys.readouterr().out.split() == ["run/flow-four.png"]
    options = ["--kind", "speed", "--region", "0:6,2:8", "--window", "1:4.5", "--output", "my.pdf"]
    assert ends("plot", "run", *options) == 0
    assert Path("my.pdf").read_bytes()[:4] == b"%PDF"


def test_a_film_and_its_progress(capsys: Captured) -> None:
    assert ends("animate", "run", "--kind", "quiver", "--fps", "5") == 0
    captured = capsys.readouterr()
    assert captured.out.split() == ["run/flow-quiver.mp4"]
    assert captured.err.startswith("drawing: 3 frames\n")
    assert "3 frames last 0.6 s; --fps 1 slows the film down" in captured.err
    assert ends("animate", "run", "--fps", "1") == 0 and "slows" not in capsys.readouterr().err
    assert count_frames_and_secs("run/flow-quiver.mp4")[0] == 3
    assert ends("animate", "run", "--average", "3") == 0
    said = capsys.readouterr().err
    assert "the film has one frame, so nothing moves in it" in said and "slows" not in said
    assert ends("animate", "run", "--output", "film.gif", "--quiet") == 0
    captured = capsys.readouterr()
    assert captured.out + captured.err == ""
    assert Path("film.gif").read_bytes()[:3] == b"GIF"


def test_pictures_and_films_are_files_of_the_run(capsys: Captured) -> None:
    from mesokit.cli.runs import _files_of_run

    assert ends("animate", "run", "--quiet") == 0
    assert set(Path("run").iterdir()) <= set(_files_of_run(Path("run")))


@pytest.mark.parametrize(
    ("arguments", "words", "status"),
    [
        (
            ["plot", "run", "--result", "flow-frames", "--region", "0:1,0:1"],
            "--region: only for a picture of the flow",
            2,
        ),
        (["plot", "run", "--region", "0:1,0:1"], "at least 2 bins along each axis", 2),
        (["animate", "run", "--average", "7"], "average = 7: expected a whole number", 2),
        (["plot", "run", "--kind", "swirl"], "kind = 'swirl': expected 'quiver'", 2),
        (["plot", "run", "--kind", "speed", "--region", "0:5"], "two numbers for each axis", 2),
        (["plot", "run", "--kind", "speed", "--region", "a:5,0:1"], "expected x0:x1,y0:y1", 2),
        (["plot", "run", "--kind", "speed", "--region", "0:50,0:8"], "x from 0 to 12", 2),
        (["plot", "run", "--kind", "speed", "--window", "5"], "expected t0:t1", 2),
        (["plot", "run", "--kind", "speed", "--window", "1:2,3:4"], "expected t0:t1", 2),
        (["plot", "run", "--kind", "speed", "--axes", "x"], "expected two of x, y", 2),
        (["plot", "run", "--kind", "speed", "--output", "a.xyz"], "choose one of", 1),
        (["plot", "nowhere", "--kind", "speed"], "nowhere: no such folder", 2),
        (["animate", "run", "--output", "a.avi"], "ends in .mp4 or .gif", 2),
        (["animate", "run", "--fps", "-1"], "fps = -1", 2),
        (["animate", "run", "--fps", "nan"], "'--fps': nan is no number", 2),
        (["plot", "run", "--width", "nan"], "'--width': nan is no number", 2),
        (["plot", "run", "--kind", "speed", "--at", "inf"], "'--at': inf is no number", 2),
        (["plot", "run", "--kind", "speed", "--window", "0:nan"], "--window 0:nan: expected", 2),
        (["animate", "nowhere"], "nowhere: no such folder", 2),
    ],
)
def test_one_line_for_what_is_wrong(
    arguments: list[str], words: str, status: int, capsys: Captured
) -> None:
    assert ends(*arguments) == status
    message = capsys.readouterr().err
    assert words in message
    assert message.startswith("mesokit: error: ") and message.count("\n") == 1


def test_from_python() -> None:
    run = mesokit.open("run")
    assert len(run.flow().axes) == 6
    assert run.animate("again.gif", window=(0, 4)).frames == 2


def test_a_name_that_is_none_has_a_nearest_one() -> None:
    run = mesokit.open("run")
    with pytest.raises(mesokit.CaseError, match=r"regoin: unknown; .*did you mean 'region'"):
        run.flow("speed", regoin=3)
    with pytest.raises(mesokit.CaseError, match="did you mean 'fps'"):
        run.animate("film.gif", fsp=3)


def test_from_a_simulation_in_memory() -> None:
    simulation = mesokit.Simulation("case.toml", threads=1)
    simulation.run()
    assert len(simulation.flow("streamlines").axes) == 2
    assert simulation.animate("memory.gif").frames == 3
