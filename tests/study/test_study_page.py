"""The page of a study, what a notebook shows of it, and folders of merged runs."""

from __future__ import annotations

import base64
import json
import os
import shlex
from types import SimpleNamespace

import pytest

import mesokit
from mesokit import Study
from mesokit.cli import main
from mesokit.errors import CaseError, RunError
from mesokit.io.run_directory import RunDirectory
from mesokit.report.document.pictures import link_to
from mesokit.report.progress import Reporter
from mesokit.report.table import cells
from mesokit.study import document
from mesokit.study.local import Here
from mesokit.study.work import carry
from tests.helpers.fake_notebook import in_a_notebook
from tests.helpers.html_page import Page

FORCE = "fluid.force.acceleration"


@pytest.fixture(scope="module")
def study(case_file, tmp_path_factory) -> Study:
    """Two forces, two seeds, carried by this process."""
    output = tmp_path_factory.mktemp("pages") / "study"
    study = Study(case_file, {FORCE: [0.02, 0.04]}, seeds=2, output=output)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        for run in study.runs:
            assert carry(str(run.path)) == ""
    return study


@pytest.fixture(scope="module")
def merged(study):
    return study.merged()


def said(capsys, *arguments) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as end:
        main([str(a) for a in arguments])
    out = capsys.readouterr()
    return int(end.value.code or 0), out.out, out.err


def preformatted(text: str) -> list[str]:
    """The blocks of a page that are to be copied."""
    import html

    return [html.unescape(part.partition("</pre>")[0]) for part in text.split("<pre>")[1:]]


def test_the_page_is_sound_and_holds_every_number(study, capsys):
    report = RunDirectory(study.runs[0].path).report_file
    report.write_text("<p>of a run</p>")
    status, out, err = said(capsys, "report", study.path)
    path = study.path / "report.html"
    assert (status, out.strip(), err) == (0, str(path), "")
    text = path.read_text(encoding="utf-8")
    page = Page(text)
    rows = study.table()
    for row in rows:
        _, measured, expected, _, deviation, _ = cells(row.number)
        assert {row.number.what, measured, expected, deviation} - {""} <= set(page.texts)
        known = all(number.error > 0 for number in row.each)  # of a weak flow some are not
        assert (row.seeds is not None) == known
        if known:
            assert f"{row.seeds.chi2:.2g} of 1, p {row.seeds.p:.2g}" in page.texts
    assert sum(row.seeds is not None for row in rows) >= 4
    assert len(rows) >= 6 and {"0.02", "0.04", "a channel"} <= set(page.texts)
    pictures = [link for link in page.links if link.startswith("data:")]
    drawn = {row.name for row in rows if row.number.error > 0}
    assert {f"figure-{name}" for name in drawn} <= set(page.ids) and len(pictures) == len(drawn)
    assert base64.b64decode(pictures[0].partition(",")[2])[:5] == b"<?xml"
    assert {link[1:] for link in page.links if link.startswith("#")} <= set(page.ids)
    to_files = [link for link in page.links if not link.startswith(("data:", "#"))]
    folders = [run.path.resolve() for run in study.runs]
    assert [(study.path / link).resolve() for link in to_files] == [
        folders[0], report.resolve(), *folders[1:]
    ]  # fmt: skip
    assert "has not ended" not in text and "observe velocity-profile" in page.texts
    report.unlink()


