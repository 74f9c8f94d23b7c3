"""Proves a module's assertions for all inputs, by induction over clocks, with Bitwuzla.

The module is SMT-LIB text from Yosys's `write_smt2 -stbv`: states, initial states, transitions, and the assumptions, assertions and covers
of a state.
"""

import dataclasses
import pathlib
import re

from synth import smt, tools


@dataclasses.dataclass(frozen=True)
class Model:
    """A module as SMT-LIB text."""

    top: str
    text: str

    def listed(self, what: str) -> list[tuple[str, str]]:
        """Returns number and name of each "assert", "assume" or "cover" statement, or name and width of each "input" or "wire"."""
        return re.findall(rf"^; yosys-smt2-{what} (\S+) (.*)$", self.text, re.M)

    def functions(self) -> tuple[list[str], list[str]]:
        """Returns SMT-LIB for the uninterpreted functions of contracts/functions.sv: their declarations, and the equations for a `state`.
        An equation says that wire X_result is function X of wire X_operands."""
        width = dict(self.listed("wire"))
        declared, equal = {}, []
        for result in width:
            found = re.fullmatch(r"(?:.*\.)?(\w+)_result", result)
            operands = result.removesuffix("result") + "operands"
            if not found or operands not in width:
                continue
            declared[found[1]] = (f"(declare-fun {found[1]} ((_ BitVec {width[operands]})) "
                                  f"(_ BitVec {width[result]}))")
            equal.append(f"(= (|{self.top}_n {result}| state) "
                         f"({found[1]} (|{self.top}_n {operands}| state)))")
        return list(declared.values()), equal

    def clocks(self, count: int) -> str:
        """Returns SMT-LIB for `count` states s0, s1, ... Each is a successor of the state before. All assumptions hold in each state."""
        declared, equal = self.functions()
        lines = ["(set-logic QF_UFBV)", self.text, *declared,
                 f"(define-fun functions ((state |{self.top}_s|)) Bool (and true true {' '.join(equal)}))"]
        for k in range(count):
            lines.append(smt.state(self.text, self.top, f"s{k}", f"s{k - 1}" if k else ""))
            lines.append(f"(assert (and (|{self.top}_u| s{k}) (|{self.top}_h| s{k}) (functions s{k})))")
        return "\n".join(lines) + "\n"

    def first(self) -> str:
        """Returns the SMT-LIB assertion that s0 is an initial state."""
        return f"(assert (|{self.top}_i| s0))\n"

    def always(self, clocks: range) -> str:
        """Returns the term that all assertions hold in these states."""
        return "(and true " + " ".join(f"(|{self.top}_a| s{k})" for k in clocks) + ")"


def _refuse(model: Model, file: pathlib.Path, text: str, clocks: range) -> None:
    """Raises Refuted, with the broken assertions and the inputs, if an assertion can fail in a state of `clocks`. Raises ToolFailed if the
    solver cannot decide."""
    asserts, inputs = model.listed("assert"), model.listed("input")
    last = clocks[-1]
    terms = [f"(|{model.top}_a {number}| s{last})" for number, _ in asserts]
    terms += [f"(|{model.top}_n {name}| s{k})" for k in range(last + 1) for name, _ in inputs]
    answer = smt.solve(file, f"{text}(assert (not {model.always(clocks)}))\n", tuple(terms))
    if answer["answer"] == "unsat":
        return
    values = answer["values"]
    if answer["answer"] != "sat":
        raise tools.ToolFailed(f"{file}: {answer['answer']}: {values}")
    broken = [place for (_, place), term in zip(asserts, terms) if values.get(term) == "0"]
    raise tools.Refuted(f"{'; '.join(broken)} ({file})", {term: value for term, value in values.items() if "_n " in term})


def holds(top: str, smt2: pathlib.Path, steps: int, reach: int) -> None:
    """Proves all assertions by induction: they hold in the first `steps` clocks from power-up, and in the clock after any `steps` clocks in
    which they held. Also checks that a run of `steps` clocks from power-up exists, and that every `cover` is reached within `reach` clocks.
    A module with assumptions must have a `cover`, because contradictory assumptions would prove anything.
    `steps` = 0: the module has no registers. Raises Refuted or ToolFailed if a check fails."""
    model = Model(top, smt2.read_text())
    if not model.listed("assert"):
        raise tools.ToolFailed(f"{top}: found no assertion, expected one or more")
    covers = model.listed("cover")
    if model.listed("assume") and not covers:
        raise tools.ToolFailed(f"{top}: it assumes something and covers nothing")
    from_start = model.clocks(max(steps, 1)) + (model.first() if steps else "")
    _refuse(model, smt2.with_name("from_start.smt2"), from_start, range(max(steps, 1)))
    if smt.solve(smt2.with_name("possible.smt2"), from_start)["answer"] != "sat":
        raise tools.ToolFailed(f"{top}: no run is possible: {smt2.parent}")
    if steps:
        onwards = model.clocks(steps + 1) + f"(assert {model.always(range(steps))})\n"
        _refuse(model, smt2.with_name("onwards.smt2"), onwards, range(steps, steps + 1))
    within = model.clocks(max(reach, 1)) + (model.first() if steps else "")
    for number, place in covers:
        reached = " ".join(f"(|{top}_c {number}| s{k})" for k in range(max(reach, 1)))
        if smt.solve(smt2.with_name(f"cover_{number}.smt2"),
                              f"{within}(assert (or false {reached}))\n")["answer"] != "sat":
            raise tools.ToolFailed(f"{place}: not reached in {reach} clocks: {smt2.parent}")
