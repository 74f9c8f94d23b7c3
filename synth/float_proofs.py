"""Proves the float cores against IEEE 754 for all operands.

A query is one SMT-LIB file for any solver, build/synth/proofs/float.NAME/query.smt2. It has the specification (proofs/float/*.smt2), the
core as Yosys writes it, and a claim (proofs/float/claims). The answer "unsat" means that no operands break the claim. Placeholders such as
$E and $S stand for numbers that depend on the format.
"""

import dataclasses
import functools
import pathlib
import re
import string

from synth import cores, smt, store, tools, yosys

FLOAT = pathlib.Path(__file__).resolve().parent / "proofs" / "float"

# Exponent and fraction widths of a format, and of the next wider format that Bitwuzla supports.
FORMATS = {"binary16": (5, 10, 8, 23), "binary32": (8, 23, 11, 52)}
# Formats that Bitwuzla does not support. Their numbers are represented in a supported format with HELD_FRACTION fraction bits. The claims
# about the operations NARROW_CLAIMS are in separate files for these formats (claims/*_narrow.smt2).
NARROW_FORMATS = {"bfloat16": (8, 7, 11, 52)}
HELD_FRACTION = {"bfloat16": 23}
NARROW_CLAIMS = ("add", "multiply", "divide")

# Kinds of arithmetic, as parameters of a core.
ARITHMETIC = {
    "ripple": "Arith 2", "uniform": "Arith 3", "graded": "Arith 0", "prefix": "Arith 4", "structural": "Arith 0",
    "behavioural": "Arith 1", "": ""}
ADDERS = ["ripple", "uniform", "graded", "prefix"]  # the structural kinds


@dataclasses.dataclass(frozen=True)
class Operation:
    """A claim about module `top` ("": about the specification alone).

    `specification`: files of proofs/float. `contracts`: modules that a contract replaces. `parameters`: parameters of `top`.
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
        ("format", "multiply", "divide"), ("srt_divider",)),
    "divide_whole": Operation("fp_divider", "the quotient", ("format", "multiply", "divide")),
    "divide_cut": Operation(
        "fp_divider", "the quotient cut off after 21 bits, around any of significands",
        ("format", "multiply", "divide"), ("srt_divider",),
        "ExpWidth $E FracWidth $F QuotientBits 21"),
    "srt_row": Operation(
        "srt_row", "a row of the divider: w' = 4 w - digit d, and |w'| <= 2/3 d again",
        ("srt",), (), "Width $N"),
    "srt_first_row": Operation(
        "srt_first_row", "the first row: w = 2 x - digit d, and |w| <= 2/3 d",
        ("srt",), (), "Width $N"),
    "srt_ends": Operation(
        "srt_divider", "what enters the rows, remainder and quotient, around any rows",
        ("srt",), ("srt_row", "srt_first_row"), "Width $S Rows $ROWS"),
    "decode": Operation("", "a number is its significand by a power of two", ("format", "multiply")),
    "sticky": Operation("", "what is left of a quotient may count as half a place", ("format", "multiply", "divide")),
    "compare": Operation("fp_compare", "equal, less, unordered, flags", ("format", "compare")),
}


@dataclasses.dataclass(frozen=True)
class FloatProof:
    """A claim about one module. `long`: the proof takes more than a few minutes."""

    operation: str
    format: str
    arithmetic: str = ""
    quotient_bits: int = 0
    long: bool = False

    @property
    def name(self) -> str:
        """Unique name of the claim; part of its folder's name."""
        bits = self.quotient_bits
        parts = (self.operation, self.format, self.arithmetic, f"{bits}_bits" if bits else "")
        return ".".join(filter(None, parts))

    @property
    def says(self) -> str:
        """The claim in words."""
        return OPERATIONS[self.operation].says

    @property
    def parameters(self) -> str:
        """The module's parameters as text, "Name value ..."."""
        fixed = string.Template(OPERATIONS[self.operation].parameters).substitute(self.numbers())
        return f"{fixed} {ARITHMETIC[self.arithmetic]}"

    def numbers(self) -> dict[str, object]:
        """Returns the values of the placeholders ($E, $S, ...) in the texts of the specification and the claim."""
        exp, frac, wide_exp, wide_frac = (FORMATS | NARROW_FORMATS)[self.format]
        held_frac = HELD_FRACTION.get(self.format, frac)
        width = 1 + exp + frac
        bias, wide_bias = 2 ** (exp - 1) - 1, 2 ** (wide_exp - 1) - 1
        infinity = (2 ** exp - 1) << frac
        rows = (self.quotient_bits or frac + 2) // 2  # rows of the divider; each gives two quotient bits
        residual = frac + 2

        def wide(significand: int, exponent: int) -> str:
            """Returns significand * 2**exponent in the wider format, sort Wide."""
            top = significand.bit_length() - 1
            fraction = (significand << (wide_frac - top)) - (1 << wide_frac)
            return (f"(fp #b0 #b{exponent + top + wide_bias:0{wide_exp}b} "
                    f"#b{fraction:0{wide_frac}b})")

        def power(exponent: int) -> str:
            """Returns three numbers near p = 2**exponent: x, the largest below p with frac + 1 significant bits; (x + p) / 2; p."""
            one = 2 ** (frac + 2)
            return " ".join(wide(n, exponent - frac - 2) for n in (one - 2, one - 1, one))

        chain = "".join(
            f"(= free_{wire}_i_{row} {f'free_{wire}_o_{row - 1}' if wire != 'divisor' else wire})"
            for row in range(1, rows + 1) for wire in ("sum", "carry", "divisor"))

        def digits(first: str, sign: str) -> str:
            """Returns the concatenated quotient digits of one sign, the first digit most significant."""
            return functools.reduce(lambda upper, row: f"(concat {upper} free_{sign}_o_{row})", range(1, rows + 1), first)

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
            # sticky: range of exponents twice as wide as that of quotients
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

    def files(self) -> list[pathlib.Path]:
        """Returns the files of the specification, then the file of the claim."""
        parts = OPERATIONS[self.operation].specification
        claim = self.operation
        if self.is_narrow:
            parts, claim = (*parts, *(part for part in ("add", "narrow") if part not in parts)), f"{claim}_narrow"
        return [*(FLOAT / f"{part}.smt2" for part in parts), FLOAT / "claims" / f"{claim}.smt2"]

    @property
    def is_narrow(self) -> bool:
        """Whether the claim rounds to a format that the solver does not support."""
        return self.format in NARROW_FORMATS and self.operation in NARROW_CLAIMS

    def texts(self) -> list[str]:
        """Returns the contents of `files` with placeholders replaced by `numbers`."""
        numbers = self.numbers()
        return [string.Template(file.read_text()).substitute(numbers) for file in self.files()]

    def sources(self) -> list[pathlib.Path]:
        """Returns the RTL files, with contracts in place of the modules that they replace."""
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
    *(FloatProof("compare", name) for name in FORMATS | NARROW_FORMATS),
    *(FloatProof(part, name, kind) for part in ("srt_row", "srt_ends") for name in FORMATS
      for kind in (*ADDERS, "behavioural")),
    *(FloatProof(part, name) for part in ("decode", "sticky") for name in FORMATS),
    FloatProof("divide_cut", "binary32", "graded", 21),
    *(FloatProof("srt_first_row", name) for name in FORMATS),
    FloatProof("srt_ends", "binary32", "graded", 21),
    *(dataclasses.replace(one, long=True) for one in _CORES
      if (one.operation, one.format) == ("add", "binary32")),
]


