"""The command theory: coefficients of fluids and numbers of chains."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from mesokit import theory
from tests.helpers.commands import ROOT, Captured, ends, refusal


@pytest.fixture(autouse=True)
def folder(empty_folder: Path) -> Path:
    """Work in an empty folder."""
    return empty_folder


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--density", "-1"], "--density"),
        (["--density", "nan"], "--density = nan: expected a finite number"),
        (["--timestep", "1e9"], "--timestep = 1000000000: expected a number of at most 1000"),
        (["--timestep", "1e-7"], "--timestep = 1e-07: expected a number of at least 1e-06"),
        (["--kT", "1e7"], "--kT = 10000000: expected a number of at most 1e+06"),
        (["--mass", "0"], "--mass = 0: expected a number of at least 0.001"),
        (["--angle", "400"], "--angle"),
        (["--rule", "at", "--angle", "90"], "--angle"),
        (["--angle-distribution", "uniform"], "--angle-distribution = 'uniform'"),
        (["--rule", "sdr"], "--rule"),
        (["--dimension", "4"], "--dimension"),
        (["--rule", "none"], "no coefficients: there are none without collisions"),
        (["--set", "fluid.densty=5"], "fluid.densty: unknown key"),
        (["--length", "3"], "--length, --K, --stress-time: expected a length, and with it one"),
        (["--length", "3", "--K", "1", "--stress-time", "1"], "with it one of the others"),
        (["--K", "1"], "expected a length"),
        (["--length", "2", "--K", "-1"], "'--K': -1"),
        (["--frequency", "1"], "--frequency: only with --length"),
        (["nowhere.toml"], "nowhere.toml: no such file"),
    ],
)
def test_theory_refuses(options: list[str], words: str, capsys: Captured) -> None:
    assert words in refusal(capsys, "theory", *options)


@pytest.mark.parametrize(
    "option", ["plot", "draw", "wave-length", "until", "bond-length", "radius"]
)
def test_theory_names_the_script_for_figures(option: str, capsys: Captured) -> None:
    said = refusal(capsys, "theory", "--length", "3", "--K", "1", f"--{option}", "1")
    (script,) = re.findall(r"examples/\w+\.py", said)
    assert f"--{option}: unknown option" in said and (ROOT / script).exists()


def test_theory_takes_the_fluid_of_a_case(capsys: Captured) -> None:
    """Its values, those that options replace, and its chains."""
    chains = str(ROOT / "examples" / "viscoelastic" / "fig_5_6.toml")
    assert ends("theory", chains, "--density", "5", "--frequency", "0.1") == 0
    said = capsys.readouterr().out
    fluid = [
        "--density",
        "5",
        "--angle",
        "130.0614",
        "--thermostat",
        "maxwell-boltzmann",
        "--frequency",
        "0.1",
    ]
    assert ends("theory", *fluid, "--length", "10", "--K", "1") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in said.splitlines() if "of a fluid of molecules" not in line] == lines
    spheres = str(ROOT / "examples" / "hard_disks.toml")
    assert "hard_disks.toml: run.method = 'event-driven'" in refusal(capsys, "theory", spheres)
    assert "--dimension: only" in refusal(capsys, "theory", chains, "--dimension", "2")
    mixture = ["[[fluid.species]]", "density = 5", "mass = 2"]
    mixture += ["[[fluid.species]]", "density = 5", "mass = 1"]
    Path("mixture.toml").write_text("\n".join(["run.steps = 1", "box.size = [8, 8]", *mixture]))
    assert "mixture.toml: fluid.collision.rule = 'srd': no coefficients: no theory of a mix" in (
        refusal(capsys, "theory", "mixture.toml")
    )


def test_theory_asks_rules_of_ones_own(tmp_path: Path) -> None:
    """By the name of theory that they have, and by coefficients that they compute."""
    (tmp_path / "mine.py").write_text(
        "from typing import Literal\n"
        "from mesokit.case.component import component, tag\n"
        "from mesokit.method.mpcd.collision.at import AT\n"
        "@component\n"
        "class Named(AT):\n"
        "    rule: Literal['named'] = tag('named')\n"
        "    def in_theory(self): return {'rule': 'srd', 'angle': 90.0}\n"
        "@component\n"
        "class Computed(Named):\n"
        "    rule: Literal['computed'] = tag('computed')\n"
        "    def in_theory(self): return None\n"
        "    def transport(self, gas): return Named().transport(gas)\n"
    )
    (tmp_path / "case.toml").write_text(
        "run.steps = 1\nbox.size = [8, 8]\nfluid.collision.rule = 'named'\n"
    )
    known = theory.transport("srd", 2, 10, 0.1, angle=90)
    for given, source in (
        (["case.toml"], "sum of both parts"),
        (["--rule", "computed", "--dimension", "2"], "of this collision rule"),
    ):
        words = [sys.executable, "-m", "mesokit", "--import", "mine", "theory", *given]
        run = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True)
        row = next(line for line in run.stdout.splitlines() if line.startswith("kinematic"))
        assert row.split()[2:] == [f"{known.viscosity:.4g}", "a^2/tau", *source.split()]


def test_theory_knows_fluids_of_chains(capsys: Captured) -> None:
    """Beside the functions of theory, which have tests of their own."""
    chain = ["--length", "10", "--K", "0.5"]
    assert ends("theory", "--thermostat", "maxwell-boltzmann", *chain) == 0
    said = {line[:20].strip(): line[20:] for line in capsys.readouterr().out.splitlines()}
    free = theory.transport(
        dimension=3, density=10, timestep=0.1, angle=130, rule="srd",
        thermostat="maxwell-boltzmann",
    )  # fmt: skip
    stirring = theory.self_diffusion(3, free.diffusion, free.viscosity, 10)
    times = theory.rouse_times(theory.linear_modes(10), 1 / stirring, K=0.5)
    rows = list(said)  # a time of modes with one of modes, half of it after both
    assert rows.index("with hydrodynamics") == rows.index("slowest mode time") + 1
    assert float(said["slowest mode time"].split()[0]) == pytest.approx(times.mode[0], rel=1e-3)
    bonds = times.stress.sum() / 10  # kT per molecule, over the mass density
    assert float(said["viscosity of bonds"].split()[0]) == pytest.approx(bonds, rel=1e-3)
    assert ends("theory", "--length", "4", "--stress-time", "30", "--frequency", "0.1") == 0
    said = {line[:20].strip(): line[20:] for line in capsys.readouterr().out.splitlines()}
    assert float(said["slowest stress time"].split()[0]) == 30.0
    rates = theory.linear_modes(4).eigenvalues[1:]
    turns = 0.1 * 30.0 * rates[0] / rates
    stored = 10 / 4 * (turns**2 / (1 + turns**2)).sum()
    assert float(said["storage modulus"].split()[0]) == pytest.approx(stored, rel=1e-3)


def test_theory_says_what_a_thermostat_changes(capsys: Captured) -> None:
    ends("theory", "--dimension", "2", "--density", "16", "--timestep", "1", "--angle", "90")
    said = capsys.readouterr().out.splitlines()[1]
    assert said.startswith("thermostat") and "with others: maxwell-boltzmann +15 %, resc" in said


def test_theory_prints_coefficients_and_sources(capsys: Captured) -> None:
    assert ends("theory", "--angle", "130.06") == 0
    out = capsys.readouterr().out
    assert "0.8705" in out
    assert "Gompper" in out
    assert "holds: grid shift 1" in out
