"""A mapped netlist for placing and routing, with short names of cells, ports and nets."""

import dataclasses

CONSTANTS = {"0": "gnd", "1": "vdd", "x": "gnd"}  # constant bit in Yosys's JSON -> rail with this value


@dataclasses.dataclass(frozen=True)
class Cell:
    """An instance: its name in the netlist of `make synth`, its type, and the net of each pin."""

    name: str
    kind: str
    pins: dict[str, str]


@dataclasses.dataclass(frozen=True)
class Port:
    """A port of one bit. `net` is a rail if the port is held at a constant."""

    name: str
    output: bool
    net: str


@dataclasses.dataclass(frozen=True)
class Netlist:
    """Cells by their short names (c0, c1, ...), and ports by their short names (p0, p1, ...).

    A net has the short name of its first port, because qrouter finds a port by the name of its net. A net without ports is named n1, n2,
    ... Further ports of a net are not routed.
    """

    top: str
    cells: dict[str, Cell]
    ports: dict[str, Port]

    def nets(self) -> dict[str, list[tuple[str, str]]]:
        """Returns the ends of each net: (cell, pin) for a cell's pin, ("PIN", port) for a port."""
        found: dict[str, list[tuple[str, str]]] = {}
        for name, port in self.ports.items():
            if port.net == name:
                found[name] = [("PIN", name)]
        for name, cell in self.cells.items():
            for pin, net in cell.pins.items():
                found.setdefault(net, []).append((name, pin))
        return found

    def verilog(self) -> str:
        """Returns the netlist as Verilog with the short names, to time the netlist as placed."""
        constant = {rail: f"1'b{bit}" for bit, rail in CONSTANTS.items() if bit != "x"}
        lines = [f"module {self.top} ({', '.join(self.ports)});"]
        wires = {net for cell in self.cells.values() for net in cell.pins.values()}
        lines += [f"  wire {net};" for net in sorted(wires - constant.keys() - self.ports.keys())]
        for name, port in self.ports.items():
            lines.append(f"  {'output' if port.output else 'input'} {name};")
            if port.net != name:
                lines.append(f"  assign {name} = {constant.get(port.net, port.net)};")
        for name, cell in self.cells.items():
            pins = ", ".join(f".{pin}({constant.get(net, net)})" for pin, net in cell.pins.items())
            lines.append(f"  {cell.kind} {name} ({pins});")
        return "\n".join([*lines, "endmodule"]) + "\n"


def parse(module: dict, top: str) -> Netlist:
    """Returns the netlist of a module in Yosys's JSON."""
    first: dict[int, str] = {}  # bit -> its first port
    bits = [(port["direction"] == "output", name if len(port["bits"]) == 1 else f"{name}[{place}]", bit)
            for name, port in module["ports"].items() for place, bit in enumerate(port["bits"])]
    for place, (_, _, bit) in enumerate(bits):
        first.setdefault(bit, f"p{place}")

    def net(bit: int | str) -> str:
        return CONSTANTS[bit] if isinstance(bit, str) else first.get(bit, f"n{bit}")

    cells = {f"c{place}": Cell(name, cell["type"], {pin: net(bits[0]) for pin, bits in
                                                    cell["connections"].items() if bits})
             for place, (name, cell) in enumerate(sorted(module["cells"].items()))}
    return Netlist(top, cells, {f"p{place}": Port(name, output, net(bit))
                                for place, (output, name, bit) in enumerate(bits)})
