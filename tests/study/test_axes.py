"""What a study varies, and the runs that follow from it."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit.case import toml
from mesokit.errors import CaseError
from mesokit.study.axes import Axis, grid
from mesokit.study.plan import planned, short_names


@pytest.mark.parametrize(
    ("text", "points"),
    [
        ("fluid.density=5,10", [{"fluid.density": 5}, {"fluid.density": 10}]),
        ("a=0:1:3", [{"a": 0.0}, {"a": 0.5}, {"a": 1.0}]),
        ("a=1:9:3", [{"a": 1}, {"a": 5}, {"a": 9}]),
        ("a=0.01:1:3:log", [{"a": 0.01}, {"a": 0.1}, {"a": 1.0}]),
        ("rule=srd,at", [{"rule": "srd"}, {"rule": "at"}]),
        ("v=[0.1, 0],[0.2, 0]", [{"v": [0.1, 0]}, {"v": [0.2, 0]}]),
        ("a=1,2; b=x,y", [{"a": 1, "b": "x"}, {"a": 2, "b": "y"}]),
    ],
)
def test_what_the_command_line_says(text, points):
    assert list(Axis.parse(text)) == points


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("fluid.density", "expected KEY=VALUE"),
        ("fluid.density=", "expected KEY=VALUE"),
        ("a=1,2;b=1,2,3", "a has 2, b has 3"),
        ("a=-1:1:3:log", "begins above 0"),
        ("a=x:1:3", "expected KEY=VALUE"),
        ("a=1:2:0", "no value; expected KEY=VALUE"),
        ("a=1:2", "or KEY=FIRST:LAST:NUMBER"),
        ("a=-inf:2:4", "vary a=-inf:2:4: expected two finite numbers"),
        ("a=2:nan:4:log", "vary a=2:nan:4:log: expected two finite numbers"),
        ("a=1.7e308:-1.7e308:2", "expected two numbers, not that far apart"),
        ("a=inf:1:3", "expected two finite numbers"),
        ("a=0:1:100001", "vary a=0:1:100001: expected at most 100000 values"),
    ],
)
def test_what_cannot_be_varied(text, words):
    with pytest.raises(CaseError, match=words):
        Axis.parse(text)


numbers = st.floats(-1e6, 1e6).map(lambda x: float(f"{x:.9g}"))


@given(st.lists(st.one_of(numbers, st.integers(-(2**40), 2**40)), min_size=1, max_size=5))
def test_lists_come_back_as_they_were(values):
    assert [p["k"] for p in Axis.parse(f"k={', '.join(map(repr, values))}")] == values
    assert [p["k"] for p in Axis.from_table({"k": values})] == values


def test_tables_with_dots_or_nested_are_the_same():
    for table in ({"fluid.kT": "1:2:2"}, {"fluid": {"kT": [1, 2]}}):
        assert list(Axis.from_table(table)) == [{"fluid.kT": 1}, {"fluid.kT": 2}]


def test_every_combination_with_every_seed():
    axes = [Axis.parse("a.x=1,2"), Axis.parse("b=0.5,1.5;c=p,q")]
    assert len(grid(axes)) == 4
    runs = planned(axes, [1, 7], Path("s"))
    assert len(runs) == 8 and len({run.path for run in runs}) == 8
    assert runs[-1].path.as_posix() == "s/runs/x=2,b=1.5,c=q/seed=7"
    assert runs[-1].point == {"a.x": 2, "b": 1.5, "c": "q"}
    with pytest.raises(CaseError, match=r"vary a\.x: given twice"):
        grid([axes[0], axes[0]])
    with pytest.raises(CaseError, match="a value is there twice"):
        planned([Axis.parse("a=1,1")], [1], Path("s"))


def test_names_that_would_be_alike_are_whole():
    assert short_names(["fluid.kT", "wall.1.radius", "wall.2.radius"]) == [
        "kT", "wall.1.radius", "wall.2.radius",
    ]  # fmt: skip


def test_a_number_for_a_vector():
    """It takes the place of the one component that is not zero, and of nothing else."""
    data = {"fluid": {"force": {"acceleration": [0.0, 0.1]}, "other": [1.0, 2.0], "none": [0, 0]}}
    for key in ("force.acceleration", "other", "none"):
        toml.override(data, f"fluid.{key}", "0.3")
    assert data["fluid"] == {"force": {"acceleration": [0.0, 0.3]}, "other": 0.3, "none": 0.3}
