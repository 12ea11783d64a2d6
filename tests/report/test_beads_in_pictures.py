"""Polymers over the flow: whole molecules, at both ends of a periodic box, sheared or not."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from mesokit import WCA, Harmonic, Plates
from mesokit.errors import RunError
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.report.flow import animate, picture, usual
from mesokit.report.flow.beads import BeadFrames, look
from mesokit.report.flow.source import sources
from mesokit.report.flow.trajectory_source import FluidBonds
from mesokit.report.style import COLOURS
from tests.helpers.known_flows import MAPS, results_of
from tests.helpers.small_fluids import make_case

RING = Polymer(topology="ring", length=4)
SOLUTES = Solutes((Polymer(2), Polymer(length=3), RING), bond=Harmonic(K=2.0), pair=WCA(sigma=0.8))
SIZE = (12, 10)


class Frames(SimpleNamespace):
    """A trajectory in memory, read as one in a file is."""

    fields, diameter = ("position",), None

    def __len__(self):
        return len(self.frames)

    def __getitem__(self, index):
        return {"position": self.frames[index]}


def trajectory(case, *frames, first=0):
    """Of the beads from the first on, folded into the box."""
    kinds = 1 + np.repeat([0, 1, 2], [2, 3, 4])
    folded = [np.asarray(frame[first:], float) % case.box.size for frame in frames]
    return Frames(
        frames=folded, time=np.arange(len(frames)) * 1.0,
        id=case.particles + np.arange(first, 9), species=kinds[first:],
        mass=np.ones(9 - first),
    )  # fmt: skip


WHOLE = np.array([
    [1, 3], [6, 6],  # monomers
    [11.5, 9.5], [12.3, 10.2], [13, 10.8],  # a chain over a corner
    [4, 4], [5, 4], [5, 5], [4, 5],  # a ring
])  # fmt: skip


DIMERS = Molecule(bond=Harmonic(K=2.0))


@pytest.mark.parametrize("molecule", [None, DIMERS], ids=["particles", "dimers"])
def test_molecules_are_whole_and_repeat_where_they_leave_the_box(molecule):
    """Whatever bonds the fluid around them has."""
    case = make_case(SIZE, density=2, solutes=SOLUTES, molecule=molecule)
    beads = BeadFrames(case, trajectory(case, 0 * WHOLE, WHOLE), ("x", "y")).at()
    np.testing.assert_allclose(beads.places, WHOLE)
    assert beads.kinds.tolist() == [0, 0, 1, 1, 1, 2, 2, 2, 2]
    bonds = sorted(map(tuple, np.sort(beads.bonds).tolist()))
    assert bonds == [(2, 3), (3, 4), (5, 6), (5, 8), (6, 7), (7, 8)]
    assert set(beads.repeats) == {(0, 0), (-12, 0), (0, -10), (-12, -10)}
    assert (beads.time, set(beads.diameters)) == (1.0, {0.8})
    turned = BeadFrames(case, trajectory(case, WHOLE), ("y", "x")).at(0.0)
    np.testing.assert_allclose(turned.places, WHOLE[:, ::-1])


def test_images_above_lie_aside_under_shear():
    """The chain leaves through the upper edge: what is above has slid by 0.05 * 10 * t."""
    case = make_case(SIZE, density=2, solutes=SOLUTES, shear_rate=0.05)
    frames = trajectory(case, WHOLE, WHOLE)
    slid = 0.5
    folded = WHOLE - np.array([slid, 10]) * (WHOLE[:, 1:] >= 10)
    frames.frames[1] = folded % np.array(SIZE)
    beads = BeadFrames(case, frames, ("x", "y")).at()
    np.testing.assert_allclose(beads.places, WHOLE)
    assert (-slid, -10) in set(beads.repeats) and (-slid - 12, -10) in set(beads.repeats)


def test_plates_have_no_images():
    case = make_case(SIZE, density=2, solutes=SOLUTES, walls=[Plates(axis="y")])
    inside = WHOLE - [0, 2]
    beads = BeadFrames(case, trajectory(case, inside), ("x", "y")).at()
    np.testing.assert_allclose(beads.places, inside)
    assert set(beads.repeats) == {(0, 0), (-12, 0)}


def test_a_part_of_the_beads_has_a_part_of_the_bonds():
    case = make_case(SIZE, density=2, solutes=SOLUTES)
    frames = trajectory(case, WHOLE)
    frames.id, frames.species, frames.frames = frames.id[:4], frames.species[:4], [WHOLE[:4] % SIZE]
    assert BeadFrames(case, frames, ("x", "y")).at().bonds.tolist() == [[2, 3]]


@pytest.mark.parametrize("kind", ["speed", "quiver", "four"])
def test_they_are_drawn_over_every_panel(kind):
    """Each kind in a colour of its own, where it is; the corner shows all of the chain."""
    case = make_case(SIZE, observe=MAPS, density=20, solutes=SOLUTES)
    results = results_of(make_case(SIZE, observe=MAPS, density=20))
    figure = picture(case, results, trajectory(case, WHOLE), kind)
    panels = 4 if kind == "four" else 1
    for ax in figure.axes[:panels]:
        places = {}
        for line in ax.lines:
            if line.get_color() in COLOURS:
                places.setdefault(line.get_color(), []).extend(map(tuple, line.get_xydata()))
        chain = sorted(places[COLOURS[3]])
        np.testing.assert_allclose(chain, [(0.3, 0.2), (1.0, 0.8), (11.5, 9.5)])
        assert len(places[COLOURS[1]]) == 2 and len(places[COLOURS[4]]) == 4
    said = " ".join(text.get_text() for text in reversed(figure.texts))
    assert r"solutes at $t=0\,\tau$" in said


def test_beads_alone_are_no_flow():
    """Of beads there are pictures; speed and density of the fluid they do not tell."""
    case = make_case(SIZE, density=2, solutes=SOLUTES)
    frames = trajectory(case, WHOLE)
    assert picture(case, {}, frames, "particles").axes[0].lines
    for kind in ("speed", "density"):
        with pytest.raises(RunError, match="the run kept none of them"):
            picture(case, {}, frames, kind)


def test_kinds_have_a_legend_and_marks_of_their_own():
    """In grey colours look alike."""
    case = make_case(SIZE, density=2, solutes=SOLUTES)
    figure = picture(case, {}, trajectory(case, WHOLE), "particles")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["kind 1", "kind 2", "kind 3"]
    marks = {line.get_color(): line.get_marker() for line in figure.axes[0].lines}
    assert len({marks[colour] for colour in {look(kind, 0, False)[0] for kind in range(3)}}) == 3
    figure.canvas.draw()
    assert legend.get_window_extent().y1 < figure.axes[0].get_window_extent().y0


def test_one_chain_and_the_next_differ_in_grey():
    colours = [look(0, molecule, True)[0] for molecule in range(len(COLOURS))]
    grey = np.array([to_rgb(colour) for colour in colours]) @ [0.299, 0.587, 0.114]
    assert len(set(colours)) == len(COLOURS)
    assert (abs(np.diff(grey)) > 0.13).all()


def test_chains_of_one_kind_are_told_apart_and_those_behind_are_paler():
    chains = Solutes((Polymer(2, length=3),), bond=Harmonic(K=2.0))
    case = make_case((12, 10, 8), density=2, solutes=chains)
    places = [[2, 2, 1], [3, 2, 1], [4, 2, 1], [2, 6, 7], [3, 6, 7], [4, 6, 7]]
    frames = trajectory(make_case(SIZE, density=2, solutes=SOLUTES), WHOLE)
    frames.frames, frames.species = [np.array(places, float)], np.ones(6, int)
    frames.id, frames.mass = case.particles + np.arange(6), np.ones(6)
    beads = BeadFrames(case, frames, ("x", "y")).at()
    assert beads.molecules.tolist() == [0, 0, 0, 1, 1, 1] and beads.names == []
    figure = picture(case, {}, frames, "particles", axes=("x", "y"))
    back, front = (
        line for line in figure.axes[0].lines if len(line.get_xdata()) == 3
    )  # in the order in which they are drawn
    assert set(back.get_ydata()) == {2.0} and set(front.get_ydata()) == {6.0}
    assert front.get_color() == COLOURS[3] and back.get_color() not in COLOURS
    assert figure.legends == []


@pytest.mark.parametrize("rate", [0.0, 0.5])
def test_bonds_of_the_fluid_are_short_and_drawn_at_both_ends_of_the_box(rate):
    """Also where images above and below have slid; particles come in any order."""
    case = make_case((8, 8), density=4 / 64, molecule=DIMERS, shear_rate=rate)
    ids, time = np.array([2, 0, 3, 1]), 0.5
    slid = case.box.displacement(time)
    assert slid == rate * 8 * time
    position = np.array([[3, 7.5], [1, 1], [(3.25 + 8 - slid) % 8, 0.25], [1.5, 1]])
    lines = FluidBonds(case, ids, [0, 1]).at(position, time)
    inside = [[[1, 1], [1.5, 1]]]
    over = [[[3, 7.5], [3.25, 8.25]], [[3 - slid, -0.5], [3.25 - slid, 0.25]]]
    images = (np.array(sorted(lines.tolist())) - np.array(sorted(inside + over)))[..., 0]
    np.testing.assert_allclose(np.sort(lines[..., 1], axis=None), [-0.5, 0.25, 1, 1, 7.5, 8.25])
    np.testing.assert_allclose(images % 8, 0, atol=1e-12)
    assert FluidBonds(case, ids[:1], [0, 1]).at(position[:1], time) is None


@pytest.mark.parametrize(("number", "drawn"), [(40, True), (4000, False)])
def test_bonds_of_the_fluid_are_drawn_where_they_are_few(number, drawn):
    case = make_case((8, 8), density=number / 64, molecule=DIMERS)
    r = np.random.default_rng(1).uniform(0, 8, (number, 2))
    frames = Frames(
        frames=[r], time=np.zeros(1), id=np.arange(number), species=np.zeros(number, int),
        mass=np.ones(number),
    )  # fmt: skip
    axes = picture(case, {}, frames, "particles").axes[0]
    assert bool(axes.collections) == drawn


def test_a_film_of_a_run_that_kept_solutes_alone_shows_them(tmp_path):
    """And a picture: the usual kinds need velocities that are not there."""
    case = make_case(SIZE, density=2, solutes=SOLUTES)
    film = animate(case, {}, trajectory(case, WHOLE, WHOLE + 0.5, WHOLE + 1), tmp_path / "a.gif")
    assert film.frames == 3
    assert len(picture(case, {}, trajectory(case, WHOLE)).axes) == 1
    with pytest.raises(RunError, match="this picture needs velocities, and the run kept none"):
        picture(case, {}, trajectory(case, WHOLE), "speed")
    with pytest.raises(RunError, match=r'^speed: this picture needs velocities in time.*"flow-fr'):
        animate(case, {}, None, tmp_path / "b.gif")


def test_kinds_that_a_run_has_kept_come_first():
    case = make_case(SIZE, density=2, observe=MAPS)
    found = sources(case, results_of(case), None)
    assert usual(case, found, "four", in_time=False) == "speed"  # it kept no particles
    assert usual(case, found[1:], "four", in_time=False) == "density"
