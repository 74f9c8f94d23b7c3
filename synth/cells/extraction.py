"""A cell's circuit from its layout: transistors with the junctions at their sides, and what its wires hold.

SkyWater's netlists of the cells in the package are of transistors alone. KLayout finds them again in the layout, with the
areas and edges of the diffusion at their sides (shared by the transistors at it) and the contacts there, and the shapes of every
net. A net's capacitance is that of its polysilicon outside of transistors, local interconnect and metal 1 to ground;
between nets there is none, and wires have no resistance but that of the contacts.
"""

import collections
import dataclasses
import re

from synth.cells import models, package

# aF per um2 of a layer and per um of its edge, to what lies below it: SkyWater's nominal ones.
CAPACITANCES = {"poly": (106.13, 55.27), "li1": (36.99, 40.70), "met1": (25.78, 40.57)}

# Ohms of a contact to diffusion, as in the netlists that SkyWater extracted from the same layouts.
CONTACT = {"n": 182, "p": 400}

LAYERS = {"nwell": (64, 20), "diffusion": (65, 20), "poly": (66, 20), "contact": (66, 44), "li1": (67, 20),
          "mcon": (67, 44), "met1": (68, 20)}
LABELS = {"li1": (67, 5), "met1": (68, 5)}
RAILS = ("VPWR", "VGND", "VPB", "VNB")


@dataclasses.dataclass(frozen=True)
class Transistor:
    """Its model ("n", "p"), nets, width (um), area (um2) and perimeter (um) of its source and its drain, ohms at them, and how far
    (um) the diffusion reaches on both sides of the gate: its stress makes a p transistor faster, an n slower."""

    model: str
    source: str
    gate: str
    drain: str
    width: float
    source_sides: tuple[float, float]
    drain_sides: tuple[float, float]
    ohms: tuple[float, float]
    reach: tuple[float, float]

    def spice(self, name: str) -> str:
        """A line of a netlist; the body is at a rail."""
        (area_s, edge_s), (area_d, edge_d) = self.source_sides, self.drain_sides
        body = "VGND" if self.model == "n" else "VPWR"
        return (f"M{name} {self.drain} {self.gate} {self.source} {body} {self.model} w={self.width:g}u "
                f"l={models.LENGTH}u as={area_s:.4f}p ad={area_d:.4f}p ps={edge_s:.3f}u pd={edge_d:.3f}u "
                f"nrs={self.ohms[0]:g} nrd={self.ohms[1]:g} "  # squares of diffusion, 1 ohm each in both models
                f"sa={self.reach[0]:.3f}u sb={self.reach[1]:.3f}u\n")


@dataclasses.dataclass(frozen=True)
class Circuit:
    """A cell: its pins but for the rails, transistors, and aF of each net."""

    name: str
    pins: tuple[str, ...]
    transistors: tuple[Transistor, ...]
    capacitances: dict[str, float]

    def spice(self) -> str:
        """The cell as a subcircuit `cell` of its pins and VPWR; ground is VGND, a global net."""
        text = [f".subckt cell {' '.join(self.pins)} VPWR\n"]
        text += [transistor.spice(str(i)) for i, transistor in enumerate(self.transistors)]
        text += [f"C{i} {net} VGND {farads:.1f}e-18\n" for i, (net, farads) in enumerate(self.capacitances.items())]
        return "".join([*text, ".ends\n"])


def circuit(name: str) -> Circuit:
    """The circuit of a cell, e.g. "nand2_1"; ValueError where the layout has other transistors than the netlist."""
    netlist = package.cell(name, "spice").read_text()
    pins = re.search(r"^\.subckt \S+ (.*)$", netlist, re.M)[1].split()
    found = _extract(name)
    drawn = collections.Counter((transistor.model, round(transistor.width, 3)) for transistor in found.transistors)
    stated = collections.Counter((model[0], float(width) / 1e6) for model, width in re.findall(
        r"^X\d+ .* sky130_fd_pr__(?:special_)?(nfet_01v8|pfet_01v8_hvt) w=(\S+)u l=150000u$", netlist, re.M))
    if drawn != stated:
        raise ValueError(f"{name}: the layout has the transistors {dict(drawn)}, the netlist {dict(stated)}")
    return dataclasses.replace(found, pins=tuple(pin for pin in pins if pin not in RAILS))


