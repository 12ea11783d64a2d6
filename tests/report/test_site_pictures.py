"""Pictures and films of the sites of a lattice: what stands in them is what the frames have."""

from __future__ import annotations

import imageio_ffmpeg
import numpy as np
import pytest
from matplotlib.collections import PolyCollection, QuadMesh
from matplotlib.path import Path as Outline

from mesokit import Box, Case, CaseError, Run, RunError
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.report.flow import animate, picture
from mesokit.report.flow.heights import faces
from mesokit.report.flow.oblique import RIGHT, TOWARDS, UP, projected
from mesokit.report.flow.palette import colours
from tests.helpers.lattices import lattice_case

ROOT = 0.75**0.5
GAS = LatticeGas(
    species=("empty", "A", "B"),
    process=(GasProcess(name="on", site="empty -> A", rate=1.0),),
)


class Frames:
    """Frames of sites, as a trajectory has them."""

    fields, diameter = ("site",), None

    def __init__(self, states, time=None):
        self.states = np.asarray(states)
        count = len(self.states)
        self.time = np.arange(count, dtype=float) if time is None else np.asarray(time, float)
        self.id = np.arange(self.states[0].size)

    def __len__(self):
        return len(self.states)

    def __getitem__(self, index):
        return {"site": self.states[index].ravel()}


def drawn(sites, model, kind_of_lattice="square", kind=None, time=None, **given):
    """A picture of sites (frames, sites along each axis)."""
    lattice = {key: given.pop(key) for key in ("ends",) if key in given}
    frames = Frames(sites, time)
    case = lattice_case(frames.states.shape[1:], model, kind_of_lattice, **lattice)
    return picture(case, {}, frames, kind, **given)


def spins(*shape):
    return np.random.default_rng(3).integers(0, 2, shape)


def bin_at(image, x, y):
    """The number that a picture shows at places."""
    values = np.asarray(image.get_array())
    left, right, low, high = image.get_extent()
    ny, nx = values.shape
    columns = ((np.asarray(x) - left) / (right - left) * nx).astype(int)
    rows = ((np.asarray(y) - low) / (high - low) * ny).astype(int)
    return values[rows, columns]


# places of sites (i, j) in the middle of their patches, from the definition of each lattice
PLACES = {
    "square": lambda i, j: (i + 0.5, j + 0.5),
    "triangular": lambda i, j: (i + 0.25 + 0.5 * (j % 2), ROOT * (j + 0.5)),
    "honeycomb": lambda i, j: (ROOT * (i + 0.5), 1.5 * j + 1.0 - 0.5 * ((i + j) % 2)),
}


@pytest.mark.parametrize("kind", PLACES)
def test_each_site_has_its_colour_at_its_place(kind):
    states = spins(2, 8, 6)
    figure = drawn(states, Ising(), kind)
    ax, bar = figure.axes
    (image,) = ax.images
    i, j = np.indices((8, 6))
    x, y = PLACES[kind](i, j)
    np.testing.assert_array_equal(bin_at(image, x, y), states[-1])
    for dx, dy in ((0.3, 0.0), (-0.3, 0.0), (0.0, 0.2), (0.0, -0.2)):  # within its patch
        left, right, low, high = image.get_extent()
        inside = (x + dx > left) & (x + dx < right) & (y + dy > low) & (y + dy < high)
        found = bin_at(image, (x + dx)[inside], (y + dy)[inside])
        np.testing.assert_array_equal(found, states[-1][inside])
    assert [text.get_text() for text in bar.get_yticklabels()] == ["down", "up"]
    assert any(text.get_text() == "$t = 1$" for text in figure.texts)
    assert ax.get_xlabel() == "$x$  [$a$]"


def test_a_lattice_that_ends_shows_its_shifted_rows_whole():
    states = spins(1, 8, 6)
    (image,) = drawn(states, Ising(), "triangular", ends=("x",)).axes[0].images
    i, j = np.indices((8, 6))
    assert image.get_extent()[:2] == [0, 8.5]
    found = bin_at(image, i + 0.5 + 0.5 * (j % 2), ROOT * (j + 0.5))
    np.testing.assert_array_equal(found, states[0])


