"""The float cores held against IEEE 754, for every operand: the queries, and the solver's answers.

A query is one file of SMT-LIB, build/synth/proofs/float.NAME/query.smt2, that any solver reads:
the specification (proofs/float/*.smt2), the core as Yosys writes it, and a claim
(proofs/float/claims). "unsat" means that no operand breaks the claim. Placeholders ($E, $S) are
numbers that follow from the format.
"""

import dataclasses
import functools
import importlib.util
import json
import pathlib
import re
import string
import struct
import sys

from synth import cores, store, tools

FLOAT = pathlib.Path(__file__).resolve().parent / "proofs" / "float"

# Exponent and fraction widths of a format, and of a wider one that Bitwuzla knows: the next.
FORMATS = {"binary16": (5, 10, 8, 23), "binary32": (8, 23, 11, 52)}
# Formats that it does not know: their numbers are held in the format of this fraction width, and
# NARROW_CLAIMS are read instead of the claims of that name.
NARROW_FORMATS = {"bfloat16": (8, 7, 11, 52)}
HELD_FRACTION = {"bfloat16": 23}
NARROW_CLAIMS = ("add", "multiply", "divide")
# No query holds all of it: one for each difference of exponents.
SPLIT_FORMATS = {"binary64": (11, 52, 15, 112)}

# What a core is made of, as its parameters.
ARITHMETIC = {
    "ripple": "Arith 0 Adder 0", "uniform": "Arith 0 Adder 1", "graded": "Arith 0 Adder 2",
    "prefix": "Arith 0 Adder 3", "structural": "Arith 0", "behavioural": "Arith 1", "": ""}
ADDERS = ["ripple", "uniform", "graded", "prefix"]  # the structural kinds


@dataclasses.dataclass(frozen=True)
class Operation:
    """What is claimed of which module, by which specification, around which contracts.

    `top`: "" for a claim about the specification alone. `parameters`: the module's.
    """

    top: str
    says: str
    specification: tuple[str, ...]
    contracts: tuple[str, ...] = ()
    parameters: str = "ExpWidth $E FracWidth $F"


OPERATIONS = {
    "add": Operation("fp_adder", "the sum, all modes and flags", ("format", "add")),
    "multiply": Operation(
        "fp_multiplier", "the product, all modes and flags, around any product of significands",
        ("format", "multiply"), ("multiplier",)),
    "multiply_whole": Operation("fp_multiplier", "the product", ("format", "multiply")),
    "divide": Operation(
        "fp_divider", "the quotient, all modes and flags, around any quotient of significands",
        ("format", "multiply", "divide"), ("srt_divider_stages",)),
    "divide_whole": Operation("fp_divider", "the quotient", ("format", "multiply", "divide")),
    "divide_cut": Operation(
        "fp_divider", "the quotient cut off after 21 bits, around any of significands",
        ("format", "multiply", "divide"), ("srt_divider_stages",),
        "ExpWidth $E FracWidth $F QuotientBits 21"),
    "srt_row": Operation(
        "srt_row", "a row of the divider: w' = 4 w - digit d, and |w'| <= 2/3 d again",
        ("srt",), (), "Width $N"),
    "srt_first_row": Operation(
        "srt_first_row", "the first row: w = 2 x - digit d, and |w| <= 2/3 d",
        ("srt",), (), "Width $N"),
    "srt_ends": Operation(
        "srt_divider_stages", "what enters the rows, remainder and quotient, around any rows",
        ("srt",), ("srt_row", "srt_first_row"), "Width $S Rows $ROWS"),
    "decode": Operation("", "a number is its significand by a power of two",
                        ("format", "multiply")),
    "sticky": Operation("", "what is left of a quotient may count as half a place",
                        ("format", "multiply", "divide")),
    "compare": Operation("fp_compare", "equal, less, unordered, flags", ("format", "compare")),
}


