"""Proves the SystemVerilog assertions that modules in proofs/ make about the RTL."""

import dataclasses
import pathlib
import re
from collections.abc import Callable

from synth import catalogue, cores, induction, smt, store, tools, yosys
from synth.smt import PROOFS

# A line of a counterexample that Yosys prints: name, decimal value, hexadecimal value, bits.
PORT = re.compile(r"^  \\(\S+) +\S+ +\S+ +([01x]+)$", re.M)


@dataclasses.dataclass(frozen=True)
class Proof:
    """A proof or a check. `work` returns the result, and whether an earlier run kept it. `quick`: takes well under half a minute, and
    is also run by `make test`. `long`: runs only on request."""

    name: str
    claim: str
    how: str
    work: Callable[[], tuple[dict, bool]]
    quick: bool = True
    long: bool = False


def rtl(core: str) -> list[pathlib.Path]:
    """Returns the files of a core of hw/."""
    return catalogue.Design("", "", core).sources()


Prepare = Callable[[list[pathlib.Path]], str]  # returns, for RTL files, Yosys's commands that make the module a proof instantiates


def opened(name: str, wires: str, memories: str = "", **parameters: object) -> Prepare:
    """Returns a Prepare that makes a module opened_NAME from module `name`: flattened, with inner wires as outputs, for use in invariants.

    `wires`: the names of these wires, as Yosys patterns. `memories`: name, depth and width of each memory. All words of a memory become
    one output, word 0 lowest. It is named after the memory, with gen_... and u_words. removed and other dots replaced by _.
    """
    words = memories.split()
    lines = ["flatten -noscopeinfo", f"rename -top opened_{name}", f"cd opened_{name}"]
    lines += [f"expose w:{wire}" for wire in wires.split()]
    lines += ["opt_reduce  # one enable for all bits of a word", "memory -nordff  # a register of an address stays one of its own",
              "opt_clean"]
    for memory, depth, width in zip(words[::3], words[1::3], words[2::3], strict=True):
        port = re.sub(r"gen_\w+\.|u_words\.", "", memory).replace(".", "_")
        held = ",".join(f"\\{memory}[{place}]" for place in reversed(range(int(depth))))
        lines += [f"add -output {port} {int(depth) * int(width)}", f"connect -set {port} {held}"]
    return lambda rtl: "\n".join([smt.read(rtl, name, parameters.items()), *lines, "cd .."])


def holds(top: str, method: str = "SAT", sources: list[pathlib.Path] | None = None,
          prepare: Prepare | None = None, parameters: tuple[tuple[str, object], ...] = (), steps: int = 0,
          reach: int = 0, beside: tuple[str, ...] = (), name: str = "") -> tuple[dict, bool]:
    """Proves the assertions of proofs/<top>.sv. Raises Refuted or ToolFailed if an assertion does not hold, if the file has no assertion,
    or if the assumptions make a `cover` unreachable.

    `method`: "SAT" (Yosys's solver) or "Bitwuzla". `sources`: the RTL, by default the modules of hw/arith that the proof uses.
    `prepare`: makes the module under proof from `sources`; of `sources`, the proof then reads only packages and the modules `beside`.
    `steps`: 0 for combinational assertions. Otherwise the assertions are proven in the first `steps` clocks from reset, and in the clock
    after any `steps` clocks in which they held. `reach`: number of clocks within which every `cover` must be reached, by default `steps`.
    """
    folder = store.OUT / "proofs" / (name or top)
    own = PROOFS / f"{top}.sv"
    hardware = cores.used(top, [*rtl("arith"), own])[:-1] if sources is None else sources
    read = [*(file for file in hardware if not prepare or file.stem in beside or file.stem.endswith("_pkg")), own]
    solver = smt.version() if method == "Bitwuzla" else ""
    wanted = store.key([*hardware, *read, smt.FREE], yosys.version(), solver, method, parameters, steps,
                       reach, prepare and prepare([]).replace(f"{tools.ROOT}/", ""))

    def work() -> dict:
        smt2 = folder / "model.smt2"
        said = yosys.run("\n".join([
            *([prepare(hardware)] if prepare else []), smt.read(read, top, parameters), smt.FLAT, "select -assert-min 1 t:$assert",
            *([f"async2sync\ndffunmap\nwrite_smt2 -stbv -wires {smt2}"] if method == "Bitwuzla" else
              ["select -assert-none t:$assume", "sat -prove-asserts -show-ports -set-def-inputs"])]), folder / "yosys.log")
        if method == "Bitwuzla":
            induction.holds(top, smt2, steps, reach or steps)
        elif "no model found: SUCCESS!" not in said:
            raise tools.Refuted(f"{top} (log: {folder / 'yosys.log'})", dict(PORT.findall(said)))
        return {"holds": True}

    return store.proven(folder, wanted, work)