def test_a_layer_of_three_axes_is_named():
    states = spins(1, 4, 6, 8)
    figure = drawn(states, Ising(), "cubic", "sites", axes=("z", "x"), at=5.5)
    (image,) = figure.axes[0].images
    k, i = np.indices((8, 4))
    np.testing.assert_array_equal(bin_at(image, k + 0.5, i + 0.5), states[0, :, 5, :].T)
    assert any(text.get_text() == "layer 6 of 6 along $y$" for text in figure.texts)
    with pytest.raises(CaseError, match=r"at = 6\.5: expected a place from 0 to 6"):
        drawn(states, Ising(), "cubic", "sites", axes=("z", "x"), at=6.5)


def test_heights_on_a_map_are_those_about_their_mean():
    heights = 100 + np.arange(12).reshape(1, 4, 3)
    figure = drawn(heights, Family(), kind="sites")
    (image,) = figure.axes[0].images
    np.testing.assert_allclose(np.asarray(image.get_array()).T, heights[0] - 105.5)
    assert image.get_clim() == (-5.5, 5.5)


def test_space_time_has_a_row_for_each_frame_and_time_runs_down():
    states = spins(4, 10)
    figure = drawn(states, Ising(), "chain", time=[0.0, 1.0, 2.0, 6.0])
    ax, bar = figure.axes
    (mesh,) = [part for part in ax.get_children() if isinstance(part, QuadMesh)]
    np.testing.assert_array_equal(np.asarray(mesh.get_array()).reshape(4, 10), states)
    assert mesh.get_coordinates()[:, 0, 1].tolist() == [0, 1, 2, 6, 10]
    assert ax.get_ylim() == (10, 0) and ax.get_xlim() == (0, 10)
    assert ax.get_title() == "$t = 0$ to $t = 6$"
    assert [text.get_text() for text in bar.get_yticklabels()] == ["down", "up"]
    late = drawn(states, Ising(), "chain", time=[0.0, 1.0, 2.0, 6.0], window=(1, 2)).axes[0]
    assert late.get_ylim() == (3, 1)


def test_profiles_are_heights_at_several_times():
    heights = np.arange(101)[:, None] + spins(101, 12)
    shown = {}
    for time in ("linear", "log"):
        case, frames = lattice_case((12,), Family(), "chain"), Frames(heights)
        (ax,) = picture(case, {}, frames, time=time).axes
        lines = ax.get_lines()
        shown[time] = [int(line.get_label().strip("$").removeprefix("t = ")) for line in lines]
        assert "less its mean" in ax.get_ylabel()  # they are apart by many widths
        for row, line in zip(shown[time], lines, strict=True):
            np.testing.assert_allclose(line.get_ydata()[:-1], heights[row] - heights[row].mean())
            assert line.get_drawstyle() == "steps-post" and line.get_xdata()[-1] == 12
    assert shown["linear"] == [0, 20, 40, 60, 80, 100]
    assert shown["log"][0] == 0 and shown["log"][-1] == 100
    ratios = np.diff(np.log(shown["log"][1:]))
    assert ratios.min() > 0.5 * ratios.max()  # about as far apart, with whole times


def test_profiles_of_a_surface_that_has_hardly_grown_are_its_heights():
    heights = np.arange(6)[:, None] + 5 * spins(6, 12)
    (ax,) = picture(lattice_case((12,), Family(), "chain"), {}, Frames(heights)).axes
    assert "less" not in ax.get_ylabel()
    for row, line in zip(range(6), ax.get_lines(), strict=True):
        np.testing.assert_array_equal(line.get_ydata()[:-1], heights[row])


