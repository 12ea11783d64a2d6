"""One kind of solute, and what acts between two kinds."""

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.case.given.file import FileName
from mesokit.method.mpcd import topology as links
from mesokit.method.mpcd.solute.free import linked_parts, problem, read_links
from mesokit.potential import Angle, Bond, Pair


@component
class Polymer:
    """One kind of solute: so many molecules of so many beads; single beads are monomers.

    Mass and potentials are those of all solutes unless it has its own.
    """

    number: int = param(1, doc="molecules of this kind", ge=1)
    length: int = param(1, doc="beads of a molecule; 1: monomers", symbol="N", ge=1, le=1000)
    topology: links.Topology = param("chain", doc="how the beads are linked")
    arms: int | None = param(None, doc="arms of a star, all of one length", ge=1)
    name: str | None = param(
        None,
        doc="what observables and files call this kind, two letters or more (polymer-1, ... unless "
        "said)",
    )
    mass: float | None = param(
        None, doc="mass of its beads (that of all unless said)", unit="m", ge=1e-3, le=1e6
    )
    bond: Bond | None = param(None, doc="potential of its bonds (that of all unless said)")
    bending: Angle | None = param(
        None, doc="stiffness of two of its bonds in a row (that of all unless said)"
    )
    pair: Pair | None = param(
        None, doc="potential of any two of its beads (that of all unless said)"
    )

    bonds: FileName | Many[tuple[int, ...]] | None = param(
        None, doc="pairs of beads, from 0, or a text file of them, with topology = 'free'"
    )
    angles: FileName | Many[tuple[int, ...]] | None = param(
        None, doc="triples of beads that `bending` acts on, or a text file of them"
    )

    def __post_init__(self) -> None:
        if self.topology == "free":  # lists of links that are read once, and make one molecule
            if self.bonds is None:
                raise ValueError("bonds: missing; topology = 'free' needs them")
            for key, columns in (("bonds", 2), ("angles", 3)):
                given = getattr(self, key)
                try:
                    rows = read_links(given, columns) if isinstance(given, str) else given
                except ValueError as error:
                    raise ValueError(f"{key} = {error}") from None
                if wrong := problem(rows or (), self.length, columns):
                    raise ValueError(f"{key}: {wrong}")
                object.__setattr__(self, key, rows)
            parts = linked_parts(self.pairs_of_beads, self.length)
            if parts > 1:
                raise ValueError(
                    f"bonds: they leave {parts} pieces; expected one molecule of {self.length} "
                    "beads (length)"
                )
        elif self.bonds is not None or self.angles is not None:
            key = "angles" if self.bonds is None else "bonds"
            raise ValueError(f"{key}: only with topology = 'free'")
        if self.length == 1:
            if self.topology != "chain" or self.arms is not None:
                raise ValueError(f"topology = {self.topology!r}: a monomer is a chain")
            if self.bond is not None:
                raise ValueError("bond: only with length = 2 or more")
        if self.length < 3 and self.bending is not None:
            raise ValueError("bending: only with length = 3 or more")
        if self.name is not None and (len(self.name) < 2 or not self.name.isprintable()):
            raise ValueError(f"name = {self.name!r}: expected two letters or more")

    @property
    def pairs_of_beads(self) -> links.Links:
        """The bonds that were given."""
        return () if self.bonds is None or isinstance(self.bonds, str) else self.bonds

    @property
    def triples_of_beads(self) -> links.Links:
        """The angles that were given."""
        return () if self.angles is None or isinstance(self.angles, str) else self.angles


@component
class Between:
    """Interactions between the beads of two kinds of solutes."""

    kinds: Many[int | str] = param(
        doc="the two kinds, by name or number from 1", min_length=2, max_length=2
    )
    pair: Pair | None = param(
        None, doc="potential of two beads, one of each (they do not feel one another unless said)"
    )
