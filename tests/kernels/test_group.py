"""Groups by address: compiled code finds in a packed group what Python put there."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numba import njit, typeof

from mesokit.kernels.group import Group, by_address, replaced, writer
from mesokit.kernels.kernel import kernel
from mesokit.kernels.packing import kind_of, packed
from mesokit.scalar.jit import seldom


class Pair(NamedTuple):
    first: float
    second: int


class Inner(NamedTuple):
    values: Any
    pair: Pair


@by_address("count")
class Whole(NamedTuple):
    number: int
    count: tuple
    flag: bool
    small: Any
    inner: Inner
    table: Any
    nothing: tuple


NUMBERS = st.integers(-(2**62), 2**62)
FLOATS = st.floats(allow_nan=False)


@njit
def everything(whole):
    pair, inner = whole.inner.pair, whole.inner
    return (
        whole.number,
        whole.count[0],
        whole.flag,
        whole.small,
        inner.values[1],
        len(inner.values),
        pair.first,
        pair.second,
        whole.table[1, 2],
        whole.table.shape,
        whole.table[:, 1].sum(),
        len(whole.nothing),
        len(whole.inner),
    )


@given(NUMBERS, NUMBERS, st.booleans(), st.integers(-(2**31), 2**31 - 1), FLOATS, NUMBERS)
def test_fields_are_what_python_packed(
    number: int, count: int, flag: bool, small: int, first: float, second: int
) -> None:
    values, table = np.array([1.0, first]), np.arange(12).reshape(3, 4)[:, ::-1]
    inner = Inner(values, Pair(first, second))
    group = packed(Whole(number, (count,), flag, np.int32(small), inner, table, ()))
    column = int(table[:, 1].sum())
    expected = (
        number, count, flag, small, first, 2, first, second, table[1, 2], (3, 4), column, 0, 2,
    )  # fmt: skip
    assert everything(group) == expected


def test_what_a_kernel_writes_python_reads() -> None:
    @kernel
    def fill(whole):
        for i in range(len(whole.inner.values)):
            whole.inner.values[i] = i * whole.inner.pair.first

    values = np.zeros(3)
    fill(Whole(0, (0,), False, 0, Inner(values, Pair(0.5, 1)), np.zeros((1, 1)), ()))
    assert values.tolist() == [0.0, 0.5, 1.0]


set_count, set_number = writer("count"), writer("number")


def test_fields_that_change() -> None:
    @njit
    def counted(whole, n):
        before = whole.count[0]
        set_count(whole, n)
        return before, whole.count[0]

    group = packed(Whole(7, (5,), True, 0, Inner(np.ones(1), Pair(1.0, 1)), np.ones((1, 1)), ()))
    assert counted(group, 9) == (5, 9) and counted(group, 1) == (9, 1)
    with pytest.raises(Exception, match=r"write\(Whole"):
        njit(lambda whole: set_number(whole, 1))(group)


def test_a_group_is_one_word_and_a_type_of_its_own() -> None:
    group = Whole(7, (5,), True, 0, Inner(np.ones(1), Pair(1.0, 1)), np.ones((1, 1)), ())
    kind = kind_of(group)
    assert isinstance(kind, Group) and typeof(packed(group)) is kind
    assert kind_of(group._replace(number=8)) is kind
    assert kind_of(group._replace(number=8.0)) != kind
    assert kind_of(Pair(1.0, 1)) == typeof(Pair(1.0, 1))  # no arrays: as before
    assert packed(Pair(1.0, 1)) == Pair(1.0, 1)


def test_what_cannot_be_packed_is_named() -> None:
    with pytest.raises(TypeError, match="a group cannot hold"):
        packed(Inner(np.ones(1), Pair("a", 1)))  # type: ignore[arg-type]


def test_classes_of_one_name_are_told_apart() -> None:
    def kinds() -> type:
        class Row(NamedTuple):
            parameters: Any
            values: Any

        return Row

    one, other = (packed(kind((1.0,), np.ones(2))) for kind in (kinds(), kinds()))
    assert typeof(one) != typeof(other)


class Wave(NamedTuple):
    amplitude: float
    on: bool
    at: tuple
    inner: Any


@by_address(in_words=True)
class Law(NamedTuple):
    scale: float
    field: Any
    masses: tuple


with_field = replaced("field")


@njit
def pushed(law, i):
    wave = law.field
    value = wave.inner.values[i] + wave.inner.pair.second if wave.on else 0.0
    return law.scale * wave.amplitude * value + wave.at[1] * law.masses[0]


@seldom
def pushed_once_more(law, i):
    return 0.0 if law.field.on else pushed(law, i)


@kernel
def sum_of_steps(law, steps, out):
    for n in range(steps):
        field = Wave(law.field.amplitude * n, n % 3 > 0, (0.0, float(n)), law.field.inner)
        now = with_field(law, field)
        for i in range(len(out)):
            out[i] += pushed(now, i) + pushed_once_more(now, i)  # inlined, and called
    for i in range(len(out)):  # the group itself is as it was
        out[i] += pushed(with_field(law, None), i)


@pytest.mark.parametrize("order", ["C", "A"])
def test_a_replaced_field_is_that_of_each_step(order: str) -> None:
    values = np.arange(8.0) if order == "C" else np.arange(16.0)[::2]
    inner = Inner(values, Pair(1.0, 4))
    law, out = Law(2.0, Wave(3.0, True, (0.0, 7.0), inner), (5.0,)), np.zeros(8)
    sum_of_steps(law, 7, out)
    by_hand = 2.0 * 3.0 * (1 + 2 + 4 + 5) * (values + 4) + (21 + 0 + 3 + 6) * 5.0
    np.testing.assert_array_equal(out, by_hand + 2.0 * 3.0 * (values + 4) + 7.0 * 5.0)
