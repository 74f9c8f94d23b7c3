"""Proves that the pipelined float cores give the same results as the combinational cores, `latency` clocks later.

The claim: the result of the operands of clock 0 comes out in clock `latency`, from any state and with any operands in other clocks. The
rounding mode must be constant in clocks 0 to `latency`.
"""

import dataclasses
import re

from synth import smt, store, tools, yosys
from synth.float_proofs import ARITHMETIC, FLOAT, FORMATS, FloatProof


@dataclasses.dataclass(frozen=True)
class Cut:
    """A pipelined core, and the combinational core that it is compared with."""

    name: str
    top: str
    uncut: str  # key in OPERATIONS of the proof of the combinational core; its contracts are used here, too
    latency: dict[str, int]  # in clocks, by format
    product: int = 0  # the clock in which the contract of the multiplier puts out the product


CUTS = [
    Cut("add", "fp_adder", "add", {"binary16": 3, "binary32": 3}),
    Cut("multiply", "fp_multiplier", "multiply", {"binary16": 3, "binary32": 3}, 1),
    Cut("divide", "fp_divider", "divide_whole", {"binary16": 11, "binary32": 17}),
]


def question(cut: Cut, latency: int, stages: str, uncut: str) -> str:
    """Returns SMT-LIB for both cores (`stages`: pipelined, `uncut`) and the claim. Ports of the pipelined core in clock k end in _k."""
    named, wires = smt.ports(uncut, "uncut")
    modes = [wire for wire in wires if wire in ("rounding_mode_i", "tininess_after_i")]
    enters = {wire: word(uncut, wire) for wire in wires if wire.endswith("_i")}
    product = {wire: word(uncut, wire) for wire in wires if wire == "free_product"}
    stays = {wire: enters[wire] for wire in modes}
    if "|fp_divider_n valid_i|" in stages:
        enters["valid_i"] = "#b1"
    text = ["(set-logic QF_BV)\n", uncut, named, stages]
    text += [smt.ports(stages, cut.top, f"_{k}", f"state_{k - 1}" if k else "",
                       {**(stays if k else enters), **(product if k == cut.product else {})})[0] for k in range(latency + 1)]
    text.append(f"(define-fun claimed () Bool "
                f"(and (= result_o result_o_{latency}) (= flags_o flags_o_{latency})))\n")
    return "".join(text)


def word(model: str, wire: str) -> str:
    """Returns the SMT-LIB term of a port. A Bool port becomes a bit vector of one bit."""
    is_bit = re.search(rf"\(define-fun \|\S+_n {wire}\| \(\(state \S+\)\) Bool", model)
    return f"(ite {wire} #b1 #b0)" if is_bit else wire


def joints(cut: Cut, stages: str, uncut: str) -> list[str]:
    """Returns one claim per row of the divider: the registers after the row hold the combinational core's values. The claims are proven in
    this order, each with the previous ones assumed, because the solver does not terminate on the final claim alone."""
    found: dict[int, list[str]] = {}
    for wire, row in re.findall(rf"\(define-fun \|{cut.top}_n (\S+gen_row\[(\d+)\]\.\w+_q)\|", stages):
        inside = f"uncut_n {wire}|"
        if f"(define-fun |{inside}" in uncut and "valid" not in wire:
            found.setdefault(int(row), []).append(f"(= (|{inside} state) (|{cut.top}_n {wire}| state_{int(row) + 2}))")
    return [f"(and {' '.join(found[row])})" for row in sorted(found)]


def agree(cut: Cut, name: str, arithmetic: str) -> tuple[dict, bool]:
    """Proves that a core gives the same results with registers as without; raises ToolFailed if not. Returns what Proof.work returns."""
    exp, frac, *_ = FORMATS[name]
    folder = store.OUT / "proofs" / f"float.cuts.{cut.name}.{name}.{arithmetic}"
    uncut = FloatProof(cut.uncut, name, arithmetic)
    parameters = f"ExpWidth {exp} FracWidth {frac} {ARITHMETIC[arithmetic]} Pipelined 1"
    wanted = store.key([*uncut.sources(), smt.FREE, FLOAT / "solve.py"],
                       yosys.version(), smt.version(), parameters, cut.latency[name])

    def work() -> dict:
        stages = smt.write_model(uncut.sources(), cut.top, parameters, folder / "stages")
        plain = smt.write_model(uncut.sources(), cut.top, uncut.parameters, folder / "uncut").replace(cut.top, "uncut")
        text = question(cut, cut.latency[name], stages, plain)
        if smt.solve(folder / "assumption.smt2", text)["answer"] != "sat":
            raise tools.ToolFailed(f"{folder.name}: what it assumes cannot be")
        for claim in [*joints(cut, stages, plain), "claimed"]:
            answer = smt.solve(folder / "query.smt2", f"{text}(assert (not {claim}))\n")
            if answer["answer"] != "unsat":
                raise tools.ToolFailed(f"{folder.name}: {answer['answer']}: {claim}")
            text += f"(assert {claim})\n"
        return {"holds": True}

    return store.proven(folder, wanted, work)
