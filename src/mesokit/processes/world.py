"""The processes of a run: this one alone, or one of the ranks that an MPI launcher has started."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, TypeAlias

from mesokit import __version__
from mesokit.errors import RunError
from mesokit.processes import launcher
from mesokit.processes.alone import Alone

if TYPE_CHECKING:
    from mesokit.processes.several import Several

World: TypeAlias = "Alone | Several"
_known: World | None = None


def world() -> World:
    """The processes that run a case together. The first call is collective: all ranks make it.

    Raises RunError where MPI is asked for and not there, and for ranks of different versions.
    """
    global _known
    if _known is None:
        _known = Alone()
        if launcher.several():
            _known = _of_mpi()
            here = {"version of mesokit": __version__, "byte order": sys.byteorder}
            _known.require_same(lambda: here)
    return _known


def known() -> World:
    """The same without asking others: this process alone, as long as it has not asked."""
    return _known or Alone()


def stay_alone() -> None:
    """This process has nothing to do with other ranks."""
    global _known
    _known = Alone()


def _of_mpi() -> World:
    try:
        from mpi4py import MPI
    except ImportError as error:
        if not launcher.first():  # one says it for all
            raise SystemExit(1) from None
        raise RunError(f"several ranks need mpi4py ({error}): pip install 'mesokit[mpi]'") from None
    if MPI.COMM_WORLD.size == 1:
        return Alone()
    from mesokit.processes.several import Several

    return Several(MPI.COMM_WORLD)
