"""Records of whole numbers that many threads add to: word by word, or all words at once.

On a card additions to the sums of cells decide what a step takes. From compute capability 9.0 on it
adds a record in memory at once, out of a place in shared memory that is one thread's own: a third
of the time of its words one by one (docs/inside/gpu.md). The sums are the same.
"""

from typing import Any, NamedTuple

from mesokit.devices.device import BLOCK
from mesokit.kernels.later import intrinsic
from mesokit.scalar.jit import generic
from mesokit.scalar.pointer import add_words

LEAST_CHIP = (9, 0)
MOST_SHARED = 48 * 1024  # bytes of a block
WORD = 8  # bytes
ALIGNED = 16  # bytes: both places of a bulk addition


class WordByWord(NamedTuple):
    """One addition a word."""


class AtOnce(NamedTuple):
    """One addition a record, whose length in words is even."""


def adding(chip: tuple[int, int] | None, length: int) -> WordByWord | AtOnce:
    """How a device of this chip, or none, adds records of so many words."""
    able = chip is not None and chip >= LEAST_CHIP
    fits = length % 2 == 0 and BLOCK * length * WORD <= MOST_SHARED
    return AtOnce() if able and fits else WordByWord()


@generic
def add_record(how, start, index, values):
    """Add a tuple to the int64 numbers from `index` on, to which other threads add as well."""


add_record.register(WordByWord)(lambda how, start, index, values: add_words(start, index, values))
add_record.register(AtOnce)(lambda how, start, index, values: add_at_once(start, index, values))


@intrinsic
def add_at_once(typing_context: Any, start: Any, index: Any, values: Any) -> Any:
    """The same by one bulk addition; on cards alone."""
    from llvmlite import ir
    from numba import types

    length = len(values)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        whole, short = ir.IntType(64), ir.IntType(32)
        memory = _shared(builder.module, ir.ArrayType(whole, BLOCK * length), f"records{length}")
        read_thread = builder.module.declare_intrinsic(
            "llvm.nvvm.read.ptx.sreg.tid.x", (), ir.FunctionType(short, ())
        )
        thread = builder.zext(builder.call(read_thread, ()), whole)
        first = builder.mul(thread, ir.Constant(whole, length))
        zero = ir.Constant(whole, 0)
        for k in range(length):
            place = builder.gep(memory, [zero, builder.add(first, ir.Constant(whole, k))])
            builder.store(builder.extract_value(arguments[2], k), place)
        own = builder.ptrtoint(builder.gep(memory, [zero, first]), whole)
        shift = builder.mul(arguments[1], ir.Constant(whole, WORD))
        there = builder.add(arguments[0], shift)
        # The stores are made known to the unit that adds; the thread goes on when it has read them.
        text = (
            "fence.proxy.async.shared::cta; "
            "cp.reduce.async.bulk.global.shared::cta.bulk_group.add.u64 "
            f"[$0], [$1], {WORD * length}; "
            "cp.async.bulk.commit_group; cp.async.bulk.wait_group.read 0;"
        )
        form = ir.FunctionType(ir.VoidType(), [whole, whole])
        code = ir.InlineAsm(form, text, "l,l,~{memory}", side_effect=True)
        builder.call(code, [there, own])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, values), generate


def _shared(module: Any, kind: Any, name: str) -> Any:
    """Shared memory of a block, once in a kernel."""
    from llvmlite import ir

    if name in module.globals:
        return module.globals[name]
    memory = ir.GlobalVariable(module, kind, name, addrspace=3)
    memory.linkage, memory.align = "internal", ALIGNED
    memory.initializer = ir.Constant(kind, ir.Undefined)
    return memory
