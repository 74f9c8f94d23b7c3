"""The energy of one operation: a timed simulation of the layout's cells counts how often each net toggles.

OpenSTA writes the delay of each cell with its wires as SDF; Icarus simulates the netlist with them, glitches
and all, one operation every 100 ns. A toggle of a net costs half of C V^2, where C is its wires and the pins
that it drives, and what Liberty says that its driver takes inside, at that load and a slew of 0.18 ns.
Leakage is left out: a ten-thousandth at 10 MHz. OpenSTA 2.0.17's own report_power takes no counts of nets; at one
rate for all nets its switching power is this one, and inside a cell of n inputs it counts n times what is counted here, each
input's table at the output's rate.
"""

import bisect
import dataclasses
import pathlib
import re

from synth import liberty, mapping, store, tools
from synth.catalogue import Design, Library
from synth.layout import flow, netlist, parasitics, tests
from synth.layout.flow import Job
from synth.layout.netlist import Netlist
from synth.layout.route import RAILS

SLEW = 0.18  # ns: a point of the library's tables, and what most nets have
HERE = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass(frozen=True)
class Pin:
    """A pin of a cell: its capacitance, pF; of an output, by load in pF: pJ of a rise and of a fall."""

    farads: float
    rise: tuple[list[float], list[float]] | None = None
    fall: tuple[list[float], list[float]] | None = None


def measure(job: Job) -> tuple[dict, bool]:
    """pJ an operation of a layout that was made, toggles, and when the last net settles, ns; whether kept."""
    folder = job.folder / "energy"
    wanted = store.key(files(job.library), (job.folder / "result.json").read_text(), *versions())

    def work() -> dict:
        made = flow.load(job)
        farads = parasitics.capacitances((job.folder / f"{job.design.top}.ext").read_text(),
                                         set(made.netlist.nets()))
        return _spent(job.design, job.library, made.netlist, farads, folder, job.folder / "wires.spef")

    return store.cached(folder, wanted, tools.measured(work))


def of_cells(design: Design, library: Library, how: str) -> tuple[dict, bool]:
    """The same of a netlist of make synth by the flow `how`, without wires."""
    folder = store.OUT / "energies" / f"{design.name}.{library.name}.{how}"
    sources = [*files(library), *design.sources(how == "cells"), *mapping.files(), HERE / "netlist.py"]
    wanted = store.key(sources, mapping.flow_facts(), *versions(), design.facts, library, how)

    def work() -> dict:
        mapping.synthesise(design, library, how)
        mapped = store.OUT / "runs" / folder.name / "netlist.json"
        nets = netlist.parse(mapping.top_module(mapped), design.top)
        return _spent(design, library, nets, dict.fromkeys(nets.nets(), 0.0), folder)

    return store.cached(folder, wanted, tools.measured(work))


def files(library: Library) -> list[pathlib.Path]:
    """What any energy depends on, besides the design."""
    return [*(HERE / name for name in ("energy.py", "tests.py", "sdf.tcl")), tests.SCENE, library.models,
            library.liberty, tools.FLOWS / "constraints.sdc"]


def versions() -> tuple[str, ...]:
    """Of the tools that simulate."""
    return tools.version("iverilog"), tools.version("sta")


def _spent(design: Design, library: Library, nets: Netlist, farads: dict[str, float], folder: pathlib.Path,
           spef: pathlib.Path | None = None) -> dict:
    words = tests.words(design)
    simulate(design, library, nets, bench(nets, words), folder, spef)
    with (folder / "toggles.vcd").open() as trace:
        counts, settled = toggles(trace, 100_000)
    (folder / "toggles.vcd").unlink()
    joules = energies(nets, counts, farads, pins(library), library)
    return {"operations": len(words), "pj": round(sum(joules.values()) / len(words), 4),
            "wires_pj": round(wires(counts, farads, library) / len(words), 4),
            "toggles": round(sum(sum(count) for count in counts.values()) / len(words), 1),
            "settled_ns": settled / 1000}


