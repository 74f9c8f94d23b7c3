"""Reads LEF files: outlines and pins of a library's cells; tracks and sheet resistances of its metals."""

import dataclasses
import pathlib
import re


@dataclasses.dataclass(frozen=True)
class Rect:
    """A rectangle on a layer, um."""

    layer: str
    left: float
    bottom: float
    right: float
    top: float

    @property
    def centre(self) -> tuple[float, float]:
        """The centre's x and y, um."""
        return (self.left + self.right) / 2, (self.bottom + self.top) / 2


@dataclasses.dataclass(frozen=True)
class Macro:
    """A cell: its size (um), and the metal of each signal pin."""

    width: float
    height: float
    pins: dict[str, list[Rect]]


@dataclasses.dataclass(frozen=True)
class Layer:
    """A layer of wires: pitch and offset of its tracks (um), width of a wire (um), sheet resistance (ohms per square)."""

    pitch: float
    offset: float
    width: float
    ohms: float
    vertical: bool


@dataclasses.dataclass(frozen=True)
class Technology:
    """The parts of a LEF file that placing and routing need."""

    layers: dict[str, Layer]  # lowest first
    macros: dict[str, Macro]

    @property
    def up(self) -> str:
        """The lowest layer of vertical wires."""
        return next(name for name, layer in self.layers.items() if layer.vertical)

    @property
    def across(self) -> str:
        """The lowest layer of horizontal wires above the layer `up`."""
        names = list(self.layers)
        return next(name for name in names[names.index(self.up):] if not self.layers[name].vertical)

    @property
    def tracks(self) -> tuple[Layer, Layer]:
        """The lowest layers of vertical and of horizontal wires. Pins and ports lie on their tracks."""
        return self.layers[self.up], next(layer for layer in self.layers.values() if not layer.vertical)


def read(file: pathlib.Path) -> Technology:
    """Reads a LEF file. Raises ValueError if it has no routing layers or no cells."""
    text = file.read_text()
    layers = {name: _layer(body) for name, body in
              re.findall(r"^LAYER (\w+)\n(.*?)^END \1", text, re.M | re.S) if "ROUTING" in body}
    macros = {name: _macro(body) for name, body in
              re.findall(r"^MACRO (\w+)\n(.*?)^END \1\b", text, re.M | re.S)}
    if not layers or not macros:
        raise ValueError(f"{file}: {len(layers)} routing layers and {len(macros)} cells, expected some")
    return Technology(layers, macros)


def _layer(body: str) -> Layer:
    def number(word: str) -> float:
        return float(re.search(rf"^\s*{word}\s+([\d.e-]+)", body, re.M).group(1))

    return Layer(number("PITCH"), number("OFFSET"), number("WIDTH"), number("RESISTANCE\\s+RPERSQ"),
                 re.search(r"DIRECTION\s+VERTICAL", body) is not None)


def _macro(body: str) -> Macro:
    width, height = re.search(r"SIZE\s+([\d.]+)\s+BY\s+([\d.]+)", body).groups()
    pins = {}
    for name, pin in re.findall(r"^\s*PIN (\w+)\n(.*?)^\s*END \1\b", body, re.M | re.S):
        if not re.search(r"USE\s+(POWER|GROUND)", pin):
            pins[name] = rects(pin)
    return Macro(float(width), float(height), pins)


def rects(body: str) -> list[Rect]:
    """Returns all RECTs, each with the layer of the last LAYER statement before it."""
    layer, found = "", []
    for name, box in re.findall(r"^\s*(?:LAYER\s+(\w+)|RECT\s+([-\d. ]+?))\s*;", body, re.M):
        if name:
            layer = name
        else:
            found.append(Rect(layer, *map(float, box.split())))
    return found
