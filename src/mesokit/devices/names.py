"""Names of devices, for what must not load one."""

CPU = "cpu"  # the threads of a processor: no device
NAMES = (CPU, "cuda", "emulated", "host")
