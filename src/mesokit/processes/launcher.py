"""Number and rank of this process, from the environment that an MPI launcher sets.

MPI itself is loaded only where there are several processes, as that takes time.
"""

import os
import sys

# how many ranks there are, and which of them this is: of MPICH, Intel MPI, MS-MPI and Slurm with
# PMI-2; of Open MPI; of MVAPICH
SIZES = ("PMI_SIZE", "OMPI_COMM_WORLD_SIZE", "MV2_COMM_WORLD_SIZE")
RANKS = ("PMI_RANK", "OMPI_COMM_WORLD_RANK", "MV2_COMM_WORLD_RANK", "PMIX_RANK")


def several() -> bool:
    """Whether this may be one of several ranks: a launcher says so, or the script uses MPI."""
    if "mpi4py.MPI" in sys.modules:
        return True
    said = [os.environ[name] for name in SIZES if name in os.environ]
    if said:
        return any(size != "1" for size in said)
    # PMIx does not say how many; Slurm does
    return "PMIX_RANK" in os.environ and os.environ.get("SLURM_STEP_NUM_TASKS") != "1"


def first() -> bool:
    """Whether this is rank 0, or alone."""
    return all(os.environ.get(name, "0") == "0" for name in RANKS)
