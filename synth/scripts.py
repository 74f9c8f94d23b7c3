"""The flows as Yosys scripts, used by `make synth`, `make fpga` and `make synth VERILOG=1`."""

import pathlib

from synth import tools, yosys
from synth.catalogue import Design, Library

# ABC's script for each flow. Flow `default` has none: Yosys's default commands for ABC are used.
ABC_SCRIPTS = {"cells": "keep.abc", "kept": "keep.abc", "area": "area.abc", "small": "small.abc",
               "fast": "fast.abc", "faster": "faster.abc", "parts": "fast.abc",
               "modules": "fast.abc", "blocks": "fast.abc"}
# Modules that flow `modules` maps separately, to distinguish them in a picture of the layout.
PICTURED = ("booth_encoder", "booth_row", "carry_save_tree", "adder", "fp_unpack", "fp_round", "srt_first_row",
            "srt_row", "sticky_right_shift", "leading_zero_counter")
FILES = [pathlib.Path(__file__), pathlib.Path(yosys.__file__)]  # files that all results depend on


def elaborated(design: Design, structural: bool = False) -> str:
    """Returns commands that elaborate a design. `structural`: full adders and multiplexers become cells of flows/structure.v."""
    return yosys.read(design.sources(structural), design.top, design.parameters)


def structure(design: Design) -> str:
    """Returns commands that flatten a design to the cells of structure.v and the gates between them."""
    # structure.v is read again, for the ports of cells that have had no instance until now.
    return f"""{elaborated(design, structural=True)}
proc
flatten -noscopeinfo
opt_expr
opt_clean
read_verilog -sv -nooverwrite -lib {tools.FLOWS}/structure.v
techmap -map {tools.FLOWS}/known_inputs.v
opt_expr
opt_clean"""


def structure_json(design: Design, out: pathlib.Path) -> str:
    """Returns the commands of `structure`, followed by commands that split gates into single bits and write JSON."""
    return f"{structure(design)}\nsimplemap\nopt_clean\nwrite_json {out}"


def plain_verilog(design: Design, out: pathlib.Path) -> str:
    """Returns commands that write a design and all modules below it as one file of plain Verilog."""
    return f"{elaborated(design)}\nproc\nopt_expr\nopt_clean\nbwmuxmap\nwrite_verilog -noattr {out}"


def _kept(*modules: str) -> str:
    """Returns the command that makes ABC map each of `modules` separately, once for all instances with equal parameters."""
    return "setattr -mod -set keep_hierarchy 1 " + " ".join(f"{module}$*" for module in modules)


def gates(flow: str, blocks: list[str], out: pathlib.Path) -> str:
    """Returns commands that turn an elaborated design into gates and registers. Carry-select structures remain: no command moves logic
    across a multiplexer."""
    lines = ["proc"]
    if flow == "blocks":  # move read enables into the memories; else a register after the memory would hold the word
        lines += ["opt_clean", "opt_dff -nosdff ram$*"]
    if flow in ("parts", "blocks"):
        lines += [_kept("fp_adder", "fp_multiplier", "fp_divider", *(blocks if flow == "blocks" else []))]
    if flow == "modules":
        lines += [_kept(*PICTURED)]
    # opt_dff restores resets to constants: the reader turns them into asynchronous loads.
    lines += ["flatten -noscopeinfo", "opt_expr", "opt_merge", "opt_dff -nodffe -nosdff", "opt_clean"]
    if flow == "blocks":
        lines += ["memory -nomap", f"read_verilog -lib {tools.FLOWS}/kept_memory.v", f"techmap -map {tools.FLOWS}/kept_memories.v",
                  f"tee -q -o {out}.memories dump t:kept_memory"]
    return "\n".join([*lines, "memory", "wreduce", f"techmap -map {tools.FLOWS}/comparisons.v", "alumacc", "opt_expr", "opt_clean",
                      "techmap", "opt_expr", "opt_merge", "opt_clean"])


def standard_cells(design: Design, library: Library, flow: str, blocks: list[str], constraints: pathlib.Path,
                   out: pathlib.Path) -> str:
    """Returns commands that map a design to a library by a flow of the catalogue.

    `blocks`: modules that flow `blocks` maps separately, like the float cores. `constraints`: file of driver and load, for ABC.
    The commands write OUT.v, OUT.json, OUT.stat.json (statistics) and OUT.timed.v. In OUT.timed.v, for OpenSTA, each bit of a port is a
    port, because OpenSTA reads no concatenations in assignments. Flow `blocks` also writes OUT.blocks.json (statistics by module) and
    OUT.memories."""
    if flow == "cells":  # full adders and multiplexers become library cells, which ABC does not change
        mapped = f"{structure(design)}\ntechmap -map {tools.FLOWS}/osu_cells.v\ntechmap\nopt_expr\nopt_clean"
    elif flow in ("default", "area", "small"):
        # Yosys's default recipe. -noshare: the SAT-based resource sharing may not terminate.
        mapped = f"{elaborated(design)}\nsynth -flatten -noshare -noabc -top {design.top}"
    else:
        mapped = f"{elaborated(design)}\n{gates(flow, blocks, out)}"
    script = f"-script {tools.FLOWS / ABC_SCRIPTS[flow]}" if flow in ABC_SCRIPTS else ""
    stat = f"stat -json -liberty {library.liberty}"
    lines = [mapped, f"dfflibmap -liberty {library.liberty}", f"abc -liberty {library.liberty} -constr {constraints} {script}",
             "setattr -mod -unset keep_hierarchy *"]
    if flow == "blocks":
        lines += [f"tee -q -o {out}.blocks.json {stat}"]
    lines += ["flatten -noscopeinfo"]
    if flow == "blocks":
        lines += [f"techmap -map {tools.FLOWS}/kept_enables.v",
                  f"expose -evert {design.top}/t:kept_input {design.top}/t:kept_output", f"delete {design.top}/t:kept_memory"]
    lines += ["delete t:$scopeinfo", "select -assert-none t:$*", "splitnets", "opt_clean -purge", f"tee -q -o {out}.stat.json {stat}",
              f"write_verilog -noattr -noexpr -nohex {out}.v",
              "splitnets -ports", "opt_clean -purge", f"write_verilog -noattr -noexpr -nohex {out}.timed.v",
              f"write_json {out}.json"]
    return "\n".join(lines)


def fpga(design: Design, family: str, luts: str, out: pathlib.Path, wrapper: pathlib.Path | None = None) -> str:
    """Returns commands that map a design to an FPGA and write JSON for nextpnr. `family`: ice40 or ecp5. `luts`: options that select the
    kinds of LUTs. `wrapper`: a file with module "registered", which puts registers around the design."""
    lines = [elaborated(design)]
    if wrapper:
        lines += ["proc", "flatten -noscopeinfo", f"read_verilog {wrapper}"]
    return "\n".join([*lines, f"synth_{family} {luts} -top {'registered' if wrapper else design.top}", netlist_json(out)])


def netlist_json(out: pathlib.Path) -> str:
    """Returns commands that write a mapped design for nextpnr. They remove $scopeinfo cells, which nextpnr does not support."""
    return f"delete t:$scopeinfo\nwrite_json {out}"
