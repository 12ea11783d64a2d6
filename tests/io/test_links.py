"""Links in a run folder, such as one that was downloaded, lead no writing out of the folder."""

import os
from pathlib import Path

import pytest

from mesokit import Box, Case, Conservation, Run, Simulation, Trajectory
from mesokit.io.atomic import write_text

CASE = Case(
    run=Run(steps=20, warmup=0, checkpoint_every=10),
    box=Box([8, 8]),
    observe=[Conservation(every=5)],
    trajectory=Trajectory(every=5),
)


@pytest.mark.skipif(os.name == "nt", reason="links of Windows need rights")
def test_what_links_lead_to_is_not_written(tmp_path: Path) -> None:
    victim, stranger = tmp_path / "victim", tmp_path / "stranger"
    victim.write_text("mine")
    stranger.mkdir()
    folder = tmp_path / "run"
    Simulation(CASE, output=folder).run()
    names = [
        f".{name.name}.tmp" for name in folder.iterdir() if name.is_file() and name.name != ".lock"
    ]
    assert {".run.h5.tmp", ".checkpoint.npz.tmp", ".case.toml.tmp"} <= set(names)
    for name in names:
        (folder / name).symlink_to(victim)
    for name in (".trajectory.coming", ".trajectory.done"):
        (folder / name).symlink_to(stranger)
    Simulation.resume(folder, steps=40).run()
    assert victim.read_text() == "mine" and not list(stranger.iterdir())
    assert not [name for name in names if (folder / name).is_symlink()]


def test_a_link_beside_a_file_is_replaced(tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    victim.write_text("mine")
    (tmp_path / ".a.txt.tmp").symlink_to(victim)
    write_text(tmp_path / "a.txt", "new")
    assert victim.read_text() == "mine" and (tmp_path / "a.txt").read_text() == "new"
