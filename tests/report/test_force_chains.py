"""Lines between grains that touch are as wide as their forces."""

from __future__ import annotations

import re

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, LineCollection
from PIL import Image

import mesokit
from mesokit import Box, Case, CaseError, Plates, Run, RunError, Simulation, SoftSpheres
from mesokit.case.trajectory import Trajectory
from mesokit.io.contact_records import kind_of
from mesokit.report.flow import animate, picture
from mesokit.report.flow.force_chains import LARGE, LINE, PULL, THIN, WIDE
from mesokit.report.flow.kinds import usual
from mesokit.report.flow.source import sources
from tests.helpers.grains import grains
from tests.report.test_spheres_in_pictures import frames_of

KEPT = Trajectory(every=1, fields=["position", "contact"])


def case_of(size, number, **more):
    return Case(
        run=Run(1, method="soft-spheres"), box=Box(size), spheres=SoftSpheres(number=number),
        trajectory=KEPT, walls=[Plates("xyz"[len(size) - 1])], **more,
    )  # fmt: skip


def records(*rows):
    """Contacts: pair, normal, force along it and across, gap 0."""
    d = len(rows[0][1])
    found = np.zeros(len(rows), kind_of(d, float))
    for k, (pair, normal, along, across) in enumerate(rows):
        found["pair"][k], found["normal"][k] = pair, normal
        turned = np.zeros(d)
        turned[:2] = -normal[1], normal[0]
        found["force"][k] = along * np.array(normal) + across * turned
    return found


def with_contacts(position, *rows):
    """A trajectory of one frame, or of a frame for each list of rows."""
    frames = frames_of(position)
    frames.fields = ("position", "contact")
    several = [rows] if isinstance(rows[0], tuple) else rows
    frames.contact = [records(*each) for each in several]
    return frames


STACK = [[2.0, 0.5], [2.0, 1.5], [7.9, 1.5]]
UP = ((1, 0), (0.0, 1.0), 1.0, 9.0)
DOWN = ((0, -1), (0.0, 1.0), 2.0, 0.0)


def lines_of(figure):
    """Of all lines between grains: ends, width in points, colour and dashes."""
    found = []
    for drawn in figure.axes[0].collections:
        if isinstance(drawn, LineCollection) and len(drawn.get_segments()):
            dashed = drawn.get_linestyle()[0][1] is not None
            colour = tuple(drawn.get_colors()[0][:3])
            rows = zip(drawn.get_segments(), drawn.get_linewidths(), strict=True)
            found += [(ends, wide, colour, dashed) for ends, wide in rows]
    return found


def key_of(figure):
    return next(text.get_text() for text in figure.axes[0].texts if text.get_text())


def test_lines_join_centres_and_walls_as_wide_as_normal_forces():
    figure = picture(case_of([8, 5], 3), {}, with_contacts(STACK, UP, DOWN), "force-chains")
    lines = {tuple(np.round(ends.ravel(), 9)): wide for ends, wide, _, _ in lines_of(figure)}
    above, below = (2.0, 1.5, 2.0, 0.5), (2.0, 0.5, 2.0, 0.0)
    assert {above, below} <= set(lines)
    # friction, here much larger than the normal force, changes no width
    assert lines[below] == pytest.approx(2 * lines[above])
    ax = figure.axes[0]
    points = 72 * ax.get_position().width * figure.get_size_inches()[0] / np.ptp(ax.get_xlim())
    assert lines[above] == pytest.approx(WIDE / LARGE / (3 / 3) * points)  # sum 3 over 3 disks
    assert "$1.5$" in key_of(figure)
    (bar,) = ax.lines[-1:]
    assert bar.get_linewidth() == pytest.approx(1.5 * lines[above])
    disks = [c for c in ax.collections if isinstance(c, EllipseCollection)]
    assert len(disks[-1].get_offsets()) == 4  # that at the edge twice


def test_a_contact_over_an_edge_is_drawn_at_both():
    across = ((0, 1), (1.0, 0.0), 1.0, 0.0)  # from the image of 1 on the left of 0
    frames = with_contacts([[0.4, 2.0], [7.4, 2.0]], across)
    figure = picture(case_of([8, 5], 2), {}, frames, "force-chains")
    found = sorted(tuple(np.round(ends.ravel(), 9)) for ends, *_ in lines_of(figure))
    assert (0.4, 2.0, -0.6, 2.0) in found
    assert (8.4, 2.0, 7.4, 2.0) in found