def test_what_is_drawn_last_is_what_the_eye_meets_first():
    """Columns along many rays, against a walk along each ray from the eye."""
    heights = np.random.default_rng(5).integers(1, 5, (5, 4)).astype(float)
    corners, column, _ = faces(heights, (1.0, 1.0))
    outlines = [Outline(flat) for flat in projected(corners.reshape(-1, 3)).reshape(-1, 4, 2)]
    rays = np.random.default_rng(6).uniform((0.2, -1.5), (6.0, 5.0), (300, 2))
    met, seen = [], []
    s = np.linspace(12, -12, 4001)[:, None]
    for u, v in rays:
        over = [k for k, outline in enumerate(outlines) if outline.contains_point((u, v))]
        seen.append(column[over[-1]] if over else -1)
        x, y, z = (u * RIGHT + v * UP + s * TOWARDS).T
        i, j = np.floor(x).astype(int), np.floor(y).astype(int)
        here = (i >= 0) & (i < 5) & (j >= 0) & (j < 4) & (z >= 0)
        here[here] = z[here] <= heights[i[here], j[here]]
        first = np.flatnonzero(here)[:1]
        met.append(int(i[first[0]] * 4 + j[first[0]]) if len(first) else -1)
    met, seen = np.array(met), np.array(seen)
    assert (met >= 0).sum() > 100
    assert (met == seen).mean() > 0.98  # but for rays along edges


def test_a_surface_is_exaggerated_by_a_number_that_stands_above():
    heights = spins(3, 32, 32) + 7
    figure = drawn(heights, Family(), kind="heights")
    ax = figure.axes[0]
    assert ax.get_title() == (
        rf"$t = 2$, mean height {heights[-1].mean():.4g}, heights $\times\,2$"
    )
    (columns,) = [part for part in ax.get_children() if isinstance(part, PolyCollection)]
    high = columns.get_facecolor()[:, 0].max()
    fills = columns.get_facecolor()
    tops = fills[:, 0] == high
    assert tops.sum() == heights[-1].sum() - 7 * 32 * 32  # light ones are high
    texts = [text.get_text() for text in ax.texts]
    assert {"$x$  [$a$]", "$y$  [$a$]", "height  [$a$]"} <= set(texts)


def test_balls_are_at_occupied_sites_alone():
    states = np.zeros((1, 4, 4, 4), int)
    states[0, 1, 2, 3], states[0, 3, 0, 0] = 1, 2
    alphas = {}
    for names in (None, ("A",), ("B",)):
        figure = drawn(states, GAS, "cubic", "occupied", states=names)
        ax = figure.axes[0]
        (image,) = ax.images
        alphas[names] = np.asarray(image.get_array())[..., 3] / 255
        left, right, low, high = image.get_extent()
    area = (right - left) * (high - low) / alphas[None].size
    ny, nx = alphas[None].shape
    for names, site in ((("A",), (1, 2, 3)), (("B",), (3, 0, 0))):
        alpha = alphas[names]
        assert alpha.sum() * area == pytest.approx(np.pi / 4, rel=0.02)  # one disk
        x, y = np.meshgrid(
            left + (np.arange(nx) + 0.5) * (right - left) / nx,
            low + (np.arange(ny) + 0.5) * (high - low) / ny,
        )
        middle = [(alpha * x).sum() / alpha.sum(), (alpha * y).sum() / alpha.sum()]
        np.testing.assert_allclose(middle, projected(np.array([site]))[0], atol=0.02)
    assert alphas[None].sum() == pytest.approx(alphas["A",].sum() + alphas["B",].sum())
    assert "2 of 64 sites" in drawn(states, GAS, "cubic", "occupied").axes[0].get_title()


def test_a_film_has_frames_at_geometric_times(tmp_path):
    frames = Frames(spins(21, 6, 6))
    case = lattice_case((6, 6), Ising())
    assert animate(case, {}, frames, tmp_path / "all.gif", window=(0, 2)).frames == 3
    film = animate(case, {}, frames, tmp_path / "log.mp4", time="log", window=(10, 20))
    # of 24 in a decade the last stored ones, each once
    times = 10 * 2.0 ** (np.arange(9) / 8)
    wanted = set(np.floor(times + 1e-6).astype(int).tolist())
    assert film.frames == len(wanted) < 9
    count, _ = imageio_ffmpeg.count_frames_and_secs(str(film.path))
    assert count == len(wanted)


