"""What potentials do to the velocities of beads: loops over WIDTH molecules side by side."""

from mesokit.execute.beads import WIDTH, bead_of, leave, look
from mesokit.mpcd.field.none import Zero
from mesokit.mpcd.field.protocol import acceleration
from mesokit.pointer import word
from mesokit.potential.angle import bend
from mesokit.potential.protocol import central, torn
from mesokit.scalar import added, added_scaled, by_type, dot, scalar, scaled


@scalar
def kick(physics, work, time, like):
    """Change of all velocities by the forces of where the beads are, kept for a time.

    Whether a bond is torn is the answer.
    """
    molecule = physics.molecule
    links, factor = molecule.links, time * molecule.inverse_mass
    bonds, angles, pairs = molecule.number
    apart = False
    for n in range(bonds):
        a = bead_of(work, word(links, 2 * n), like)
        b = bead_of(work, word(links, 2 * n + 1), like)
        apart |= kick_bond(molecule.bond, factor, a, b, like)
    for n in range(angles):
        a = bead_of(work, word(links, 2 * bonds + 3 * n), like)
        b = bead_of(work, word(links, 2 * bonds + 3 * n + 1), like)
        c = bead_of(work, word(links, 2 * bonds + 3 * n + 2), like)
        kick_angle(molecule.angle, factor, a, b, c, like)
    for n in range(pairs):
        a = bead_of(work, word(links, 2 * bonds + 3 * angles + 2 * n), like)
        b = bead_of(work, word(links, 2 * bonds + 3 * angles + 2 * n + 1), like)
        kick_pair(molecule.pair, factor, a, b, like)
    for k in range(molecule.beads):
        push_bead(physics.field, time, bead_of(work, k, like), like)
    return apart


@scalar
def kick_bond(potential, factor, a, b, like):
    """The force between beads a and b; whether they are farther apart than they can be."""
    d, apart = len(like), False
    for i in range(WIDTH):
        way = added_scaled(look(b, i, 0, like), -1.0, look(a, i, 0, like))
        square = dot(way, way)
        _, push = central(potential, square)
        change = scaled(factor * push, way)
        leave(a, i, d, added_scaled(look(a, i, d, like), -1.0, change))
        leave(b, i, d, added(look(b, i, d, like), change))
        apart |= torn(potential, square)
    return apart


@by_type
def kick_pair(pair, factor, a, b, like):
    """The force between beads a and b that any two beads have, if there is one."""
    return _kick_pair if len(pair) else lambda *_: None


def _kick_pair(pair, factor, a, b, like):
    kick_bond(pair[0], factor, a, b, like)


@by_type
def kick_angle(angle, factor, a, b, c, like):
    """The forces of the angle of beads a, b and c, if there are any."""
    return _kick_angle if len(angle) else lambda *_: None


def _kick_angle(angle, factor, a, b, c, like):
    d = len(like)
    for i in range(WIDTH):
        middle = look(b, i, 0, like)
        before = added_scaled(middle, -1.0, look(a, i, 0, like))
        after = added_scaled(look(c, i, 0, like), -1.0, middle)
        _, first, last = bend(angle[0], before, after)
        first, last = scaled(factor, first), scaled(factor, last)
        leave(a, i, d, added(look(a, i, d, like), first))
        leave(b, i, d, added_scaled(look(b, i, d, like), -1.0, added(first, last)))
        leave(c, i, d, added(look(c, i, d, like), last))


@by_type
def push_bead(field, time, bead, like):
    """The body force, if there is one."""
    return (lambda *_: None) if field.instance_class is Zero else _push_bead


def _push_bead(field, time, bead, like):
    d = len(like)
    for i in range(WIDTH):
        r, v = look(bead, i, 0, like), look(bead, i, d, like)
        leave(bead, i, d, added_scaled(v, time, acceleration(field, r)))


@scalar
def add_virial(physics, work, time, lanes, tensor, like):
    """Add to (d, d) sums the momentum that bonds, angles and pairs hand over along themselves.

    Each is the vector between two beads times the impulse on the second, in that time.
    """
    molecule = physics.molecule
    links = molecule.links
    bonds, angles, pairs = molecule.number
    for n in range(bonds):
        a = bead_of(work, word(links, 2 * n), like)
        b = bead_of(work, word(links, 2 * n + 1), like)
        bond_virial(molecule.bond, time, a, b, lanes, tensor, like)
    for n in range(angles):
        a = bead_of(work, word(links, 2 * bonds + 3 * n), like)
        b = bead_of(work, word(links, 2 * bonds + 3 * n + 1), like)
        c = bead_of(work, word(links, 2 * bonds + 3 * n + 2), like)
        angle_virial(molecule.angle, time, a, b, c, lanes, tensor, like)
    for n in range(pairs):
        a = bead_of(work, word(links, 2 * bonds + 3 * angles + 2 * n), like)
        b = bead_of(work, word(links, 2 * bonds + 3 * angles + 2 * n + 1), like)
        pair_virial(molecule.pair, time, a, b, lanes, tensor, like)


@scalar
def bond_virial(potential, time, a, b, lanes, tensor, like):
    """That of the bonds between beads a and b."""
    for i in range(lanes):
        way = added_scaled(look(b, i, 0, like), -1.0, look(a, i, 0, like))
        _, push = central(potential, dot(way, way))
        add_product(tensor, time * push, way, way)


@by_type
def pair_virial(pair, time, a, b, lanes, tensor, like):
    """That of what any two beads have, if there is anything."""
    return _pair_virial if len(pair) else lambda *_: None


def _pair_virial(pair, time, a, b, lanes, tensor, like):
    bond_virial(pair[0], time, a, b, lanes, tensor, like)


@by_type
def angle_virial(angle, time, a, b, c, lanes, tensor, like):
    """That of the angles of beads a, b and c, if they have one."""
    return _angle_virial if len(angle) else lambda *_: None


def _angle_virial(angle, time, a, b, c, lanes, tensor, like):
    for i in range(lanes):
        middle = look(b, i, 0, like)
        before = added_scaled(middle, -1.0, look(a, i, 0, like))
        after = added_scaled(look(c, i, 0, like), -1.0, middle)
        _, first, last = bend(angle[0], before, after)
        add_product(tensor, -time, before, first)
        add_product(tensor, time, after, last)


@scalar
def add_product(tensor, factor, a, b):
    """Add a factor times the outer product of two vectors to (d, d) sums."""
    d = len(a)
    for j in range(d):
        for k in range(d):
            tensor[j * d + k] += factor * a[j] * b[k]
