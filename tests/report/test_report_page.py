"""The report of a run is one sound HTML file that holds everything and needs nothing else."""

from __future__ import annotations

import base64
from html.parser import HTMLParser

import pytest
from fake_fluid import FakeFluid

import mesokit
from mesokit import Conservation, Plates, RunError, VelocityField, VelocityProfile
from mesokit.cli import main
from mesokit.io import h5md
from mesokit.io.run_directory import RunDirectory, provenance
from mesokit.report.document.pictures import drawn

VOID = {"meta", "img", "br", "link", "input", "hr"}
OBSERVE = (Conservation(every=5), VelocityProfile(), VelocityField())
TITLE = 'Slit <script>alert("1")</script> & more'


class Page(HTMLParser):
    """Tags that are open, links and sources, and the text."""

    def __init__(self, text):
        super().__init__()
        self.open, self.links, self.ids, self.texts, self.tags = [], [], [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attributes:
            if name in ("src", "href"):
                self.links.append(value)
            if name == "id":
                self.ids.append(value)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(" ".join(data.split()))


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    """`run_folder(ended)` is the folder of a run in a slit, as a run leaves it."""
    from mesokit import Box, Case, Fluid, Run

    def make(ended):
        folder = tmp_path_factory.mktemp("report") / "slit"
        parts = {"walls": [Plates("y")], "observe": OBSERVE, "title": TITLE}
        case = Case(run=Run(steps=60), box=Box([6, 8]), fluid=Fluid(density=5), **parts)
        directory, fluid = RunDirectory.create(folder, case), FakeFluid(case)
        accumulators = [observable.accumulator(case) for observable in case.observe]
        while fluid.step < 60:
            fluid.advance(10)
            for accumulator in accumulators:
                accumulator.observe(fluid)
        record = provenance(case, threads=1)
        if ended:
            record |= {"ended": "2020-02-02T02:02:02+00:00", "timings": {"sweep": 3.0, "sort": 1.0}}
            results = [accumulator.result() for accumulator in accumulators]
            h5md.write(directory.data_file, case, record, results, None)
        directory.write_provenance(record)
        return folder

    return make


@pytest.fixture(scope="module")
def ended(run_folder):
    """A run that has ended, with films, and its report."""
    folder = run_folder(True)
    (folder / "flow-speed.mp4").write_bytes(b"film" * 100)
    return folder, mesokit.open(folder).report()


def test_it_is_sound_and_needs_nothing_from_outside(ended):
    folder, path = ended
    assert path == folder / "report.html"
    page = Page(path.read_text(encoding="utf-8"))
    for link in page.links:
        assert link.startswith(("data:", "#")) or (folder / link).exists(), link
    assert {link[1:] for link in page.links if link.startswith("#")} <= set(page.ids)
    assert len(page.ids) == len(set(page.ids))
    assert "script" not in page.tags and TITLE in page.texts


def test_it_holds_every_number_and_every_figure(ended):
    folder, path = ended
    files, text = mesokit.open(folder), path.read_text(encoding="utf-8")
    page = Page(text)
    for result in files.results.values():
        assert f"figure-{result.name}" in page.ids
        for comparison in result.comparisons:
            assert comparison.what in page.texts, comparison
    pictures = [link for link in page.links if link.startswith("data:")]
    assert len(pictures) == len(OBSERVE)
    for picture in pictures:
        assert base64.b64decode(picture.partition(",")[2])[:5] in (b"<?xml", b"\x89PNG\r")
    for words in ("75.0 %", "momentum x, m a/", "kinematic viscosity", "flow-speed.mp4", "0.1.0"):
        assert words in text, words
    assert 'quantity = "velocity-profile"' in " ".join(page.texts)
    assert "has not ended" not in text


def test_a_run_that_has_not_ended_says_so(run_folder, capsys):
    folder = run_folder(False)
    with pytest.raises(SystemExit) as status:
        main(["report", str(folder), "--output", str(folder.parent / "early.html")])
    assert status.value.code == 0 and "early.html" in capsys.readouterr().out
    text = (folder.parent / "early.html").read_text(encoding="utf-8")
    Page(text)
    assert "This run has not ended" in text and "Measured and expected" not in text


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
