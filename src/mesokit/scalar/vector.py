"""Vectors as tuples of numbers."""

from mesokit.scalar.intrinsics import mul_add, with_item
from mesokit.scalar.jit import by_type, elementwise, scalar


@elementwise
def first(values, like):
    """As many of the values as the tuple `like` has elements."""
    return "values[{k}]"


@elementwise
def scaled(factor, x):
    """A vector times a number."""
    return "factor * x[{k}]"


@elementwise
def added(a, b):
    """The sum of two vectors."""
    return "a[{k}] + b[{k}]"


@elementwise
def chosen(condition, a, b):
    """a where the condition holds, else b, for vectors a and b."""
    return "a[{k}] if condition else b[{k}]"


@elementwise
def added_scaled(a, factor, b):
    """a + factor * b for vectors a and b."""
    return "mul_add(factor, b[{k}], a[{k}])"


@scalar
def row(vectors, i, like):
    """Row i of an array as a vector, a tuple as long as `like`."""
    for k in range(len(like)):
        like = with_item(like, k, vectors[i, k])
    return like


@scalar
def dot(a, b):
    """Scalar product of two vectors."""
    total = a[0] * b[0]
    for k in range(1, len(a)):
        total = mul_add(a[k], b[k], total)
    return total


@by_type
def products(a, b):
    """All products of an element of one vector and one of another, row by row of their matrix."""
    if len(a) == 2:
        return lambda a, b: scaled(a[0], b) + scaled(a[1], b)
    return lambda a, b: scaled(a[0], b) + scaled(a[1], b) + scaled(a[2], b)


@by_type
def outer(a, b):
    """Vector product: a tuple of one number for vectors of two, of three for vectors of three."""
    if len(a) == 2:
        return lambda a, b: (a[0] * b[1] - a[1] * b[0],)
    return lambda a, b: (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )
