"""A timestep of just a tenth of a contact, which `check` takes, is never refused by the run."""

import math

from hypothesis import given
from hypothesis import strategies as st

from mesokit import Box, Case, Run, SoftSpheres, SpringDashpot
from mesokit.method.spheres.soft.scales import fastest_followed


def case_of(law: SpringDashpot, steps: float) -> Case:
    """Two disks whose contact takes so many steps."""
    timestep = law.contact_time_of(0.5, 1.0) / steps
    spheres = SoftSpheres(number=2, pair=law, timestep=timestep)
    return Case(run=Run(steps=0, method="soft-spheres"), box=Box([10, 10]), spheres=spheres)


@given(stiffness=st.floats(1e2, 1e8), damping=st.floats(0, 0.5))
def test_a_tenth_of_a_contact_is_followed(stiffness, damping):
    law = SpringDashpot(stiffness=stiffness, damping=damping * math.sqrt(stiffness))
    assert fastest_followed(case_of(law, 10)) == math.inf
