"""Places and routes designs on FPGAs and reads their clock rates between registers.

A design without a clock, or with more port bits than a package has pins, is first wrapped in input and output registers.
`python3 -m synth.fpga` places the units (`make fpga`) and prints their table.
"""

import argparse
import dataclasses
import functools
import hashlib
import inspect
import json
import pathlib
import re
import sys

from synth import catalogue, runner, scripts, store, tables, tools, yosys
from synth.catalogue import Design, Fpga

MOST_PINS = 150  # every package used here has at least this many pins


def place(design: Design, fpga: Fpga) -> tuple[dict, bool]:
    """Places and routes a design with each seed. Returns the figures of `reported` for the seed with the median clock rate. Key `rates` has
    the MHz of all seeds, in ascending order. Also returns whether all results were kept from earlier runs."""
    folder = store.OUT / "runs" / f"{design.name}.{fpga.name}"
    wanted = store.key([*design.sources(), *scripts.FILES], yosys.version(), design.facts, fpga.name, fpga.luts,
                       inspect.getsource(registered), inspect.getsource(_map))
    netlist, mapped = store.cached(folder, wanted, lambda: runner.step("mapping", folder / "yosys.log", lambda: _map(design, fpga, folder)))
    # The key of a kept placement has the netlist's hash: after RTL changes that leave the netlist unchanged, the placement is reused.
    pins = [tools.ROOT / word for word in fpga.arguments if word.endswith(".lpf")]
    wanted = store.key(pins, netlist["digest"], tools.version(fpga.tool), fpga.tool, fpga.arguments, fpga.wanted_mhz, inspect.getsource(_place))
    runs = [store.cached(folder / f"seed-{seed}", wanted,
                         lambda s=seed: runner.step("placing, routing", folder / f"seed-{s}" / "nextpnr.log", lambda: _place(fpga, folder, s)))
            for seed in fpga.seeds]
    by_rate = sorted((run for run, _ in runs), key=lambda run: run["mhz"])
    return {**by_rate[len(runs) // 2], "rates": [run["mhz"] for run in by_rate]}, mapped and all(there for _, there in runs)


def _map(design: Design, fpga: Fpga, folder: pathlib.Path) -> dict:
    ports, wrapper = folder / "ports.json", None
    yosys.run(f"{scripts.elaborated(design)}\nwrite_json {ports}", folder / "ports.log")
    sides = port_widths(design.top, json.loads(ports.read_text()))
    if not design.clock or sum(width for _, _, width in sides) > MOST_PINS:
        wrapper = folder / "registered.v"
        wrapper.write_text(registered(design, sides))
    yosys.run(scripts.fpga(design, fpga.name, fpga.luts, folder / "netlist.json", wrapper), folder / "yosys.log")
    return {"digest": digest(folder / "netlist.json")}


def digest(netlist: pathlib.Path) -> str:
    """Returns a hash of Yosys's netlist that ignores references to RTL lines."""
    return hashlib.sha256(re.sub(r'"src": "[^"]*"', "", netlist.read_text()).encode()).hexdigest()


def _place(fpga: Fpga, folder: pathlib.Path, seed: int) -> dict:
    # The names are relative because nextpnr for the ECP5 runs in a sandbox with a /tmp of its own.
    netlist, report, config = ((folder / name).relative_to(tools.ROOT) for name in (
        "netlist.json", f"seed-{seed}/placed.json", f"seed-{seed}/board.config"))
    tools.run([fpga.tool, *fpga.arguments, "--json", netlist, "--seed", seed, "--freq", fpga.wanted_mhz, "--timing-allow-fail",
               "--report", report, *(("--textcfg", config) if fpga.clock else ())], folder / f"seed-{seed}" / "nextpnr.log")
    return reported(json.loads((tools.ROOT / report).read_text()), fpga)


def reported(report: dict, fpga: Fpga) -> dict:
    """Returns figures of nextpnr's report: numbers of cells; MHz of clock `fpga.clock` ("": of the fastest clock); slowest path."""
    used = {name: count["used"] for name, count in report["utilization"].items() if count["used"]}
    counts = (used.get(cell, 0) for cell in fpga.cells)
    rates = [found["achieved"] for name, found in report["fmax"].items() if fpga.clock in name]
    return {"mhz": round(max(rates), 1), **dict(zip(("luts", "registers", "multipliers", "block RAMs"), counts, strict=True)),
            "used": used, **slowest_path(report["critical_paths"], fpga.clock)}


def slowest_path(paths: list[dict], clock: str = "") -> dict:
    """Returns the slowest path between registers of `clock` ("": any clock): both end registers, ns in registers and logic, ns in wires."""
    path = next(path["path"] for path in paths if path["from"] == path["to"] and clock in path["from"])
    ns = {kind: sum(step["delay"] for step in path if (step["type"] == "routing") == (kind == "wires"))
          for kind in ("logic", "wires")}
    return {"from": register(path[0]["from"]["cell"]), "to": register(path[-1]["to"]["cell"]),
            **{kind: round(delay, 1) for kind, delay in ns.items()}}


def register(cell: str) -> str:
    """Returns the signal in a register or DSP block, from the cell's name: u_divider.norm_q for u_divider.norm_q_TRELLIS_FF_Q_7."""
    return re.sub(r"_(TRELLIS_FF|SB_DFF|MULT18X18D|DP16KD|LUT4|CCU2C|PFUMX|L6MUX21).*", "", cell)


def port_widths(top: str, netlist: dict) -> list[tuple[str, str, int]]:
    """Returns direction, name and bits of each port of `top` in Yosys's JSON."""
    return [(body["direction"], port, len(body["bits"])) for port, body in netlist["modules"][top]["ports"].items()]


def registered(design: Design, ports: list[tuple[str, str, int]]) -> str:
    """Returns the Verilog of a wrapper with registers at all inputs and outputs of `design`.

    The registers form shift registers, whose ends are the wrapper's ports. A wide design has more bits than a device has pins, and
    unconnected ports would be optimised away.
    """
    clock = [port for port in ports if port[1] == design.clock]
    low = {"input": 0, "output": 0}
    connections = [f"    .{port}(clk_i)" for _, port, _ in clock]
    for direction, port, width in ports:
        if (direction, port, width) not in clock:
            bus = {"input": "in", "output": "result"}[direction]
            connections.append(f"    .{port}({bus}[{low[direction]} +: {width}])")
            low[direction] += width
    lines = ["module registered (input clk_i, input bit_i, input load_i, output bit_o);",
             f"  reg [{low['input'] - 1}:0] in;", f"  reg [{low['output'] - 1}:0] out, shifted;",
             f"  wire [{low['output'] - 1}:0] result;",
             f"  {design.top} dut (", ",\n".join(connections), "  );",
             "  always @(posedge clk_i) begin",
             "    in <= {in, bit_i};",
             "    out <= result;",
             "    shifted <= load_i ? out : {1'b0, shifted} >> 1;",
             "  end", "  assign bit_o = shifted[0];", "endmodule"]
    return "\n".join(lines) + "\n"


@tools.command("fpga")
def main() -> int:
    """Places the units, prints and keeps their table. Returns 1 if one fails, 2 for errors that the user can correct."""
    parser = argparse.ArgumentParser(prog="synth.fpga", description="Places and routes the units on FPGAs.")
    parser.add_argument("names", nargs="*", help="beginnings of units' names; all if none")
    parser.add_argument("--seeds", type=int, default=3, help="placements, of which the median counts (%(default)s)")
    parser.add_argument("--jobs", type=int, default=2, help="at once (%(default)s)")
    parser.add_argument("--publish", action="store_true", help="write the table into the pages of hw that have a place for it")
    given = parser.parse_args()
    units = [unit for unit in catalogue.fpga_units() if unit[0].name.startswith(tuple(given.names or [""]))]
    if given.publish and given.names:
        raise ValueError("--publish: expected all units, found " + " ".join(given.names))
    if not units or given.seeds < 1:
        raise ValueError("expected at least one seed, and some of "
                         + ", ".join(unit[0].name for unit in catalogue.fpga_units()))
    for _, _, _, fpga in units:
        tools.find(fpga.tool)
    seeds = tuple(range(1, given.seeds + 1))
    results, failures = runner.run_all(
        [runner.Job(f"{design.name} {fpga.name}", functools.partial(place, design, dataclasses.replace(fpga, seeds=seeds)),
                    lambda got: f"{got['luts']} LUTs, {got['mhz']} MHz, from {got['from']} to {got['to']}, "
                               f"{got['wires']} of {got['logic'] + got['wires']:.1f} ns in wires")
         for design, _, _, fpga in units], given.jobs)
    rows = [(unit, got) for unit, got in zip(units, results, strict=True) if got]
    print(table(rows, "make fpga"))
    if given.publish:
        text = tables.unpadded(table(rows, "make fpga PUBLISH=1"))
        for page in catalogue.HW.glob("*/README.md"):
            page.write_text(re.sub(r"(?<=<!-- fpga -->\n).*?(?=<!-- end -->)", lambda _: text, page.read_text(), flags=re.S))
    return runner.status(failures)


def period(top: str) -> int:
    """Returns a unit's clocks per test, as in the header of its module."""
    (file,) = catalogue.HW.glob(f"*/{top}.sv")
    said = re.search(r"Throughput:? (?:a test every (\d+) clocks|one test a clock)", file.read_text())
    return int(said[1] or 1)


def table(units: list[tuple[tuple, dict]], command: str) -> str:
    """Returns the table of units (from catalogue.fpga_units) and their results of place(), measured by `command`."""
    heads = ["unit", "format", "arithmetic", "device", "LUTs", "registers", "multipliers", "MHz (least to most)", "million tests/s"]
    rows = []
    for (design, form, kind, fpga), got in units:
        name = ", ".join([design.top, *(says for key, says in NAMES.items() if key in design.parameters)])
        cells = ["-" if not cell else got[key] for key, cell in zip(("luts", "registers", "multipliers"), fpga.cells, strict=False)]
        rows.append([name, form, kind, fpga.title, *cells, f"{got['mhz']} ({got['rates'][0]} to {got['rates'][-1]})", f"{got['mhz'] / period(design.top):.2f}"])
    return f"{tables.markdown(heads, rows)}\n{tables.measured(command)}"


# Descriptions of units' parameters.
NAMES = {("QuotientBits", "21"): "21-bit quotients"}


if __name__ == "__main__":
    sys.exit(main())
