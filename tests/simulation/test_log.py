"""Numbers in time: on the screen, in a file, and across any kill."""

import dataclasses
import io
import re

import numpy as np
import pytest

import mesokit
from mesokit import Box, Case, CaseError, Log, Run, RunError, every
from mesokit.io import log_file
from mesokit.method.brownian import Brownian
from mesokit.report.progress import Reporter
from mesokit.run.simulation import Simulation

SLIP = "velocity-profile.slip"
COLUMNS = ("temperature", "velocity x", SLIP, "momentum y", "kinetic energy")


@pytest.fixture(scope="module")
def logging(case):
    """The case of these tests, with a log, and with nothing else that is written."""
    run = dataclasses.replace(case.run, steps=63)  # 100 with the warm-up
    return dataclasses.replace(case, log=Log(every=9, columns=COLUMNS), run=run, trajectory=None)


@pytest.fixture(scope="module")
def whole(logging, tmp_path_factory):
    """An unbroken run: its folder, and what a callback saw."""
    seen = []

    def look(simulation):
        found = simulation["velocity-profile"].comparisons
        slip = next(((c.measured, c.error) for c in found if "slip" in c.what), (np.nan, np.nan))
        seen.append((simulation.step, simulation.time, *simulation.engine.totals(), *slip))

    folder = tmp_path_factory.mktemp("logs") / "run"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        Simulation(logging, output=folder, callbacks=[every(9, look)], threads=1).run()
    return folder, seen


def test_lines_are_what_the_fluid_and_the_observables_say(whole):
    folder, seen = whole
    log = mesokit.open(folder).log
    assert log["step"].tolist() == [*range(0, 100, 9)]
    assert list(log.dtype.names) == ["step", "time", *COLUMNS[:3], f"{SLIP} error", *COLUMNS[3:]]
    for row, (step, time, number, momentum, energy, *slip) in zip(log, seen, strict=True):
        expected = [energy / number, momentum[0] / number, *slip, momentum[1], energy]
        np.testing.assert_allclose(list(row), [step, time, *expected], rtol=1e-8)
    assert np.isnan(log[SLIP][0])
    assert np.isfinite(log[SLIP][-1])


@pytest.mark.parametrize("at", [8, 50, 85])
def test_after_a_kill_the_file_is_that_of_an_unbroken_run(logging, whole, crash_at, at, tmp_path):
    """Lines after the checkpoint are dropped, also a half one."""
    path = tmp_path / "run"
    with pytest.raises(crash_at.error):
        Simulation(logging, output=path, threads=1).run(progress=crash_at(at))
    with (path / "log.csv").open("a") as file:
        file.write("99,9.9,1")
    assert 99 not in mesokit.open(path).log["step"]
    Simulation.resume(path, threads=2).run()
    assert (path / "log.csv").read_bytes() == (whole[0] / "log.csv").read_bytes()


@pytest.mark.parametrize(
    "damage",
    [
        lambda log: log[:30] + b"\xff" + log[31:],
        lambda log: log.replace(b"\n9,", b"\nx9,"),
        lambda log: log.replace(b"\n9,", b"\n9,9,"),
        lambda log: log.replace(b"\n9,", b"\nnan,"),
        lambda log: log.replace(b"temperature", b"warmth"),
    ],
)
def test_a_damaged_log_is_set_aside(damage, logging, crash_at, tmp_path):
    """The run goes on, and its log begins anew; earlier damaged ones are kept as well."""
    path = tmp_path / "run"
    with pytest.raises(crash_at.error):
        Simulation(logging, output=path, threads=1).run(progress=crash_at(50))
    (path / "log-damaged.csv").write_bytes(b"before")
    damaged = damage((path / "log.csv").read_bytes())
    (path / "log.csv").write_bytes(damaged)
    with pytest.warns(UserWarning, match=r"log.csv: damaged: .*kept as log-damaged2.csv, a new"):
        Simulation.resume(path, threads=1).run()
    assert (path / "log-damaged.csv").read_bytes() == b"before"
    assert (path / "log-damaged2.csv").read_bytes() == damaged
    steps = mesokit.open(path).log["step"].tolist()
    assert steps == [step for step in range(0, 100, 9) if step >= steps[0]] and steps[0] > 0


