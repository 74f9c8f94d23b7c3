"""Compares a mapped netlist with its RTL: by ABC's equivalence check if there are no registers, else by simulation on equal vectors."""

import json
import pathlib
import re

from synth import mapping, scripts, store, tools, yosys
from synth.catalogue import Design, Library

PROOFS = pathlib.Path(__file__).resolve().parent / "proofs"
SECONDS = 600  # time limit of ABC for one netlist


def equal(design: Design, library: Library, flow: str) -> tuple[dict, bool]:
    """Proves by ABC that the netlist of a design without registers is equivalent to its RTL. Raises ToolFailed if ABC does not prove it."""
    folder = store.OUT / "netlists" / f"{design.name}.{library.name}.{flow}"
    files = [*design.sources(), library.liberty, pathlib.Path(__file__), *mapping.files()]
    wanted = store.key(files, mapping.flow_facts(), design.facts, library, flow)

    def work() -> dict:
        mapping.synthesise(design, library, flow)
        run = store.OUT / "runs" / f"{design.name}.{library.name}.{flow}"
        # ABC cannot match two different expansions of a product. The RTL is therefore expanded like the netlist, by alumacc.
        expand = "alumacc\n" if design.top == "multiplier" else ""
        gates = "flatten -noscopeinfo\nopt_expr\ntechmap\nopt_clean -purge\nselect -assert-none t:$*FF*\nwrite_blif"
        yosys.run(f"""{scripts.elaborated(design)}
proc
{expand}{gates} {folder}/rtl.blif
design -reset
{cells(library)}
read_verilog {run}/netlist.v
hierarchy -check -top {design.top}
proc
{gates} {folder}/netlist.blif""", folder / "yosys.log")
        said = yosys.abc(f"cec -T {SECONDS} {folder}/rtl.blif {folder}/netlist.blif", folder / "abc.log")
        if "Networks are equivalent" not in said:
            raise tools.ToolFailed(f"{folder}/abc.log: {said.strip().splitlines()[-1]}")
        return {"holds": True}

    return store.proven(folder, wanted, work)


def cells(library: Library) -> str:
    """Returns Yosys commands that read the library's combinational cells and flip-flops, with the functions stated in the Liberty file."""
    return f"""read_liberty -ignore_miss_func -ignore_miss_dir -ignore_miss_data_latch {library.liberty}
delete LATCH TBUFX1 TBUFX2 PAD*
proc"""


def agree(design: Design, library: Library, flow: str, vectors: int) -> tuple[dict, bool]:
    """Simulates the netlist and the RTL on `vectors` input vectors. Raises ToolFailed if an output bit differs."""
    folder = store.OUT / "netlists" / f"{design.name}.{library.name}.{flow}"
    files = [*design.sources(), library.liberty, PROOFS / "netlist_agrees.cpp", pathlib.Path(__file__), *mapping.files()]
    wanted = store.key(files, mapping.flow_facts(), tools.version("verilator"), design.facts,
                       library, flow, vectors)
    return store.proven(folder, wanted, lambda: _agree(design, library, flow, vectors, folder))


def _agree(design: Design, library: Library, flow: str, vectors: int,
           folder: pathlib.Path) -> dict:
    mapping.synthesise(design, library, flow)
    run = store.OUT / "runs" / f"{design.name}.{library.name}.{flow}"
    # Writes Verilog of the library's cells, from their functions in the Liberty file, and of the netlist, renamed to `netlist`.
    yosys.run(f"""{cells(library)}
write_verilog -noattr {folder}/cells.v
design -reset
read_verilog {run}/netlist.v
rename {design.top} netlist
write_json {folder}/netlist.json
write_verilog -noattr -noexpr {folder}/netlist.v""", folder / "cells.log")
    ports = json.loads((folder / "netlist.json").read_text())["modules"]["netlist"]["ports"]
    (folder / "twins.sv").write_text(twins(design, ports))
    sources = [*design.sources(), folder / "cells.v", folder / "netlist.v", folder / "twins.sv"]
    # -Wno-lint: lint is for hand-written code. -Wno-UNOPTFLAT: bits of a vector that depend on each other look like loops to Verilator.
    # -fno-const-bit-op-tree: without this option Verilator 5.006 computes wrong bits for the divider's netlist. Yosys's evaluation of the
    # same file confirms that the netlist is right.
    tools.run(["verilator", "--cc", "--exe", "--build", "-O3", "-fno-const-bit-op-tree", "-Wno-fatal",
               "-Wno-lint", "-Wno-UNOPTFLAT", "--no-timing", "-CFLAGS", "-O2", "--top-module", "twins",
               "--Mdir", folder / "obj", *sources, PROOFS / "netlist_agrees.cpp", "-o", "twins"],
              folder / "build.log")
    said = tools.run([str(folder / "obj" / "twins"), str(vectors)], folder / "run.log")
    return {"vectors": int(re.search(r"(\d+) vectors", said).group(1))}


def twins(design: Design, ports: dict) -> str:
    """Returns SystemVerilog of a module that instantiates RTL and netlist with the same inputs, and compares their outputs."""
    named = {"clk_i", "rst_ni"}
    inputs = [(name, len(port["bits"])) for name, port in ports.items()
              if port["direction"] == "input" and name not in named]
    outputs = [(name, len(port["bits"])) for name, port in ports.items()
               if port["direction"] == "output"]
    # Input words of 32 bits: Verilator requires the unused upper bits of a port to be 0. At least three words make the port a C++ array.
    total = 32 * max(3, -(-sum(width for _, width in inputs) // 32))
    low, slices = 0, {}
    for name, width in inputs:
        slices[name] = f"in_i[{low} +: {width}]"
        low += width
    parameters = ", ".join(f".{name}({value})" for name, value in design.parameters)
    lines = ["// verilator lint_off UNUSEDSIGNAL", "module twins (", "  input logic clk_i,", "  input logic rst_ni,",
             f"  input logic [{total - 1}:0] in_i,", "  output logic differ_o", ");"]
    for twin in ("rtl", "netlist"):
        lines += [f"  logic [{width - 1}:0] {twin}_{name};" for name, width in outputs]
        connections = [f".{name}({name})" for name in ports if name in named]
        connections += [f".{name}({bits})" for name, bits in slices.items()]
        connections += [f".{name}({twin}_{name})" for name, _ in outputs]
        head = f"{design.top} #({parameters})" if twin == "rtl" else "netlist"
        lines.append(f"  {head} u_{twin} ({', '.join(connections)});")
    differences = " || ".join(f"rtl_{name} != netlist_{name}" for name, _ in outputs)
    return "\n".join([*lines, f"  assign differ_o = {differences};", "endmodule"]) + "\n"
