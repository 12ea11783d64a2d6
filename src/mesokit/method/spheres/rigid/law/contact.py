"""What two rigid grains do to one another: the coefficients of all laws of a contact."""

from mesokit.case.component import component, param
from mesokit.method.spheres.rigid.law.cohesion import ContactCohesion


@component
class RigidContact:
    """Coefficients of a contact: grains do not overlap, and have what is not 0 here besides.

    >>> RigidContact(friction=0.3).restitution
    0.0
    """

    friction: float = param(
        0.5,
        doc="Coulomb's coefficient: largest force along the surface over that along the normal",
        symbol=r"\mu",
        ge=0,
        le=1e6,
    )
    restitution: float = param(
        0.0,
        doc="normal velocity after a step over minus that before, of contacts that close in it",
        symbol="e",
        ge=0,
        le=1,
    )
    rolling: float = param(
        0.0,
        doc="largest torque against rolling over the reduced radius and the normal force",
        symbol=r"\mu_r",
        ge=0,
        le=1e6,
    )
    cohesion: ContactCohesion | None = param(None, doc="pull at short range (none unless said)")

    @property
    def turns(self) -> bool:
        """Whether grains turn."""
        return self.friction > 0 or self.rolling > 0