def test_contacts_that_pull_are_dashed():
    pull = ((1, 0), (0.0, 1.0), -1.0, 0.0)
    figure = picture(case_of([8, 5], 3), {}, with_contacts(STACK, pull, DOWN), "force-chains")
    looks = {dashed: colour for _, _, colour, dashed in lines_of(figure)}
    assert looks == {
        True: mpl.colors.to_rgb(PULL),
        False: mpl.colors.to_rgb(LINE),
    }
    assert "$2$" in key_of(figure)  # the mean of those that push
    assert key_of(figure).endswith("dashed: pull")
    none = with_contacts(STACK, UP)
    none.contact = [none.contact[0][:0]]
    empty = picture(case_of([8, 5], 3), {}, none, "force-chains")
    assert key_of(empty) == "no contacts"
    assert lines_of(empty) == []


def test_in_space_lines_are_paler_at_the_back_and_cut_at_a_plane():
    places = [[2.0, 1.0, 0.5], [2.0, 1.0, 1.5], [4.0, 7.0, 0.5], [4.0, 7.0, 1.5]]
    rows = [((k, k + 1), (0.0, 0.0, -1.0), 1.0, 0.0) for k in (0, 2)]
    case, frames = case_of([8, 8, 5], 4), with_contacts(places, *rows)
    figure = picture(case, {}, frames, "force-chains", axes=("x", "z"))
    shades = {round(float(ends[0, 0])): sum(colour) for ends, _, colour, _ in lines_of(figure)}
    assert shades[4] > shades[2] + 0.5  # x, z: the eye is at y = 0
    (wide, *_) = {round(wide, 6) for _, wide, _, _ in lines_of(figure)}
    ax = figure.axes[0]
    points = 72 * ax.get_position().width * figure.get_size_inches()[0] / np.ptp(ax.get_xlim())
    assert wide == pytest.approx(THIN * WIDE / LARGE / 0.5 * points, rel=1e-5)
    cut = picture(case, {}, frames, "force-chains", axes=("x", "z"), at=4.0)
    assert {round(float(ends[0, 0])) for ends, *_ in lines_of(cut)} == {4}


def test_it_is_the_usual_picture_where_contacts_are_kept():
    case, frames = case_of([8, 5], 3), with_contacts(STACK, UP)
    assert usual(case, sources(case, {}, frames), "four", in_time=False) == "force-chains"
    bare = grains(fields=("position",))
    assert bare.groups[0].picture == "disks"


def test_a_film_has_one_scale_and_a_key_in_each_frame(tmp_path):
    frames = with_contacts([STACK, STACK], [UP], [UP, DOWN])
    case = case_of([8, 5], 3)
    film = animate(case, {}, frames, tmp_path / "a.gif")
    assert film.frames == 2
    with Image.open(film.path) as image:
        first = np.asarray(image.convert("L"), float)
        image.seek(1)
        second = np.asarray(image.convert("L"), float)
    assert np.abs(first - second).max() > 100  # the line to the floor


def test_the_state_of_an_engine_has_chains():
    simulation = Simulation(grains(warmup=0, trajectory=False), threads=1)
    simulation.run()
    figure = simulation.flow("force-chains")
    forces = simulation.engine.contacts().normal_forces
    (mean,) = re.findall(r"\$(.*?)\$", key_of(figure))[:1]
    assert float(mean) == pytest.approx(forces[forces > 0].mean(), rel=1e-2)
    assert len(lines_of(figure)) >= len(forces)


def test_pictures_that_cannot_be(tmp_path):
    hard = Case(run=Run(1, method="event-driven"), box=Box([8, 8]))
    with pytest.raises(CaseError, match="'event-driven' have no contacts that last; expected"):
        picture(hard, {}, frames_of([[1.0, 1.0]]), "force-chains")
    bare = grains(fields=("position",))
    with pytest.raises(RunError, match=r'\[trajectory\] with fields = \["position", "contact"\]'):
        picture(bare, {}, frames_of(np.zeros((60, 2))), "force-chains")
    with pytest.raises(CaseError, match="colour = 'speed': not with kind 'force-chains'"):
        picture(bare, {}, frames_of(np.zeros((60, 2))), "force-chains", colour="speed")
    with pytest.raises(CaseError, match="did you mean 'force-chains'"):
        picture(bare, {}, frames_of(np.zeros((60, 2))), "force-chain")
    assert mesokit.report.flow.NAMES.count("force-chains") == 1
