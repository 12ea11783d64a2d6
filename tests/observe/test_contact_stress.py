"""Stress and contacts of soft spheres: beds bear their weight, stiff gases are as hard ones."""

import math
from typing import Literal

import pytest

from mesokit import (
    Box,
    Case,
    ContactStress,
    LennardJones,
    Plates,
    PouredStart,
    RandomStart,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
)
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError, RunError
from tests.helpers.comparisons import by_name


def observed(size, steps, walls=(), warmup=0, **spheres):
    case = Case(
        run=Run(steps, warmup=warmup, method="soft-spheres"),
        box=Box(size),
        walls=list(walls),
        spheres=SoftSpheres(**spheres),
        observe=[ContactStress(every=20)],
    )
    simulation = Simulation(case, threads=1)
    simulation.run()
    found = simulation["contact-stress"]
    return by_name(found), found


def test_spheres_that_still_fall_are_not_compared_with_their_weight():
    gravity, pair = [0.0, -1.0], SpringDashpot(0.3, contact_time=0.01, friction=0.5)
    start = RandomStart()
    for warmup, steady in ((0, False), (60_000, True)):
        said, _ = observed(
            [12.0, 20.0], 400, [Plates("y")], warmup, number=40, start=start, gravity=gravity,
            kT=0.01, pair=pair,
        )  # fmt: skip
        flux = said["flux along gravity over weight"]
        assert flux.steady == steady
        assert (abs(flux.measured - 1) < 0.1) == steady


@pytest.mark.parametrize("speed", [3.0, 40.0])
def test_a_sphere_that_passes_a_wall_ends_the_run(speed):
    """Contacts that are far too soft: no sphere may leave without a word."""
    case = Case(
        run=Run(4000, method="soft-spheres"), box=Box([12.0, 20.0]), walls=[Plates("y")],
        spheres=SoftSpheres(
            number=40, kT=speed**2, start=RandomStart(),
            pair=SpringDashpot(0.3, contact_time=4.0, friction=0.5), timestep=0.01,
        ),
    )  # fmt: skip
    with pytest.raises(RunError, match="centre of a sphere has passed a wall by"):
        Simulation(case, threads=1).run()


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_bed_bears_its_weight(dimension):
    size = [12.0, 20.0] if dimension == 2 else [5.0, 5.0, 12.0]
    said, found = observed(
        size, 4000, [Plates("yz"[dimension - 2])], number=90, start=PouredStart(),
        gravity=[0.0] * (dimension - 1) + [-1.0],
        pair=SpringDashpot(0.3, contact_time=0.01, friction=0.5),
    )  # fmt: skip
    flux = said["flux along gravity over weight"]
    assert flux.measured == pytest.approx(1.0, abs=3e-3) and flux.approximate
    assert dimension < said["contacts of a sphere"].measured < 4 * dimension
    assert found.value[0] < 1e-3 * found.value[1]  # all by forces


def test_spheres_that_hit_the_ceiling_are_borne_by_it_too():
    said, _ = observed(
        [10.0, 10.0], 4000, [Plates("y")], number=20, kT=9.0, start=RandomStart(),
        gravity=[0.0, -1.0], pair=SpringDashpot(1.0, contact_time=0.02),
    )  # fmt: skip
    assert "flux along gravity over weight" not in said


def test_a_stiff_elastic_gas_has_the_pressure_of_hard_disks():
    said, _ = observed(
        [22.5, 22.5], 60_000, number=200, start=RandomStart(),
        pair=SpringDashpot(1.0, contact_time=0.02), timestep=0.001,
    )  # fmt: skip
    z = said["P/(n kT)"]
    assert abs(z.measured / z.expected - 1) < 4 * z.error / z.expected + 0.02
    assert z.error < 0.05 * z.measured and "hard" in z.note


def test_what_loses_energy_or_attracts_has_no_theory():
    for pair in (SpringDashpot(0.9, contact_time=0.02), LennardJones()):
        said, _ = observed([12.0, 12.0], 200, number=40, pair=pair)
        assert said["P/(n kT)"].expected != said["P/(n kT)"].expected
    assert "contacts of a sphere" not in said


def test_beds_of_two_sizes_are_said_to_be_approximate():
    kinds = [SphereKind(1.0), SphereKind(0.7)]
    said, _ = observed(
        [12.0, 20.0], 1000, [Plates("y")], number=90, kinds=kinds, start=PouredStart(),
        gravity=[0.0, -1.0], pair=SpringDashpot(0.3, contact_time=0.01, friction=0.5),
    )  # fmt: skip
    flux = said["flux along gravity over weight"]
    assert "approximate" in flux.note and flux.measured == pytest.approx(1.0, abs=0.05)


def test_one_sphere_has_no_stress():
    with pytest.raises(CaseError, match=r"contact-stress.*1 sphere"):
        observed([5.0, 5.0], 1, number=1)


@component
class Bump(LennardJones):
    """A potential of one's own, with fields that are called as answers of laws of contact are."""

    rule: Literal["bump"] = tag("bump")
    elastic: bool = param(True, doc="a field like any other")
    width: int = param(1, doc="another")


def test_a_potential_is_not_taken_for_a_law_of_contact_by_its_fields():
    said, _ = observed([8.0, 8.0], 40, number=16, kT=1.0, pair=Bump(), timestep=0.002)
    assert "contacts of a sphere" not in said
    assert math.isnan(said["P/(n kT)"].expected)
