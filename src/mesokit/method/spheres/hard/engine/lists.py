"""Neighbour lists: two spheres are on each other's list if they can meet within their shells.

The centre of a shell is the place of a sphere when its list was made. When the sphere leaves the
shell, it alone gets a new centre and list, and enters the lists of others. The grid of cells holds
centres, so that spheres cross no cells.
"""

import math

from mesokit.loops.cells import NOWHERE, cell_after, cell_of, cells_along, row_around
from mesokit.loops.neighbours import nearest_image
from mesokit.method.spheres.common.walls import entries
from mesokit.method.spheres.hard.engine.groups import RADIUS
from mesokit.method.spheres.hard.engine.motion import put_entries
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added_scaled, dot


@scalar
def link(lists, i, r):
    """Put the centre r of sphere i, in the box, into its cell."""
    cell = cell_of(lists, r)
    after = lists.head[cell]
    lists.cell[i], lists.following[i], lists.before[i] = cell, after, -1
    if after >= 0:
        lists.before[after] = i
    lists.head[cell] = i


@scalar
def unlink(lists, i):
    """Take a centre out of its cell."""
    after, before = lists.following[i], lists.before[i]
    if after >= 0:
        lists.before[after] = before
    if before >= 0:
        lists.following[before] = after
    else:
        lists.head[lists.cell[i]] = after


@scalar
def forget(lists, i):
    """Remove i from the lists of all others, and empty its own."""
    # Lists are mutual: i is on the list of each of its neighbours. The last entry there takes its
    # place; the order of lists does not matter, since equal times are decided by particle numbers.
    for a in range(lists.count[i]):
        j = lists.near[i, a]
        last = lists.count[j] - 1
        b = 0
        while lists.near[j, b] != i:
            b += 1
        lists.near[j, b] = lists.near[j, last]
        lists.count[j] = last
    lists.count[i] = 0


@scalar
def renew(world, lists, state, i, r):
    """Make the list of i anew about r, in the box; true if there was room."""
    unlink(lists, i)
    forget(lists, i)
    put_entries(lists.centre, i, 0, r)
    link(lists, i, r)
    return find(world, lists, state, i, r)


@scalar
def find(world, lists, state, i, r):
    """Put all spheres that may meet i on its list, and i on theirs; true if there was room."""
    room = True
    # The cells around the centre; each is at least as long as two centres on a list may be apart.
    here = cells_along(lists, r)
    for n in range(3 ** (len(r) - 1)):
        row, middle = row_around(lists, world, r, here, 0.0, n)
        for a in range(-1, 2 if row != NOWHERE else -1):
            along_x = cell_after(lists, world, 0, middle, a)
            if along_x != NOWHERE:
                room &= list_cell(world, lists, state, i, r, row + along_x)
    return room


@scalar
def list_cell(world, lists, state, i, r, cell):
    """Put the spheres of a cell that may meet i on the lists; true if there was room."""
    most, j, room = lists.near.shape[1], lists.head[cell], True
    mine = state[i, RADIUS] * lists.widest + 2.0 * lists.shell
    # Two spheres can meet before either is renewed if their centres are nearer than both radii and
    # two shells. Lists are mutual, so `forget` can remove a sphere from all of them.
    while j >= 0:
        apart = nearest_image(world, added_scaled(entries(lists.centre, j, 0, r), -1.0, r))
        reach = mine + state[j, RADIUS] * lists.widest
        if j != i and dot(apart, apart) < reach * reach:
            if lists.count[i] < most and lists.count[j] < most:
                lists.near[i, lists.count[i]] = j
                lists.near[j, lists.count[j]] = i
                lists.count[i] += 1
                lists.count[j] += 1
            else:
                room = False
        j = lists.following[j]
    return room


@scalar
def time_to_leave(world, lists, r, v, centre):
    """The time after which a sphere leaves its shell; with gravity a lower bound, from its largest
    speed."""
    gone = nearest_image(world, added_scaled(r, -1.0, centre))
    square, shell = dot(gone, gone), lists.shell
    pull = math.sqrt(dot(world.gravity, world.gravity))
    speed = dot(v, v)
    if pull > 0.0:
        left = max(shell - math.sqrt(square), 0.0)
        u = math.sqrt(speed)
        return 2.0 * left / (u + math.sqrt(u * u + 2.0 * pull * left))
    if speed < 1e-200:  # the square underflows
        return math.inf
    b = dot(gone, v)
    return (math.sqrt(max(b * b + speed * (shell * shell - square), 0.0)) - b) / speed
