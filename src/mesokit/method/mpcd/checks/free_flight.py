"""What a fluid without collisions can have, and where a box may be open."""

from collections.abc import Iterator

from mesokit.case.case import Case
from mesokit.case.component import name_of, show


def free_flight(case: Case) -> Iterator[str]:
    """Nothing that only collisions can do."""
    fluid, solutes, rule = case.fluid, case.solutes, name_of(case.fluid.collision)
    if fluid.collision.acts:
        return
    if fluid.thermostat.acts:
        yield (
            f"fluid.thermostat.rule = {show(name_of(fluid.thermostat))}: acts in collisions, and "
            f"collision rule {show(rule)} has none; leave the thermostat out"
        )
    if case.box.sheared:
        yield (
            f"{case.box.shear_key}: not with collision rule {show(rule)}, "
            "which carries no shear from particle to particle"
        )
    if solutes is not None and solutes.solvent == "random":
        yield (
            f"solutes.solvent = 'random': acts in collisions, and collision rule {show(rule)} has "
            "none; use 'fluid'"
        )


def open_box(case: Case) -> Iterator[str]:
    """No bounds but for particles that fly freely, and nothing at them."""
    given, box = f"box.open = {show(list(case.box.open))}", case.box
    if not box.open:
        return
    for axis in box.open:
        if axis not in box.axes:
            yield f"{given}: a 2D box has only 'x' and 'y'"
    if case.fluid.collision.acts:
        rule = show(name_of(case.fluid.collision))
        yield f"{given}: only with collision rule 'none'; cells of rule {rule} need a periodic box"
    for i, wall in enumerate(case.walls):
        yield f"{given}: not with wall[#{i + 1}].shape = {show(name_of(wall))}; leave one out"
    if case.solutes is not None:
        yield f"{given}: not with solutes; leave one of both out"
    for i, observable in enumerate(case.observe):
        if not observable.in_open_box:
            yield (
                f"observe[#{i + 1}].quantity = {show(name_of(observable))}: not with {given}; it "
                "needs particles that are in the box"
            )