@dataclasses.dataclass(frozen=True)
class FloatProof:
    """A claim about one module; `long`: it takes more than a few minutes."""

    operation: str
    format: str
    arithmetic: str = ""
    quotient_bits: int = 0
    long: bool = False
    distances: tuple[int, int] | None = None  # the exponents' fields differ by so much

    @property
    def name(self) -> str:
        """Unique; of the folder too."""
        bits = self.quotient_bits
        parts = (self.operation, self.format, self.arithmetic, f"{bits}_bits" if bits else "",
                 "distance_{}_to_{}".format(*self.distances) if self.distances else "")
        return ".".join(filter(None, parts))

    @property
    def says(self) -> str:
        """The claim in words."""
        return OPERATIONS[self.operation].says

    @property
    def parameters(self) -> str:
        """The module's, "Name value ..."."""
        fixed = string.Template(OPERATIONS[self.operation].parameters).substitute(self.numbers())
        return f"{fixed} {ARITHMETIC[self.arithmetic]}"

    def numbers(self) -> dict[str, object]:
        """What the specifications' placeholders stand for."""
        exp, frac, wide_exp, wide_frac = (FORMATS | NARROW_FORMATS | SPLIT_FORMATS)[self.format]
        held_frac = HELD_FRACTION.get(self.format, frac)
        width = 1 + exp + frac
        bias, wide_bias = 2 ** (exp - 1) - 1, 2 ** (wide_exp - 1) - 1
        infinity = (2 ** exp - 1) << frac
        rows = (self.quotient_bits or frac + 2) // 2  # of the divider, two bits each
        residual = frac + 2

        def wide(significand: int, exponent: int) -> str:
            """significand * 2**exponent as a Wide."""
            top = significand.bit_length() - 1
            fraction = (significand << (wide_frac - top)) - (1 << wide_frac)
            return (f"(fp #b0 #b{exponent + top + wide_bias:0{wide_exp}b} "
                    f"#b{fraction:0{wide_frac}b})")

        def power(exponent: int) -> str:
            """The number before 2**exponent, the middle between the two, and 2**exponent."""
            one = 2 ** (frac + 2)
            return " ".join(wide(n, exponent - frac - 2) for n in (one - 2, one - 1, one))

        chain = "".join(
            f"(= free_{wire}_i_{row} {f'free_{wire}_o_{row - 1}' if wire != 'divisor' else wire})"
            for row in range(1, rows + 1) for wire in ("sum", "carry", "divisor"))

        def digits(first: str, sign: str) -> str:
            """The digits of a sign, the first one on top."""
            return functools.reduce(lambda upper, row: f"(concat {upper} free_{sign}_o_{row})",
                                    range(1, rows + 1), first)

        return {
            # format
            "FS": held_frac + 1, "NARROW_PAD": held_frac - frac - 1,
            "HELD": "w" if held_frac == frac else f"(concat w (_ bv0 {held_frac - frac}))",
            "INFINITY_PLACE": f"#b{infinity << 1:0{width}b}", "POWER": wide(1, bias + 1),
            "E": exp, "S": frac + 1, "F": frac, "W": width, "SIGN": width - 1, "QUIET": frac - 1,
            "WE": wide_exp, "WS": wide_frac + 1, "WF": wide_frac, "WW": 1 + wide_exp + wide_frac,
            "NAN": f"#b{infinity | 1 << (frac - 1):0{width}b}",
            "OVERFLOW": power(bias + 1), "UNDERFLOW": power(1 - bias),
            # multiply
            "FIELD_HIGH": width - 2, "P": 2 * frac + 2, "EXTEND": wide_exp - exp,
            "PAD": wide_frac - 2 * frac - 2,
            "PRODUCT_FIELD": wide_bias + wide_frac - 2 * (bias + frac),
            "DECODE_FIELD": wide_bias + wide_frac - bias - frac, "DECODE_PAD": wide_frac - frac - 1,
            # divide
            "WFIELD_HIGH": wide_exp + wide_frac - 1, "WF_TOP": wide_frac - 1,
            "WF_S": wide_frac - frac, "Q": 2 * rows + 2, "QUOTIENT_ONE": 4 ** rows,
            "QPAD": wide_frac - 2 * rows - 3,
            "QUOTIENT_FIELD": wide_bias + wide_frac - 2 - 2 * rows,
            "QUOTIENT_SHIFT": 2 * rows + 1, "QX": frac + 2 * rows + 2,
            "CUT_FROM_2": 2 * rows + 2 - self.quotient_bits,
            "CUT_FROM_1": 2 * rows + 1 - self.quotient_bits,
            # sticky: exponents twice as far apart as those of quotients
            "STICKY_PAD": wide_frac - 2 * rows - 10,
            "STICKY_FROM": wide_bias + wide_frac - 2 - 2 * rows - 2 ** (exp + 1),
            "STICKY_TO": wide_bias + wide_frac - 2 - 2 * rows + 2 ** (exp + 1),
            # rows of the divider
            "N": residual, "N4": residual + 4, "N2": residual + 2, "N_TOP": residual - 1,
            "N_NEXT": residual - 2, "ROWS": rows, "Q1": 2 * rows + 1,
            "CHAIN": f"(and true {chain})",
            "POSITIVES": digits("free_digit_o_0", "positive"),
            "NEGATIVES": digits("#b00", "negative"),
        }

    def case(self) -> str:
        """The case that is proven, if not all of them are at once."""
        if not self.distances:
            return ""
        exp, frac, *_ = SPLIT_FORMATS[self.format]
        field = f"(_ extract {exp + frac - 1} {frac})"
        a_less_b = f"(bvsub ({field} a_i) ({field} b_i))"
        b_less_a = f"(bvsub ({field} b_i) ({field} a_i))"
        distance = f"(ite (bvuge ({field} a_i) ({field} b_i)) {a_less_b} {b_less_a})"
        least, most = self.distances
        return (f"(assert (and (bvuge {distance} (_ bv{least} {exp})) "
                f"(bvule {distance} (_ bv{most} {exp}))))\n")

    def files(self) -> list[pathlib.Path]:
        """The specification, and behind it the claim."""
        parts = OPERATIONS[self.operation].specification
        claim = self.operation
        if self.is_narrow:
            parts, claim = (*parts, *(part for part in ("add", "narrow") if part not in parts)), f"{claim}_narrow"
        return [*(FLOAT / f"{part}.smt2" for part in parts), FLOAT / "claims" / f"{claim}.smt2"]

    @property
    def is_narrow(self) -> bool:
        """Whether the claim rounds to a format that the solver does not know."""
        return self.format in NARROW_FORMATS and self.operation in NARROW_CLAIMS

    def texts(self) -> list[str]:
        """The contents of `files`, numbers in place of placeholders."""
        numbers = self.numbers()
        return [string.Template(file.read_text()).substitute(numbers) for file in self.files()]

    def sources(self) -> list[pathlib.Path]:
        """The RTL, contracts in place of the modules that they stand for."""
        contracts = OPERATIONS[self.operation].contracts
        files = [file for file in cores.files("fp") if file.stem not in contracts]
        return files + [FLOAT / "contracts" / f"{module}.sv" for module in contracts]


_CORES = [FloatProof(operation, name, kind)
          for operation in ("add", "multiply", "divide") for name in FORMATS
          for kind in (*ADDERS, "behavioural")]
PROOFS = [
    *(FloatProof(operation, name, kind) for name in NARROW_FORMATS
      for operation in (*NARROW_CLAIMS, "srt_row", "srt_ends") for kind in (*ADDERS, "behavioural")),
    *(FloatProof(operation, name) for name in NARROW_FORMATS for operation in ("decode", "srt_first_row")),
    *(one for one in _CORES if (one.operation, one.format) != ("add", "binary32")),
    *(FloatProof("compare", name, kind) for name in FORMATS | NARROW_FORMATS
      for kind in ("structural", "behavioural")),
    *(FloatProof(part, name, kind) for part in ("srt_row", "srt_ends") for name in FORMATS
      for kind in (*ADDERS, "behavioural")),
    *(FloatProof(part, name) for part in ("decode", "sticky") for name in FORMATS),
    FloatProof("divide_cut", "binary32", "graded", 21),
    *(FloatProof("srt_first_row", name) for name in FORMATS),
    FloatProof("srt_ends", "binary32", "graded", 21),
    *(FloatProof("add", name, "graded", long=True, distances=(least, most))
      for name, (exp, frac, *_) in SPLIT_FORMATS.items()
      for least, most in (*((n, n) for n in range(frac + 8)), (frac + 8, 2 ** exp - 1))),
    *(dataclasses.replace(one, long=True) for one in _CORES
      if (one.operation, one.format) == ("add", "binary32")),
]


def state(model: str, top: str, name: str, before: str = "",
          given: dict[str, str] | None = None) -> str:
    """Declares a state of a module: one that follows `before`, or any. Registers are terms of the state
    before, inputs in `given` the terms there, and no equations: what two states compute alike is then
    one term to the solver."""
    width = int(re.search(rf"\(define-sort \|{re.escape(top)}_s\| \(\) \(_ BitVec (\d+)\)\)", model)[1])
    fields = re.findall(r"^\(define-fun \|(\S+#\d+)\| .*\(\(_ extract (\d+) (\d+)\) state\).* ; (.*)$",
                        model, re.M)
    following = re.findall(r"^  \(= (.*) \(\|(\S+#\d+)\| next_state\)\)", model, re.M)
    next_of = {field: re.sub(r"\bstate\b", before, term) for term, field in following if before}
    known = []
    for field, high, low, called in fields:
        wire = re.fullmatch(r"(?:.*[.\\])?(\w+)(?: \[(\d+)(?::(\d+))?\])?", called)
        if field in next_of:
            known.append((int(high), int(low), next_of[field]))
        elif given and wire and wire[1] in given:
            bits = f"(_ extract {wire[2]} {wire[3] or wire[2]})" if wire[2] else ""
            known.append((int(high), int(low), f"({bits} {given[wire[1]]})" if bits else given[wire[1]]))
    parts, top_bit = [], width - 1
    for high, low, term in sorted(known, reverse=True):
        if high < top_bit:
            parts.append(f"((_ extract {top_bit} {high + 1}) any_{name})")
        parts.append(term)
        top_bit = low - 1
    if top_bit >= 0:
        parts.append(f"((_ extract {top_bit} 0) any_{name})")
    word = functools.reduce(lambda upper, lower: f"(concat {upper} {lower})", parts)
    return (f"(declare-const any_{name} |{top}_s|)\n"
            f"(define-fun {name} () |{top}_s| {word})\n")


def ports(model: str, top: str, suffix: str = "", before: str = "",
          given: dict[str, str] | None = None) -> tuple[str, list[str]]:
    """A state (see `state`), names for a module's ports in it and for what contracts leave free
    ("free_..."; with the number of its row, where it is in one), and those names without `suffix`, which
    each gets."""
    text = [state(model, top, f"state{suffix}", before, given)]
    names = []
    pattern = re.compile(rf"\(define-fun \|({top}_n (\S+))\| \(\(state \|{top}_s\|\)\) "
                         r"(\([^)]*\)|Bool)")
    for function, wire, sort in pattern.findall(model):
        found = re.fullmatch(r"(?:.*\[(\d+)\])?(?:.*\.)?(free_\w+)", wire)
        name = wire
        if found:
            name = found[2] + (f"_{found[1]}" if found[1] else "")
        elif not re.fullmatch(r"\w+_[io]", wire):
            continue
        text.append(f"(define-fun {name}{suffix} () {sort} (|{function}| state{suffix}))")
        names.append(name)
    return "\n".join(text) + "\n", names


