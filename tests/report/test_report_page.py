"""The report of a run is one sound HTML file that holds everything and needs nothing else."""

from __future__ import annotations

import base64
import re
import types

import pytest

import mesokit
from mesokit import RunError
from mesokit.cli import main
from mesokit.report.document.pictures import drawn
from mesokit.report.document.run import page
from tests.helpers.html_page import Page


@pytest.fixture(scope="module")
def ended(run_folder):
    """A run that has ended, with films, and its report."""
    folder = run_folder(True)
    (folder / "flow-speed.mp4").write_bytes(b"film" * 100)
    return folder, mesokit.open(folder).report()


def test_it_is_sound_and_needs_nothing_from_outside(ended):
    folder, path = ended
    title = mesokit.open(folder).case.title
    assert path == folder / "report.html"
    page = Page(path.read_text(encoding="utf-8"))
    for link in page.links:
        assert link.startswith(("data:", "#")) or (folder / link).exists(), link
    assert {link[1:] for link in page.links if link.startswith("#")} <= set(page.ids)
    assert len(page.ids) == len(set(page.ids))
    assert "<script>" in title and "script" not in page.tags and title in page.texts


def test_it_holds_every_number_and_every_figure(ended):
    folder, path = ended
    files, text = mesokit.open(folder), path.read_text(encoding="utf-8")
    page = Page(text)
    for result in files.results.values():
        assert f"figure-{result.name}" in page.ids
        for comparison in result.comparisons:
            assert comparison.what in page.texts, comparison
    assert len(files.comparisons()) >= 2
    pictures = [link for link in page.links if link.startswith("data:")]
    assert len(pictures) == len(files)
    for picture in pictures:
        assert base64.b64decode(picture.partition(",")[2])[:5] in (b"<?xml", b"\x89PNG\r")
    for words in ("75.0 %", "momentum x, m a/", "kinematic viscosity", "flow-speed.mp4"):
        assert words in text, words
    assert files.provenance["versions"]["mesokit"] in text
    assert 'quantity = "velocity-profile"' in " ".join(page.texts)
    assert "has not ended" not in text


def test_a_long_hash_breaks_on_a_narrow_screen(ended):
    """The version in the citation is one word: without leave to break it the page scrolls."""
    text = ended[1].read_text(encoding="utf-8")
    assert re.search(r'<section id="cite">\s*<h2>To cite it</h2>\s*<p>', text)
    (rules,) = re.findall(r"#cite p \{([^}]*)\}", text)
    assert "overflow-wrap: anywhere;" in rules


def test_a_run_that_has_not_ended_says_so(run_folder, capsys):
    folder = run_folder(False)
    with pytest.raises(SystemExit) as status:
        main(["report", str(folder), "--output", str(folder.parent / "early.html")])
    assert status.value.code == 0 and "early.html" in capsys.readouterr().out
    text = (folder.parent / "early.html").read_text(encoding="utf-8")
    Page(text)
    assert "This run has not ended" in text and "Measured and expected" not in text


def test_results_so_far_are_in_the_report_of_a_run_that_goes_on(ended):
    folder, _ = ended
    files = mesokit.open(folder)
    record = files.provenance | {
        "sources": {"digest": "d1" * 32, "commit": "c0" * 20, "changed": "true"},
        "starts_from": {"fluid.start.run": {"path": "before", "sha256": "ab" * 32}},
    }
    running = types.SimpleNamespace(path=folder, case=files.case, provenance=record, ended=False)
    running.state = "has not ended: step 3 of 60"
    running.so_far = lambda: {"velocity-profile": files["velocity-profile"]}
    read = Page(page(running, folder / "report.html"))
    assert "This run has not ended: step 3 of 60" in read.texts
    assert "What is below is what it had measured by then." in read.texts
    assert "figure-velocity-profile" in read.ids and "slip at the walls" in read.texts
    for words in ("c0" * 20, "changed since", f"sha256 {'d1' * 32}", "fluid.start.run", "before"):
        assert words in read.texts, words


def test_small_films_go_into_the_page_and_others_are_linked(ended):
    folder, _ = ended
    inside = mesokit.open(folder).report(folder.parent / "with.html", films=True)
    assert "data:video/mp4;base64," in inside.read_text(encoding="utf-8")
    outside = mesokit.open(folder).report(folder.parent / "without.html")
    assert 'href="slit/flow-speed.mp4"' in outside.read_text(encoding="utf-8")


def test_large_drawings_are_png_and_the_same_drawing_is_the_same_text():
    from mesokit.report.notebook import ShownFigure

    def figure(points):
        made = ShownFigure()
        made.subplots().plot(range(points), [k * k % 97 for k in range(points)], "o")
        return made

    assert drawn(figure(10)).startswith("data:image/svg") and drawn(figure(10)) == drawn(figure(10))
    assert drawn(figure(20_000)).startswith("data:image/png")


def test_what_cannot_be_written_or_read_is_told_in_one_line(ended, tmp_path, capsys):
    folder, _ = ended
    with pytest.raises(RunError, match="cannot write"):
        mesokit.open(folder).report(tmp_path / "nowhere" / "r.html")
    with pytest.raises(SystemExit) as status:
        main(["report", str(tmp_path)])
    assert status.value.code == 2 and "holds no run" in capsys.readouterr().err
