"""Files of figures say where they come from, and are as wide as asked."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

import mesokit
from mesokit import RunError, __version__
from mesokit.cli import main
from mesokit.cli.runs import _files_of_run
from mesokit.io.checkpoint import digest


@pytest.fixture(scope="module")
def files(run_folder):
    return mesokit.open(run_folder(True))


def command(*words):
    with pytest.raises(SystemExit) as status:
        main([str(word) for word in words])
    return status.value.code


def test_metadata_of_every_kind_of_file(files, tmp_path):
    from mesokit.report import save

    about = f"seed 1, mesokit {__version__}; case sha256 {digest(files.case.to_toml())}"
    png, svg, pdf = (
        save(files["velocity-profile"], tmp_path / f"figure.{kind}", files.case, run="slit")
        for kind in ("png", "svg", "pdf")
    )
    with Image.open(png) as picture:
        assert picture.text["Description"] == f"{files.case.title}, run slit, {about}"
        assert picture.text["Title"] == files.case.title
    assert about in svg.read_text(encoding="utf-8")
    assert b"case sha256" in pdf.read_bytes()


def test_the_line_below_hides_nothing_and_does_not_stay(files, tmp_path):
    from mesokit.report import plot, save_figure
    from mesokit.report.finish.origin import origin_of

    figure = plot(files["velocity-profile"], case=files.case)
    plain = save_figure(figure, tmp_path / "plain.png")
    figure = plot(files["velocity-profile"], case=files.case)
    figure.origin = origin_of(files.case, "slit")
    marked = save_figure(figure, tmp_path / "marked.png")
    assert not any("run slit" in text.get_text() for text in figure.texts)
    with Image.open(plain) as one, Image.open(marked) as other:
        (width, height), size = one.size, other.size
        assert size[0] == width and 30 < size[1] - height < 40
        foot = other.convert("L").crop((0, height, *size))
        assert foot.getextrema()[0] < 200  # something is written there
        top = np.asarray(other.convert("L").crop((0, 0, width, height)), float)
        assert np.abs(top - np.asarray(one.convert("L"), float)).max() == 0


@pytest.mark.parametrize("words", [["--result", "velocity-profile"], ["--kind", "speed"]])
def test_as_wide_as_asked(files, tmp_path, words):
    path = tmp_path / "narrow.png"
    assert command("plot", files.path, *words, "--width", 3.4, "--output", path) == 0
    with Image.open(path) as picture:
        assert abs(picture.width / 200 - 3.4) < 0.4
        assert "run slit" in picture.text["Description"]


def test_the_format_of_all_results(files):
    assert command("plot", files.path, "--format", "svg") == 0
    written = {path.stem for path in files.path.glob("*.svg")}
    assert written == set(files)
    assert set(files.path.glob("*.svg")) <= set(_files_of_run(files.path))  # --overwrite may go on


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--output", "x.pdf"], "there are many pictures; add --result NAME"),
        (["--result", "velocity-profil"], "did you mean 'velocity-profile'?"),
        (["--result", "conservation", "--kind", "speed"], "not with --kind"),
        (["--result", "conservation", "--at", "3"], "--at: only for a picture of the flow"),
    ],
)
def test_options_without_a_meaning_together(files, words, said, capsys):
    assert command("plot", files.path, *words) == 2
    assert said in capsys.readouterr().err


def test_an_unknown_ending(files, tmp_path):
    with pytest.raises(RunError, match="choose one of"):
        files.plot(tmp_path, ending=".xyz")