def test_surfaces_and_balls_move_in_films(tmp_path):
    frames = Frames(np.arange(2)[:, None, None] + spins(2, 8, 8))
    film = animate(lattice_case((8, 8), Family()), {}, frames, tmp_path / "a.gif", "heights")
    assert film.frames == 2
    frames = Frames(spins(2, 4, 4, 4))
    film = animate(lattice_case((4, 4, 4), Ising(), "cubic"), {}, frames, tmp_path / "b.gif")
    assert film.frames == 2


PLANE, CHAIN, SPACE = spins(2, 8, 8), spins(2, 8), spins(2, 4, 4, 4)


@pytest.mark.parametrize(
    "states, model, lattice, given, words",
    [
        (PLANE, Ising(), "square", {"kind": "space-time"}, "states on a plane; expected 'sites'$"),
        (PLANE, Ising(), "square", {"kind": "heights"}, "states on a plane; expected 'sites'$"),
        (PLANE, Family(), "square", {"kind": "profiles"}, "heights on a plane; expected"),
        (CHAIN, Family(), "chain", {"kind": "heights"}, "on a chain; expected .space-time. or"),
        (CHAIN, Ising(), "chain", {"kind": "profiles"}, "on a chain; expected .space-time.$"),
        (SPACE, Ising(), "cubic", {"kind": "occupied", "states": ["A"]}, "'down' or 'up'"),
        (PLANE, Ising(), "square", {"kind": "occupied"}, "on a plane; expected 'sites'$"),
        (PLANE, Ising(), "square", {"states": ["up"]}, "states = .* not with this kind"),
        (CHAIN, Ising(), "chain", {"states": ["up"]}, "states = .* expected 'occupied'"),
        (SPACE, Ising(), "cubic", {"region": ((0, 2), (0, 2))}, "region = .* not with kind 'occ"),
        (CHAIN, Family(), "chain", {"time": "logarithmic"}, "time = .* 'linear' or 'log'"),
        (PLANE, Ising(), "square", {"kind": "particles"}, "on a plane; expected 'sites'$"),
        (CHAIN, Ising(), "chain", {"kind": "sites"}, "on a chain; expected 'space-time'$"),
        (SPACE, Ising(), "cubic", {"kind": "four"}, "space; expected 'sites' or 'occupied'"),
        (PLANE, Ising(), "square", {"at": 1.0}, "at = 1: this lattice has no third axis"),
        (PLANE, Ising(), "square", {"kind": "hights"}, "did you mean 'heights'"),
    ],
)  # fmt: skip
def test_what_a_lattice_does_not_have_is_refused(states, model, lattice, given, words):
    frames = Frames(states)
    case = lattice_case(states.shape[1:], model, lattice)
    with pytest.raises(CaseError, match=words) as error:
        picture(case, {}, frames, **given)
    assert "\n" not in str(error.value)


def test_films_and_runs_that_have_nothing_to_draw(tmp_path):
    case = lattice_case((8,), Ising(), "chain")
    with pytest.raises(CaseError, match="one picture of all times; expected 'sites', 'profiles'"):
        animate(case, {}, Frames(CHAIN), tmp_path / "a.gif")
    with pytest.raises(RunError, match=r'run it again: \[trajectory\] with fields = \["site"\]'):
        picture(case, {}, None)
    fluid = Case(run=Run(steps=1), box=Box([8, 8]))
    with pytest.raises(CaseError, match="kind = 'heights': method 'mpcd' has no lattice"):
        picture(fluid, {}, None, "heights")


def test_colours_of_states_differ_in_grey():
    for number in (2, 3, 4):
        grey = colours(number)(np.arange(number))[:, :3] @ [0.299, 0.587, 0.114]
        assert (np.diff(grey) < -0.15).all()
