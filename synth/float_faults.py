"""`python3 -m synth.float_faults [CORE ...]`: single faults in the binary16 cores, refuted.

The solver finds operands that show the fault. What the faulty core gives for them goes, as a
vector, to build/sim/check_vectors, whose simulated core has no fault: it must differ. Which fault is
shown first is the solver's choice; in the end it is asked whether those left change anything.
"""

import argparse
import collections
import dataclasses
import pathlib
import subprocess
import sys

from synth import float_proofs, smt, store, tables, tools, yosys

CLAIMS = {"add": "add", "multiply": "multiply_whole", "divide": "divide_whole",
          "compare": "compare"}
MODES = ["near_even", "minMag", "min", "max", "near_maxMag", "minMag", "minMag", "minMag"]
MOST = 255  # faults in a core
# Where there is a choice: counterexamples that vectors can tell. They have no `unordered`, and take
# == for quiet and < for signalling.
SHOWN_BY_VECTORS = {"compare": """(assert (or
  (and (not signaling_i) (not (= equal_o (fp.eq (number a_i) (number b_i)))))
  (and signaling_i (not (= less_o (fp.lt (number a_i) (number b_i)))))
  (not (= flags_o (compare-flags a_i b_i signaling_i)))))
"""}
# Where the solver looks first: with b known there is no product or quotient of two unknowns.
LOOK_FIRST = dict.fromkeys(("multiply", "divide"), [
    f"(assert (= b_i #x{word}))\n"
    for word in ("3BFF", "D555", "2AAA", "7801", "0400", "B6DB", "0333")])
CHECK_VECTORS = tools.ROOT / "build" / "sim" / "check_vectors"


def results(core: str, values: dict[str, str]) -> list[tuple[str, str]]:
    """The operations of a counterexample, by TestFloat's names, and what the faulty core gave."""
    if core == "compare":
        less, equal = int(values["less_o"]), int(values["equal_o"])
        if values["signaling_i"] == "0":
            return [("f16_eq", str(equal))]
        return [("f16_lt", str(less)), ("f16_le", str(less | equal))]
    operation = {"add": "f16_sub" if values.get("subtract_i") == "1" else "f16_add",
                 "multiply": "f16_mul", "divide": "f16_div"}[core]
    return [(operation, f"{int(values['result_o'], 2):04X}")]


def differs(core: str, values: dict[str, str]) -> tuple[str, bool]:
    """A counterexample as a vector, with the faulty result; whether the sound core differs."""
    vector = ""
    for operation, result in results(core, values):
        options = [operation, "--check-nans"]
        if core != "compare":
            options += ["--rounding", MODES[int(values["rounding_mode_i"], 2)], "--tininess",
                        "after" if values["tininess_after_i"] == "1" else "before"]
        words = " ".join(f"{int(values[port], 2):04X}" for port in ("a_i", "b_i"))
        line = f"{words} {result} {int(values['flags_o'], 2):02X}"
        vector = f"{' '.join(options)}: {line}"
        done = subprocess.run([CHECK_VECTORS, *options], input=line + "\n", text=True, check=False,
                              capture_output=True)
        if done.returncode == 1:
            return vector, True
        if done.returncode != 0:
            raise tools.ToolFailed(f"check_vectors: {done.stderr}")
    return vector, False


