"""Runs of kinetic Monte Carlo by the commands: told, logged, made longer, drawn."""

from pathlib import Path

import numpy as np
import pytest

from mesokit import open as opened
from mesokit.cli import main
from tests.helpers.refusals import has_words, refused

CASE = """
[run]
method = "kinetic-monte-carlo"
steps = 40
[box]
size = {size}
[lattice]
kind = "{kind}"
model = {model}
[[observe]]
quantity = "event-rates"
[log]
every = 20
columns = {columns}
[trajectory]
every = 20
fields = ["site"]
"""


def write(folder: Path, size: str, kind: str, model: str, columns: str) -> Path:
    case = folder / "case.toml"
    case.write_text(CASE.format(size=size, kind=kind, model=model, columns=columns))
    return case


def command(*arguments: object) -> None:
    with pytest.raises(SystemExit) as end:
        main([str(one) for one in arguments])
    assert end.value.code == 0


def test_a_run_tells_of_sites_and_goes_on_and_is_drawn(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    case = write(tmp_path, "[20, 12]", "square", '{ rule = "ising" }', '["up", "events"]')
    command("run", case)
    told = capsys.readouterr()
    assert "40 steps of 240 sites" in told.err
    assert "particles" not in told.err + told.out
    whole = opened("case")
    frames = [np.array(frame["site"]) for frame in whole.trajectory]
    assert [frame.shape for frame in frames] == [(240,)] * 3
    command("run", case, "--set", "run.steps=20", "--output", "short", "--quiet")
    command("resume", "short", "--steps", "40", "--quiet")
    longer = opened("short")
    for frame, other in zip(frames, longer.trajectory, strict=True):
        np.testing.assert_array_equal(frame, other["site"])
    start = "--set", 'lattice.start={ rule = "run", run = "short" }'
    command("run", case, *start, "--output", "on", "--quiet")
    np.testing.assert_array_equal(opened("on").trajectory[0]["site"], frames[-1])
    has_words(
        refused(capsys, "run", case, *start, "--set", "box.size=[20, 14]", "--output", "no"),
        ("lattice.start.run", "that run has a box of [20, 12]"),
    )
    command("plot", "case", "--kind", "sites")
    assert (tmp_path / "case" / "flow-sites.png").exists()


def test_check_says_that_equilibrium_takes_time(tmp_path, capsys):
    case = write(tmp_path, "[20, 12]", "square", '{ rule = "ising" }', '["up"]')
    case.write_text(case.read_text().replace('"event-rates"', '"magnetisation"'))
    command("check", case)
    told = capsys.readouterr().out
    assert "warning: run.warmup = 0: equilibrium takes time, and means of magnetisation" in told
    command("check", case, "--set", "run.warmup=10")
    assert "equilibrium takes time" not in capsys.readouterr().out


def rows(told: str) -> dict[str, str]:
    """Rows of `mesokit check`: what, and the rest of the line."""
    lines = [line.split("  ", 1) for line in told.splitlines() if "  " in line]
    return {what.strip(): rest.strip() for what, rest in lines}


def test_check_says_what_follows_from_rates(tmp_path, capsys):
    case = write(tmp_path, "[20, 12]", "square", '{ rule = "ising", kT = 3.0 }', '["up"]')
    command("check", case)
    found = rows(capsys.readouterr().out)
    assert found["detailed balance"].startswith("holds")
    assert found["correlation length"].startswith("2.137 sites")
    # spins that are all up flip down: one of five rates, exp(-8/3) of 240 sites
    start = '--set=lattice.start={ rule = "uniform", state = "up" }'
    command("check", case, start)
    assert rows(capsys.readouterr().out)["rate of all events"].startswith("16.68 1/time")
    model = '--set=lattice.model={ rule = "solid-on-solid", flux = 1.0 }'
    command("check", case, model, "--set", 'log.columns=["height"]')
    assert "broken by process deposit" in rows(capsys.readouterr().out)["detailed balance"]


@pytest.mark.parametrize(
    ("kT", "warning"),
    [
        ("2.4", "box.size = [20, 12]: spins are correlated over 10.23"),
        ("2.269185314213022", "at the critical point all means depend on the size"),
    ],
)
def test_check_warns_of_correlations_that_are_long(kT, warning, tmp_path, capsys):
    model = f'{{ rule = "ising", kT = {kT} }}'
    command("check", write(tmp_path, "[20, 12]", "square", model, '["up"]'))
    assert warning in capsys.readouterr().out
    model = '{ rule = "ising", kT = 4.0 }'
    command("check", write(tmp_path, "[20, 12]", "square", model, '["up"]'))
    assert "warning" not in capsys.readouterr().out


def test_heights_are_kept_and_a_chain_has_no_map(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    case = write(tmp_path, "[64]", "chain", '{ rule = "family" }', '["height", "width"]')
    command("run", case, "--quiet")
    last = np.array(opened("case").trajectory[-1]["site"])
    assert last.mean() == pytest.approx(40, rel=0.1)
    capsys.readouterr()
    words = "kind = 'sites'", "heights on a chain", "'space-time' or 'profiles'"
    has_words(refused(capsys, "plot", "case", "--kind", "sites"), words)
    command("check", case, "--picture", "start.png")
    assert (tmp_path / "start.png").exists()
    command("plot", "case", "--time", "log")
    assert (tmp_path / "case" / "flow-profiles.png").exists()
    command("export", "case", "--to", "grown.xyz")
    assert (tmp_path / "grown.xyz").read_text().count("Lattice=") == 3
