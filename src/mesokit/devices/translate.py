"""PTX as C: each instruction becomes the statement that rounds as it does.

What NVIDIA's compiler made of a kernel then runs on a processor, thread after thread: the bits of a
card, but for what its assembler does. An instruction that is not known here, and one that leaves a
rounding open, raises an error. No kernel may have barriers or words for a warp, and shared memory
only as places of single threads (see `devices.records`).
"""

import re
from collections.abc import Callable

TYPES = {
    "f64": "double", "f32": "float", "s64": "int64_t", "u64": "uint64_t", "b64": "uint64_t",
    "s32": "int32_t", "u32": "uint32_t", "b32": "uint32_t", "s16": "int16_t", "u16": "uint16_t",
    "b16": "uint16_t", "s8": "int8_t", "u8": "uint8_t", "b8": "uint8_t", "pred": "int",
}  # fmt: skip
TWICE = {"s32": "s64", "u32": "u64", "s16": "s32", "u16": "u32"}
WIDER = {"u64": "unsigned __int128", "s64": "__int128", "u32": "uint64_t", "s32": "int64_t"}
OPERATORS = {
    "add": "+", "sub": "-", "mul": "*", "div": "/", "rem": "%", "and": "&", "or": "|", "xor": "^",
}  # fmt: skip
CLASSES = {  # of real numbers
    "finite": "isfinite({0})",
    "infinite": "isinf({0})",
    "number": "!isnan({0})",
    "notanumber": "isnan({0})",
}
COMPARISONS = {
    "eq": "==", "ne": "!=", "lt": "<", "le": "<=", "gt": ">", "ge": ">=",
    "lo": "<", "ls": "<=", "hi": ">", "hs": ">=",
}  # fmt: skip
WHOLE_PARTS = {"rmi": "floor", "rpi": "ceil", "rzi": "trunc", "rni": "rint"}
SPECIAL = {"%tid.x": "tid", "%ntid.x": "ntid", "%ctaid.x": "ctaid", "%nctaid.x": "nctaid"}
SHARED = r"\.shared\s+\.align\s+\d+\s+\.b8\s+([\w$]+)\[(\d+)\];"
SPACES = ("param", "local", "const", "shared", "global")
GLOBAL, GENERIC = "global", "generic"
HEAD = r"""
#include <math.h>
#include <stdint.h>
#include <string.h>
static __thread uint32_t tid, ntid, ctaid, nctaid;
static inline uint64_t bits_f64(double x) { uint64_t u; memcpy(&u, &x, 8); return u; }
static inline double f64_of(uint64_t u) { double x; memcpy(&x, &u, 8); return x; }
static inline uint32_t bits_f32(float x) { uint32_t u; memcpy(&u, &x, 4); return u; }
static inline float f32_of(uint32_t u) { float x; memcpy(&x, &u, 4); return x; }
static inline int32_t s32_of(double x) {
  return x != x ? 0 : x >= 0x1p31 ? INT32_MAX : x <= -0x1p31 ? INT32_MIN : (int32_t)x; }
static inline int64_t s64_of(double x) {
  return x != x ? 0 : x >= 0x1p63 ? INT64_MAX : x <= -0x1p63 ? INT64_MIN : (int64_t)x; }
static inline double max_f64(double a, double b) {
  return a != a ? b : b != b ? a : a == 0 && b == 0 ? (signbit(a) ? b : a) : a > b ? a : b; }
static inline double min_f64(double a, double b) {
  return a != a ? b : b != b ? a : a == 0 && b == 0 ? (signbit(a) ? a : b) : a < b ? a : b; }
#define max_f32(a, b) (float)max_f64(a, b)
#define min_f32(a, b) (float)min_f64(a, b)
"""
PLAIN_MEMORY = """
static inline char *seen(uint64_t address, int size, int what) { return (char *)address; }
static inline char *seen_or_own(uint64_t address, int size, int what) { return (char *)address; }
"""
READ, WRITE, ADD = 0, 1, 2  # what an access does with memory
# The rest of a launch: threads in the order that is given, whole blocks.
LAUNCH = """
void launch(const int64_t *order, int64_t threads, int64_t block, char *given) {{
  ntid = block; nctaid = threads / block;
  for (int64_t j = 0; j < threads; j++) {{
    tid = order[j] % block; ctaid = order[j] / block; {before}
    {entry}({given});
  }}
}}
"""


