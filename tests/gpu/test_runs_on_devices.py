"""Runs on devices, from the case file: files, records, resumes on other devices, and refusals."""

from __future__ import annotations

import gc
import json
import subprocess
import zipfile

import pytest

from mesokit import (
    FENE,
    WCA,
    Disk,
    MaxwellBoltzmann,
    Plates,
    Polymer,
    Simulation,
    Solutes,
    Study,
)
from mesokit import open as open_run
from mesokit.devices.host import Host
from mesokit.errors import CaseError, RunError
from mesokit.method.mpcd.engine.cuda.cost import launches_of, memory_of
from mesokit.method.mpcd.engine.cuda.engine import CUDA
from tests.helpers.kinds_of_fluid import EMBEDDED
from tests.helpers.rank_runs import MESOKIT, MPIEXEC, Ranks, same_files
from tests.helpers.small_fluids import make_case

STEPS = 40
CASE = """
[run]
steps = {steps}
[box]
size = [8, 6, 5]
[fluid]
density = 5
timestep = 0.4
thermostat = {{ rule = "maxwell-boltzmann" }}
force = {{ rule = "uniform", acceleration = [0.05, 0, 0] }}
[[wall]]
shape = "plates"
axis = "y"
virtual = "none"
[[observe]]
quantity = "velocity-profile"
axis = "y"
every = 3
[[observe]]
quantity = "wall-stress"
[trajectory]
every = 10
[log]
every = 10
"""


