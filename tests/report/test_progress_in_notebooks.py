"""A run from Python says how it goes if asked to, and in a notebook."""

from __future__ import annotations

import pytest

from mesokit import Box, Run, Simulation
from mesokit.report.document import progress
from mesokit.report.document.progress import NotebookReporter, reporter_for
from mesokit.report.progress import Reporter
from tests.helpers.fake_notebook import in_a_notebook


@pytest.fixture
def notebook(monkeypatch):
    return in_a_notebook(monkeypatch)


def run(**options):
    Simulation(run=Run(steps=30), box=Box([8, 8]), threads=1).run(**options)


def test_a_notebook_shows_a_bar(notebook, capsys):
    run()
    first, last = (" ".join(page.texts) for page in (notebook.pages[0], notebook.pages[-1]))
    assert "running" in first and " 0 %" in first
    assert "100 %" in last and last.rstrip().endswith("s")
    assert "progress" in notebook.pages[-1].tags
    assert capsys.readouterr() == ("", "")


def test_a_notebook_shows_nothing_if_told_so(notebook, capsys):
    run(progress=False)
    assert notebook.pages == [] and capsys.readouterr() == ("", "")


def test_a_script_says_nothing_unless_asked(capsys):
    assert not progress.in_notebook()
    run()
    assert capsys.readouterr() == ("", "")
    run(progress=True)
    assert "running: step 30 of 30 after" in capsys.readouterr().err


def test_a_reporter_of_ones_own_is_kept():
    own = Reporter(quiet=True)
    assert reporter_for(own) is own


def test_lines_that_stay_and_longer_runs(notebook, capsys):
    bar = NotebookReporter()
    bar.start(10, 5)
    bar.tell("step 5")
    bar.lengthen(20)
    bar.last = 10
    bar.finish()
    assert "50 %" in " ".join(notebook.pages[-1].texts)
    assert capsys.readouterr().out == "step 5\n"
