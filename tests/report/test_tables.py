"""Numbers of a run leave as CSV, JSON, data frames and labelled arrays, and are the same there."""

from __future__ import annotations

import csv
import json
import sys
from math import isnan

import numpy as np
import pytest

import mesokit
from mesokit import CaseError
from mesokit.cli import main
from mesokit.io.tables import record
from mesokit.report.table import cells
from mesokit.seam.result import Comparison, Result


@pytest.fixture(scope="module")
def files(run_folder):
    return mesokit.open(run_folder(True))


def said(capsys, *arguments):
    with pytest.raises(SystemExit) as status:
        main([str(argument) for argument in arguments])
    return status.value.code, capsys.readouterr()


def test_the_files_of_a_run_are_a_mapping(files):
    names = ["conservation", "velocity-field", "velocity-profile"]
    assert list(files) == list(files.keys()) == names and len(files) == 3
    assert "velocity-field" in files and "viscosity" not in files and files.get("nothing") is None
    assert [result.name for result in files.values()] == names
    assert files == files and files != mesokit.open(files.path) and len({files}) == 1


def test_comparisons_of_a_run_have_one_name_each(files):
    found = files.comparisons()
    assert found["velocity-profile.slip-at-the-walls"] is files["velocity-profile"]["slip"]
    assert len(found) == sum(len(result.comparisons) for result in files.values())


def test_a_run_without_results_is_still_there(run_folder):
    early = mesokit.open(run_folder(False))
    assert early and not early.ended
    with pytest.raises(mesokit.RunError, match="has not ended"):
        list(early)


@pytest.mark.parametrize("name", ["velocity-profile", "velocity-field", "conservation"])
def test_tables_of_a_result_hold_its_numbers(files, name, tmp_path):
    result = files[name]
    frame, data = result.to_dataframe(), result.to_xarray()
    assert len(frame) == result.value.size and list(frame)[: len(result.x)] == list(result.x)
    np.testing.assert_array_equal(data["value"], result.value)
    np.testing.assert_array_equal(data["error"], result.error)
    np.testing.assert_array_equal(data["expected"], result.expected)
    for axis, places in result.x.items():
        np.testing.assert_array_equal(data[axis], places)
        chosen = data["value"].isel({axis: -1}).to_numpy().ravel()
        rows = frame[frame[axis] == places[-1]]["value"].to_numpy()
        np.testing.assert_array_equal(chosen, rows)
    assert data["value"].attrs.get("units", "") == result.units["value"]
    assert frame.attrs["units"] == result.units and data.attrs["samples"] == result.samples
    lines = result.to_csv(tmp_path / "r.csv").read_text().splitlines()
    assert lines[0].startswith(f"# {name}: {result.about}; ")
    rows = list(csv.DictReader(lines[1:]))
    np.testing.assert_array_equal([float(row["value"]) for row in rows], frame["value"])


def test_comparisons_as_data_frame_and_csv(files, tmp_path):
    frame = files.to_dataframe()
    with open(files.to_csv(tmp_path / "c.csv"), newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["key"] for row in rows] == list(frame["key"]) and list(frame) == list(rows[0])
    for row, (name, comparison) in zip(rows, files.comparisons().items(), strict=True):
        assert name == f"{row['result']}.{row['key']}"
        assert row["measured"] == ("" if isnan(comparison.measured) else str(comparison.measured))


def test_without_pandas_the_extra_is_named(files, monkeypatch):
    for name, call in (("pandas", files.to_dataframe), ("xarray", files["conservation"].to_xarray)):
        monkeypatch.setitem(sys.modules, name, None)
        with pytest.raises(CaseError, match=rf"{name}: pip install 'mesokit\[tables\]'"):
            call()


