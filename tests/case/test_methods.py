"""A case belongs to a method; a package can bring one."""

import copy
import dataclasses
import importlib
import pickle

import pytest

from mesokit import Box, Case, CaseError, Fluid, Plates, Run, Simulation, Start
from mesokit.case import methods
from mesokit.case.case import case_class
from mesokit.seam.method import Method, method_of

WANDER = """
import dataclasses
from mesokit.method.brownian.method import METHOD as BROWNIAN
METHOD = dataclasses.replace(BROWNIAN, name="wander")
"""
CASE = """
[run]
steps = 20
method = "wander"
[box]
size = [5, 5]
[brownian]
density = 3
[[observe]]
quantity = "mean-square-displacement"
every = 2
max_lag = 6
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """An installed package with a method."""
    folder, record = tmp_path / "wander", tmp_path / "wander-1.0.dist-info"
    (folder / "templates").mkdir(parents=True)
    record.mkdir()
    (folder / "__init__.py").touch()
    (folder / "method.py").write_text(WANDER)
    (folder / "templates" / "wander.toml").write_text(CASE)
    (record / "METADATA").write_text("Metadata-Version: 2.1\nName: wander\nVersion: 1.0\n")
    (record / "entry_points.txt").write_text("[mesokit.methods]\nwander = wander.method\n")
    monkeypatch.syspath_prepend(tmp_path)
    yield
    case_class.cache_clear()


@pytest.mark.usefixtures("package")
def test_a_package_brings_a_method():
    case = Case.from_toml(methods.templates()["wander"])
    assert method_of(case).name == "wander"
    assert case.brownian.density == 3
    simulation = Simulation(case, threads=2)
    simulation.run()
    assert simulation["mean-square-displacement"].samples == 11  # the start included


@pytest.mark.usefixtures("package")
def test_a_method_may_offer_no_observable_of_its_own(tmp_path, monkeypatch):
    method = methods.load("wander")
    module = importlib.import_module("wander.method")
    monkeypatch.setattr(module, "METHOD", dataclasses.replace(method, observables=()))
    case = tmp_path / "case.toml"
    case.write_text(CASE.split("[[observe]]")[0])
    assert Case.from_toml(case).observe == ()
    case.write_text(CASE)
    with pytest.raises(CaseError, match=r"observe\[#1\].quantity = .* does not offer any$"):
        Case.from_toml(case)


def entry_point(folder, value):
    (folder / "wander-1.0.dist-info" / "entry_points.txt").write_text(
        f"[mesokit.methods]\nwander = {value}\n"
    )


@pytest.mark.usefixtures("package")
def test_an_entry_point_may_name_the_object_in_its_module(tmp_path):
    entry_point(tmp_path, "wander.method:METHOD")
    assert methods.load("wander").name == "wander"


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ("wander.methud", "No module named 'wander.methud'"),
        ("wander", "module 'wander' has no attribute 'METHOD'"),
    ],
)
@pytest.mark.usefixtures("package")
def test_an_entry_point_without_a_method_is_refused(tmp_path, value, reason):
    entry_point(tmp_path, value)
    with pytest.raises(CaseError, match=f"run.method = 'wander': module .* imported: {reason}"):
        methods.load("wander")


@pytest.mark.parametrize("name", methods.METHODS)
def test_every_method_answers_what_it_is_asked(name):
    method = methods.load(name)
    assert isinstance(method, Method)
    assert method.name == name
    case = Case(run=Run(steps=1, method=name), box=Box([6, 6]))
    assert method_of(case) is method
    assert sum(group.number for group in case.groups) > 0
    assert method.timestep(case) > 0
    assert method.summary(case, 2).rows


def test_a_case_is_of_the_class_of_its_method():
    case = Case(Run(steps=1), Box([6, 6]), Fluid(density=5), walls=[Plates("y")])
    assert isinstance(case, Case)
    assert type(case) is case_class("mpcd")
    assert case.fluid.density == 5
    assert copy.deepcopy(case) == case == pickle.loads(pickle.dumps(case))


def test_a_method_that_there_is_not_is_refused():
    with pytest.raises(CaseError, match=r"'brownain': expected .*, or .*; did you mean"):
        Run(steps=1, method="brownain")


@pytest.mark.parametrize("key", ["positons", "fluid"])
def test_what_a_simulation_cannot_start_from_is_refused(key):
    with pytest.raises(CaseError, match=f"not {key}"):
        Simulation(Case(run=Run(steps=1), box=Box([6, 6])), **{key: None})


def test_a_fluid_does_not_start_from_a_run_of_another_method(tmp_path):
    walk = Case(run=Run(steps=1, method="brownian"), box=Box([6, 6]))
    Simulation(walk, output=tmp_path / "walk").run()
    fluid = Fluid(start=Start(run=str(tmp_path / "walk")))
    with pytest.raises(
        CaseError, match=r"fluid\.start\.run = .*: that is a run of method 'brownian'"
    ):
        Simulation(Case(run=Run(steps=1), box=Box([6, 6]), fluid=fluid))
