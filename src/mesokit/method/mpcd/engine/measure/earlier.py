"""The particles of a checkpoint, row by row, as readings of the fluid that wrote it."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mesokit.method.mpcd.engine.beads.readings import fold_beads
from mesokit.method.mpcd.engine.cpu.numbers import Floats, Numbers
from mesokit.method.mpcd.engine.measure.readings import between


class EarlierRows:
    """Positions of whole molecules, or velocities (n, d), of a state, made when first read.

    `state` has its arrays by name, which may lie in a file. Raises ValueError if they are not those
    of this fluid.
    """

    def __init__(self, numbers: Numbers, state: Mapping[str, Any], name: str) -> None:
        self.numbers, self.state, self.name = numbers, state, name
        self.shape, self.dtype = (numbers.n, numbers.dimension), np.dtype(float)
        for array in ("positions", "velocities", "images"):
            if state[array].shape != self.shape:
                raise ValueError(f"{array} of shape {state[array].shape}, not {self.shape}")
        time = int(state["step"]) * numbers.timestep
        self.box = numbers.case.box.kernel(numbers.closed, time, numbers.timestep)

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, rows: slice) -> Floats:
        first, last, _ = rows.indices(len(self))
        beads = self.numbers.beads
        start, end = first // beads * beads, -(-last // beads) * beads
        names = ("positions", "velocities", "images")
        r, v, image = (np.array(self.state[name][start:end]) for name in names)
        crossed, zero = np.zeros(r.shape), (0.0,) * r.shape[1]
        fold_beads(self.box, r.reshape(-1), v.reshape(-1), crossed.reshape(-1), zero)
        image = image + crossed.astype(np.int32)
        found = {"positions": r, "velocities": v}[self.name]
        if self.name == "positions" and beads > 1:
            leader = np.repeat(np.arange(0, len(r), beads), beads)
            separation = between(r, image, leader, np.arange(len(r)), self.numbers.box, self.box)
            found = r[leader] + separation
        return found[first - start : last - start]