def test_info_as_json(files, run_folder, capsys):
    status, out = said(capsys, "info", files.path, "--json")
    record = json.loads(out.out)
    assert status == 0 and record["ended"] and record["case"]["fluid"]["density"] == 5.0
    measured = [row["measured"] for row in record["comparisons"]]
    numbers = [c.measured for c in files.comparisons().values()]
    assert measured == [None if isnan(number) else number for number in numbers]
    assert record["provenance"]["seed"] == 1 and record["results"][1]["shape"]["x"] == 6
    assert "NaN" not in out.out
    status, out = said(capsys, "info", run_folder(False), "--json")
    record = json.loads(out.out)
    assert status == 0 and "has not ended" in record["state"] and record["comparisons"] == []


def test_check_as_json(files, capsys):
    status, out = said(capsys, "check", files.path / "case.toml", "--json", "--threads", 1)
    record = json.loads(out.out)
    assert status == 0 and record["case"]["run"]["steps"] == 60
    numbers = mesokit.derive(files.case, threads=1)
    assert record["numbers"]["transport"]["viscosity"] == numbers.transport.viscosity
    assert record["seconds"] == numbers.seconds
    assert ["particles", str(numbers.particles)] in [
        [row["what"], row["value"]] for row in record["rows"]
    ]


def test_table_writes_csv(files, tmp_path, capsys):
    path = tmp_path / "t.csv"
    assert said(capsys, "table", files.path, "--output", path)[0] == 0
    assert path.read_text().startswith("result,key,what,measured")
    wanted = ["--result", "velocity-profile", "--output", path]
    assert said(capsys, "table", files.path, *wanted)[0] == 0
    assert path.read_text().splitlines()[1] == "y,value,error,expected,fit"
    wanted[1] = "velocity-profil"
    status, out = said(capsys, "table", files.path, *wanted)
    assert status == 2 and "did you mean 'velocity-profile'?" in out.err


def test_digits_of_what_is_known_far_better_than_its_value():
    """An error of rounding is none; a small deviation that is significant shows its size."""
    count = Comparison("contacts", 2.75, 2e-18, 3.0)
    assert isnan(count.deviation) and str(count) == "contacts: 2.750, expected 3"
    sharp = Comparison("temperature", 1.000049, 3.2e-6, 1.0)
    assert str(sharp).endswith("+15.3 standard errors, +0.0049 %")
    assert cells(sharp)[4] == "+15.3 s.e. (+0.0049 %)"
    assert cells(Comparison("slip", 1.05, 0.01, 1.0))[4] == "+5.0 s.e. (+5.0 %)"


def test_results_are_described_in_plain_words():
    axes = {"time": np.arange(3.0), "of": np.array(["all"]), "row": np.array(list("xyz"))}
    value = np.zeros((3, 1, 3))
    result = Result("q", "q", axes, value, value, r"order $|\psi_6|$ of $k_B T$", {}, samples=1)
    assert repr(result) == "q: order |psi_6| of k_B T, 1 sample; by time (3), row (3)"
    number = Result("q", "q", {}, 1.0, 0.1, "speed", {}, samples=2)
    assert repr(number) == "q: speed, 2 samples"
    kinds = {"of": np.array(["small", "large"])}
    two = Result("q", "q", kinds, np.zeros(2), np.zeros(2), "speed", {}, samples=2)
    assert repr(two) == "q: speed, 2 samples; by group (2)"


@pytest.mark.parametrize(
    ("note", "said_of_it", "far"),
    [
        ("", "+9.0 s.e. (+18.0 %)", True),
        ("steady; error bar is a lower bound: of 3 samples", "at most +9.0 s.e. (+18.0 %)", False),
    ],
)
def test_a_lower_bound_of_an_error_bounds_the_deviation(note, said_of_it, far):
    number = Comparison("slip", 5.9, 0.1, 5.0, "a", note)
    assert cells(number)[4] == said_of_it and number.far == far
    assert record(number)["lower_bound"] == bool(note)
    most = "at most " if note else ""
    assert f"expected 5: {most}+9.0 standard errors, +18.0 %" in str(number)
    assert str(number).endswith(f"({note})" if note else "%")
