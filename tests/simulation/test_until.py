"""Runs that go on until a number is known well enough."""

import dataclasses

import pytest

import mesokit
from mesokit.cli import main
from mesokit.errors import CaseError
from mesokit.run.simulation import Simulation
from mesokit.run.until import Goal


@pytest.fixture
def short(case):
    """The case with few steps: its numbers are poorly known."""
    return dataclasses.replace(case, run=dataclasses.replace(case.run, steps=60))


def error_of(simulation):
    return simulation["velocity-profile"]["slip"].error


def test_longer_until_the_error_is_small(short, tmp_path):
    """It ends where the goal is reached, with the bits of a run that was as long from the start."""
    simulation = Simulation(short, output=tmp_path / "run", threads=1)
    simulation.run()
    before = error_of(simulation)
    Simulation.resume(tmp_path / "run", threads=2).run(until=f"velocity-profile.slip={before / 2}")
    files = mesokit.open(tmp_path / "run")
    steps = files.case.run.steps
    assert files["velocity-profile"]["slip"].error <= before / 2
    assert steps > 60 and steps % 3 == 0
    longer = dataclasses.replace(short, run=dataclasses.replace(short.run, steps=steps))
    whole = Simulation(longer, threads=1)
    whole.run()
    assert whole.results == files.results


def test_goal_that_is_met(short):
    simulation = Simulation(short, threads=1)
    simulation.run(until="velocity-profile.slip=1e9")
    assert simulation.case.run.steps == 60


@pytest.mark.parametrize(
    ("number", "words"), [("slip", "known to"), ("viscosity", "is undetermined")]
)
def test_limit(short, number, words):
    """What cannot be reached in time is said, also of a number that the run does not determine."""
    simulation = Simulation(short, threads=1)
    with pytest.warns(UserWarning, match=f"{words} .* after 90 steps: more is needed"):
        simulation.run(37 + 90, until=f"velocity-profile.{number}=0.001%")
    assert simulation.case.run.steps == 90 and simulation.step == 127


def test_status_of_the_command(short, tmp_path, capsys):
    """0 where the error is as small as was asked, 3 where the limit came first."""
    folder = tmp_path / "run"
    Simulation(short, output=folder, threads=1).run()
    for goal, status in (("slip=100", 0), ("slip=1e-9", 3)):
        with pytest.raises(SystemExit) as end:
            given = ["--until-error", f"velocity-profile.{goal}", "--steps", "75"]
            main(["resume", str(folder), *given])
        said = capsys.readouterr().err
        assert (end.value.code or 0) == status
        assert ("more is needed" in said) == (status == 3)
        assert "0 steps of" not in said
    assert mesokit.open(folder).case.run.steps == 75


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("velocity-profile.viscosity", "expected OBSERVABLE.NUMBER=ERROR"),
        ("velocity-profile.viscosity=-1%", "expected OBSERVABLE.NUMBER=ERROR"),
        ("velocity-profil.viscosity=1%", "did you mean 'velocity-profile'"),
        ("=1", "no observable ''; there is"),
    ],
)
def test_poor_goals(case, text, words):
    with pytest.raises(CaseError, match=words):
        Goal.parse(text, case)


def test_unknown_number(short):
    simulation = Simulation(short, threads=1)
    simulation.run(50)
    with pytest.raises(CaseError, match=r"until velocity-profile: .*viscosity"):
        simulation.run(until="velocity-profile.viscocity=1%")
