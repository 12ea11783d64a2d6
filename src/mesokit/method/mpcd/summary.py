"""What `mesokit check` says of a case."""

from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.case import Case
from mesokit.case.kind import has_run
from mesokit.method.mpcd.derived import compiling_memory, derive
from mesokit.method.mpcd.numbers import Derived
from mesokit.seam.method import Row, Summary


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers of a case as a table, and what to mind."""
    numbers = derive(case, threads)
    rows = [
        *_particle_rows(case, numbers),
        *numbers.fluid_rows(),
        *numbers.flow_rows(case.fluid.timestep),
        ("run time", duration_text(numbers.seconds), f"estimate: {numbers.assumed}"),
        ("memory", size_text(numbers.memory), _memory_word(case, numbers)),
    ]
    if numbers.trajectory:
        rows.append(("trajectory", size_text(numbers.trajectory), "estimate"))
    return Summary(tuple(rows), numbers.warnings, numbers.seconds, numbers.record(), numbers.memory)


def _memory_word(case: Case, numbers: Derived) -> str:
    compiling = compiling_memory(case)
    if has_run(case) or compiling <= numbers.memory:
        return "estimate"
    return f"estimate; {size_text(compiling)} while it compiles, the first time"


def _particle_rows(case: Case, numbers: Derived) -> list[Row]:
    rows = [("particles", f"{numbers.particles:,}".replace(",", " "), "")]
    if case.solutes is not None:
        rows.append(("beads of solutes", f"{case.solutes.beads:,}".replace(",", " "), ""))
    molecule = case.fluid.molecule
    if molecule is not None:
        number_of = f"{numbers.particles // molecule.length:,}".replace(",", " ")
        rows.append(("molecules", number_of, f"{molecule.topology}s of {molecule.length}"))
    if numbers.relaxation is not None:
        time, name = numbers.relaxation
        steps = f"slowest mode, {name}; {round(time / case.fluid.timestep)} steps"
        rows.append(("relaxation time", number(time, "tau"), steps))
        if rate := abs(case.box.steady_rate):
            rows.append(("Weissenberg number", number(rate * time), "shear rate x relaxation time"))
    if numbers.substeps is not None:
        how = molecule.propagation if molecule is not None else "verlet"
        rows.append(("sub-steps", str(numbers.substeps), how))
    if molecule is not None and case.solutes is not None:
        beads = case.solutes.number_of_substeps(case.box.dimension, case.fluid)
        rows.append(("sub-steps of solutes", str(beads), "verlet"))
    return rows
