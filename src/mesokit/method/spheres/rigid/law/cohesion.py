"""Cohesion: grains within a short range pull one another with a constant force.

The contact of a cohesive pair opens when it is pulled by more than that force (Kadau, Schwager,
Bartels, Brendel and Wolf 2003). The pull counts as given, and the contact pushes against it; so
friction is limited by mu times the sum of push and pull.
"""

from mesokit.case.component import component, param
from mesokit.scalar.jit import scalar


@component
class ContactCohesion:
    """A constant force between grains, within a range of their surfaces.

    >>> ContactCohesion(force=2.0, range=0.01).energy
    0.02
    """

    force: float = param(
        doc="largest pull that a contact withstands", unit="mass length/time^2", gt=0, le=1e9
    )
    range: float = param(
        doc="gap between surfaces up to which they pull", unit="length", gt=0, le=1e9
    )

    @property
    def energy(self) -> float:
        """The work that parts two grains."""
        return self.force * self.range


@scalar
def pull(force, within, gap, step):
    """The impulse with which surfaces a `gap` apart pull one another in a step."""
    return force * step if gap < within else 0.0
