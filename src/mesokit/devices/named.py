"""Devices by the names that users give them."""

import re
from typing import Any

from mesokit.case.component import nearest, one_of, show
from mesokit.devices.device import Device
from mesokit.devices.names import NAMES
from mesokit.errors import CaseError

NUMBERS = {"cuda": (r"\d{1,3}", "cuda:1"), "emulated": (r"\d{1,2}\.\d", "emulated:9.0")}
HINTS = {"gpu": "cuda", "GPU": "cuda"}  # what is typed, and meant


def require_name(given: Any) -> str:
    """The name of a device; "cuda:1" is the second card, "emulated:8.0" is of that compute
    capability. Raises CaseError for another."""
    name, colon, more = given.partition(":") if isinstance(given, str) else ("", "", "")
    if name in NAMES and not colon:
        return str(given)
    if name in NUMBERS:
        form, example = NUMBERS[name]
        if re.fullmatch(form, more):
            return str(given)
        raise CaseError(f"device = {show(given)}: expected {show(name)}, or such as {example!r}")
    meant = HINTS.get(name)
    hint = f"; did you mean {meant!r}?" if meant else ""
    if not hint and isinstance(given, str):
        hint = nearest(given, NAMES)
    raise CaseError(f"device = {show(given)}: expected {one_of(NAMES)}{hint}")


def require_there(given: Any) -> None:
    """Raise RunError where there is no device of a name; no memory is taken on it."""
    device = opened(given)
    if (close := getattr(device, "close", None)) is not None:
        close()


def opened(given: Any) -> Device | None:
    """The device of a name, ready for kernels; None for the threads of a processor.

    "cuda" is the first card, "emulated" its machine code's text run on the processor, "host" a loop
    over threads compiled for the processor. The last two are slow: they show that bits are the same
    where there is no card.

    Raises CaseError for another name, and RunError where there is no such device.
    """
    name, _, more = require_name(given).partition(":")
    if name == "cuda":
        from mesokit.devices.cuda import Cuda

        return Cuda(int(more or 0))
    if name == "emulated":
        from mesokit.devices.emulated import CHIP, Emulated

        major, _, minor = more.partition(".")
        return Emulated((int(major), int(minor)) if more else CHIP)
    if name == "host":
        from mesokit.devices.host import Host

        return Host()
    return None
