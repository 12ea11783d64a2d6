"""What the keys of a case are called in pictures."""

from __future__ import annotations

import re
from typing import Any

LONGEST = 36  # letters of an explanation beside a name
VECTOR = "one number for each axis"  # explains no meaning


def called(case: Any, key: str) -> tuple[str, str]:
    """A name in words, and the unit, of a key; the key itself where nothing says more.

    >>> from mesokit import Box, Case, Molecule, Run
    >>> case = Case(run=Run(steps=1), box=Box([8, 8]))
    >>> called(case, "fluid.collision.angle"), called(case, "fluid.density")
    (('rotation angle', 'degrees'), ('density (particles per cell)', '1/a^2'))
    >>> called(case, "run.checkpoint_minutes")[1]
    'minutes'
    """
    *parents, last = key.split(".")
    here, of = case, ""
    for before, part in zip(["", *parents], parents, strict=False):
        if isinstance(here, tuple):
            of = f" of {before} {part}" if len(here) > 1 else ""
            named = [item for item in here if part == getattr(item, "label", None)]
            here = here[int(part) - 1] if part.isdecimal() else next(iter(named), None)
        else:
            fields = {key: field for field, key in case._method.keys.items()}
            here = getattr(here, fields.get(part, part), None)
    field = getattr(type(here), "__pydantic_fields__", {}).get(last)
    if field is None:
        return key, ""
    unit = str((field.json_schema_extra or {}).get("unit", "")).replace("time", "tau")
    unit = unit.replace("1/a^d", f"1/a^{case.box.dimension}")
    return _words(last.replace("_", " "), field.description or "") + of, unit


def _words(name: str, explanation: str) -> str:
    """The name, with what it means where that is short.

    >>> _words("K", "U = K r^2"), _words("mass", "mass of a bead"), _words("length", "beads; one")
    ('K in U = K r^2', 'mass of a bead', 'length (beads)')
    """
    meaning = re.split(r"[,;:(]", explanation)[0].strip()
    if not meaning or len(meaning) > LONGEST or meaning == VECTOR:
        return name
    if "=" in meaning:
        return f"{name} in {meaning}"
    return meaning if name in meaning.split() else f"{name} ({meaning})"
