"""Proofs of assertions: a module of proofs/, the RTL that it speaks of, and whether they hold."""

import dataclasses
import pathlib
import re
from collections.abc import Callable

from synth import catalogue, cores, induction, smt, store, tools

PROOFS = pathlib.Path(__file__).resolve().parent / "proofs"
# A line of a counterexample of Yosys's: name, decimal, hexadecimal, bits.
PORT = re.compile(r"^  \\(\S+) +\S+ +\S+ +([01x]+)$", re.M)


@dataclasses.dataclass(frozen=True)
class Proof:
    """Something that is shown; `quick`: in well under half a minute, so `make test` shows it too;
    `long`: only where it is asked for."""

    name: str
    claim: str
    how: str
    work: Callable[[], tuple[dict, bool]]
    quick: bool = True
    long: bool = False


def rtl(core: str) -> list[pathlib.Path]:
    """The files of a core of hw/."""
    return catalogue.Design("", "", core).sources()


def holds(top: str, method: str = "SAT", sources: list[pathlib.Path] | None = None,
          prepare: str = "", parameters: tuple[tuple[str, object], ...] = (), steps: int = 0,
          reach: int = 0, prepared: str = "", beside: tuple[str, ...] = (), name: str = "") -> tuple[dict, bool]:
    """Proves the assertions of proofs/<top>.sv; raises Refuted or ToolFailed where one does not hold, where there
    is none, and where what is assumed leaves a `cover` out of reach.

    `method`: "SAT" (Yosys's) or "Bitwuzla". `sources`: the RTL, what is named of hw/arith unless said.
    `prepare`, `prepared`: a Tcl file that makes a module of it first, and what of. `beside`: files of
    `sources`, by name, whose modules the proof itself has beside that one.
    `steps`: 0 for combinational ones; else proven for that many clocks from reset and, where they
    held for so many, for the next one. `reach`: clocks to reach covers in, `steps` unless said.
    """
    folder = store.OUT / "proofs" / (name or top)
    own = PROOFS / f"{top}.sv"
    hardware = cores.used(top, [*rtl("arith"), own])[:-1] if sources is None else sources
    read = [*(file for file in hardware if not prepare or file.stem in beside), own]
    scripts = [PROOFS / "prove.tcl", pathlib.Path(induction.__file__), *([PROOFS / prepare] if prepare else [])]
    solver = smt.version() if method == "Bitwuzla" else ""
    wanted = store.key([*hardware, *read, *scripts], tools.version("yosys"), solver, method, parameters, steps,
                       reach, prepared)

    def work() -> dict:
        smt2 = folder / "model.smt2"
        said = tools.run(["yosys", "-c", PROOFS / "prove.tcl"], folder / "yosys.log", {
            "SOURCES": " ".join(map(str, read)), "TOP": top,
            "PARAMETERS": " ".join(f"{key} {value}" for key, value in parameters),
            "PREPARE": str(PROOFS / prepare) if prepare else "",
            "RTL": " ".join(map(str, hardware)), "PREPARED": prepared,
            "SMT2": str(smt2) if method == "Bitwuzla" else ""})
        if method == "Bitwuzla":
            induction.holds(top, smt2, steps, reach or steps)
        elif "no model found: SUCCESS!" not in said:
            raise tools.Refuted(f"{top} (log: {folder / 'yosys.log'})", dict(PORT.findall(said)))
        return {"holds": True}

    return store.proven(folder, wanted, work)
