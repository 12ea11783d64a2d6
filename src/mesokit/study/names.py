"""Names of keys of a case and of measured numbers in pictures."""

import re
from typing import Any

from mesokit.seam.in_units import units_of

LONGEST = 36  # letters of an explanation beside a name
VECTOR = "one number for each axis"  # explains no meaning
# by the beginning of the name of a number, without the conditions that follow in some names
SYMBOLS = {
    "viscosity": r"\nu", "storage modulus": "G'", "loss modulus": "G''", "permeability": "k",
    "diffusion coefficient": "D", "mean polar order": r"\varphi", "susceptibility": r"\chi",
    "drag coefficient": "C_D", "lift coefficient": "C_L", "shear rate": r"\dot\gamma",
    "mean square radius of gyration": r"\langle R_g^2 \rangle", "sound speed": "c",
    "mean temperature": "k_BT", "pressure": "p", "Reynolds number": r"\mathrm{Re}",
    "sound attenuation": r"\Gamma", "relaxation time": r"\tau",
}  # fmt: skip
CONDITIONS = "from|along|of|at|up to|in"


def called(case: Any, key: str) -> tuple[str, str]:
    """Name in words and unit of a key; the key itself if there is no description.

    >>> from mesokit import Box, Case, Molecule, Run
    >>> case = Case(run=Run(steps=1), box=Box([8, 8]))
    >>> called(case, "fluid.collision.angle"), called(case, "fluid.mass")
    (('rotation angle $\\\\alpha$', 'degrees'), ('mass of a particle', 'm'))
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
    unit = units_of(case).of(unit.replace("^d", f"^{case.box.dimension}"))
    name, symbol = last.replace("_", " "), (field.json_schema_extra or {}).get("symbol")
    words = _words(name, field.description or "")
    if symbol:
        words = f"{name if '(' in words else words} ${symbol}$"
    return words + of, unit


def with_symbol(what: str) -> str:
    """The name of a measured number, with its symbol if it has one.

    >>> with_symbol("viscosity from curvature"), with_symbol("viscosity over theory")
    ('viscosity $\\\\nu$ from curvature', 'viscosity over theory')
    """
    for name, symbol in SYMBOLS.items():
        if re.fullmatch(rf"{re.escape(name)}( ({CONDITIONS})\b.*)?", what):
            return f"{name} ${symbol}${what[len(name) :]}"
    return what


def _words(name: str, explanation: str) -> str:
    """The name, with its meaning if that is short.

    >>> _words("K", "U = K r^2"), _words("mass", "mass of a bead"), _words("length", "beads; one")
    ('K in U = K r^2', 'mass of a bead', 'length (beads)')
    """
    meaning = re.split(r"[,;:(]", explanation)[0].strip()
    if not meaning or len(meaning) > LONGEST or meaning == VECTOR:
        return name
    if "=" in meaning:
        return f"{name} in {meaning}"
    return meaning if name in meaning.split() else f"{name} ({meaning})"
