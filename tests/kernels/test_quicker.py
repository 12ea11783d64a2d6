"""What numba answers in fewer calls is what it answered before."""

import operator
import os
import subprocess
import sys

import pytest
from numba import njit, types
from numba.core import compiler, ir
from numba.core.errors import TypingError
from numba.core.registry import cpu_target
from numba.extending import overload

from mesokit.kernels import quicker


def function(a, b, *more, c=2.0):
    """Statements of many kinds."""
    total, pairs = a + b, [(a, b), (b, c)]
    for k, (x, y) in enumerate(pairs):
        total += more[k] * x - y if k else {"x": x}["x"]
    assert total != 3, "no"
    return total, list(more), function(a, b, total)


def listed(value):
    """The variables in a value, as numba's own code finds them."""
    if isinstance(value, ir.Var):
        return [value]
    if isinstance(value, ir.Expr):
        return listed(value._kws)
    if isinstance(value, ir.Inst):
        return listed(vars(value))
    if isinstance(value, dict):
        return listed(list(value.values()))
    several = value if isinstance(value, (list, tuple)) else ()
    return [found for one in several for found in listed(one)]


def test_variables_are_listed_in_their_order():
    blocks = compiler.run_frontend(function).blocks.values()
    statements = [one for block in blocks for one in block.body]
    kinds = {type(one) for one in statements}
    assert {ir.Assign, ir.Jump, ir.Branch, ir.Return} <= kinds and len(statements) > 80
    found = [one.list_vars() for one in statements if type(one) not in (ir.Del, ir.Return)]
    assert found == [listed(one) for one in statements if type(one) not in (ir.Del, ir.Return)]
    assert sum(map(len, found)) > 100


@pytest.mark.parametrize("name", ["add", "floordiv", "lt", "and_", "getitem"])
def test_signatures_are_those_of_numba(name):
    context = cpu_target.typing_context
    context.refresh()
    kind = context.resolve_value_type(getattr(operator, name))
    left = types.UniTuple(types.int64, 2) if name == "getitem" else types.int64
    for right in (types.int64, types.literal(1), types.uint8):
        first = kind.get_call_type(context, (left, right), {})
        assert first == quicker._resolve(kind, context, (left, right), {})
        assert kind.get_call_type(context, (left, right), {}) is first


def test_what_another_target_has_resolved_is_not_taken():
    """One object of a function holds the code that was found last, for processors or for cards."""
    context = cpu_target.typing_context
    kind, given = context.resolve_value_type(operator.add), (types.int64, types.int32)
    found = kind.get_call_type(context, given, {})
    ours = kind.get_impl_key(found)
    kind._impl_keys[found.args] = "code for a card"
    assert kind.get_call_type(context, given, {}) is found
    assert kind.get_impl_key(found) == ours


def test_words_of_errors_are_as_bold_as_before():
    """Numba's own code, in a process of its own."""
    program = "from numba.core.errors import termcolor; print(termcolor().errmsg('No match.'))"
    env = os.environ | {"NUMBA_COLOR_SCHEME": "dark_bg"}
    texts = [
        subprocess.run([sys.executable, "-c", before + program], env=env, capture_output=True)
        for before in ("", "import mesokit.kernels.quicker; ")
    ]
    assert texts[0].stdout == texts[1].stdout and b"No match." in texts[0].stdout


def test_a_signature_that_comes_later_is_found():
    def product(a, b):
        return a @ b

    with pytest.raises(TypingError):
        njit(product)(True, False)

    @overload(operator.matmul)
    def of_booleans(a, b):
        both = isinstance(a, types.Boolean) and isinstance(b, types.Boolean)
        return (lambda a, b: a and b) if both else None

    assert njit(product)(True, True)
    assert not njit(product)(True, False)