def write_model(sources: list[pathlib.Path], top: str, parameters: str, folder: pathlib.Path,
                keep: str = "") -> str:
    """A module as SMT-LIB; its netlist goes to `keep`."""
    smt2 = folder / "model.smt2"
    tools.run(["yosys", "-c", FLOAT / "model.tcl"], folder / "yosys.log", {
        "SOURCES": " ".join(map(str, sources)), "TOP": top, "PARAMETERS": parameters,
        "SMT2": str(smt2), "KEEP": keep})
    return smt2.read_text()


def query(one: FloatProof, model: str) -> tuple[str, list[str]]:
    """A query but for its last assertions, and the names of the module's ports."""
    *specification, claim = one.texts()
    top = OPERATIONS[one.operation].top
    named, wires = ports(model, top) if top else ("", [])
    return "(set-logic QF_BVFP)\n" + "".join([*specification, model, named, claim, one.case()]), wires


def solve(file: pathlib.Path, text: str, terms: tuple[str, ...] = (), limit: float = 0) -> dict:
    """Bitwuzla's answer to `text`, which is kept in `file`; see proofs/float/solve.py."""
    if importlib.util.find_spec("bitwuzla") is None:
        raise tools.MissingTool("Bitwuzla is not installed: pip install -r synth/requirements.txt")
    file.write_text(text + "(check-sat)\n")
    out = tools.run([sys.executable, FLOAT / "solve.py", file, limit, *terms],
                    file.with_suffix(".log"))
    return json.loads(out.splitlines()[-1])


def proven(one: FloatProof) -> tuple[dict, bool]:
    """Proves a claim; raises ToolFailed, with the operands, where it does not hold."""
    folder = store.OUT / "proofs" / f"float.{one.name}"
    wanted = store.key([*one.sources(), FLOAT / "model.tcl", FLOAT / "solve.py"],
                       tools.version("yosys"), one.parameters, one.texts(), *filter(None, [one.case()]))

    def work() -> dict:
        top = OPERATIONS[one.operation].top
        model = write_model(one.sources(), top, one.parameters, folder) if top else ""
        text, wires = query(one, model)
        if solve(folder / "assumption.smt2", text + "(assert assumed)\n")["answer"] != "sat":
            raise tools.ToolFailed(f"{one.name}: what it assumes cannot be")
        answer = solve(folder / "query.smt2",
                       text + "(assert assumed)\n(assert (not claimed))\n", tuple(wires))
        if answer["answer"] != "unsat":
            raise tools.ToolFailed(f"{one.name}: {answer['answer']}: {answer['values']}")
        return {"holds": True}

    return store.cached(folder, wanted, tools.measured(work))


SPECIFICATIONS = [FloatProof(operation, name)
                  for operation in ("add", "multiply", "divide", "compare")
                  for name in FORMATS | NARROW_FORMATS]
VECTORS = 125_000  # for each of these
BATCH = 5000  # evaluated in one query

# What MPFR is asked of each: FloatOp of sim/fp/float_format.h, and `second` of vectors/.
ASKED = {"add": {0: "false", 1: "true"}, "multiply": {2: "false"}, "divide": {3: "false"},
         "compare": {4: "false", 6: "true"}}
CODES = {"binary16": ("<H", "<e", "<f", "<I"), "binary32": ("<I", "<f", "<d", "<Q")}


def wide_word(word: int, name: str) -> str:
    """The word of a number in the next wider format."""
    if name == "bfloat16":
        return wide_word(word << 16, "binary32")
    narrow, as_narrow, as_wide, wide = CODES[name]
    value = struct.unpack(as_narrow, struct.pack(narrow, word))[0]
    bits = struct.unpack(wide, struct.pack(as_wide, value))[0]
    return f"#b{bits:0{8 * struct.calcsize(wide)}b}"


