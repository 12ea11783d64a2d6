"""Virtual particles of walls as stages of the step.

They fill the solid part of the cells that walls cut, so that these collide as the cells of the
fluid do: all of a cell at once where the collision rule cannot tell (`per_cell`), else one by one
(`one_by_one`). By the top-up rule cells are filled to the mean density instead.
"""

from typing import Any

import mesokit.geometry.solids.virtual_particles  # noqa: F401  what virtual particles ask of solids
from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.virtual import one_by_one, per_cell
from mesokit.method.mpcd.engine.virtual.gradient import follow_pieces
from mesokit.method.mpcd.engine.virtual.particles import drawn_per_cell
from mesokit.scalar.jit import by_type


def _nothing(worker, now, physics, fluid, walls):
    return None


@by_type
def fill_walls(worker, now, physics, fluid, walls):
    """Virtual particles at t + dt, their cells, and what they add to the sums of these."""
    if not _has(walls, "virtual") or _has(walls, "top_up"):
        return _nothing
    return per_cell.fill_cells if drawn_per_cell(walls) else one_by_one.fill_one_by_one


@by_type
def follow_flow(worker, now, physics, fluid, walls):
    """Measure how the fluid's velocity rises from surfaces, if a wall needs it."""
    return follow_pieces if _has(walls, "gradient") else _nothing


@by_type
def top_up_walls(worker, now, physics, fluid, walls):
    """Virtual particles for the cells that hold fewer particles than the fluid's mean, if asked."""
    return one_by_one.top_up if _has(walls, "top_up") else _nothing


@by_type
def recoil(worker, now, physics, fluid, walls):
    """Add the impulse that walls take by the collision of the virtual particles in them."""
    if not _has(walls, "virtual"):
        return _nothing
    return per_cell.recoil_per_cell if drawn_per_cell(walls) else one_by_one.recoil_one_by_one


def _has(walls: Any, name: str) -> bool:
    return len(field_of(walls, name)) > 0
