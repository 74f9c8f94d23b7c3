"""`python3 -m sim.mutate.netlist`: a module of hw/ as Yosys elaborates it, with single faults; an input chooses one of them.

Writes NAME.v, the flattened module with one more port, `mutant`: 0 for the sound module, k for fault k;
NAME.list, Yosys's own lines, a fault each, with the lines of hw/ it is in; and NAME.il, the sound one.
A fault inverts a bit at a cell's port or holds it at 0 or 1. They are chosen by the seed, evenly over
modules, cells, wires and lines of source (Yosys's `mutate`, as YosysHQ's mcy uses it)."""

import argparse
import pathlib
import re
import sys

from synth import cores, tools, yosys

# Yosys's other modes invert a bit if a neighbouring bit is 0 or 1; two such faults in one netlist can form a loop.
MODES = ("inv", "const0", "const1")
# Wires that nothing reads.
UNUSED = re.compile(r"-wire \S*\bunused_")
# Ports of memory cells that may have faults. Faults at other ports would give memories that Yosys cannot write as Verilog: with different
# clocks at their ports, with enables of asynchronous reads, or tables with computed contents.
MEMORIES = {"memrd": ("ADDR", "DATA"), "memwr": ("ADDR", "DATA", "EN"), "meminit": ()}


def source(fault: str) -> str:
    """Returns FILE:LINE in hw/ for a line of OUT.list. If the line has a source range, this is the place of the faulty expression.
    Otherwise, it is the declaration of the wire or the instance. Returns "" if the line has neither."""
    found = re.search(r"-src \S*?(hw/\S+?:\d+)\.\d+-", fault) or re.search(r"-src \S*?(hw/\S+?:\d+)", fault)
    return found[1] if found else ""


def write(out: pathlib.Path, top: str, parameters: list[str], count: int, seed: int, around: list[str], within: str = "") -> int:
    """Writes OUT.v, OUT.list and OUT.il; returns the number of faults. Raises ToolFailed and MissingTool."""
    files = dict.fromkeys(file for core in cores.names() for file in cores.files(core))
    kept = " ".join(f"--blackboxed-module {module}" for module in around)
    # Yosys also writes localparams and generate variables as parameters of black-boxed instances; they are removed.
    derived = [f"setparam {' '.join(f'-unset {name}' for name in names)} t:{file.stem}" for file in files if file.stem in around
               if (names := re.findall(r"\b(?:localparam [^=;]*?|genvar +)(\w+) *=", file.read_text()))]
    faults = out.with_suffix(".list")
    chosen_from = (8 if within else 2) * count + 20  # MODES has three of the five modes that Yosys chooses from
    # $shiftx becomes $shift: $shiftx would be written as a part-select that may begin outside the word, where Verilator reads other bits.
    yosys.run(f"{yosys.read(files, top, (text.split('=', 1) for text in parameters), kept)}\n"
              "flatten -noscopeinfo\nbwmuxmap\nopt -full\nopt_clean\nchtype -set $shift t:$shiftx\n"
              + "\n".join(derived) + f"\nwrite_rtlil {out}.il\n" + "\n".join(f"tee -q -o {out}.{kind} select -list t:${kind}*" for kind in MEMORIES) +
              f"\nmutate -list {chosen_from} -seed {seed} -o {faults}", out.with_suffix(".log"))
    ports = {cell.partition("/")[2]: ports for kind, ports in MEMORIES.items()
             for cell in pathlib.Path(f"{out}.{kind}").read_text().splitlines()}
    lines = [line for line in faults.read_text().splitlines()
             if re.search(r"-mode (\w+)", line).group(1) in MODES and within in line
             and re.search(r"-port (\w+)", line)[1] in ports.get(re.search(r"-cell (\S+)", line)[1], line) and not UNUSED.search(line)][:count]
    lines = [line.replace("mutate ", f"mutate -ctrl mutant 16 {number} ", 1)
             for number, line in enumerate(lines, 1)]
    faults.write_text("\n".join(lines) + "\n")
    # Wires are split into bits: if one bit of a word depends on another bit, Verilator would treat the word as a loop.
    yosys.run(f"read_rtlil {out}.il\nscript {faults}\nsplitnets -driver\nopt_clean\nwrite_verilog -noattr {out}.v",
              out.with_suffix(".faults.log"))
    return len(lines)


def main() -> int:
    """Runs the command line. Returns 2 if Yosys fails."""
    parser = argparse.ArgumentParser(prog="sim.mutate.netlist", description=__doc__)
    parser.add_argument("out", type=pathlib.Path, help="path and NAME of the files to write")
    parser.add_argument("top", help="the module")
    parser.add_argument("parameters", nargs="*", help="Name=value")
    parser.add_argument("--around", nargs="*", default=[], metavar="MODULE",
                        help="modules that stay as they are in hw/: instances of them in OUT.v")
    parser.add_argument("--within", default="", metavar="FILE", help="a file of hw/: only faults in its lines")
    parser.add_argument("--count", type=int, default=1000, help="faults (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="(%(default)s)")
    given = parser.parse_args()
    try:
        write(given.out, given.top, given.parameters, given.count, given.seed, given.around, given.within)
    except (tools.MissingTool, tools.ToolFailed) as error:
        print(f"sim.mutate.netlist: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
