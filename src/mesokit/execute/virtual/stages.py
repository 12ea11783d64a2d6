"""Virtual particles of walls as stages of the step: which of their kinds a case has.

They fill the solid part of the cells that walls cut, so that these collide as the cells of the
fluid do. A slit holds one layer of them between its two plates (`slit`); in the cells that solids
of any shape cut they come one by one, or as one for each cell where the collision rule cannot tell
(`one_by_one`, `per_cell`). By the top-up rule cells are filled to the mean density instead.
"""

from typing import Any

from mesokit.execute.cpu.physics import field_of
from mesokit.execute.virtual import one_by_one, per_cell, slit, slit_gradient, slit_top_up
from mesokit.execute.virtual.gradient import follow_pieces
from mesokit.scalar.jit import by_type


def _nothing(team, now, physics, fluid, walls):
    return None


@by_type
def fill_walls(team, now, physics, fluid, walls):
    """Virtual particles at t + dt, their cells, and what they add to the sums of these."""
    if _has(walls, "slit"):
        return slit.fill_slit
    if not _has(walls, "solids") or _has(walls, "top_up"):
        return _nothing
    return per_cell.fill_cells if one_by_one.drawn_per_cell(walls) else one_by_one.fill_solids


@by_type
def follow_flow(team, now, physics, fluid, walls):
    """How the fluid's velocity rises with the distance from surfaces, where that is asked."""
    if not _has(walls, "gradient"):
        return _nothing
    return follow_pieces if _has(walls, "solids") else slit_gradient.follow_plates


@by_type
def top_up_walls(team, now, physics, fluid, walls):
    """Virtual particles for the cells that hold fewer particles than the fluid's mean, if asked."""
    if not _has(walls, "top_up"):
        return _nothing
    return one_by_one.top_up_solids if _has(walls, "solids") else slit_top_up.top_up_slit


@by_type
def recoil(team, now, physics, fluid, walls):
    """What solids take by the collision of the virtual particles in them."""
    if _has(walls, "slit"):
        return slit.slit_recoil
    if not _has(walls, "solids"):
        return _nothing
    return per_cell.cells_recoil if one_by_one.drawn_per_cell(walls) else one_by_one.solids_recoil


def _has(walls: Any, name: str) -> bool:
    return len(field_of(walls, name)) > 0
