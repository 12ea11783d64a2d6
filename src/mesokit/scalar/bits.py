"""Bits of words, and search among the 64 bytes at an address: few instructions on any processor."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.later import intrinsic
from mesokit.scalar.jit import scalar

_ONE, _THREE, _BYTE = np.uint64(1), np.uint64(3), np.uint64(255)


@intrinsic
def equal_bytes(typing_context: Any, address: Any, value: Any) -> Any:
    """A word with a bit for each of the 64 bytes at an address, set where it has a value."""
    from llvmlite import ir
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        byte, vector = ir.IntType(8), ir.VectorType(ir.IntType(8), 64)
        whole = builder.load(builder.inttoptr(arguments[0], vector.as_pointer()), align=1)
        one = builder.insert_element(
            ir.Constant(vector, ir.Undefined),
            builder.trunc(arguments[1], byte),
            ir.Constant(ir.IntType(32), 0),
        )
        every = builder.shuffle_vector(
            one,
            ir.Constant(vector, ir.Undefined),
            ir.Constant(ir.VectorType(ir.IntType(32), 64), [0] * 64),
        )
        equal = builder.icmp_unsigned("==", whole, every)
        return builder.bitcast(equal, ir.IntType(64))

    return types.uint64(types.uint64, types.uint64), generate


@intrinsic
def bits_set(typing_context: Any, word: Any) -> Any:
    """How many bits of a word are set."""
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.ctpop(arguments[0])

    return types.uint64(types.uint64), generate


@intrinsic
def high_product(typing_context: Any, a: Any, b: Any) -> Any:
    """The 64 high bits of the product of two words of 64 bits."""
    from llvmlite import ir
    from numba import types

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        wide = ir.IntType(128)
        product = builder.mul(*(builder.zext(one, wide) for one in arguments))
        return builder.trunc(builder.lshr(product, ir.Constant(wide, 64)), ir.IntType(64))

    return types.uint64(types.uint64, types.uint64), generate


@scalar
def nth_bit(word, rank):
    """The number of the bit with this rank among those of a word that are set, the lowest first."""
    # without a branch: the half with it, then the half of that, down to one bit
    at = np.int64(0)
    for k in range(6):
        half = 32 >> k
        low = np.int64(bits_set(word & ((_ONE << np.uint64(half)) - _ONE)))
        up = rank >= low
        word = word >> np.uint64(half if up else 0)
        rank -= low if up else 0
        at += half if up else 0
    return at


def table_of_bits() -> NDArray[np.uint8]:
    """Numbers (256 * 8,) of the bits that are set in each byte, by rank.

    >>> table_of_bits()[8 * 0b1010 : 8 * 0b1010 + 2].tolist()
    [1, 3]
    """
    found = np.zeros((256, 8), np.uint8)
    for byte in range(256):
        bits = [k for k in range(8) if byte >> k & 1]
        found[byte, : len(bits)] = bits
    return found.ravel()


@scalar
def nth_bit_in_table(table, word, rank):
    """The same as `nth_bit`, of the last byte by a table."""
    at = np.int64(0)
    for k in range(3):
        half = 32 >> k
        low = np.int64(bits_set(word & ((_ONE << np.uint64(half)) - _ONE)))
        up = rank >= low
        word = word >> np.uint64(half if up else 0)
        rank -= low if up else 0
        at += half if up else 0
    return at + np.int64(table[((word & _BYTE) << _THREE) | np.uint64(rank)])
