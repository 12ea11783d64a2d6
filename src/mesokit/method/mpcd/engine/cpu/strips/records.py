"""Moves numbers between records (all numbers of a cell side by side) and rows of strips.

Four lanes at a time are turned round in vector registers. Written as a loop over single numbers,
each number would be one store to a cache line of its own, and stores are what limits such a loop.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core.cgutils import gep
from numba.extending import intrinsic

from mesokit.loops.layout import QUAD, SCRATCH_ROW, record_length, sums_length

_I32, _I64 = ir.IntType(32), ir.IntType(64)


@intrinsic
def gather(typing_context: Any, records: Any, cell: Any, i: Any, rows: Any, pattern: Any) -> Any:
    """Copy the records of the cells of lanes i to i + 3 into rows, one for each of their numbers.

    A record is `record_length(len(pattern))` long.
    """
    count = len(pattern)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = context, builder, signature, arguments
        source, cells, target = (_start(*given, k) for k in (0, 1, 3))
        lane = arguments[2]
        length = record_length(count)
        starts = _starts(builder, cells, lane, length)
        for k in range(0, count, 2):
            pairs = [_load(builder, source, _plus(builder, start, k), 2) for start in starts]
            for row, values in enumerate(_rows(builder, pairs)[: count - k]):
                place = _plus(builder, lane, (k + row) * SCRATCH_ROW)
                _store(builder, target, place, values)
        return context.get_dummy_value()

    return types.void(records, cell, i, rows, pattern), generate


@intrinsic
def spread(typing_context: Any, records: Any, start: Any, i: Any, rows: Any, pattern: Any) -> Any:
    """Write lanes i to i + 3 of the rows into the four records from `start`."""
    count = len(pattern)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        target, source = (_start(context, builder, signature, arguments, k) for k in (0, 3))
        first = builder.mul(arguments[1], ir.Constant(_I64, record_length(count)))
        for k in range(0, count, 2):
            rows = [
                _load(builder, source, _plus(builder, arguments[2], row * SCRATCH_ROW), QUAD)
                for row in range(k, min(k + 2, count))
            ]
            for j, pair in enumerate(_pairs(builder, rows[0], rows[-1])):
                _store(builder, target, _plus(builder, first, j * record_length(count) + k), pair)
        return context.get_dummy_value()

    return types.void(records, types.int64, types.int64, rows, pattern), generate


@intrinsic
def scatter_add(
    typing_context: Any, sums: Any, cell: Any, i: Any, rows: Any, terms: Any, tallied: Any
) -> Any:
    """Count lanes i to i + 3 in the sums of their cells, and add their rows of integers.

    The sums of a cell are `sums_length(len(terms))` integers: the number of particles, one for each
    term, and padding. A particle counts as 1 if `tallied` is (), else as what the row after the
    terms says.
    """
    count = len(terms)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        given = context, builder, signature, arguments
        target, cells, source = (_start(*given, k) for k in (0, 1, 3))
        lane = arguments[2]
        length = sums_length(count)
        starts = _starts(builder, cells, lane, length)
        columns = [
            _load(builder, source, _plus(builder, lane, k * SCRATCH_ROW), QUAD)
            for k in range(count + len(tallied))
        ]
        ones = ir.Constant(ir.VectorType(_I64, QUAD), [1] * QUAD)
        columns = [columns.pop() if len(tallied) else ones, *columns]
        columns += [ir.Constant(ir.VectorType(_I64, QUAD), [0] * QUAD)] * (length - count - 1)
        parts = [_turned(builder, columns[k : k + QUAD]) for k in range(0, length, QUAD)]
        # This loop runs when the kernel is compiled and writes the code of four lanes. They come in
        # turn, load, add, store: two lanes may be in one cell, and the second must see the first.
        for j in range(QUAD):
            for p, part in enumerate(parts):
                place = _plus(builder, starts[j], p * QUAD)
                before = _load(builder, target, place, QUAD)
                _store(builder, target, place, builder.add(before, part[j]))
        return context.get_dummy_value()

    return types.void(sums, cell, i, rows, terms, tallied), generate


@intrinsic
def gather_sums(typing_context: Any, sums: Any, start: Any, i: Any, rows: Any, terms: Any) -> Any:
    """Add the sums of the four cells from `start` to lanes i to i + 3 of the rows; clear them."""
    count = len(terms)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        source, target = (_start(context, builder, signature, arguments, k) for k in (0, 3))
        length = sums_length(count)
        first = builder.mul(arguments[1], ir.Constant(_I64, length))
        for k in range(0, length, QUAD):
            places = [_plus(builder, first, j * length + k) for j in range(QUAD)]
            found = [_load(builder, source, place, QUAD) for place in places]
            for place in places:
                _store(builder, source, place, ir.Constant(found[0].type, [0] * QUAD))
            for row, values in enumerate(_turned(builder, found)[: count + 1 - k]):
                place = _plus(builder, arguments[2], (k + row) * SCRATCH_ROW)
                before = _load(builder, target, place, QUAD)
                _store(builder, target, place, builder.add(before, values))
        return context.get_dummy_value()

    return types.void(sums, types.int64, types.int64, rows, terms), generate


def _start(context: Any, builder: Any, signature: Any, arguments: Any, k: int) -> Any:
    array = context.make_array(signature.args[k])(context, builder, arguments[k])
    return array.data


def _starts(builder: Any, cells: Any, lane: Any, length: int) -> list[Any]:
    """The first elements of the records of the cells of four lanes."""
    places = (gep(builder, cells, _plus(builder, lane, j), inbounds=True) for j in range(QUAD))
    numbers = (builder.zext(builder.load(place), _I64) for place in places)
    return [builder.mul(number, ir.Constant(_I64, length)) for number in numbers]


def _plus(builder: Any, index: Any, constant: int) -> Any:
    return builder.add(index, ir.Constant(_I64, constant)) if constant else index


def _place(builder: Any, base: Any, index: Any, width: int) -> Any:
    place = gep(builder, base, index, inbounds=True)
    if width == 1:
        return place
    return builder.bitcast(place, ir.VectorType(base.type.pointee, width).as_pointer())


def _load(builder: Any, base: Any, index: Any, width: int) -> Any:
    return builder.load(_place(builder, base, index, width), align=8)


def _store(builder: Any, base: Any, index: Any, values: Any) -> None:
    width = getattr(values.type, "count", 1)
    builder.store(values, _place(builder, base, index, width), align=8)


def _shuffle(builder: Any, a: Any, b: Any, *picked: int) -> Any:
    mask = ir.Constant(ir.VectorType(_I32, len(picked)), list(picked))
    return builder.shuffle_vector(a, b, mask)


def _rows(builder: Any, pairs: list[Any]) -> list[Any]:
    """Four pairs, one for each lane, as two rows of four."""
    even = _shuffle(builder, pairs[0], pairs[2], 0, 1, 2, 3)
    odd = _shuffle(builder, pairs[1], pairs[3], 0, 1, 2, 3)
    return [_shuffle(builder, even, odd, 0, 4, 2, 6), _shuffle(builder, even, odd, 1, 5, 3, 7)]


def _pairs(builder: Any, first: Any, second: Any) -> list[Any]:
    """Two rows of four as four pairs, one for each lane."""
    return [_shuffle(builder, first, second, j, j + QUAD) for j in range(QUAD)]


def _turned(builder: Any, rows: list[Any]) -> list[Any]:
    """The transpose of four rows of four."""
    low = [_shuffle(builder, rows[k], rows[k + 1], 0, 4, 2, 6) for k in (0, 2)]
    high = [_shuffle(builder, rows[k], rows[k + 1], 1, 5, 3, 7) for k in (0, 2)]
    return [
        _shuffle(builder, *halves, j, j + 1, j + 4, j + 5) for j in (0, 2) for halves in (low, high)
    ]
