"""What the walls of a case do to hard spheres."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.geometry.surface import Surface
from mesokit.method.spheres.common.wall.surfaces import surface_rows

Array = NDArray[np.float64]


class WallRows(NamedTuple):
    """rows (walls, 14) for the machinery; contacts (walls, 4): restitution (-1: as a pair has),
    tangential, friction and temperature (0: none); surface (walls,): number of each one's surface;
    names of the surfaces."""

    rows: Array
    contacts: Array
    surface: NDArray[np.int64]
    names: tuple[str, ...]


def wall_rows(case: Case) -> WallRows:
    """All walls of a case."""
    found = surface_rows(case)
    contacts = [_contact(case, surface) for _, surface in found.surfaces]
    return WallRows(
        found.rows, np.array(contacts, float).reshape(-1, 4), found.surface, found.names
    )


def _contact(case: Case, surface: Surface) -> tuple[float, float, float, float]:
    """Restitution, tangential restitution, friction and temperature of a surface."""
    pair, own = case.spheres.collision, surface.contact
    given = own.restitution if own is not None else None
    tangential = own.tangential if own is not None else None
    friction = own.friction if own is not None else None
    tangential = pair.tangential if tangential is None else tangential
    friction = pair.friction if friction is None else friction
    temperature = 0.0
    if surface.rule == "diffuse":
        own_kT = own.temperature if own is not None else None
        temperature = float(case.spheres.kT if own_kT is None else own_kT)
    return (
        -1.0 if given is None else given,
        -1.0 if surface.rule == "slip" else tangential,
        np.inf if friction is None else friction,
        temperature,
    )