class UnknownInstructionError(ValueError):
    """An instruction that has no statement here."""


class Translation:
    """The C of a kernel's PTX.

    Parameters
    ----------
    ptx : str
        Text of one kernel, and of the functions that it calls.
    memory : str
        C of the function `seen`, which gives the place in this process of an access to global
        memory: its address, its size in bytes, and whether it reads, writes or adds; and of
        `seen_or_own`, the same where the address may be that of a thread's own memory.
    before : str
        A statement before each thread, which has the number order[j].
    """

    def __init__(self, ptx: str, memory: str = PLAIN_MEMORY, before: str = "") -> None:
        self._registers: dict[str, str] = {}
        self._heads: list[str] = []
        self._functions: list[str] = []
        self._entry: tuple[str, int] = "", 0
        text = re.sub(r"//.*", "", ptx)
        text = re.sub(
            r"^\s*\.(maxntid|minnctapersm|reqntid|noreturn|pragma).*", "", text, flags=re.M
        )
        for name, size in re.findall(SHARED, text):
            self._heads.append(f"static char p_{name}[{size}] __attribute__((aligned(16)));")
        found = re.finditer(
            r"\.(entry|func)\s*(\([^)]*\))?\s*([\w$]+)\s*\(([^)]*)\)\s*(;|\{)", text
        )
        for one in found:
            if one[5] == "{":
                body = text[one.end() : _end_of_block(text, one.end())]
                self._add_function(one[1] == "entry", one[3], one[2] or "", one[4], body)
        entry, count = self._entry
        given = ", ".join(f"given + {8 * k}" for k in range(count))
        launch = LAUNCH.format(before=before, entry=f"f_{entry}", given=given)
        parts = HEAD, memory, *self._heads, *self._functions, launch
        self.source = "\n".join(parts)

    def _add_function(self, entry: bool, name: str, back: str, given: str, body: str) -> None:
        names = re.findall(r"\.param\s+(?:\.align\s+\d+\s+)?\.\w+\s+([\w$]+)", f"{back},{given}")
        parameters = ", ".join(f"char *p_{one}" for one in names) or "void"
        head = f"static void f_{name}({parameters})"
        self._registers = {}
        lines = list(map(self._line, _pieces(body)))
        self._heads.append(f"{head};")
        declared = "\n".join(
            f"{TYPES[kind]} {_plain(one)} = 0;" for one, kind in self._registers.items()
        )
        self._functions.append(f"{head} {{\n{declared}\n" + "\n".join(lines) + "\n}\n")
        if entry:
            self._entry = name, len(names)

    def _line(self, piece: str) -> str:
        if piece in "{}":
            return piece
        if piece.endswith(":"):
            return f"l_{_plain(piece[:-1])}:;"
        text = " ".join(piece.rstrip(";").split())
        if text.startswith(".reg"):
            self._declare(text)
            return ""
        if found := re.match(r"\.(local|param)\s.*?\.(\w+)\s+([\w$]+)(?:\[(\d+)\])?$", text):
            return f"char p_{found[3]}[{found[4] or 8}] __attribute__((aligned(16)));"
        if text.startswith("."):
            return ""
        if guard := re.match(r"@(!?)(%p\d+)\s+(.*)", text):
            return f"if ({guard[1]}{_plain(guard[2])}) {{ {self._statement(guard[3])} }}"
        return self._statement(text)

    def _declare(self, text: str) -> None:
        found = re.match(r"\.reg\s+\.(\w+)\s+(%?[\w$]+)(?:<(\d+)>)?", text)
        assert found is not None, text
        if found[3]:
            self._registers |= {f"{found[2]}{k}": found[1] for k in range(int(found[3]))}
        else:
            self._registers[found[2]] = found[1]

    # --- operands -------------------------------------------------------------------------------

    def _value(self, operand: str, kind: str) -> str:
        """An operand as a number of a kind, whatever register it lies in."""
        if operand in SPECIAL:
            return f"(({TYPES[kind]}){SPECIAL[operand]})"
        if found := re.fullmatch(r"0[dD]([0-9A-Fa-f]{16})", operand):
            return f"f64_of(0x{found[1]}ull)" if kind == "f64" else f"0x{found[1]}ull"
        if found := re.fullmatch(r"0[fF]([0-9A-Fa-f]{8})", operand):
            return f"f32_of(0x{found[1]}u)" if kind == "f32" else f"0x{found[1]}u"
        if re.fullmatch(r"-?\d+", operand):
            number = "INT64_MIN" if operand == str(-(2**63)) else f"{operand}ll"
            return f"(({TYPES[kind]}){number})"
        if operand not in self._registers:  # the name of a place in memory
            return f"(({TYPES[kind]})(uintptr_t)p_{operand})"
        held, name = self._registers[operand], _plain(operand)
        if kind in ("f64", "f32") and held != kind:
            return f"{kind}_of({name})"
        if held in ("f64", "f32") and held != kind:
            return f"bits_{held}({name})"
        return name if kind in ("pred", held) else f"(({TYPES[kind]}){name})"

    def _put(self, register: str, kind: str, value: str) -> str:
        """Store a number of a kind in a register."""
        if register == "_":
            return f"{value};"
        held = self._registers[register]
        if kind in ("f64", "f32") and held != kind:
            value = f"bits_{kind}({value})"
        elif held in ("f64", "f32") and held != kind:
            value = f"{held}_of({value})"
        return f"{_plain(register)} = {value};"

    def _place(self, operand: str, space: str, size: int, what: int) -> str:
        """The place in this process of `[register + offset]` or `[name + offset]`."""
        base, _, offset = operand[1:-1].partition("+")
        base, shift = base.strip(), offset.strip() or "0"
        if base not in self._registers:
            return f"(p_{base} + {shift})"
        address = f"({self._value(base, 'u64')} + {shift})"
        if space not in (GLOBAL, GENERIC):
            return f"((char *){address})"
        return f"{'seen' if space == GLOBAL else 'seen_or_own'}({address}, {size}, {what})"

    # --- instructions ---------------------------------------------------------------------------

    def _statement(self, text: str) -> str:
        name, _, rest = text.partition(" ")
        head, *words = name.split(".")
        operands = re.findall(r"\{[^}]*\}|\([^)]*\)|\[[^\]]*\]|[^,\s]+", rest)
        how: Callable[[list[str], list[str]], str] | None = getattr(self, f"_do_{head}", None)
        try:
            if how is None and head in OPERATORS:
                return self._operator(head, words, operands)
            if how is not None:
                return how(words, operands)
        except (KeyError, IndexError, AssertionError):
            pass
        raise UnknownInstructionError(f"no statement for the instruction: {text}")

    def _operator(self, head: str, words: list[str], to: list[str]) -> str:
        kind = words[-1]
        if kind in ("f64", "f32"):
            assert words[0] == "rn"  # with no rounding named, the assembler may contract it
        if "wide" in words:
            wide = TWICE[kind]
            product = f"({TYPES[wide]}){self._value(to[1], kind)} * {self._value(to[2], kind)}"
            return self._put(to[0], wide, product)
        if "hi" in words:
            a, b = (f"({WIDER[kind]}){self._value(x, kind)}" for x in to[1:])
            return self._put(to[0], kind, f"({TYPES[kind]})({a} * {b} >> {kind[1:]})")
        a, b = (self._value(x, kind) for x in to[1:])
        if kind[0] == "s" and head in ("add", "sub", "mul"):  # these wrap
            unsigned = TYPES["u" + kind[1:]]
            result = f"({TYPES[kind]})(({unsigned}){a} {OPERATORS[head]} ({unsigned}){b})"
            return self._put(to[0], kind, result)
        return self._put(to[0], kind, f"({TYPES[kind]})({a} {OPERATORS[head]} {b})")

    def _do_fma(self, words: list[str], to: list[str]) -> str:
        assert words == ["rn", "f64"]
        return self._put(to[0], "f64", f"fma({', '.join(self._value(x, 'f64') for x in to[1:])})")

    def _do_mad(self, words: list[str], to: list[str]) -> str:
        kind = words[-1]
        wide = TWICE[kind] if "wide" in words else kind
        a, b = (f"({TYPES[wide]}){self._value(x, kind)}" for x in to[1:3])
        return self._put(to[0], wide, f"({TYPES[wide]})({a} * {b} + {self._value(to[3], wide)})")

    def _do_ld(self, words: list[str], to: list[str]) -> str:
        kind, space = words[-1], _space(words)
        places = self._places(to[1], words, space, READ)
        into = [one.strip() for one in to[0].strip("{}").split(",")]
        loads = (f"*({TYPES[kind]} *){place}" for place in places)
        return " ".join(self._put(one, kind, load) for one, load in zip(into, loads, strict=True))

    def _do_st(self, words: list[str], to: list[str]) -> str:
        kind, space = words[-1], _space(words)
        places = self._places(to[0], words, space, WRITE)
        given = [one.strip() for one in to[1].strip("{}").split(",")]
        return " ".join(
            f"*({TYPES[kind]} *){place} = {self._value(one, kind)};"
            for one, place in zip(given, places, strict=True)
        )

    def _places(self, operand: str, words: list[str], space: str, what: int) -> list[str]:
        size = max(int(words[-1][1:]) // 8, 1)
        number = next((int(word[1:]) for word in words if re.fullmatch(r"v[24]", word)), 1)
        inner = operand[1:-1].strip()
        return [
            self._place(f"[{_farther(inner, k * size)}]", space, size, what) for k in range(number)
        ]

    def _do_red(self, words: list[str], to: list[str]) -> str:
        return self._atomic(words, to[0], to[1], "_")

    def _do_atom(self, words: list[str], to: list[str]) -> str:
        return self._atomic(words, to[1], to[2], to[0])

    def _atomic(self, words: list[str], place: str, value: str, back: str) -> str:
        kind = words[-1]
        assert _space(words) == GLOBAL and kind[0] != "f"  # whole numbers alone have no order
        at = f"({TYPES[kind]} *){self._place(place, GLOBAL, int(kind[1:]) // 8, ADD)}"
        given = self._value(value, kind)
        if "add" in words:
            return self._put(back, kind, f"__atomic_fetch_add({at}, {given}, __ATOMIC_RELAXED)")
        assert "max" in words
        found = "" if back == "_" else self._put(back, kind, "before")
        number = TYPES[kind]
        return (
            f"{{ {number} *there = {at}, before = *there, most = {given}; "
            f"if (most > before) *there = most; {found} }}"
        )

    def _do_cp(self, words: list[str], to: list[str]) -> str:
        if words[:2] == ["async", "bulk"]:  # groups of bulk additions, which are done at once here
            assert words[2] in ("commit_group", "wait_group")
            return ""
        assert words[:3] == ["reduce", "async", "bulk"]
        assert words[-2:] == ["add", "u64"]
        size, source = int(to[2]), self._place(to[1], "shared", 8, READ)
        places = (f"[{_farther(to[0][1:-1], k)}]" for k in range(0, size, 8))
        adds = (
            f"__atomic_fetch_add((uint64_t *){self._place(place, GLOBAL, 8, ADD)}, "
            f"*(uint64_t *)({source} + {8 * k}), __ATOMIC_RELAXED);"
            for k, place in enumerate(places)
        )
        return " ".join(adds)

    def _do_fence(self, words: list[str], to: list[str]) -> str:
        assert words == ["proxy", "async", "shared::cta"]
        return ""

    def _do_mov(self, words: list[str], to: list[str]) -> str:
        if to[0].startswith("{"):
            low, high = (one.strip() for one in to[0].strip("{}").split(","))
            both = self._value(to[1], "b64")
            return f"{self._put(low, 'b32', f'(uint32_t){both}')} " + self._put(
                high, "b32", f"(uint32_t)({both} >> 32)"
            )
        if to[1].startswith("{"):
            low, high = (self._value(x.strip(), "b32") for x in to[1].strip("{}").split(","))
            return self._put(to[0], "b64", f"((uint64_t){high} << 32 | {low})")
        return self._put(to[0], words[-1], self._value(to[1], words[-1]))

    def _do_cvta(self, words: list[str], to: list[str]) -> str:
        return self._put(to[0], "u64", self._value(to[1], "u64"))

    def _do_cvt(self, words: list[str], to: list[str]) -> str:
        wanted, given = words[-2:]
        value = self._value(to[1], given)
        if wanted == given == "f64":
            if "sat" in words:
                return self._put(to[0], wanted, f"{value} >= 1 ? 1.0 : {value} > 0 ? {value} : 0.0")
            return self._put(to[0], wanted, f"{WHOLE_PARTS[words[0]]}({value})")
        if given == "f64" and wanted in ("s32", "s64"):
            assert words[0] == "rzi"
            return self._put(to[0], wanted, f"{wanted}_of({value})")
        assert given[0] != "f" or wanted[0] == "f"
        return self._put(to[0], wanted, f"({TYPES[wanted]}){value}")

    def _do_testp(self, words: list[str], to: list[str]) -> str:
        return self._put(to[0], "pred", CLASSES[words[0]].format(self._value(to[1], words[1])))

    def _do_setp(self, words: list[str], to: list[str]) -> str:
        compare, kind = words[0], words[-1]
        a, b = self._value(to[1], kind), self._value(to[2], kind)
        nan = f"({a} != {a} || {b} != {b})"
        if compare in ("nan", "num"):
            return self._put(to[0], "pred", nan if compare == "nan" else f"!{nan}")
        real = kind in ("f64", "f32")
        unordered = real and compare.endswith("u") and compare != "u"
        test = f"({a} {COMPARISONS[compare[:-1] if unordered else compare]} {b})"
        if unordered:
            test = f"({test} || {nan})"
        elif real:
            test = f"({test} && !{nan})"
        if len(words) == 3 and len(to) == 4:  # combined with another predicate
            test = f"({test} {OPERATORS[words[1]]} {self._value(to[3].lstrip('!'), 'pred')})"
            assert "!" not in to[3]
        return self._put(to[0], "pred", test)

    def _do_selp(self, words: list[str], to: list[str]) -> str:
        a, b = (self._value(x, words[-1]) for x in to[1:3])
        return self._put(to[0], words[-1], f"{self._value(to[3], 'pred')} ? {a} : {b}")

    def _do_max(self, words: list[str], to: list[str]) -> str:
        return self._extreme("max", ">", words, to)

    def _do_min(self, words: list[str], to: list[str]) -> str:
        return self._extreme("min", "<", words, to)

    def _extreme(self, head: str, compare: str, words: list[str], to: list[str]) -> str:
        kind = words[-1]
        a, b = (self._value(x, kind) for x in to[1:])
        if kind in ("f64", "f32"):
            return self._put(to[0], kind, f"{head}_{kind}({a}, {b})")
        return self._put(to[0], kind, f"{a} {compare} {b} ? {a} : {b}")

    def _do_neg(self, words: list[str], to: list[str]) -> str:
        return self._put(to[0], words[-1], f"-{self._value(to[1], words[-1])}")

    def _do_not(self, words: list[str], to: list[str]) -> str:
        sign = "!" if words[-1] == "pred" else "~"
        return self._put(to[0], words[-1], f"{sign}{self._value(to[1], words[-1])}")

    def _do_abs(self, words: list[str], to: list[str]) -> str:
        value = self._value(to[1], words[-1])
        plain = f"{value} < 0 ? -{value} : {value}"
        return self._put(to[0], words[-1], f"fabs({value})" if words[-1] == "f64" else plain)

    def _do_sqrt(self, words: list[str], to: list[str]) -> str:
        kind = words[-1]
        assert words == ["rn", kind]
        root = {"f64": "sqrt", "f32": "sqrtf"}[kind]
        return self._put(to[0], kind, f"{root}({self._value(to[1], kind)})")

    def _do_rcp(self, words: list[str], to: list[str]) -> str:
        assert words == ["rn", "f64"]
        return self._put(to[0], "f64", f"1.0 / {self._value(to[1], 'f64')}")

    def _do_copysign(self, words: list[str], to: list[str]) -> str:
        sign, size = (self._value(x, "f64") for x in to[1:])
        return self._put(to[0], "f64", f"copysign({size}, {sign})")

    def _do_shl(self, words: list[str], to: list[str]) -> str:
        return self._shifted("<<", words[-1], to)

    def _do_shr(self, words: list[str], to: list[str]) -> str:
        return self._shifted(">>", words[-1], to)

    def _shifted(self, how: str, kind: str, to: list[str]) -> str:
        value, count = self._value(to[1], kind), self._value(to[2], "u32")
        beyond = f"({value} < 0 ? -1 : 0)" if kind[0] == "s" else "0"
        inside = f"({TYPES[kind]})({value} {how} {count})"
        return self._put(to[0], kind, f"{count} >= {kind[1:]} ? {beyond} : {inside}")

    def _do_bfe(self, words: list[str], to: list[str]) -> str:
        kind, size = words[-1], int(words[-1][1:])
        first, number = int(to[2]), int(to[3])
        up, down = size - first - number, size - number
        value = f"({TYPES[kind]})(({TYPES['u' + kind[1:]]}){self._value(to[1], kind)} << {up})"
        return self._put(to[0], kind, f"{value} >> {down}")

    def _do_bfi(self, words: list[str], to: list[str]) -> str:
        kind, first, number = words[-1], int(to[3]), int(to[4])
        mask = f"0x{((1 << number) - 1) << first:x}ull"
        into, given = self._value(to[2], kind), self._value(to[1], kind)
        return self._put(to[0], kind, f"({into} & ~{mask}) | (({given} << {first}) & {mask})")

    def _do_bra(self, words: list[str], to: list[str]) -> str:
        return f"goto l_{_plain(to[0])};"

    def _do_ret(self, words: list[str], to: list[str]) -> str:
        return "return;"

    def _do_call(self, words: list[str], to: list[str]) -> str:
        back, name, *given = to if to[0].startswith("(") else ["()", *to]
        names = re.findall(r"[\w$]+", f"{back} {' '.join(given)}")
        return f"f_{name}({', '.join(f'p_{one}' for one in names)});"


def _space(words: list[str]) -> str:
    """The memory of an access; without a name it is global or a thread's own, by its address."""
    return next((word for word in words if word in SPACES), GENERIC)


def _farther(place: str, bytes_on: int) -> str:
    base, _, offset = place.partition("+")
    return f"{base.strip()}+{int(offset.strip() or 0) + bytes_on}"


def _plain(name: str) -> str:
    """A name of PTX as one of C."""
    return re.sub(r"\W", "_", name.lstrip("%"))


def _end_of_block(text: str, start: int) -> int:
    depth, k = 1, start
    while depth:
        depth += {"{": 1, "}": -1}.get(text[k], 0)
        k += 1
    return k - 1


def _pieces(body: str) -> list[str]:
    """Labels, braces and instructions; braces within an instruction enclose operands."""
    pattern = r"[\w$]+:(?!:)|(?:@!?%p\d+\s+)?[.\w:]+(?:\s[^;{}]*\{[^}]*\}[^;]*|\s[^;{}]*)?;|[{}]"
    return [found[0] for found in re.finditer(pattern, body)]
