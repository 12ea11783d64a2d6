"""Random kicks to all spheres."""

from typing import Literal

import numpy as np

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.common.draws import normal_rows
from mesokit.method.spheres.hard.heating.protocol import Heated, Heating

PURPOSE = 80  # of the random numbers, above METHOD


@component
class Kicks(Heating):
    """Normal random kicks, whose sum is zero, as of a vibrated plate below.

    After Williams and MacKintosh (1996). Inelastic spheres come to a temperature at which they lose
    as much in collisions (`mesokit.theory.kicked_temperature`).
    """

    rule: Literal["kicks"] = tag("kicks")
    power: float = param(0.1, doc="energy that a sphere gets per time", unit="kT/time", gt=0)

    @property
    def white_noise(self) -> bool:
        return True

    def act(self, heated: Heated, interval: float) -> None:
        n, d = heated.velocities.shape
        kicks = normal_rows(heated.seed, heated.turn, PURPOSE, n, d)
        kicks *= np.sqrt(2 * self.power * interval / (d * heated.masses))[:, None]
        kicks -= heated.masses @ kicks / heated.masses.sum()
        heated.velocities[:] += kicks
