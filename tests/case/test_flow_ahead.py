"""What is said of the flow before a run: known, bounded, or not known."""

from __future__ import annotations

import dataclasses

import pytest

from mesokit import Cylinder, Disk, NoThermostat, Plates, Run, Uniform
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.summary import summary

PUSH = {"force": Uniform([0.02, 0])}


def test_nothing_is_claimed_of_a_flow_round_obstacles(make_case):
    """The speed of the empty channel is a bound, and no reason to warn of its Mach number."""
    empty = derive(make_case((40, 30), walls=[Plates("y")], **PUSH))
    case = make_case((40, 30), walls=[Plates("y"), Disk([20, 15], 5)], **PUSH)
    found = derive(case)
    assert empty.mach > 0.2 and any("Mach" in text for text in empty.warnings)
    assert (found.flow_speed, found.reynolds, found.mach) == (None, None, None)
    assert found.flow_bound == empty.flow_speed
    assert not any("Mach" in text for text in found.warnings)
    assert any("the flow needs up to" in text for text in found.warnings)
    rows = {name: (value, word) for name, value, word in summary(case).rows}
    assert rows["flow speed"][0] == "not known" and "without them" in rows["flow speed"][1]
    most = f"{empty.reynolds:.4g} without obstacles"
    assert rows["Reynolds number"] == ("not known", most)


def test_the_flow_in_a_round_pipe_is_that_of_hagen_and_poiseuille(make_case):
    pipe = Cylinder([0, 12, 12], radius=10, axis="x", fluid="inside")
    case = make_case((8, 24, 24), walls=[pipe], force=Uniform([0.01, 0, 0]))
    found = derive(case)
    nu = found.transport.viscosity
    assert found.flow == "Hagen-Poiseuille"
    assert found.flow_speed == pytest.approx(0.01 * 100 / (4 * nu))
    assert found.reynolds == pytest.approx(found.flow_speed * 20 / nu)
    assert found.steady_time == pytest.approx(100 / (5.783 * nu), rel=1e-3)


@pytest.mark.parametrize("rule", ["no-slip", "slip"])
def test_heating_by_friction_is_a_bound_where_walls_cool(make_case, rule):
    walls = [Plates("y", lower={"rule": rule}, upper={"rule": "no-slip"})]
    case = make_case((20, 20), walls=walls, thermostat=NoThermostat(), **PUSH)
    longer = dataclasses.replace(case, run=Run(steps=10_000))
    (text,) = (text for text in derive(longer).warnings if "friction" in text)
    assert "by at most" in text and "cool" in text
