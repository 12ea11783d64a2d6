"""Forces and readings of contacts, with spheres and with walls."""

from mesokit.method.spheres.soft.engine.acting import act, measure
from mesokit.method.spheres.soft.engine.contact.force import Contact
from mesokit.method.spheres.soft.engine.contact.pairs import add_contact_forces, measure_pairs
from mesokit.method.spheres.soft.engine.contact.walls import (
    contact_forces_from_walls,
    measure_walls,
)
from mesokit.method.spheres.soft.engine.groups import LARGEST


@act.register(Contact)
def _(law, mine, time, step, world, noted, room):
    largest = add_contact_forces(law, mine, step, world, room)
    for i in range(mine[0], mine[1]):
        largest = max(largest, contact_forces_from_walls(law, i, time, step, world, room))
    noted[LARGEST] = max(noted[LARGEST], largest * law.scale)


@measure.register(Contact)
def _(law, i, time, world, readings):
    measure_pairs(law, i, world, readings)
    measure_walls(law, i, time, world, readings)
