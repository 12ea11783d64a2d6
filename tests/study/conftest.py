"""A small case whose numbers have error bars, and studies of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from mesokit import Study
from mesokit.study.local import Here
from tests.helpers.studies import FORCE

CASE = """
title = "a channel"
[run]
steps = 120
warmup = 10
seed = 5
[box]
size = [12, 9]
[fluid]
density = 9.52
collision = { rule = "srd", angle = 90 }
thermostat = { rule = "maxwell-boltzmann" }
force = { rule = "uniform", acceleration = [0.02, 0] }
[[wall]]
axis = "y"
shape = "plates"
[[observe]]
quantity = "velocity-profile"
axis = "y"
every = 3
[[observe]]
quantity = "flow-rate"
every = 10
"""


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of studies go on in this process: the start of others is most of their time."""
    made = "mesokit.study.study.Processes"
    monkeypatch.setattr(made, lambda jobs, threads, parts, device: Here(threads, device))


@pytest.fixture(scope="session")
def case_file(tmp_path_factory) -> Path:
    """The case, as a file."""
    path = tmp_path_factory.mktemp("study") / "channel.toml"
    path.write_text(CASE)
    return path


@pytest.fixture(scope="session")
def study(case_file, tmp_path_factory) -> Study:
    """Two forces, three seeds, two at once; the flow has not built up, and is weak."""
    output = tmp_path_factory.mktemp("studies") / "study"
    study = Study(case_file, {FORCE: [0.02, 0.04]}, seeds=3, output=output)
    study.run(jobs=2)
    return study
