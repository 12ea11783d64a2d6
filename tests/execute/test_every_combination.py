"""Any two registered components run together, or are refused by name.

Of all combinations a few are chosen so that every pair of kinds is met at least once. The tests of
the laws find them compiled.
"""

import itertools

import numpy as np
import pytest

from mesokit import AT, SRD, MaxwellBoltzmann, NoForce, NoThermostat, Plates, Surface, Uniform
from mesokit.errors import CaseError
from mesokit.method.mpcd import collision, field, thermostat
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.fluid import Species
from mesokit.method.mpcd.start.fluid import start

pytestmark = pytest.mark.long

BOUNDARIES = {
    "periodic": lambda d: {},
    "sheared": lambda d: {"shear_rate": 0.1},
    "slit": lambda d: {"walls": [Plates(axis="y", upper=Surface("slip"))]},
    "topped-up slit": lambda d: {"walls": [Plates(axis="xyz"[d - 1], virtual="top-up")]},
}
KINDS = {
    "dimension": (2, 3),
    "rule": collision.RULES,
    "thermostat": thermostat.RULES,
    "field": field.RULES,
    "boundary": tuple(BOUNDARIES),
    "masses": (1, 2),
}


# The tests of the laws need these kernels.
FREE, BARE = NoThermostat, NoForce
PLAIN = {
    dimension: [(rule, FREE, BARE, "periodic", masses) for rule in collision.RULES]
    for dimension, masses in ((2, 2), (3, 1))
}
PLAIN[3] += [(SRD, rule, BARE, "periodic", 1) for rule in thermostat.RULES]
PLAIN[3] += [(AT, FREE, rule, "periodic", 1) for rule in field.RULES]
CANONICAL = MaxwellBoltzmann
for dimension in (2, 3):
    PLAIN[dimension] += [
        (rule, FREE if rule().rule.startswith("at") else CANONICAL, BARE, "sheared", 1)
        for rule in collision.RULES
    ]
PLAIN[2] += [(SRD, CANONICAL, Uniform, boundary, 1) for boundary in ("slit", "topped-up slit")]


def build(dimension, rule, thermostat, field, boundary, masses):
    """The case of a combination. Raises CaseError where there is no physics for it."""
    from tests.helpers.small_fluids import example, make_case

    species = (Species(mass=1, density=3), Species(mass=2, density=2)) if masses == 2 else ()
    return make_case(
        (4, 6, 5)[:dimension], collision=rule(), thermostat=thermostat(),
        force=example(field, dimension), **({"species": species} if species else {"density": 5}),
        **BOUNDARIES[boundary](dimension),
    )  # fmt: skip


def pairs(combination):
    return set(itertools.combinations(enumerate(combination), 2))


def cover():
    """Few valid combinations with every pair that occurs in any: greedily the most new pairs."""
    valid, refused = [], []
    for combination in itertools.product(*KINDS.values()):
        try:
            build(*combination)
            valid.append(combination)
        except CaseError as error:
            refused.append((combination, str(error)))
    chosen = [combination for combination in valid if combination[1:] in PLAIN[combination[0]]]
    missing = set().union(*map(pairs, valid)).difference(*map(pairs, chosen))
    while missing:
        best = max(valid, key=lambda combination: len(pairs(combination) & missing))
        chosen.append(best)
        missing -= pairs(best)
    return chosen, refused


CHOSEN, REFUSED = cover()


def name(combination):
    return " ".join(getattr(part, "__name__", str(part)) for part in combination)


@pytest.mark.parametrize("combination", CHOSEN, ids=name)
def test_combination_runs(combination):
    fluid = CPU(build(*combination), 2)
    start(fluid)
    fluid.advance(3)
    number, _, energy = fluid.totals()
    r, v = fluid.positions(), fluid.velocities()
    assert (r >= 0).all() and (r <= fluid.box).all() and np.isfinite(v).all()
    volume = (24, 120)[combination[0] - 2]
    assert number == 5 * volume
    assert 0.7 < energy / (0.5 * combination[0] * number) < 1.6  # near kT, whatever the rule


def test_what_is_refused_is_named():
    for _, message in REFUSED:
        assert "\n" not in message and any(
            key in message for key in ("thermostat", "force", "shear_rate", "wall", "collision")
        ), message


def test_every_kind_is_met():
    met = set().union(*map(set, CHOSEN))
    assert set().union(*map(set, KINDS.values())) <= met
