"""Generic functions: one implementation for each class, in kernels and from plain Python."""

from typing import NamedTuple

import pytest
from numba import njit
from numba.core.errors import TypingError

from mesokit import NoForce, Uniform
from mesokit.case.box import Box, fold
from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.scalar.jit import generic


class Square(NamedTuple):
    """Side."""

    side: float


class Circle(NamedTuple):
    """Radius."""

    radius: float


@generic
def area(shape):
    """Area of a shape."""


@area.register(Square)
def _(shape):
    return shape.side * shape.side


def test_the_class_picks_the_implementation():
    kernel = njit(lambda shape: area(shape))
    assert area(Square(3.0)) == kernel(Square(3.0)) == 9.0
    assert (area.__name__, area.__doc__) == ("area", "Area of a shape.")


def test_a_class_that_is_not_registered_is_an_error_and_no_silence():
    with pytest.raises(TypeError, match="area: nothing is registered for Circle"):
        area(Circle(1.0))
    with pytest.raises(TypingError, match="area"):
        njit(lambda shape: area(shape))(Circle(1.0))


def test_an_implementation_takes_the_arguments_of_the_stub():
    with pytest.raises(TypeError, match=r"area takes \(shape\)"):

        @area.register(Circle)
        def _(circle):
            return 3.0


def test_the_physics_can_be_asked_from_python():
    periodic = Box([4, 4]).kernel((False, False))
    folded, velocity, crossed = fold(periodic, (5.0, -1.0), (1.0, 2.0), (0.0, 0.0))
    assert (folded, velocity, crossed) == ((1.0, 3.0), (1.0, 2.0), (1.0, -1.0))
    assert acceleration(Uniform((0.5, 0.0)).kernel((4, 4)), (1.0, 1.0)) == (0.5, 0.0)
    assert acceleration(NoForce().kernel((4, 4)), (1.0, 1.0)) == ()
