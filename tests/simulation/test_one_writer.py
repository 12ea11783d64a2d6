"""Two processes never write into the same folder; test_killed.py shows that a kill frees it."""

import pytest

from mesokit import Simulation, StopRun, every
from mesokit.cli import main
from mesokit.errors import RunError

SAID = "another process is writing there; wait for it, or stop it first"


def refused(capsys, *arguments):
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    assert end.value.code == 1
    return capsys.readouterr().err


def test_folder_that_another_writes(case, tmp_path, capsys):
    """Resuming or replacing a run that is under way is refused; it ends as it would have."""
    folder, seen = tmp_path / "run", []

    def meddle(simulation):
        before = sorted((path.name, path.read_bytes()) for path in folder.glob("*.*"))
        with pytest.raises(RunError, match=SAID):
            Simulation.resume(folder, steps=1000)
        given = tmp_path / "case.toml"
        given.write_text(case.to_toml(tmp_path))
        for command in (["resume", folder], ["run", given, "--output", folder, "--overwrite"]):
            said = refused(capsys, *command)
            assert said.splitlines()[-1] == f"mesokit: error: {folder}: {SAID}"
        seen.append(simulation.step)
        assert sorted((path.name, path.read_bytes()) for path in folder.glob("*.*")) == before

    simulation = Simulation(case, output=folder, threads=1, callbacks=[every(400, meddle)])
    simulation.run()
    assert seen == [0, 400]
    assert (folder / "run.h5").exists()
    assert Simulation.resume(folder).step == simulation.step


def test_free_after_stops_and_errors(case, tmp_path):
    """However a run ends, its folder is free."""

    def fail(simulation):
        raise RuntimeError("no more")

    def stop(simulation):
        raise StopRun

    for name, function in (("failed", fail), ("stopped", stop)):
        simulation = Simulation(case, output=tmp_path / name, callbacks=[every(50, function)])
        if function is fail:
            with pytest.raises(RunError):
                simulation.run()
        else:
            simulation.run()
        Simulation.resume(tmp_path / name)