def agrees_with_mpfr(one: FloatProof, count: int = VECTORS) -> tuple[dict, bool]:
    """Evaluates a specification, by the solver, on `count` operations of which MPFR gives the
    result; and sees that it refuses one of them with a bit of the result changed."""
    folder = store.OUT / "proofs" / f"float.specification.{one.name}"
    vectors = FLOAT / "vectors" / f"{one.operation}{'_narrow' if one.is_narrow else ''}.smt2"
    numbers = one.numbers()
    width = numbers["W"]
    wide = "" if one.operation == "divide" else "(define-sort WideWord () (_ BitVec $WW))\n"
    text = "".join(["(set-logic QF_BVFP)\n", *one.texts()[:-1], wide, vectors.read_text()])
    text = string.Template(text).substitute(numbers)
    oracle = [tools.ROOT / "sim" / name for name in ("fp/vectors.cpp", "test/fp/oracle.cpp")]
    program = FLOAT / "mpfr_vectors.cpp"
    wanted = store.key([*oracle, program, FLOAT / "solve.py"], text, count)

    def case(line: str, second: str) -> str:
        mode, after, a, b, result, flags = map(int, line.split())
        after_text = "true" if after else "false"
        return (f"(agrees (mode #b{mode:03b}) {after_text} #b{a:0{width}b} #b{b:0{width}b} "
                f"#b{result:0{width}b} #b{flags:05b} {second} "
                f"{wide_word(a, one.format)} {wide_word(b, one.format)})")

    def evaluate(cases: list[str]) -> dict:
        return solve(folder / "cases.smt2",
                     text + "(assert (not (and true\n" + "\n".join(cases) + ")))\n")

    def work() -> dict:
        maker = folder / "mpfr_vectors"
        tools.run(["g++", "-std=c++20", "-O2", "-iquote", tools.ROOT, program, *oracle, "-lmpfr",
                   "-lgmp", "-o", maker], folder / "build.log")
        exp, frac, *_ = (FORMATS | NARROW_FORMATS)[one.format]
        asked = ASKED[one.operation]
        for op, second in asked.items():
            lines = tools.run([str(maker), exp, frac, op, count // len(asked)],
                              folder / "vectors.txt").splitlines()
            mode, after, a, b, result, flags = lines[0].split()
            wrong = " ".join((mode, after, a, b, str(int(result) ^ 1), flags))
            if evaluate([case(wrong, second)])["answer"] != "sat":
                raise tools.ToolFailed(f"{one.name}: a wrong result passes: {folder}/cases.smt2")
            for start in range(0, len(lines), BATCH):
                cases = [case(line, second) for line in lines[start:start + BATCH]]
                if evaluate(cases)["answer"] != "unsat":
                    raise tools.ToolFailed(f"{one.name}: differs from MPFR: {folder}/cases.smt2")
        return {"holds": True}

    return store.cached(folder, wanted, tools.measured(work))


def lemma(name: str) -> tuple[dict, bool]:
    """Proves a lemma of numbers: z3 says "unsat", or "sat" where the question does."""
    file = FLOAT / "lemmas" / f"{name}.smt2"
    folder = store.OUT / "proofs" / f"float.lemma.{name}"

    def work() -> dict:
        answers = tools.run(["z3", file], folder / "z3.log").split()
        questions = re.findall(r"^\(check-sat\)( ; sat)?$", file.read_text(), re.M)
        if answers != ["sat" if said else "unsat" for said in questions]:
            raise tools.ToolFailed(f"{file}: {' '.join(answers)}")
        return {"holds": True}

    return store.cached(folder, store.key([file], tools.version("z3")), tools.measured(work))


LEMMAS = {"multiplication": "what claims/multiply.smt2 assumes of a product",
          "division": "from the rows to the quotient",
          "edge_bound": "beyond its bound an edge product has the exact one's sign, binary32",
          "distance": "how far off N . I may be, and two steps to the bound on t"}
