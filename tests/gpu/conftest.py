"""The compiler for GPUs is not on every system; without it there is nothing to ask."""

from importlib.util import find_spec

collect_ignore = [] if find_spec("numba_cuda") else ["test_gpu.py"]
