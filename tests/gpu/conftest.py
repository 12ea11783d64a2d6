"""The compiler for GPUs is not on every system; without it there is nothing to ask."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec("numba_cuda") else ["test_*.py"]
