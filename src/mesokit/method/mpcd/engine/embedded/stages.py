"""The stages of a step that solutes change, by how they are coupled to the fluid."""

from mesokit.method.mpcd.engine.beads.flight import move_solutes
from mesokit.method.mpcd.engine.cpu.sweep import stream_fluid
from mesokit.method.mpcd.engine.embedded.flight import move_in_fluid
from mesokit.method.mpcd.engine.embedded.state import is_embedded
from mesokit.method.mpcd.engine.embedded.sweep import put_back, stream_around
from mesokit.scalar.jit import by_type


@by_type
def stream(worker, now, physics, fluid, beads):
    """The fluid's part (see `cpu.sweep.stream_fluid`)."""
    if is_embedded(beads):
        return lambda worker, now, physics, fluid, beads: stream_around(
            worker, now, physics, fluid, beads
        )
    return lambda worker, now, physics, fluid, beads: stream_fluid(worker, now, physics, fluid)


@by_type
def move_beads(worker, now, physics, fluid, beads):
    """The solutes' part (see `beads.flight.move_solutes`), with the fluid near them."""
    if not is_embedded(beads):
        return lambda worker, now, physics, fluid, beads: move_solutes(
            worker, now, physics, fluid, beads
        )

    def together(worker, now, physics, fluid, beads):
        move_in_fluid(worker, now, physics, fluid, beads)
        put_back(worker, now, physics, fluid, beads)

    return together
