"""The sections of a case of MPCD."""

from mesokit.case.component import param
from mesokit.case.describe.hints import Many
from mesokit.geometry.shape import Wall
from mesokit.method.mpcd.fluid import Fluid
from mesokit.method.mpcd.solutes import Solutes

KEYS = {"walls": "wall"}  # field -> key in the file, where they differ: one [[wall]] each


class Sections:
    """What a case of MPCD has beside the sections of every case."""

    fluid: Fluid = param(Fluid(), doc="the fluid")
    solutes: Solutes | None = param(None, doc="monomers and polymers in the fluid (none)")
    walls: Many[Wall] = param((), doc="walls; key `[[wall]]` in a file")
