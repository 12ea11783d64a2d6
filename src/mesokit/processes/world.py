"""The processes of a run: this one alone, or one of the ranks that an MPI launcher has started.

MPI is loaded only if there are several processes, because loading takes time.
"""

import os
import sys

from mesokit import __version__
from mesokit.errors import RunError
from mesokit.processes.alone import Alone

World = Alone  # or Several, which has the same methods
_known: World | None = None

# number and rank of processes: variables of MPICH, Intel MPI, MS-MPI and Slurm with PMI-2; of
# Open MPI; of MVAPICH
SIZES = ("PMI_SIZE", "OMPI_COMM_WORLD_SIZE", "MV2_COMM_WORLD_SIZE")
RANKS = ("PMI_RANK", "OMPI_COMM_WORLD_RANK", "MV2_COMM_WORLD_RANK", "PMIX_RANK")


def may_be_several() -> bool:
    """True if a launcher has set variables of several ranks, or the script has loaded MPI."""
    if "mpi4py.MPI" in sys.modules:
        return True
    sizes = [os.environ[name] for name in SIZES if name in os.environ]
    if sizes:
        return any(size != "1" for size in sizes)
    # PMIx has no variable for the number of ranks; Slurm has
    return "PMIX_RANK" in os.environ and os.environ.get("SLURM_STEP_NUM_TASKS") != "1"


def is_first() -> bool:
    """True on rank 0, and for one process."""
    return all(os.environ.get(name, "0") == "0" for name in RANKS)


def world() -> World:
    """The processes that run a case together. The first call is collective: all ranks make it.

    Raises RunError if MPI is needed and missing, and for ranks of different versions.
    """
    global _known
    if _known is None:
        _known = Alone()
        if may_be_several():
            _known = _of_mpi()
            here = {"version of mesokit": __version__, "byte order": sys.byteorder}
            _known.require_same(lambda: here)
    return _known


def known() -> World:
    """The same without messages: this process alone until `world` has been called."""
    return _known or Alone()


def stay_alone() -> None:
    """Let this process run alone, whatever other ranks do."""
    global _known
    _known = Alone()


def _of_mpi() -> World:
    try:
        from mpi4py import MPI
    except ImportError as error:
        if not is_first():  # rank 0 prints it for all
            raise SystemExit(1) from None
        raise RunError(f"several ranks need mpi4py ({error}): pip install 'mesokit[mpi]'") from None
    if MPI.COMM_WORLD.size == 1:
        return Alone()
    from mesokit.processes.several import Several

    return Several(MPI.COMM_WORLD)
