"""A case survives being written and read, and all that the package ships is valid."""

from __future__ import annotations

import dataclasses
import pickle
import typing
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit import (
    AT,
    SRD,
    ATPlusA,
    Box,
    Case,
    CaseError,
    Conservation,
    Fluid,
    MaxwellBoltzmann,
    NoForce,
    NoThermostat,
    OtherFluid,
    Plates,
    Rescale,
    Run,
    Sinusoidal,
    Species,
    SphereBody,
    SRDPlusA,
    Start,
    Surface,
    Trajectory,
    Uniform,
    Units,
    VelocityProfile,
    Water,
)
from mesokit.case.component import is_component
from mesokit.case.methods import templates
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.numbers import Derived
from mesokit.seam.method import method_of

positive = st.floats(1e-3, 1e3)
small = st.floats(-1.0, 1.0)
texts = st.text(st.characters(exclude_categories=("Cs",)), max_size=20)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Valid cases of every kind."""
    dimension = draw(st.sampled_from([2, 3]))
    vector = st.tuples(*[small] * dimension)
    size = tuple(draw(st.integers(2, 30)) for _ in range(dimension))
    held = draw(st.booleans())
    angle = st.floats(0.1, 179.9)
    collision = draw(
        st.sampled_from([AT(), ATPlusA()]) if held
        else st.one_of(st.builds(SRD, angle=angle), st.builds(SRDPlusA, angle=angle))
    )  # fmt: skip
    thermostat = (
        NoThermostat() if held
        else draw(st.sampled_from([NoThermostat(), MaxwellBoltzmann(), Rescale()]))
    )  # fmt: skip
    walled = draw(st.booleans())
    force = draw(
        st.one_of(
            st.just(NoForce()),
            st.builds(Uniform, acceleration=vector),
            st.builds(Sinusoidal, amplitude=small, waves=st.integers(1, 4)),
        )
    )
    along = tuple(0.0 if i == 1 else draw(small) for i in range(dimension))
    surface = st.sampled_from([Surface(), Surface(rule="slip"), Surface(velocity=along)])
    kinds = st.builds(Species, mass=positive, density=st.floats(1, 100))
    species = draw(st.lists(kinds, max_size=3))
    names = draw(st.lists(st.from_regex("[a-z][a-z0-9-]{0,8}", fullmatch=True), unique=True))
    return Case(
        title=draw(texts),
        run=Run(
            steps=draw(st.integers(0, 10**12)),
            warmup=draw(st.integers(0, 10**6)),
            seed=draw(st.integers(0, 2**56 - 1)),
            checkpoint_minutes=draw(positive),
            checkpoint_every=draw(st.none() | st.integers(1, 10**6)),
        ),
        box=Box(
            size, shear_rate=0.0 if walled or not isinstance(force, NoForce) else draw(small)
        ),
        fluid=Fluid(
            timestep=draw(st.floats(1e-5, 1e-2)), kT=draw(positive),
            collision=collision, thermostat=thermostat, force=force, species=tuple(species),
            grid_shift=draw(st.floats(0, 1)),
            start=draw(st.sampled_from([Start(), Start(run="/a b"), Start(positions='/c"\\d')])),
            **({} if species else {"density": draw(st.floats(1, 100)), "mass": draw(positive)}),
        ),
        walls=(Plates(axis="y", lower=draw(surface), upper=draw(surface)),) if walled else (),
        observe=tuple(
            draw(st.sampled_from([Conservation(name=n), VelocityProfile(name=n, axis="x")]))
            for n in names
        ),
        trajectory=draw(st.none() | st.builds(Trajectory, every=st.integers(1, 100))),
        units=draw(st.none() | st.builds(
            Units, cell=st.floats(1e-9, 1), match=st.just("thermal"),
            fluid=st.sampled_from([Water(), Water(300), OtherFluid(1.2, 1.8e-5, 293)]),
            depth=st.none() | st.floats(1e-9, 1) if dimension == 2 else st.none(),
        )),
    )  # fmt: skip


@given(cases())
def test_written_and_read_a_case_is_the_same(tmp_path_factory: typing.Any, case: Case) -> None:
    path = tmp_path_factory.getbasetemp() / "round-trip.toml"
    path.write_text(case.to_toml(), encoding="utf-8")
    again = Case.from_toml(path)
    assert again == case
    assert again.to_toml() == case.to_toml()
    derive(case, 2)  # whatever is valid has derived numbers


@pytest.mark.parametrize(("keys", "virtual"), [
    ({}, "fill"), ({"virtual": "none"}, "none"), ({"surface": "slip"}, "none"),
    ({"surface": "slip", "virtual": "none"}, "none"),
])  # fmt: skip
def test_bodies_keep_what_fills_them(tmp_path: Path, keys: dict[str, str], virtual: str) -> None:
    """A slip surface has no virtual particles, whether it says so or not."""
    body = SphereBody(radius=3, **keys)
    assert body.virtual == virtual and dataclasses.replace(body) == body
    case = Case(run=Run(1), box=Box([16, 16, 16]), fluid=Fluid(), bodies=[body])
    (tmp_path / "case.toml").write_text(case.to_toml())
    again = Case.from_toml(tmp_path / "case.toml")
    assert again == case == pickle.loads(pickle.dumps(case))
    assert again.bodies[0].virtual == virtual


@pytest.mark.parametrize("name", templates())
def test_templates_are_valid_and_without_warnings(name: str) -> None:
    case = Case.from_toml(templates()[name])
    summary = method_of(case).summary(case, 2)
    assert summary.warnings == ()
    assert summary.seconds < 60


def components(hint: typing.Any) -> set[type]:
    """All components that a case can hold."""
    if not is_component(hint):
        return {c for arg in typing.get_args(hint) for c in components(arg)}
    inner = [field.annotation for field in hint.__pydantic_fields__.values()]
    return {hint, *(c for i in inner for c in components(i))}


@pytest.mark.parametrize("cls", sorted(components(Case), key=lambda c: c.__name__))
def test_every_key_says_what_it_means(cls: typing.Any) -> None:
    assert cls.__doc__
    for name, field in cls.__pydantic_fields__.items():
        assert field.description, name


def test_components_are_frozen_and_take_arrays() -> None:
    box = Box(np.array([10, 20]))
    assert box == Box([10, 20.0])
    with pytest.raises(dataclasses.FrozenInstanceError):
        box.size = (3, 3)  # type: ignore[misc]


def test_numbers_of_numpy_are_numbers() -> None:
    fluid = Fluid(density=np.float32(0.5), timestep=np.float16(0.25), mass=np.int64(2))  # type: ignore[arg-type]
    assert (fluid.density, fluid.timestep, fluid.mass) == (0.5, 0.25, 2.0)
    assert type(fluid.density) is float
    run = Run(steps=np.int64(7), seed=np.uint8(3), warmup=np.float32(5))  # type: ignore[arg-type]
    assert (run.steps, run.seed, run.warmup) == (7, 3, 5)
    assert type(run.steps) is int
    assert Uniform(np.float32([0.5, 0])).acceleration == (0.5, 0.0)  # type: ignore[arg-type]
    for wrong in (np.float32("inf"), np.float64("nan"), 10**400):
        with pytest.raises(CaseError, match="finite"):
            Fluid(density=wrong)
    with pytest.raises(CaseError, match="63 bits"):
        Run(steps=np.int64(-(2**63)))  # type: ignore[arg-type]


def test_a_byte_order_mark_is_no_text(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text("[run]\nsteps = 1\n[box]\nsize = [4, 4]", "utf-8-sig")
    assert Case.from_toml(tmp_path / "case.toml").run.steps == 1


def test_a_number_that_is_shown_as_the_limit_is_not_above_it() -> None:
    def slit(push: float) -> Derived:
        fluid = Fluid(force=Uniform((push, 0)))
        return derive(Case(run=Run(1), box=Box([30, 30]), fluid=fluid, walls=(Plates("y"),)))

    mach = slit(0.01).mach
    assert mach
    assert "Mach" not in " ".join(slit(0.01 * 0.203 / mach).warnings)
    assert "Mach number 0.21:" in " ".join(slit(0.01 * 0.207 / mach).warnings)


def test_errors_in_python_name_class_and_argument() -> None:
    with pytest.raises(CaseError, match=r"^SRD\.angle = 200: expected a number of at most 180$"):
        SRD(angle=200)
    with pytest.raises(CaseError, match=r"^Fluid\.densty: unknown key; did you mean 'density'\?$"):
        Fluid(densty=3)  # type: ignore[call-arg]
    with pytest.raises(CaseError, match=r"^Fluid\.collision\.angle: unknown key"):
        Fluid(collision={"rule": "at", "angle": 3})  # type: ignore[arg-type]


def test_species_define_density_and_mass() -> None:
    fluid = Fluid(species=[Species(mass=1, density=6), Species(mass=5, density=2)])  # type: ignore[arg-type]
    assert (fluid.density, fluid.mass) == (8, 2)
    assert dataclasses.replace(fluid, timestep=0.2).density == 8
    assert Case(run=Run(1), box=Box([10, 10]), fluid=fluid).particles == 800


class TestOverrides:
    """Values given on the command line."""

    @pytest.fixture
    def path(self) -> Path:
        return Path(str(templates()["poiseuille"]))

    def test_replace_values(self, path: Path) -> None:
        case = Case.from_toml(
            path,
            {
                "run.steps": "7",
                "fluid.collision": '{ rule = "at" }',
                "fluid.thermostat.rule": "none",
                "wall.1.virtual": "top-up",
                "observe.density-profile.every": "3",
                "title": "two words",
            },
        )
        assert case.run.steps == 7
        assert case.fluid.collision == AT()
        assert case.walls[0].virtual == "top-up"
        assert case.observe[1].every == 3
        assert case.title == "two words"

    @pytest.mark.parametrize(
        ("key", "value", "words"),
        [
            ("fluid.densty", "5", "fluid.densty: unknown key; did you mean 'density'?"),
            ("fluid.density", "-5", "fluid.density = -5: expected a number above 0"),
            ("run.steps.more", "5", "run.steps"),
            ("wall.2.axis", "x", "wall.2: expected the number 1 or a unique name"),
            (
                "wall.axis",
                "x",
                "wall.axis: expected the number 1 or a unique name after wall, as in wall.1.axis",
            ),
            ("observe.stress.every", "1", "observe.stress: expected a number from 1 to 6"),
            ("", "1", "key path"),
        ],
    )
    def test_wrong_ones_are_refused(self, path: Path, key: str, value: str, words: str) -> None:
        with pytest.raises(CaseError) as error:
            Case.from_toml(path, {key: value})
        assert words in str(error.value)
        assert "\n" not in str(error.value)


def test_start_files_are_found_from_the_folder_of_the_case(tmp_path: Path) -> None:
    np.save(tmp_path / "r.npy", np.zeros((4, 2)))
    (tmp_path / "c.toml").write_text(
        '[run]\nsteps = 1\n[box]\nsize = [4, 4]\n[fluid]\nstart = { positions = "r.npy" }\n'
    )
    case = Case.from_toml(tmp_path / "c.toml")
    assert case.fluid.start.positions == str((tmp_path / "r.npy").resolve())
    assert case.missing_files() == []
