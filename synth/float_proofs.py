"""The float cores held against IEEE 754, for every operand: the queries, and the solver's answers.

A query is one file of SMT-LIB, build/synth/proofs/float.NAME/query.smt2, that any solver reads:
the specification (proofs/float/*.smt2), the core as Yosys writes it, and the claim
(proofs/float/claims). "unsat" means that no operand breaks the claim.
"""

import dataclasses
import importlib.util
import json
import pathlib
import re
import string
import sys

from synth import cores, store, tools

FLOAT = pathlib.Path(__file__).resolve().parent / "proofs" / "float"

# Exponent and fraction widths.
FORMATS = {"binary16": (5, 10), "binary32": (8, 23)}
# The next wider of the formats that Bitwuzla knows.
WIDER = {"binary16": (8, 23), "binary32": (11, 52)}

# What a core is made of, as its parameters.
ARITHMETIC = {
    "ripple": "Adder 0", "uniform": "Adder 1", "graded": "Adder 2", "prefix": "Adder 3",
    "behavioural": "Adder 4"}

MODES = ["near_even", "minMag", "min", "max", "near_maxMag"]  # TestFloat's names


@dataclasses.dataclass(frozen=True)
class Operation:
    """What is specified: the core, its specification, its claim, what stands for its parts."""

    top: str
    says: str
    specification: tuple[str, ...]
    claim: str
    contracts: tuple[str, ...] = ()  # modules that are replaced


OPERATIONS = {
    "add": Operation("fp_adder", "is IEEE 754's sum, all modes and flags",
                     ("add",), "add"),
    "multiply": Operation("fp_multiplier", "rounds the product of the significands as IEEE 754 does",
                          ("multiply",), "multiply", ("booth_multiplier",)),
    "multiply_whole": Operation("fp_multiplier", "is IEEE 754's product, all modes and flags",
                                ("multiply",), "multiply_whole"),
    "divide": Operation("fp_divider", "rounds the quotient of the significands as IEEE 754 does",
                        ("multiply", "divide"), "divide", ("srt_divider_stages",)),
    "compare": Operation("fp_compare", "is IEEE 754's comparison",
                         ("compare",), "compare"),
}


def numbers(name: str, quotient_bits: int = 0) -> dict[str, object]:
    """What the specifications' placeholders stand for in the format `name`."""
    exp, frac = FORMATS[name]
    wide_exp, wide_frac = WIDER[name]
    width = 1 + exp + frac
    bias, wide_bias = 2 ** (exp - 1) - 1, 2 ** (wide_exp - 1) - 1
    infinity = (2 ** exp - 1) << frac
    rows = ((quotient_bits - 1 if quotient_bits else frac + 1) + 1) // 2

    def wide(significand: int, exponent: int) -> str:
        """significand * 2**exponent as a Wide."""
        top = significand.bit_length() - 1
        fraction = (significand << (wide_frac - top)) - (1 << wide_frac)
        return f"(fp #b0 #b{exponent + top + wide_bias:0{wide_exp}b} #b{fraction:0{wide_frac}b})"

    def power(exponent: int) -> str:
        """The number before 2**exponent, the middle between the two, and 2**exponent."""
        one = 2 ** (frac + 2)
        return " ".join(wide(n, exponent - frac - 2) for n in (one - 2, one - 1, one))

    return {
        "E": exp, "S": frac + 1, "F": frac, "W": width, "SIGN": width - 1, "QUIET": frac - 1,
        "FIELD_HIGH": width - 2, "FIELD_LOW": frac, "P": 2 * frac + 2,
        "WE": wide_exp, "WS": wide_frac + 1, "WF": wide_frac, "WW": 1 + wide_exp + wide_frac,
        "EXTEND": wide_exp - exp, "PAD": wide_frac - 2 * frac - 2,
        "NAN": f"#b{infinity | 1 << (frac - 1):0{width}b}",
        "OVERFLOW": power(bias + 1), "UNDERFLOW": power(1 - bias),
        "PRODUCT_FIELD": wide_bias + wide_frac - 2 * (bias + frac),
        "WFIELD_HIGH": wide_exp + wide_frac - 1, "WF_TOP": wide_frac - 1, "WF_S": wide_frac - frac,
        "Q": 2 * rows + 2, "QUOTIENT_ONE": 4 ** rows, "QPAD": wide_frac - 2 * rows - 3,
        "QUOTIENT_FIELD": wide_bias + wide_frac - 2 - 2 * rows,
    }


def specification(operation: str, name: str, quotient_bits: int = 0) -> str:
    """The specification of `operation` in the format `name`."""
    files = [FLOAT / f"{part}.smt2"
             for part in ("format", *OPERATIONS[operation].specification)]
    values = numbers(name, quotient_bits)
    text = "".join(string.Template(file.read_text()).substitute(values) for file in files)
    return "(set-logic QF_BVFP)\n" + text


