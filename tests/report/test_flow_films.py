"""Films of the flow: what is in the file, and what is left of it when something goes wrong."""

from __future__ import annotations

import io

import numpy as np
import pytest
from imageio_ffmpeg import count_frames_and_secs, read_frames
from PIL import Image, ImageChops

from mesokit import FlowFrames, __version__
from mesokit.errors import CaseError, RunError
from mesokit.io.checkpoint import digest
from mesokit.report.finish.saving import FOOT
from mesokit.report.flow import animate, encode
from mesokit.report.flow.film import DPI
from mesokit.report.progress import FilmReporter
from tests.helpers.known_flows import FRAMES, MAPS, results_of


@pytest.fixture
def run(make_case):
    """A case and its results: 4 frames, and one cut short."""
    case = make_case((12, 10), observe=[FRAMES])
    return case, results_of(case, samples=22), None


@pytest.mark.parametrize("kind", ["speed", "four"])
def test_an_mp4_has_all_whole_frames(run, tmp_path, kind):
    film = animate(*run, tmp_path / "film.mp4", kind, fps=4)
    assert (film.frames, film.fps) == (4, 4.0)
    assert count_frames_and_secs(film.path) == (4, 1.0)
    reader = read_frames(film.path)
    width, height = next(reader)["size"]
    assert width % 2 == height % 2 == 0 and width > 800
    frames = [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in reader]
    assert len(frames) == 4
    assert (frames[0] != frames[1]).any()
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]


def test_a_gif_starts_again(run, tmp_path):
    film = animate(*run, tmp_path / "film.gif", "particles", fps=10)
    with Image.open(film.path) as image:
        assert (image.format, image.n_frames) == ("GIF", 4)
        assert image.info["duration"] == 100 and image.info["loop"] == 0
        assert image.size[0] > 500


def test_films_say_where_they_come_from(run, tmp_path):
    """In a line below every frame, beside the picture, and in the file."""
    about = f"seed 1, mesokit {__version__}; case sha256 {digest(run[0].to_toml())}"
    one = animate(*run, tmp_path / "one.gif", "speed", run="slit")
    other = animate(*run, tmp_path / "other.gif", "speed", run="pipe")
    with Image.open(one.path) as first, Image.open(other.path) as second:
        assert f"run slit, {about}" in first.info["comment"].decode()
        foot = first.size[1] - int(FOOT * DPI[".gif"])
        for frame in (0, 3):
            first.seek(frame)
            second.seek(frame)
            difference = ImageChops.difference(first.convert("L"), second.convert("L"))
            written = difference.point(lambda grey: 255 * (grey > 60)).getbbox()  # not the palette
            assert written is not None and written[1] >= foot
    film = animate(*run, tmp_path / "film.mp4", "speed", run="slit")
    assert f"run slit, {about}".encode() in film.path.read_bytes()


def test_a_window_and_a_region_of_it(run, tmp_path):
    time = run[1]["flow-frames"].x["time"]
    film = animate(
        *run, tmp_path / "film.gif", "vorticity", window=(time[1], time[2]), region=((0, 6), (2, 8))
    )
    assert film.frames == 2


def test_all_pictures_have_the_same_colours(run, tmp_path, monkeypatch):
    from mesokit.report.flow.maps import speed

    reaches = []
    draw = speed.draw
    monkeypatch.setattr(
        speed, "draw", lambda ax, flow, region, r: (reaches.append(r), draw(ax, flow, region, r))
    )
    animate(*run, tmp_path / "film.gif", "speed")
    assert len(reaches) == 4 and len(set(reaches)) == 1


def test_it_says_how_it_goes(run, tmp_path):
    stream = io.StringIO()
    animate(*run, tmp_path / "film.gif", "speed", progress=FilmReporter(stream=stream))
    lines = stream.getvalue().splitlines()
    assert lines[0] == "drawing: 4 frames"
    assert lines[-1].startswith("drawing: frame 4 of 4 after")
    reporter = FilmReporter(stream=stream)
    reporter.start(10, 0, "drawing")
    reporter.now += 2.0
    reporter.bar.advance(reporter.task.id, 4)
    assert reporter.words(4) == "2 frames/s, 3.0 s left"


def test_a_notebook_shows_the_film(run, tmp_path):
    for name, words in (("film.mp4", "<video controls"), ("film.gif", "<img src=")):
        assert animate(*run, tmp_path / name, "density")._repr_html_().startswith(words)


@pytest.mark.parametrize("name", ["film.mp4", "film.gif"])
def test_what_stops_it_leaves_the_old_file(run, tmp_path, name):
    class Stop(FilmReporter):
        def update(self, step):
            if step == 2:
                raise KeyboardInterrupt

    (tmp_path / name).write_text("old")
    with pytest.raises(KeyboardInterrupt):
        animate(*run, tmp_path / name, "speed", progress=Stop(quiet=True))
    assert (tmp_path / name).read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_film_that_is_not_whole_is_no_film(run, tmp_path, monkeypatch):
    import imageio_ffmpeg

    monkeypatch.setattr(imageio_ffmpeg, "count_frames_and_secs", lambda path: (3, 1.0))
    with pytest.raises(RunError, match="is the disk full"):
        animate(*run, tmp_path / "film.mp4", "speed")
    assert not list(tmp_path.iterdir())


def test_folders_that_are_not_there(run, tmp_path):
    for ending in encode.ENCODERS:
        with pytest.raises(RunError, match=r"cannot write .*nowhere"):
            animate(*run, tmp_path / "nowhere" / f"film{ending}", "speed")


@pytest.mark.parametrize(
    ("choices", "words"),
    [
        ({"path": "film.avi"}, "output = 'film.avi': expected a name that ends in .mp4 or .gif"),
        ({"fps": 0}, "fps = 0: expected a number from 0.1 to 100"),
        ({"fps": 1e-5}, "fps = 1e-05: expected a number from 0.1 to 100"),
        ({"fps": "fast"}, "fps = 'fast'"),
        ({"kind": "spede"}, "did you mean 'speed'"),
        ({"window": (0, 1)}, "no frame in it"),
    ],
)
def test_it_refuses(run, choices, words):
    with pytest.raises(CaseError) as error:
        animate(*run, **({"path": "film.mp4"} | choices))
    assert words in str(error.value)


def test_maps_of_the_whole_run_make_no_film(make_case):
    case = make_case((12, 10), observe=MAPS)
    with pytest.raises(RunError, match="in time, and the run kept only their mean"):
        animate(case, results_of(case), None, "film.mp4")


def test_films_of_particles_need_particles(make_case):
    case = make_case((12, 10), observe=[FlowFrames(window=50, particles=0)])
    with pytest.raises(RunError, match="with particles > 0, or"):
        animate(case, results_of(case), None, "film.mp4", "four")