def simulate(design: Design, library: Library, nets: Netlist, text: str, folder: pathlib.Path,
             spef: pathlib.Path | None = None) -> None:
    """Runs the test bench `text` around the netlist's cells with their delays; what it writes is in `folder`, what it says in
    vvp.log there."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "netlist.v").write_text(nets.verilog())
    tools.run(["sta", "-exit", HERE / "sdf.tcl"], folder / "sta.log", {
        "LIBERTY": str(library.liberty), "NETLIST": str(folder / "netlist.v"), "TOP": design.top,
        "SDC": str(tools.FLOWS / "constraints.sdc"), "DRIVER": library.driver, "ACCESS": "0", "CLOCK": "",
        "LOAD": f"{library.load_pf}", "SPEF": str(spef or ""), "OUT": str(folder / "delays.sdf")})
    # Icarus takes the typical of three delays, and OpenSTA states the least and the most alone.
    delays = (folder / "delays.sdf").read_text()
    (folder / "delays.sdf").write_text(re.sub(r"\(([\d.]+)::([\d.]+)\)", r"(\2)", delays))
    (folder / "cells.v").write_text(re.sub(r"`timescale.*", "`timescale 1ns/1ps", library.models.read_text()))
    (folder / "bench.v").write_text(text)
    tools.run(["iverilog", "-g2012", "-gspecify", "-Ttyp", "-o", "bench", "bench.v", "netlist.v", "cells.v"],
              folder / "iverilog.log", folder=folder)
    tools.run(["vvp", "-n", "bench"], folder / "vvp.log", folder=folder)


def bench(nets: Netlist, words: list[dict[str, int]]) -> str:
    """A test bench that gives the inputs of each operation 100 ns and notes all toggles from the second on."""
    inputs = [(name, port.name) for name, port in nets.ports.items() if not port.output]
    lines = ["`timescale 1ns/1ps", "module bench;", f"  reg [{len(inputs) - 1}:0] in;"]
    lines += [f"  wire {name};" for name, port in nets.ports.items() if port.output]
    connections = [f".{name}(in[{place}])" for place, (name, _) in enumerate(inputs)]
    connections += [f".{name}({name})" for name, port in nets.ports.items() if port.output]
    lines += [f"  {nets.top} dut ({', '.join(connections)});", "  initial begin",
              '    $sdf_annotate("delays.sdf", dut);']
    for place, word in enumerate([words[-1], *words]):
        value = 0
        for bit, (_, port) in enumerate(inputs):
            name, _, index = port.partition("[")
            value |= (word.get(name, 0) >> int(index.rstrip("]") or 0) & 1) << bit
        lines.append(f"    in = {len(inputs)}'h{value:x}; #100;")
        if place == 0:
            lines.append('    $dumpfile("toggles.vcd"); $dumpvars(1, dut);')
    return "\n".join([*lines, "    $finish;", "  end", "endmodule"]) + "\n"


def toggles(trace, period: int) -> tuple[dict[str, tuple[int, int]], int]:
    """Rises and falls of each signal of a VCD, and the latest within a period that one of them comes."""
    names: dict[str, list[str]] = {}
    last: dict[str, str] = {}
    counts: dict[str, list[int]] = {}
    now = latest = 0
    for line in trace:
        if line[0] in "01":
            key = line[1:].rstrip()
            before = last.get(key)
            if before is not None and before != line[0]:
                counts[key][line[0] == "0"] += 1
                latest = max(latest, now)
            last[key] = line[0]
        elif line[0] == "#":
            now = int(line[1:]) % period
        elif line.startswith("$var"):
            _, _, _, key, name, *_ = line.split()
            names.setdefault(key, []).append(name)
            counts[key] = [0, 0]
    return {name: tuple(counts[key]) for key, all_names in names.items() for name in all_names}, latest


def energies(nets: Netlist, counts: dict[str, tuple[int, int]], farads: dict[str, float],
             kinds: dict[str, dict[str, Pin]], library: Library) -> dict[str, float]:
    """pJ of each net's toggles, those inside the cell that drives it among them."""
    found = {}
    for net, ends in nets.nets().items():
        if net in RAILS or net not in counts:
            continue
        load, drivers = farads[net], []
        for cell, pin in ends:
            if cell == "PIN":
                load += library.load_pf if nets.ports[pin].output else 0
                continue
            here = kinds[nets.cells[cell].kind][pin]
            load += here.farads
            if here.rise:
                drivers.append(here)
        rises, falls = counts[net]
        found[net] = (rises + falls) * load * library.volts ** 2 / 2
        for driver in drivers:
            found[net] += rises * at(driver.rise, load) + falls * at(driver.fall, load)
    return found


def wires(counts: dict[str, tuple[int, int]], farads: dict[str, float], library: Library) -> float:
    """pJ that the wires alone take of it."""
    return sum(sum(counts[net]) * pf * library.volts ** 2 / 2 for net, pf in farads.items() if net in counts)


def at(curve: tuple[list[float], list[float]], x: float) -> float:
    """Between the two points of a curve around x, on the line through them."""
    xs, ys = curve
    place = min(max(bisect.bisect(xs, x), 1), len(xs) - 1)
    x0, x1, y0, y1 = *xs[place - 1: place + 1], *ys[place - 1: place + 1]
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0)


def pins(library: Library) -> dict[str, dict[str, Pin]]:
    """Every pin of every cell; a curve is the mean over the inputs that it is stated for."""
    return {cell.name: {pin.name: Pin(pin.number("capacitance"), curve(pin, "rise_power"), curve(pin, "fall_power"))
                        for pin in cell.of("pin")} for cell in liberty.read(library.liberty).of("cell")}


def curve(pin: liberty.Group, word: str) -> tuple[list[float], list[float]] | None:
    """The mean of all tables of that name at SLEW, by load; None where there is none or it has no load."""
    curves = []
    for table in (table for power in pin.of("internal_power") for table in power.of(word)):
        axes = [liberty.numbers(table.attributes[axis]) for axis in ("index_1", "index_2") if axis in table.attributes]
        rows = [liberty.numbers(row) for row in re.findall(r'"([^"]*)"', table.attributes["values"])]
        if len(axes) == 2:
            curves.append((axes[0], [at((axes[1], row), SLEW) for row in rows]))
    if not curves:
        return None
    return curves[0][0], [sum(values) / len(values) for values in zip(*(ys for _, ys in curves), strict=True)]