@pytest.fixture
def case(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(CASE.format(steps=STEPS))
    return file


@pytest.mark.long  # kernels of ranks
def test_a_run_goes_from_processor_to_device_and_back_to_ranks(case, tmp_path) -> None:
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    Simulation(case, output=whole, threads=1).run()
    first = Simulation(case, output=parts, threads=1)
    first.run(7)
    first.checkpoint()
    second = Simulation.resume(parts, device="emulated")
    second.run(12)
    second.checkpoint()
    third = Simulation.resume(parts, threads=2)
    third.run(11)
    third.checkpoint()
    del first, second, third
    if MPIEXEC is None:
        Simulation.resume(parts, device="host").run()
    else:
        ranks = Ranks([MPIEXEC, "-n", 2, *MESOKIT, "resume", parts, "--quiet"], tmp_path)
        assert ranks.end() == 0, ranks.err
    same_files(whole, parts)


def test_the_record_names_the_device(case, tmp_path) -> None:
    Simulation(case, output=tmp_path / "run", device="host").run(2)
    record = json.loads((tmp_path / "run" / "provenance.json").read_text())
    assert record["device"] == "host"
    assert "on the device host" in str(open_run(tmp_path / "run"))


def mesokit(folder, *words):
    done = subprocess.run([*MESOKIT, *words], cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr.strip()


def test_a_device_that_is_not_there_is_an_error_before_the_run(case, tmp_path) -> None:
    status, _, said = mesokit(tmp_path, "run", case.name, "--device", "cud", "--quiet")
    expected = "'cpu', 'cuda', 'emulated' or 'host'; did you mean 'cuda'?"
    assert (status, said) == (2, f"mesokit: error: case.toml: device = 'cud': expected {expected}")
    assert not (tmp_path / "case").exists()


def test_what_a_device_takes_is_known_without_a_card(case, tmp_path) -> None:
    status, out, said = mesokit(tmp_path, "check", case.name, "--device", "cuda")
    assert (status, said) == (0, "")
    rows = dict(line.partition("  ")[::2] for line in out.splitlines())
    assert "on this processor" in rows["run time"]
    assert "on this processor" in rows["memory"]
    assert "without tables" in rows["device memory"]
    assert "6 launches of 10 us each" in rows["on one H200"]


def test_a_fluid_too_large_for_this_machine_may_fit_a_card(tmp_path) -> None:
    (tmp_path / "bulk.toml").write_text("[run]\nsteps = 1\n[box]\nsize = [464, 464, 464]\n")
    status, out, _ = mesokit(tmp_path, "check", "bulk.toml", "--device", "cuda")
    assert status == 0
    rows = dict(line.partition("  ")[::2] for line in out.splitlines())
    assert "too large" in rows["on one A100 80 GB"]
    assert "particle-steps/s" in rows["on one H200"]
    assert "of memory, this machine has" not in out


def test_a_study_asks_for_the_device_before_its_first_run(case, tmp_path) -> None:
    study = Study(case, None, 2, output=tmp_path / "study")
    with pytest.raises(RunError, match=r"^device = 'cuda:7': "):
        study.run(device="cuda:7", progress=False)
    assert not list((tmp_path / "study").rglob("provenance.json"))


@pytest.mark.parametrize(
    ("chip", "expected"),
    [("9", "--chip 9: expected a compute"), ("7.0", "capability 7.0: expected one that is known")],
)
def test_a_chip_that_is_none_is_an_error_of_one_line(case, tmp_path, chip, expected) -> None:
    status, _, said = mesokit(tmp_path, "warm", case.name, "--chip", chip)
    assert status != 0
    assert expected in said
    assert "\n" not in said


class Idle:
    """A device that only counts what it is asked for."""

    name, chip = "idle", (9, 0)

    def __init__(self) -> None:
        self.bytes = self.launches = 0

    def allocate(self, size) -> int:
        self.bytes += size
        return self.bytes

    def kernel(self, body, given) -> None:
        return None

    def launch(self, kernel, words) -> None:
        self.launches += 1

    def clear(self, address, size) -> None:
        self.launches += 1

    def free(self, address) -> None: ...
    def write(self, address, values) -> None: ...
    def read(self, address, values) -> None: ...
    def wait(self) -> None: ...


CHAINS = Solutes((Polymer(5, length=4),), bond=FENE(), pair=WCA(), mass=3.0, substeps=7)
HELD = {"thermostat": MaxwellBoltzmann()}
ASKED = {
    "bulk": HELD,
    "plates": HELD | {"walls": [Plates("y")]},
    "chains": HELD | {"solutes": CHAINS},
    "beads in the fluid": HELD | {"solutes": EMBEDDED, "walls": [Plates("y", virtual="none")]},
}


@pytest.mark.parametrize("parts", ASKED.values(), ids=ASKED)
def test_what_is_told_of_a_case_is_what_an_engine_asks_a_device_for(parts) -> None:
    idle = Idle()
    engine = CUDA(make_case((40, 41, 42), density=10, **parts), idle)
    assert memory_of(engine.numbers) == pytest.approx(idle.bytes, rel=0.02)
    counts = []
    for steps in (3, 3, 4):
        before = idle.launches
        engine.advance(steps)
        counts.append(idle.launches - before)
    assert counts[2] - counts[1] == launches_of(engine.numbers)


@pytest.mark.long
def test_kernels_of_a_card_are_compiled_ahead(case, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    given = "--set", "run.steps=8", "--set", "box.size=[4, 4, 4]"
    status, out, said = mesokit(tmp_path, "warm", case.name, "--chip", "8.0", *given)
    assert (status, said) == (0, "")
    assert "case.toml: " in out
    kept = list((tmp_path / "cache").rglob("cuda/*.zip"))
    texts = [zipfile.ZipFile(file).read("kernel.ptx").decode() for file in kept]
    assert len(texts) > 5
    assert all(".target sm_80" in text for text in texts)


def test_memory_of_a_device_is_given_back_with_the_engine() -> None:
    device = Host()
    engine = CUDA(make_case((9, 8), walls=(Disk(centre=(4, 4), radius=2),)), device)
    assert len(device._held) > 20
    del engine
    gc.collect()
    assert device._held == {}


def test_methods_without_kernels_are_refused(tmp_path) -> None:
    file = tmp_path / "birds.toml"
    file.write_text('[run]\nmethod = "flock"\nsteps = 1\n[box]\nsize = [8, 8]\n')
    with pytest.raises(CaseError, match=r"device = 'host': not for run\.method = 'flock'"):
        Simulation(file, device="host")


@pytest.mark.long
def test_replicas_on_a_device_are_those_of_the_processor(case, tmp_path) -> None:
    case.write_text(CASE.format(steps="9\nreplicas = 2"))
    for device in ("cpu", "host"):
        Simulation(case, output=tmp_path / device, device=device, threads=1).run()
    same_files(tmp_path / "cpu", tmp_path / "host")