def test_a_damaged_log_of_a_run_that_has_ended_begins_anew_with_its_header(logging, tmp_path):
    path = tmp_path / "run"
    Simulation(logging, output=path, threads=1).run()
    log = (path / "log.csv").read_bytes()
    (path / "log.csv").write_bytes(b"\xff" + log[1:])
    with pytest.warns(UserWarning, match="kept as log-damaged.csv"):
        Simulation.resume(path, threads=1).run()
    Simulation.resume(path, threads=1).run()
    assert (path / "log.csv").read_bytes() == log.splitlines(keepends=True)[0]
    assert [file.name for file in path.glob("log-*")] == ["log-damaged.csv"]
    assert len(mesokit.open(path).log) == 0


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize("screen", [io.StringIO, Terminal])
def test_lines_on_the_screen(logging, screen):
    """Under a header that comes again; nothing if quiet."""
    often = dataclasses.replace(logging, log=Log(every=4, columns=("temperature", "velocity x")))
    stream, quiet = screen(), screen()
    simulation = Simulation(often, threads=1)
    simulation.run(progress=Reporter(stream=stream))
    plain = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", stream.getvalue())
    lines = [line.strip() for line in plain.splitlines() if line.strip()]
    header = [line for line in lines if line.startswith("step") and "temp" in line]
    rows = [line.split() for line in lines if len(line.split()) == 4 and line[0].isdigit()]
    assert [int(row[0]) for row in rows] == [*range(0, 101, 4)]
    assert len(header) == 2
    assert 0.5 < float(rows[-1][2]) < 2
    Simulation(often, threads=1).run(progress=Reporter(quiet=True, stream=quiet))
    assert quiet.getvalue() == ""


def test_what_no_observable_compares_is_said_once(logging):
    stream = io.StringIO()
    wrong = dataclasses.replace(logging, log=Log(every=9, columns=("velocity-profile.slib",)))
    Simulation(wrong, threads=1).run(progress=Reporter(stream=stream))
    assert stream.getvalue().count("log.columns: velocity-profile.slib: no comparison 'slib'") == 1


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        (("temprature",), r"log.columns\[#1\] = 'temprature': expected .*did you mean 'temp"),
        (("momentum z",), r"'momentum z': expected 'temperature', .* or 'wall-|'velocity-profile"),
        (("temperature", "velocity.slip"), r"log.columns\[#2\] = .*did you mean 'velocity-profile"),
        (("velocity-profile.",), r"log.columns\[#1\]"),
        (("temperature", "temperature"), r"expected each column once"),
    ],
)
def test_unknown_columns_are_refused(logging, columns, words):
    with pytest.raises(CaseError, match=words):
        dataclasses.replace(logging, log=Log(every=9, columns=columns))


def test_a_log_is_part_of_the_case(logging, tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(logging.to_toml())
    assert Case.from_toml(file) == logging


def test_no_log(uninterrupted):
    with pytest.raises(RunError, match=r"the case has no \[log\]"):
        _ = mesokit.open(uninterrupted.directory.path).log


def test_damaged_files_are_refused_in_one_line(tmp_path):
    file = tmp_path / "log.csv"
    with pytest.raises(RunError, match=r"log.csv: no such file"):
        log_file.read(file)
    for text in ("", "step,time\n1,2,3\n", "step,time\n1,x\n", "step,time\nnan,1\n"):
        file.write_text(text)
        with pytest.raises(RunError, match=r"log.csv: damaged"):
            log_file.read(file)
    file.write_bytes(b"step,time\n1,2\n\xff,3\n")
    with pytest.raises(RunError, match=r"log.csv: damaged: byte 14 is not UTF-8"):
        log_file.read(file)


def test_a_method_has_columns_of_its_own(tmp_path):
    case = Case(
        run=Run(steps=20, method="brownian"),
        box=Box([4, 4]),
        brownian=Brownian(),
        log=Log(every=10),
    )
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run()
    log = mesokit.open(tmp_path / "run").log
    assert log.dtype.names == ("step", "time", "centre x", "centre y")
    centre = simulation.engine.positions(unwrapped=True).mean(axis=0)
    np.testing.assert_allclose([log["centre x"][-1], log["centre y"][-1]], centre, rtol=1e-8)
