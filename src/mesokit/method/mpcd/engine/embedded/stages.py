"""The stages of a step that solutes change, by how they are coupled to the fluid."""

from mesokit.method.mpcd.engine.beads import flight
from mesokit.method.mpcd.engine.cpu import sweep
from mesokit.method.mpcd.engine.embedded.flight import move_in_fluid
from mesokit.method.mpcd.engine.embedded.state import is_embedded
from mesokit.method.mpcd.engine.embedded.sweep import put_back, stream_around
from mesokit.scalar.jit import by_type

stream_all = sweep.stream
move_alone = flight.move_beads


@by_type
def stream(team, now, physics, fluid, beads):
    """The fluid's part (see `cpu.sweep.stream`)."""
    if is_embedded(beads):
        return lambda team, now, physics, fluid, beads: stream_around(
            team, now, physics, fluid, beads
        )
    return lambda team, now, physics, fluid, beads: stream_all(team, now, physics, fluid)


@by_type
def move_beads(team, now, physics, fluid, beads):
    """The solutes' part (see `beads.flight.move_beads`), with the fluid near them."""
    if not is_embedded(beads):
        return lambda team, now, physics, fluid, beads: move_alone(team, now, physics, fluid, beads)

    def together(team, now, physics, fluid, beads):
        move_in_fluid(team, now, physics, fluid, beads)
        put_back(team, now, physics, fluid, beads)

    return together
