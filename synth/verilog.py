"""Writes a module of hw/ with given parameters, and all modules that it instantiates, as one file of plain Verilog.

`python3 -m synth.verilog TOP [Name=value ...]` writes build/verilog/TOP.v, for tools that read no SystemVerilog, such as Icarus Verilog.
The exit status is 2 for an unknown module or parameter.
"""

import pathlib
import sys

from synth import catalogue, scripts, tools, yosys

OUT = tools.ROOT / "build" / "verilog"


def write(design: catalogue.Design, out: pathlib.Path) -> None:
    """Elaborates `design` and writes `out`; raises ToolFailed if Yosys refuses the design."""
    out.parent.mkdir(parents=True, exist_ok=True)
    out.unlink(missing_ok=True)  # a failed run must not leave an older file behind
    yosys.run(scripts.plain_verilog(design, out), out.with_suffix(".log"))
    # Yosys writes overlapping case items, open ports, words of which one bit depends on another, and operands of mixed widths.
    lint = "".join(f"/* verilator lint_off {rule} */\n" for rule in ("CASEOVERLAP", "PINMISSING", "UNOPTFLAT", "WIDTH"))
    out.write_text(f"// {' '.join([design.top, *map('='.join, design.parameters)])}, by make synth VERILOG=1\n{lint}{out.read_text()}")


@tools.command("verilog")
def main() -> int:
    """Runs the command line."""
    if len(sys.argv) < 2 or not sys.argv[1]:
        raise ValueError("expected TOP, a module of hw/: make synth VERILOG=1 TOP=fp_adder [PARAMS='ExpWidth=5 FracWidth=10']")
    words = [word.partition("=") for word in " ".join(sys.argv[2:]).split()]
    out = OUT / f"{sys.argv[1]}.v"
    write(catalogue.design(sys.argv[1], **{name: value for name, _, value in words}), out)
    print(f"{out.relative_to(tools.ROOT)}: {out.read_text().count(chr(10) + 'module ')} modules")
    return 0


if __name__ == "__main__":
    sys.exit(main())