def query(one: FloatProof, model: str) -> tuple[str, list[str]]:
    """Returns a query without its final `assert` commands, and the names of the module's ports."""
    *specification, claim = one.texts()
    top = OPERATIONS[one.operation].top
    named, wires = smt.ports(model, top) if top else ("", [])
    return "(set-logic QF_BVFP)\n" + "".join([*specification, model, named, claim]), wires


def proven(one: FloatProof) -> tuple[dict, bool]:
    """Proves a claim. Raises Refuted, with the operands, if the claim does not hold, and ToolFailed if the solver gives up."""
    folder = store.OUT / "proofs" / f"float.{one.name}"
    wanted = store.key([*one.sources(), smt.FREE, FLOAT / "solve.py"], yosys.version(), smt.version(), one.parameters, one.texts())

    def work() -> dict:
        top = OPERATIONS[one.operation].top
        model = smt.write_model(one.sources(), top, one.parameters, folder) if top else ""
        text, wires = query(one, model)
        if smt.solve(folder / "assumption.smt2", text + "(assert assumed)\n")["answer"] != "sat":
            raise tools.ToolFailed(f"{one.name}: what it assumes cannot be")
        answer = smt.solve(folder / "query.smt2", text + "(assert assumed)\n(assert (not claimed))\n", tuple(wires))
        if answer["answer"] == "sat":
            raise tools.Refuted(one.name, answer["values"])
        if answer["answer"] != "unsat":
            raise tools.ToolFailed(f"{one.name}: {answer['answer']}: {answer['values']}")
        return {"holds": True}

    return store.proven(folder, wanted, work)


def lemma(name: str) -> tuple[dict, bool]:
    """Proves a lemma about numbers: z3 must answer "unsat" to every `check-sat`, or "sat" to those with the comment "; sat"."""
    file = FLOAT / "lemmas" / f"{name}.smt2"
    folder = store.OUT / "proofs" / f"float.lemma.{name}"

    def work() -> dict:
        answers = tools.run(["z3", file], folder / "z3.log").split()
        questions = re.findall(r"^\(check-sat\)( ; sat)?$", file.read_text(), re.M)
        if answers != ["sat" if said else "unsat" for said in questions]:
            raise tools.ToolFailed(f"{file}: {' '.join(answers)}")
        return {"holds": True}

    return store.proven(folder, store.key([file], tools.version("z3")), work)


LEMMAS = {"multiplication": "what claims/multiply.smt2 assumes of a product",
          "division": "from the rows to the quotient",
          "edge_bound": "beyond its bound an edge product has the exact one's sign, binary32",
          "distance": "how far off N . I may be, and two steps to the bound on t"}
