"""Checks the specifications of the float cores (proofs/float/*.smt2) against MPFR."""

import string
import struct

from synth import smt, store, tools
from synth.float_proofs import FLOAT, FORMATS, NARROW_FORMATS, FloatProof

SPECIFICATIONS = [FloatProof(operation, name)
                  for operation in ("add", "multiply", "divide", "compare")
                  for name in FORMATS | NARROW_FORMATS]
VECTORS = 125_000  # test vectors per specification
BATCH = 5000  # vectors evaluated in one query

# The operations that MPFR computes for each specification: number in FloatOp of sim/fp/float_format.h -> argument `second` in vectors/.
ASKED = {"add": {0: "false", 1: "true"}, "multiply": {2: "false"}, "divide": {3: "false"}, "compare": {4: "false", 6: "true"}}
CODES = {"binary16": ("<H", "<e", "<f", "<I"), "binary32": ("<I", "<f", "<d", "<Q")}


def wide_word(word: int, name: str) -> str:
    """Converts a word of format `name` to the next wider format; returns the SMT-LIB literal of its bits."""
    if name == "bfloat16":
        return wide_word(word << 16, "binary32")
    narrow, as_narrow, as_wide, wide = CODES[name]
    value = struct.unpack(as_narrow, struct.pack(narrow, word))[0]
    bits = struct.unpack(wide, struct.pack(as_wide, value))[0]
    return f"#b{bits:0{8 * struct.calcsize(wide)}b}"


def agrees_with_mpfr(one: FloatProof, count: int = VECTORS) -> tuple[dict, bool]:
    """Checks, by the solver, that a specification accepts MPFR's results of `count` operations. Also checks that it rejects a result with
    one bit changed."""
    folder = store.OUT / "proofs" / f"float.specification.{one.name}"
    vectors = FLOAT / "vectors" / f"{one.operation}{'_narrow' if one.is_narrow else ''}.smt2"
    numbers = one.numbers()
    width = numbers["W"]
    wide = "" if one.operation == "divide" else "(define-sort WideWord () (_ BitVec $WW))\n"
    text = "".join(["(set-logic QF_BVFP)\n", *one.texts()[:-1], wide, vectors.read_text()])
    text = string.Template(text).substitute(numbers)
    oracle = [tools.ROOT / "sim" / name for name in ("fp/vectors.cpp", "test/fp/oracle.cpp")]
    program = FLOAT / "mpfr_vectors.cpp"
    wanted = store.key([*oracle, program, FLOAT / "solve.py"], smt.version(), text, count)

    def case(line: str, second: str) -> str:
        mode, after, a, b, result, flags = map(int, line.split())
        after_text = "true" if after else "false"
        return (f"(agrees (mode #b{mode:03b}) {after_text} #b{a:0{width}b} #b{b:0{width}b} "
                f"#b{result:0{width}b} #b{flags:05b} {second} "
                f"{wide_word(a, one.format)} {wide_word(b, one.format)})")

    def evaluate(cases: list[str]) -> dict:
        return smt.solve(folder / "cases.smt2", text + "(assert (not (and true\n" + "\n".join(cases) + ")))\n")

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

    return store.proven(folder, wanted, work)
