"""No overlap and no pull: the law of Signorini for velocities (Moreau 1988; Jean 1999)."""

from mesokit.scalar.jit import scalar


@scalar
def pushed(push, mass, velocity, least):
    """The impulse along the normal after one update of a contact.

    push: so far; mass: reduced; velocity: of the surfaces away from one another with that impulse;
    least: velocity below which they would overlap at the end of the step, minus the gap over the
    time of a step, or that of a bounce. The impulse is what keeps that velocity, and never pulls.
    """
    return max(push - mass * (velocity - least), 0.0)


@scalar
def closing(gap, step):
    """The least velocity of surfaces a `gap` apart, which may close but not overlap.

    Surfaces that overlap already may stay so: they are not pushed apart (Unger and Kertész 2003).
    """
    return -max(gap, 0.0) / step