def sources(operation: Operation) -> list[pathlib.Path]:
    """The RTL of a core, contracts in place of what they stand for."""
    files = [file for file in cores.files("fp") if file.stem not in operation.contracts]
    return files + [FLOAT / "contracts" / f"{module}.sv" for module in operation.contracts]


def ports(model: str, top: str) -> tuple[str, list[str]]:
    """Names for the core's ports and for what contracts leave free ("free_..."), and those names."""
    text = [f"(declare-const state |{top}_s|)"]
    names = []
    pattern = re.compile(rf"\(define-fun \|({top}_n (\S+))\| \(\(state \|{top}_s\|\)\) "
                         r"(\([^)]*\)|Bool)")
    for function, wire, sort in pattern.findall(model):
        last = wire.split(".")[-1]
        if "." in wire and not last.startswith("free_"):
            continue
        if not re.fullmatch(r"\w+_[io]|free_\w+", last):
            continue
        text.append(f"(define-fun {last} () {sort} (|{function}| state))")
        names.append(last)
    return "\n".join(text) + "\n", names


def query(operation: str, name: str, model: str, extra: str = "") -> tuple[str, list[str]]:
    """All of a query but its last assertion, and the names of the core's ports."""
    named, wires = ports(model, OPERATIONS[operation].top)
    claim = (FLOAT / "claims" / f"{OPERATIONS[operation].claim}.smt2").read_text()
    return specification(operation, name) + model + named + claim + extra, wires


def installed() -> None:
    """Raises MissingTool where the solver is not."""
    if importlib.util.find_spec("bitwuzla") is None:
        raise tools.MissingTool("Bitwuzla is not installed: pip install -r synth/requirements.txt")


def solve(file: pathlib.Path, text: str, terms: tuple[str, ...] = ()) -> dict:
    """Bitwuzla's answer to `text`, which is kept in `file`."""
    file.write_text(text + "(check-sat)\n")
    out = tools.run([sys.executable, FLOAT / "solve.py", file, *terms], file.with_suffix(".log"))
    return json.loads(out.splitlines()[-1])


@dataclasses.dataclass(frozen=True)
class FloatProof:
    """A claim about one core; `long`: it takes more than a few minutes."""

    operation: str
    format: str
    arithmetic: str
    long: bool = False

    @property
    def name(self) -> str:
        """Unique; of the folder too."""
        return ".".join(filter(None, (self.operation, self.format, self.arithmetic)))

    @property
    def says(self) -> str:
        """The claim in words."""
        return OPERATIONS[self.operation].says

    @property
    def parameters(self) -> str:
        """The core's, "Name value ..."."""
        exp, frac = FORMATS[self.format]
        return f"ExpWidth {exp} FracWidth {frac} {ARITHMETIC.get(self.arithmetic, '')}"


PROOFS = [
    *(FloatProof(operation, "binary16", kind)
      for operation in ("add", "multiply", "divide") for kind in ARITHMETIC),
    *(FloatProof(operation, "binary32", kind)
      for operation in ("multiply", "divide") for kind in ARITHMETIC),
    *(FloatProof("compare", name, "") for name in FORMATS),
    *(FloatProof("add", "binary32", kind, long=True) for kind in ("behavioural", "graded")),
]


def proven(one: FloatProof) -> tuple[dict, bool]:
    """Proves a claim; raises ToolFailed, with the operands, where it does not hold."""
    installed()
    parts = OPERATIONS[one.operation]
    folder = store.OUT / "proofs" / f"float.{one.name}"
    claim = FLOAT / "claims" / f"{parts.claim}.smt2"
    wanted = store.key([*sources(parts), *sorted(FLOAT.glob("*.*")), claim],
                       tools.version("yosys"), one.parameters, sorted(numbers(one.format).items()))

    def work() -> dict:
        write_model(parts, one.parameters, folder / "model.smt2")
        text, wires = query(one.operation, one.format, (folder / "model.smt2").read_text())
        if solve(folder / "assumption.smt2", text + "(assert assumed)\n")["answer"] != "sat":
            raise tools.ToolFailed(f"{one.name}: what it assumes cannot be")
        answer = solve(folder / "query.smt2",
                       text + "(assert assumed)\n(assert (not claimed))\n", tuple(wires))
        if answer["answer"] != "unsat":
            raise tools.ToolFailed(f"{one.name}: {answer['answer']}: {answer['values']}")
        return {"holds": True, "seconds": answer["seconds"], "megabytes": answer["megabytes"]}

    return store.cached(folder, wanted, work)


def write_model(parts: Operation, parameters: str, smt2: pathlib.Path, keep: str = "") -> None:
    """Writes a core as SMT-LIB, and its netlist to `keep`."""
    tools.run(["yosys", "-c", FLOAT / "model.tcl"], smt2.with_name("yosys.log"), {
        "SOURCES": " ".join(map(str, sources(parts))), "TOP": parts.top, "PARAMETERS": parameters,
        "SMT2": str(smt2), "KEEP": keep})
