"""Runs that go on after their end: the same bits as if they had been so long from the start."""

import dataclasses
import json

import numpy as np
import pytest

import mesokit
from mesokit.errors import CaseError
from mesokit.io import h5md, hdf5
from mesokit.run.simulation import Simulation


@pytest.fixture
def half(case):
    """The case, half as long, at a step where nothing is due."""
    return dataclasses.replace(case, run=dataclasses.replace(case.run, steps=211))


def test_resumed_for_longer(half, tmp_path, ends_alike):
    """A run that had ended goes on to the bits of a long one; the case on record says so."""
    first = Simulation(half, output=tmp_path / "run", threads=2)
    first.run()
    assert (tmp_path / "run" / "run.h5").exists()
    longer = Simulation.resume(tmp_path / "run", threads=1, steps=400)
    assert not (tmp_path / "run" / "run.h5").exists(), "results of the shorter run would be read"
    longer.run()
    ends_alike(longer)
    files = mesokit.open(tmp_path / "run")
    assert files.case.run.steps == 400
    assert "steps = 400" in files.provenance["case"]
    assert [(entry["step"], entry["steps"]) for entry in files.provenance["lengthened"]] == [
        (248, 400)
    ]
    assert files.provenance["ended"]


def test_in_pieces(case, tmp_path, ends_alike):
    """`run(n)` goes on n steps, also beyond the end of the case."""
    short = dataclasses.replace(case, run=dataclasses.replace(case.run, steps=50))
    pieces = Simulation(short, output=tmp_path / "run", threads=1)
    pieces.run(20)
    assert pieces.step == 20 and not (tmp_path / "run" / "run.h5").exists()
    pieces.run(0)
    assert pieces.step == 20
    pieces.run(67)
    assert pieces.step == 87 and (tmp_path / "run" / "run.h5").exists()
    pieces.run(350)
    assert pieces.case.run.steps == 400
    ends_alike(pieces)


def test_made_longer_by_hand(half, tmp_path, ends_alike):
    """More steps in the case of a run: resume goes on, as the state does not know of its end."""
    Simulation(half, output=tmp_path / "run", threads=2).run()
    file = tmp_path / "run" / "case.toml"
    file.write_text(file.read_text().replace("steps = 211", "steps = 400"))
    longer = Simulation.resume(tmp_path / "run")
    longer.run()
    ends_alike(longer)


@pytest.mark.parametrize("moment", ["frames", "data file", "case"])
def test_killed_while_made_longer(half, tmp_path, ends_alike, monkeypatch, crash_at, moment):
    """Whatever is done by then, nothing is lost."""
    Simulation(half, output=tmp_path / "run", threads=1).run()
    before = {
        "frames": ("mesokit.io.trajectory.TrajectoryWriter.flush", None),
        "data file": ("mesokit.io.run_directory.RunDirectory.write_case", None),
        "case": ("mesokit.run.folder.recorded_case", None),
    }[moment][0]

    def crash(*given):
        raise crash_at.error

    with monkeypatch.context() as patch:
        patch.setattr(before, crash)
        with pytest.raises(crash_at.error):
            Simulation.resume(tmp_path / "run", steps=400)
    longer = Simulation.resume(tmp_path / "run", steps=400)
    longer.run()
    ends_alike(longer)


def test_frames_come_back_whole(half, tmp_path):
    """What was written as frames is read as they were recorded, to the bit."""
    Simulation(half, output=tmp_path / "run", threads=1).run()
    frames = list(h5md.frames(tmp_path / "run" / "run.h5"))
    assert [int(frame["step"]) for frame in frames] == list(range(37, 249, 25))
    again = Simulation(half, threads=1)
    again.run(37)
    np.testing.assert_array_equal(frames[0]["velocity"], again.engine.velocities().astype("f4"))
    assert frames[0]["image"].dtype == np.int32


@pytest.mark.parametrize(
    ("steps", "words"),
    [
        (100, "run.steps = 100: the run has done 211 already"),
        (-1, "steps = -1: expected a whole number of at least 0"),
        (2.5, "steps = 2.5: expected a whole number of at least 0"),
    ],
)
def test_not_shorter(half, tmp_path, steps, words):
    Simulation(half, output=tmp_path / "run", threads=1).run()
    with pytest.raises(CaseError, match=words):
        Simulation.resume(tmp_path / "run", steps=steps)
    record = json.loads((tmp_path / "run" / "provenance.json").read_text())
    assert record["ended"] and "lengthened" not in record


def test_record_follows(tmp_path):
    """What a run says of itself is of its length and its threads now: in SI, how long it was."""
    bulk = mesokit.Simulation(
        box=mesokit.Box([8, 8]),
        run=mesokit.Run(steps=20),
        units=mesokit.Units(cell=1e-6, match="thermal"),
        output=tmp_path / "run",
        threads=1,
    )
    bulk.run()
    short = mesokit.open(tmp_path / "run").provenance
    Simulation.resume(tmp_path / "run", threads=2, steps=40).run()
    with hdf5.opened(tmp_path / "run" / "run.h5") as file:
        duration = file["parameters/units"].attrs["duration"]
        record = json.loads(file["parameters/provenance"][()])
    assert duration == record["units"]["duration"]
    assert duration == pytest.approx(2 * short["units"]["duration"])
    assert (short["threads"], record["threads"]) == (1, 2)
