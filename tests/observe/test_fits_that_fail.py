"""A fit that has found nothing shows no number, but why."""

import math

import pytest

from mesokit import Harmonic, TransverseModes
from mesokit.method.mpcd.molecule import Molecule
from mesokit.observe.shared.fitted import fitted_number
from tests.helpers.comparisons import comparisons
from tests.helpers.small_fluids import make_fluid


@pytest.mark.parametrize(("value", "error"), [(3.1, 1.6), (-0.4, 0.2), (0.02, 5.0)])
def test_what_may_be_zero_has_no_value(value, error):
    found = fitted_number("viscosity", value, error, 0.9, "a^2/tau", "approximate: chaos")
    assert math.isnan(found.measured) and math.isnan(found.error)
    assert math.isnan(found.deviation) and math.isnan(found.percent)
    assert "undetermined" in str(found) and "within two errors of zero" in str(found)


def test_what_is_sure_keeps_its_note():
    for error in (0.3, math.nan):  # too short a run has no error bar at all
        found = fitted_number("viscosity", 0.7, error, 0.9, "a^2/tau", "approximate: chaos")
        assert found.measured == 0.7 and found.note == "approximate: chaos"


def test_a_few_samples_of_slow_molecules_determine_no_stress_time():
    molecule = Molecule(length=6, bond=Harmonic(K=0.5))
    fluid = make_fluid((8, 8, 8), density=6, molecule=molecule)
    accumulator = TransverseModes(every=2).accumulator(fluid.case)
    for _ in range(60):
        accumulator.observe(fluid)
        fluid.advance(2)
    times = comparisons(accumulator.result(), "stress time")
    for found in times:
        assert math.isnan(found.measured) or found.error < found.measured / 2
    assert any("the fit finds" in found.note for found in times)
