"""Frames that have gone to the data file are removed, also after a kill while they were."""

import pytest

from mesokit.case.trajectory import Trajectory
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory import TrajectoryWriter


@pytest.mark.parametrize("moved", [False, True])
def test_nothing_remains(tmp_path, moved):
    run = RunDirectory(tmp_path)
    left = run.trajectory_remains if moved else run.trajectory_folder
    left.mkdir()
    (left / "segment-000000000000001.npz").touch()
    TrajectoryWriter(Trajectory(every=1), run.trajectory_folder, 4).remove()
    assert list(tmp_path.iterdir()) == []
