"""The frames of a run that has ended."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.io import h5md, hdf5
from mesokit.io.contact_records import FIELD
from mesokit.io.h5md_contacts import contacts_of, has_contacts


class TrajectoryReader:
    """Frames of the particles: `reader[i]` is a dictionary, `reader.read("position")` all frames.

    Particles are in the order of `id`. In 2D the third column that the file carries is left out,
    and spins are about it. `diameter` (n,) is that of spheres, None of other particles. Contacts of
    a frame are records, see `mesokit.io.contact_records`: `reader[i]["contact"]["force"]`.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        with hdf5.opened(path) as file:
            group = h5md.particles_of(file)
            self.fields: tuple[str, ...] = ()
            self.dimension = 0
            if group is None:
                return
            self.dimension = int(group.attrs["dimension"])
            self.fields = tuple(name for name in h5md.FIELDS if name in group)
            self.fields += (FIELD,) * has_contacts(file)
            self.step: NDArray[np.int64] = group["box/edges/step"][()]
            self.time: NDArray[np.float64] = group["box/edges/time"][()]
            self.edges: NDArray[np.float64] = group["box/edges/value"][()]
            self.id: NDArray[np.int64] = group["id"][()]
            self.mass: NDArray[np.float64] = group["mass"][()]
            self.species: NDArray[np.int64] = group["species"][()]
            radius = group["radius"][()] if "radius" in group else None
            self.diameter: NDArray[np.float64] | None = None if radius is None else 2 * radius

    def __len__(self) -> int:
        return len(self.step)

    def __getitem__(self, index: int) -> dict[str, NDArray[Any]]:
        """The fields of one frame, with `step` and `time`."""
        if not -len(self) <= index < len(self):
            raise IndexError(f"frame {index} of {len(self)}")
        index %= len(self)
        frame = {name: self.read(name, slice(index, index + 1))[0] for name in self.fields}
        return frame | {"step": self.step[index], "time": self.time[index]}

    def read(self, field: str, frames: slice = slice(None)) -> Any:
        """One field of some or all frames, (frames, n, d), spins of disks and sites (frames, n).

        Contacts are a list of records, frame by frame, since their number differs.
        Raises KeyError if it is not there.
        """
        if field not in self.fields:
            raise KeyError(f"no field {field!r}; there are {', '.join(self.fields)}")
        with hdf5.opened(self.path) as file:
            if field == FIELD:
                picked = range(len(self))[frames]
                return [contacts_of(file, index, self.dimension) for index in picked]
            data = h5md.particles_of(file)[f"{field}/value"]
            return h5md.in_frames(data, frames, field, self.dimension)

    def __repr__(self) -> str:
        what = "sites" if self.fields == ("site",) else "particles"
        return (
            f"trajectory: {len(self)} frames of {len(self.id)} {what}"
            f" ({', '.join(self.fields) or 'ids only'})"
        )