@dataclasses.dataclass(frozen=True)
class Faulty:
    """A core with faults in it: number k is there where its input fault_i is k."""

    core: str
    folder: pathlib.Path
    text: str  # the query, but for the number
    wires: tuple[str, ...]

    def show(self, left: set[int], limit: float) -> dict:
        """One of the faults `left`, whichever the solver comes upon: its number, the seconds, the vector
        that shows it; or 0 and whether none of them changes anything. Kept."""
        one_of = " ".join(f"(= fault_i (_ bv{number} 8))" for number in sorted(left))
        text = f"{self.text}(assert (or false {one_of}))\n"
        folder = self.folder / f"{len(left)}_left"

        def work() -> dict:
            for wanted in (*LOOK_FIRST.get(self.core, ()), SHOWN_BY_VECTORS.get(self.core, ""), ""):
                answer = smt.solve(folder / "query.smt2", text + wanted, self.wires, limit)
                if answer["answer"] == "sat":
                    break
            verdict, vector, number = "open", "", 0
            if answer["answer"] == "unsat":
                verdict = "changes nothing"
            if answer["answer"] == "sat":
                vector, refused = differs(self.core, answer["values"])
                verdict = "refuted" if refused else "refuted, but not by a vector"
                number = int(answer["values"]["fault_i"], 2)
            return {"fault": number, "verdict": verdict, "seconds": answer["seconds"],
                    "vector": vector}

        return store.cached(folder, store.key([], text, limit), work)[0]


def put_faults(core: str, count: int, seed: int) -> Faulty:
    """A core of binary16 with `count` faults, spread evenly over its netlist."""
    folder = store.OUT / "faults" / core
    folder.mkdir(parents=True, exist_ok=True)
    one = float_proofs.FloatProof(CLAIMS[core], "binary16", "structural")
    netlist, smt2 = folder / "netlist.il", folder / "faulty.smt2"
    top = float_proofs.OPERATIONS[CLAIMS[core]].top
    faults = folder / "faults.txt"
    smt.write_model(one.sources(), top, one.parameters, folder, netlist)
    yosys.run(f"""read_rtlil {netlist}
mutate -list {count} -seed {seed} -ctrl fault_i 8 1 -o {faults}
script {faults}
opt_clean
write_smt2 -stbv -wires {smt2}""", folder / "faults.log")
    text, wires = float_proofs.query(one, smt2.read_text())
    return Faulty(core, folder, text + "(assert assumed)\n(assert (not claimed))\n", tuple(wires))


def refute(core: str, count: int, seed: int, limit: float) -> list[list[object]]:
    """A row for each of `count` faults: each is refuted, or the solver says of those that are left that
    they change nothing, or it does not come to an end."""
    faulty = put_faults(core, count, seed)
    left = set(range(1, count + 1))
    rows: list[list[object]] = []
    while left:
        shown = faulty.show(left, limit)
        found = [shown["fault"]] if shown["fault"] else sorted(left)
        rows += [[core, number, shown["verdict"], shown["seconds"], shown["vector"]]
                 for number in found]
        left -= set(found)
        print(*rows[-1], file=sys.stderr, flush=True)
    return rows


def main() -> int:
    """Prints what came of every fault; 1 where one is open, 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="synth.float_faults", description=__doc__)
    parser.add_argument("cores", nargs="*", metavar="CORE",
                        help=f"{', '.join(CLAIMS)}; all if none")
    parser.add_argument("--count", type=int, default=80, choices=range(1, MOST + 1),
                        metavar="COUNT", help="so many in each core, at most 255 (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="chooses the faults (%(default)s)")
    parser.add_argument("--limit", type=float, default=120,
                        help="processor seconds for a question (%(default)s)")
    given = parser.parse_args()
    for core in given.cores:
        if core not in CLAIMS:
            parser.error(f"{core}: expected one of {', '.join(CLAIMS)}")
    try:
        if not CHECK_VECTORS.exists():
            raise tools.MissingTool(f"{CHECK_VECTORS} is not built: make prove FAULTS=80 builds it")
        rows = [row for core in given.cores or CLAIMS
                for row in refute(core, given.count, given.seed, given.limit)]
    except (tools.MissingTool, tools.ToolFailed) as error:
        print(f"synth: {error}", file=sys.stderr)
        return 2
    print(tables.markdown(["core", "fault", "verdict", "s", "vector"], rows))
    for core in given.cores or CLAIMS:
        verdicts = collections.Counter(row[2] for row in rows if row[0] == core)
        print(f"{core}: " + ", ".join(f"{many} {verdict}" for verdict, many in verdicts.items()))
    return 1 if any(row[2] == "open" for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