def _extract(name: str) -> Circuit:
    import klayout.db as db

    layout = db.Layout()
    layout.read(str(package.cell(name, "gds")))
    found = db.LayoutToNetlist(db.RecursiveShapeIterator(layout, layout.top_cell(), []))
    layer = {key: found.make_layer(layout.layer(*numbers), key) for key, numbers in LAYERS.items()}
    labels = {key: found.make_text_layer(layout.layer(*numbers), f"{key} label") for key, numbers in LABELS.items()}
    active = {"n": layer["diffusion"] - layer["nwell"], "p": layer["diffusion"] & layer["nwell"]}
    sides = {}
    for model, region in active.items():
        sides[model] = region - layer["poly"]
        found.register(sides[model], f"{model} sides")
        gate = region & layer["poly"]
        found.register(gate, f"{model} gate")
        found.extract_devices(db.DeviceExtractorMOS3Transistor(model), {
            "SD": sides[model], "G": gate, "P": layer["poly"]})
        found.connect(sides[model])
        found.connect(sides[model], layer["contact"])
    wires = {"poly": layer["poly"] - layer["diffusion"], "li1": layer["li1"], "met1": layer["met1"]}
    found.register(wires["poly"], "field poly")
    for one in ("poly", "contact", "li1", "mcon", "met1"):
        found.connect(layer[one])
    found.connect(layer["poly"], wires["poly"])
    for one, other in (("contact", "poly"), ("contact", "li1"), ("mcon", "li1"), ("mcon", "met1")):
        found.connect(layer[one], layer[other])
    for key, label in labels.items():
        found.connect(layer[key], label)
    found.extract_netlist()
    top = found.netlist().circuit_by_name(layout.top_cell().name)

    def called(net: db.Net) -> str:
        return net.name.split(",")[0] if net.name else f"n{net.cluster_id}"

    def middle(device: db.Device) -> db.Point:
        return db.CplxTrans(layout.dbu).inverted().trans(device.trans.disp.to_p())

    def reach(device: db.Device) -> tuple[float, float]:
        gate = middle(device)
        line = db.Region(db.Box(-10**6, gate.y - 1, 10**6, gate.y + 1)) & layer["diffusion"]
        (piece,) = [box for box in (polygon.bbox() for polygon in line.merged().each()) if box.left < gate.x < box.right]
        half = models.LENGTH / 2
        return (gate.x - piece.left) * layout.dbu - half, (piece.right - gate.x) * layout.dbu - half

    def ohms(device: db.Device) -> tuple[float, float]:
        """Of the contacts of the diffusion left and right of the gate, as its source and its drain; 0 where there are none."""
        gate, model, by_net = middle(device), device.device_class().name, {}
        beside = round((models.LENGTH / 2 + 0.02) / layout.dbu)
        for point in (db.Point(gate.x - beside, gate.y), db.Point(gate.x + beside, gate.y)):
            (piece,) = [polygon for polygon in (active[model] - layer["poly"]).merged().each() if polygon.inside(point)]
            contacts = (layer["contact"] & db.Region(piece)).merged().count()
            by_net[called(found.probe_net(sides[model], point))] = CONTACT[model] / contacts if contacts else 0
        return tuple(by_net[called(device.net_for_terminal(one))] for one in "SD")

    def transistor(device: db.Device) -> Transistor:
        return Transistor(device.device_class().name, *(called(device.net_for_terminal(one)) for one in "SGD"),
                          device.parameter("W"), (device.parameter("AS"), device.parameter("PS")),
                          (device.parameter("AD"), device.parameter("PD")), ohms(device), reach(device))

    farads = {}
    for net in top.each_net():
        if called(net) not in RAILS:
            shapes = {key: found.shapes_of_net(net, region, True) for key, region in wires.items()}
            farads[called(net)] = sum(
                area * shapes[key].area() * layout.dbu**2 + edge * shapes[key].perimeter() * layout.dbu
                for key, (area, edge) in CAPACITANCES.items())
    return Circuit(name, (), tuple(transistor(device) for device in top.each_device()),
                   {net: value for net, value in farads.items() if value})
