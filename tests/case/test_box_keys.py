"""Keys of the box: what a method does not declare is refused, whatever the method."""

import dataclasses

import pytest

from mesokit import Box, Case, CaseError, Run
from mesokit.case import methods
from mesokit.case.shear.oscillating import OscillatingShear

GIVEN = {
    "shear_rate": (0.25, "box.shear_rate = 0.25"),
    "shear_frequency": (3.0, "box.shear_frequency = 3"),
    "open": (["y"], "box.open = ['y']"),
    "shear": (OscillatingShear(rate=0.5, frequency=2.0), "box.shear.rule = 'oscillating'"),
}


def test_all_keys_are_looked_at():
    assert {"size", *GIVEN} == {field.name for field in dataclasses.fields(Box)}


@pytest.mark.parametrize("key", GIVEN)
@pytest.mark.parametrize("method", sorted(methods.METHODS))
def test_what_a_method_does_not_take_is_refused(method, key):
    value, said = GIVEN[key]
    box = Box([12, 10], **{key: value})
    if key in methods.load(method).box:
        return
    with pytest.raises(CaseError) as refused:
        Case(run=Run(1, method=method), box=box)
    assert str(refused.value) == f"{said}: not with method '{method}'"


@pytest.mark.parametrize("method", sorted(methods.METHODS))
def test_keys_at_their_defaults_say_nothing(method):
    box = Box([12, 10], shear_rate=0.0, open=[], shear=None)
    assert Case(run=Run(1, method=method), box=box).box == Box([12, 10])
