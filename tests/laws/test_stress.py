"""The stress that flying particles carry and collisions move, by every rule."""

import numpy as np
import pytest

from mesokit import Box, Case, Fluid, MaxwellBoltzmann, NoThermostat, Run, Simulation, Stress
from tests.helpers.comparisons import comparisons
from tests.helpers.small_fluids import KNOWN

pytestmark = pytest.mark.long

# Molecular chaos leaves out correlated collisions; in 2D also the loop of fluctuations, most for
# rules of low viscosity. What this test is for are terms that are missing or counted twice.
CHAOS = {2: 0.2, 3: 0.06}


@pytest.mark.parametrize("size", [(24, 24), (10, 10, 10)], ids=["2D", "3D"])
@pytest.mark.parametrize("rule", KNOWN, ids=lambda rule: rule.__name__)
def test_sheared_fluid_has_its_viscosity_and_pressure(rule, size):
    """Standard errors of the viscosity are 1 to 3 %; the pressure is density kT."""
    bath = NoThermostat() if rule().rule.startswith("at") else MaxwellBoltzmann()
    rate = 0.1
    simulation = Simulation(
        Case(
            run=Run(steps=4000, warmup=300, seed=8),
            box=Box(size, shear_rate=rate),
            fluid=Fluid(density=10, timestep=0.1, collision=rule(), thermostat=bath),
            observe=[Stress()],
        )
    )
    simulation.run()
    result = simulation["stress"]
    comparison = comparisons(result, "viscosity")[0]
    error, theory = comparison.error, comparison.expected
    assert error < 0.04 * theory
    slack = 4 * error + CHAOS[len(size)] * theory
    assert abs(comparison.measured - theory) < slack, comparison
    total = np.array(result.value)[2]
    spread = np.array(result.error)[2]
    for k in range(len(size)):
        assert abs(total[k, k] + 10.0) < 4 * spread[k, k] + 0.1, total
