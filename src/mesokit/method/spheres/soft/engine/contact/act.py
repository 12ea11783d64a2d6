"""What contacts do to spheres, and what they tell: with spheres, and with walls."""

from mesokit.method.spheres.soft.engine.acting import act, tell
from mesokit.method.spheres.soft.engine.contact.force import Contact
from mesokit.method.spheres.soft.engine.contact.pairs import push_pairs, tell_pairs
from mesokit.method.spheres.soft.engine.contact.walls import push_from_walls, tell_walls
from mesokit.method.spheres.soft.engine.groups import LARGEST


@act.register(Contact)
def _(law, mine, time, step, world, noted, room):
    largest = push_pairs(law, mine, step, world, room)
    for i in range(mine[0], mine[1]):
        largest = max(largest, push_from_walls(law, i, time, step, world, room))
    noted[LARGEST] = max(noted[LARGEST], largest * law.scale)


@tell.register(Contact)
def _(law, i, time, world, told):
    tell_pairs(law, i, world, told)
    tell_walls(law, i, time, world, told)
