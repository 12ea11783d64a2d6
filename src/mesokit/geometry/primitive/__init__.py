"""The primitives that shapes consist of. A new one is a file here and a name in `PRIMITIVES`.

Each file has `distance(p, samples, r)`: the signed distance of r from the surface, negative inside
the solid, or something of its sign that is no larger; `normal(p, samples, r)`; and whether the
solid is CONVEX. One whose distance takes long also has `nearer(p, samples, r, reach)`, whether that
is below a reach, and `facing(p, samples, r)`, both distance and normal. p is a row of WIDTH
numbers, of which the first three are a place, so that all can be moved alike. A primitive of which
bodies that move can be made is convex, and also has its `extent`, its `width` and its `integrals`;
one of revolution about the vector in p[3:6] is ROUND. The kind of each part is a number at run
time: one compiled step serves every case.
"""

from types import ModuleType
from typing import Any

from mesokit.geometry.primitive import (
    ball,
    brick,
    capsule,
    ellipsoid,
    half_space,
    rod,
    sampled,
    wave,
)
from mesokit.scalar.jit import seldom

PRIMITIVES: tuple[ModuleType, ...] = (half_space, ball, rod, capsule, brick, wave, sampled)
PRIMITIVES += (ellipsoid,)
KINDS = {module.__name__.rpartition(".")[2]: number for number, module in enumerate(PRIMITIVES)}
WIDTH = 12
CONVEX = tuple(module.CONVEX for module in PRIMITIVES)
ROUND = tuple(hasattr(module, "ROUND") for module in PRIMITIVES)
MOVABLE = tuple(hasattr(module, "integrals") for module in PRIMITIVES)


def _by_kind(name: str) -> Any:
    """The function of that name of the primitive whose number comes first."""
    lines = [f"def {name}(kind, p, samples, r):"]
    for number in range(len(PRIMITIVES) - 1):
        lines.append(f"    if kind == {number}: return f{number}(p, samples, r)")
    lines.append(f"    return f{len(PRIMITIVES) - 1}(p, samples, r)")
    space = {f"f{i}": getattr(module, name) for i, module in enumerate(PRIMITIVES)}
    exec("\n".join(lines), space)
    return seldom(space[name])


def _nearer() -> Any:
    """Whether the distance from the primitive whose number comes first is below a reach."""
    lines, space = ["def nearer(kind, p, samples, r, reach):"], {}
    for number, module in enumerate(PRIMITIVES):
        quick = hasattr(module, "nearer")
        answer = (
            f"f{number}(p, samples, r, reach)" if quick else f"f{number}(p, samples, r) < reach"
        )
        lines.append(f"    if kind == {number}: return {answer}")
        space[f"f{number}"] = module.nearer if quick else module.distance
    exec("\n".join([*lines, "    return False"]), space)
    return seldom(space["nearer"])


def _facing() -> Any:
    """The distance from the primitive whose number comes first, and its normal."""
    lines, space = ["def facing(kind, p, samples, r):"], {}
    for number, module in enumerate(PRIMITIVES):
        both = f"distance{number}(p, samples, r), normal{number}(p, samples, r)"
        if hasattr(module, "facing"):
            both, space[f"facing{number}"] = f"facing{number}(p, samples, r)", module.facing
        when = f"if kind == {number}: " if number < len(PRIMITIVES) - 1 else ""
        lines.append(f"    {when}return {both}")
        space |= {f"distance{number}": module.distance, f"normal{number}": module.normal}
    exec("\n".join(lines), space)
    return seldom(space["facing"])


distance, normal, nearer = _by_kind("distance"), _by_kind("normal"), _nearer()
facing = _facing()
