"""The compiler for GPUs is not on every system; without it there is nothing to ask."""

from importlib.util import find_spec

NEEDS_IT = [
    "test_gpu.py",
    "test_devices.py",
    "test_runs_on_devices.py",
    "test_same_bits_on_devices.py",
]
collect_ignore = [] if find_spec("numba_cuda") else NEEDS_IT
