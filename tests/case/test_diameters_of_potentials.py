"""Soft spheres of a potential have its diameter, where kinds say none."""

import dataclasses

import numpy as np
import pytest

from mesokit import WCA, Box, Case, CaseError, Run, SoftSpheres, SphereKind, Table


@pytest.fixture
def table(tmp_path):
    """Rows of a soft repulsion, whose diameter is no round number."""
    r = np.linspace(0.06, 1.2, 150)
    path = tmp_path / "soft.txt"
    np.savetxt(path, np.column_stack([r, 9.0 * (1.2 - r) ** 2]))
    return Table(file=str(path))


def case_of(pair, **spheres):
    given = {"number": 12} | spheres
    return Case(
        run=Run(0, method="soft-spheres"), box=Box([9, 9]), spheres=SoftSpheres(pair=pair, **given)
    )


@pytest.mark.parametrize("kinds", [{}, {"kinds": [SphereKind(mass=2.5)]}])
def test_it_is_that_of_the_potential(table, kinds):
    for pair in (table, WCA(sigma=0.37)):
        case = case_of(pair, **kinds)
        assert [kind.diameter for kind in case.spheres.kinds] == [pair.diameter]
        assert case.spheres.kinds[0].mean_mass(2) == (2.5 if kinds else 1.0)


def test_a_case_on_record_says_it(table, tmp_path):
    case = case_of(table)
    (tmp_path / "case.toml").write_text(case.to_toml())
    assert Case.from_toml(tmp_path / "case.toml") == case
    assert f"diameter = {table.diameter!r}" in case.to_toml()


def test_the_digits_of_the_message_are_enough(table):
    with pytest.raises(CaseError, match=r"spheres\.kinds: diameter 1\.5; expected that of") as no:
        case_of(table, kinds=[SphereKind(1.5)])
    said = str(no.value).split("the potential, ")[1].split(":")[0]
    assert case_of(table, kinds=[SphereKind(float(said))])


def test_of_contacts_it_is_one():
    spheres = SoftSpheres(number=3, kinds=[SphereKind(), SphereKind(2.0)])
    assert [kind.diameter for kind in spheres.kinds] == [1.0, 2.0]
    assert dataclasses.replace(spheres, number=4).kinds == spheres.kinds
