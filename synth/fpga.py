"""Places and routes one design on an FPGA, between registers, and reads its clock rate.

A design without a clock, or with more ports than a package has pins, is put between registers first.
"""

import inspect
import json
import pathlib
import re

from synth import mapping, store, tools
from synth.catalogue import Design, Fpga


MOST_PINS = 150  # what every package here has


def place(design: Design, fpga: Fpga) -> tuple[dict, bool]:
    """LUTs, carry cells, registers, DSPs, fmax in MHz (slowest path between registers)."""
    folder = store.OUT / "runs" / f"{design.name}.{fpga.name}"
    files = [*design.sources(), tools.FLOWS / "fpga.tcl", tools.FLOWS / "elaborate.tcl"]
    wanted = store.key(files, tools.version("yosys"), tools.version(fpga.tool), design.facts,
                       fpga, inspect.getsource(registered))
    return store.cached(folder, wanted, lambda: _place(design, fpga, folder))


def _place(design: Design, fpga: Fpga, folder: pathlib.Path) -> dict:
    environment = {**mapping.elaboration(design), "FAMILY": fpga.name,
                   "OUT": str(folder / "netlist.json"), "WRAPPER": "", "PORTS": ""}
    ports = folder / "ports.json"
    tools.run(["yosys", "-c", tools.FLOWS / "fpga.tcl"], folder / "ports.log",
              {**environment, "PORTS": str(ports)})
    sides = port_widths(design.top, json.loads(ports.read_text()))
    if not design.clock or sum(width for _, _, width in sides) > MOST_PINS:
        wrapper = folder / "registered.v"
        wrapper.write_text(registered(design, sides))
        environment["WRAPPER"] = str(wrapper)
    tools.run(["yosys", "-c", tools.FLOWS / "fpga.tcl"], folder / "yosys.log", environment)
    rates = []
    # Relative names, for the ECP5's nextpnr runs in a sandbox with a /tmp of its own.
    netlist = (folder / "netlist.json").relative_to(tools.ROOT)
    for seed in fpga.seeds:
        report = folder / f"placed.{seed}.json"
        tools.run([fpga.tool, *fpga.arguments, "--json", netlist, "--seed", seed,
                   "--freq", fpga.wanted_mhz, "--timing-allow-fail", "--report",
                   report.relative_to(tools.ROOT), "--quiet"],
                  folder / f"nextpnr.{seed}.log")
        placed = json.loads(report.read_text())
        rates.append(max(clock["achieved"] for clock in placed["fmax"].values()))
    used = {name: count["used"] for name, count in placed["utilization"].items() if count["used"]}
    return {"mhz": round(sorted(rates)[len(rates) // 2], 1), "luts": used[fpga.lut_cell],
            "used": used}


def port_widths(top: str, netlist: dict) -> list[tuple[str, str, int]]:
    """Direction, name and bits of each port of `top` in Yosys's JSON."""
    (module,) = [body for name, body in netlist["modules"].items()
                 if re.search(rf"(^|\\){re.escape(top)}(\\|$)", name)]
    return [(body["direction"], port, len(body["bits"])) for port, body in module["ports"].items()]


def registered(design: Design, ports: list[tuple[str, str, int]]) -> str:
    """Verilog of a wrapper that puts registers at all inputs and outputs of `design`.

    The ports of the wrapper are a shift register's ends: a device has fewer pins than a wide design
    has bits, and what isn't used must not be optimised away.
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