def test_the_command_of_the_page_makes_the_same_study(study, tmp_path, monkeypatch):
    case, commands = preformatted(study.report(tmp_path / "page.html").read_text("utf-8"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(case)
    words = shlex.split(commands.splitlines()[1])
    with pytest.raises(SystemExit) as end:
        main([*words[1:], "--job-array"])
    assert not end.value.code
    again = Study.open("again")
    assert [(run.point, run.seed) for run in again.runs] == [
        (run.point, run.seed) for run in study.runs
    ]
    for one, other in zip(again.runs, study.runs, strict=True):
        assert one.files.case == other.files.case


def test_a_study_that_has_not_ended_says_so(case_file, tmp_path, monkeypatch, capsys):
    """Its seeds are not in a row, which no option says: the page holds a study file."""
    monkeypatch.chdir(tmp_path)
    linked = {(FORCE, "title"): [(0.02, "<one>"), (0.04, "two; three")]}
    study = Study(case_file, linked, [3, 9], output=tmp_path / "new", settings={"box.size": [9, 9]})
    failed = RunDirectory(study.runs[1].path)
    failed.write_provenance({"failed": "the bond is torn"})
    status, _, _ = said(capsys, "report", study.path, "--output", tmp_path / "early.html")
    text = (tmp_path / "early.html").read_text("utf-8")
    page = Page(text)
    assert status == 0 and "numbers" not in page.ids and "figures" not in page.ids
    assert "This study has not ended: 0 of 4 runs have." in page.texts
    assert "failed: the bond is torn" in page.texts and f"mesokit study {study.path}" in page.texts
    assert [text for text in page.texts if text == "not begun"] == ["not begun"] * 3
    case, file, commands = preformatted(text)
    (tmp_path / "case.toml").write_text(case)
    (tmp_path / "again.toml").write_text(file)
    assert "mesokit study again.toml" in commands
    again = Study.open("again.toml")
    assert [(run.point, run.seed) for run in again.runs] == [
        (run.point, run.seed) for run in study.runs
    ]
    assert again.runs[0].files.case == study.runs[0].files.case
    status, _, err = said(capsys, "report", study.path, "--films")
    assert (status, err.count("\n")) == (2, 1) and "--films: only of a run" in err


def test_a_warning_names_the_points_where_it_holds(case_file, tmp_path):
    study = Study(case_file, {FORCE: [0.002, 0.2]}, output=tmp_path / "fast")
    texts = Page(study.report().read_text("utf-8")).texts
    assert any("Mach number" in text and "(at acceleration = 0.2)" in text for text in texts)
    assert not any("Mach number" in text and "(at acceleration = 0.002)" in text for text in texts)


def test_several_warnings_at_one_point(study, monkeypatch):
    def summary(case, threads):
        strong = case.fluid.force.acceleration[0] > 0.03
        return SimpleNamespace(warnings=["fast", "hot"] if strong else [])

    monkeypatch.setattr(document, "summary_of", summary)
    at = "(at acceleration = 0.04)"
    assert document._warnings(study) == [f"fast {at}", f"hot {at}"]


def test_a_notebook_shows_a_study(study, case_file, tmp_path):
    page = Page(study._repr_html_())
    texts = " ".join(page.texts)
    assert "4 of 4 runs have ended" in texts and FORCE in texts and "0.02, 0.04" in texts
    assert "mean velocity along x" in page.texts
    new = Page(Study(case_file, {}, 2, output=tmp_path / "new")._repr_html_())
    assert "0 of 2 runs have ended" in " ".join(new.texts) and "measured" not in new.texts


def test_a_notebook_shows_how_a_study_goes(case_file, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(Study, "_workers", lambda self, *given: Here())
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])
    display = in_a_notebook(monkeypatch)
    Study(case_file, {}, 1, output=tmp_path / "quiet").run(progress=False)
    assert display.pages == []
    study = Study(case_file, {}, 2, output=tmp_path / "shown")
    study.run()
    assert "study" in display.pages[0].texts[0]
    last = " ".join(display.pages[-1].texts)
    assert "100 %" in last and "2 of 2 runs" in last
    assert capsys.readouterr() == ("", "")
    with pytest.raises(CaseError, match=r"progress = Reporter: expected True, False or a StudyRep"):
        study.run(progress=Reporter())


def test_progress_in_a_script(case_file, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(Study, "_workers", lambda self, *given: Here())
    monkeypatch.setattr("mesokit.study.work.Simulation.resume", lambda *given, **named: None)
    monkeypatch.setattr("mesokit.study.drive._answer", lambda work, stopped: "")
    study = Study(case_file, {}, 1, output=tmp_path / "s")
    monkeypatch.setattr(Here, "submit", lambda self, path: _done())
    study.run()
    assert capsys.readouterr().err == ""
    study.run(progress=True)
    assert "study: 1 of 1 runs" in capsys.readouterr().err


def _done():
    from concurrent.futures import Future

    done: Future[str] = Future()
    done.set_result("")
    return done


def test_merged_runs_say_what_they_are_pooled_from(merged, capsys):
    status, out, _ = said(capsys, "info", merged.path)
    assert status == 0 and "pooled from 2 runs, seeds 5 and 6" in out and "resume" not in out
    assert json.loads(said(capsys, "info", merged.path, "--json")[1])["state"] == merged.pooled
    assert "pooled from 2 runs" in " ".join(Page(merged._repr_html_()).texts)
    text = merged.report().read_text("utf-8")
    page = Page(text)
    assert any("240 steps in all" in words and merged.pooled in words for words in page.texts)
    assert "pooled from" in page.texts and "seed 6, to step 130" in page.texts
    commands = preformatted(text)[-1].splitlines()
    assert commands[1:4] == [
        "mesokit run case.toml --set run.seed=5 --output again-5",
        "mesokit run case.toml --set run.seed=6 --output again-6",
        "mesokit merge again-5 again-6 --output again",
    ]


def test_merged_runs_whose_results_are_lost_are_merged_again(merged):
    merged.directory.data_file.rename(merged.path / "moved")
    try:
        with pytest.raises(
            RunError, match=r"has no results; merge its runs again: mesokit merge "
        ) as e:
            mesokit.open(merged.path)["flow-rate"]
    finally:
        (merged.path / "moved").rename(merged.directory.data_file)
    assert "resume" not in str(e.value)


def test_a_study_is_no_run(study, capsys):
    status, out, err = said(capsys, "table", study.path)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert f"{study.path}: holds a study, not a run; mesokit study {study.path}" in err
    with pytest.raises(RunError, match=r"mesokit\.Study\.open reads"):
        mesokit.open(study.path)


def test_a_link_leads_to_another_drive(tmp_path, monkeypatch):
    def refuse(path, start):
        raise ValueError("path is on mount 'C:', start on mount 'D:'")

    assert link_to(tmp_path / "50 %" / "a=1", tmp_path / "page.html") == "50%20%25/a=1"
    monkeypatch.setattr(os.path, "relpath", refuse)
    link = link_to(tmp_path / "film.mp4", tmp_path / "page.html")
    assert link == (tmp_path / "film.mp4").resolve().as_uri()
