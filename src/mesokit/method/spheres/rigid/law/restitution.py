"""Bounces by Moreau's rule: the velocity after a step is -e times that before it."""

from mesokit.scalar.jit import scalar


@scalar
def bouncing(restitution, before, least):
    """The least velocity of a contact after a step: that of a bounce if it closes in the step.

    before: velocity away from one another at the start of the step; least: of a contact that does
    not bounce, minus the gap over the time of a step. A contact at rest does not bounce.
    """
    return -restitution * before if before < least else least
