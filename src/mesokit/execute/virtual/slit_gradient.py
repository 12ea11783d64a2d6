"""How fast the fluid's velocity rises with the distance from a plate.

Virtual particles at rest with the plate drag the fluid as if the plate lay deeper: in the part of a
cell that is solid the fluid's linear profile would go on, to velocities beyond the plate's. With
the rate of the profile known they can move like that; the plate is then where it should be.
"""

from mesokit.execute.cpu.strips.terms import read_sums, sums_of_cell
from mesokit.execute.cpu.threads import meet
from mesokit.geometry.protocol import across
from mesokit.scalar.cache import inner
from mesokit.scalar.intrinsics import floor, with_item

MEMORY = 1.0 / 32.0  # weight of one step; the mean must not follow the noise of single steps


def follow_plates(team, now, physics, fluid, walls):
    """Update the rates (2, d) of the lower and upper plate.

    From the cells next to the cut ones, which hold no virtual particles, at this step.
    """
    if team.thread == 0:
        _update(now, physics, fluid, walls.slit.rates)
    meet(team)


@inner
def _update(now, physics, fluid, rates):
    grid, zero, sums = now.grid, physics.zero, fluid.cells.sums
    solid = physics.solid
    axis = across(solid)
    layers, s = int(grid.cells[axis]), grid.shift[axis]
    below = s - floor(s)
    stride, beside = 1, 1
    for k in range(len(zero)):  # cells are numbered with x fastest
        if k == axis:
            beside = stride
        stride *= int(grid.cells[k])
    columns = stride // layers
    for surface in range(2):
        # Heights of the layer's middle: cells end at k - shift.
        layer = 1 if surface == 0 else layers - 2
        height = 1.5 - below if surface == 0 else 0.5 + below
        mass, momentum = 0.0, zero
        for column in range(columns):
            cell = column // beside * beside * layers + layer * beside + column % beside
            n, m, p, _, _ = read_sums(physics, sums_of_cell(sums, cell, physics.terms))
            mass += m if n > 0.0 else 0.0
            for k in range(len(zero)):
                momentum = with_item(momentum, k, momentum[k] + p[k])
        for k in range(len(zero)):
            u = solid.lower_velocity[k] if surface == 0 else solid.upper_velocity[k]
            rate = (momentum[k] / max(mass, 1e-300) - u) / height if mass > 0.0 else 0.0
            rate = 0.0 if k == axis else rate
            rates[surface, k] += MEMORY * (rate - rates[surface, k])
