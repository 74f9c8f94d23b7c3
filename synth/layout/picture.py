"""Draws a layout from its DEF: cells by the part that they belong to, wires, the slowest path."""

import pathlib

from matplotlib import collections as shapes

from synth.drawing import plt
from synth.layout import route
from synth.layout.flow import Layout

INCHES = 11  # of the longer side
METALS = {"metal1": "#203040", "metal2": "#303030", "metal3": "#5a5a5a"}  # higher ones: grey


def draw(layout: Layout, parts: dict[str, str], path: list[dict], title: str, out: pathlib.Path) -> None:
    """Writes OUT.png. `path`: the steps of the slowest path; none are drawn where it is empty."""
    left, bottom, right, top = layout.routing.die
    scale = INCHES / max(right - left, top - bottom)
    figure, axes = plt.subplots(figsize=((right - left) * scale + 2.8, (top - bottom) * scale + 0.6),
                                layout="constrained")
    labels = list(dict.fromkeys(parts.values()))
    colours = dict(zip(labels, _colours(len(labels)), strict=True))
    _cells(axes, layout, parts, colours)
    fine = (right - left) * (top - bottom) / 1e5  # um: the larger the die, the thinner its wires
    _wires(axes, layout, 0.9 / max(1, fine) ** 0.5)
    if path:
        _path(axes, layout, path, max(1.2, 3 / max(1, fine) ** 0.25))
    for port, (x, y, _) in layout.routing.ports.items():
        axes.plot(x, y, "s", ms=2, color="black" if layout.netlist.ports[port].output else "grey")
    for label in labels:
        axes.plot([], [], "s", ms=9, color=colours[label], label=label)
    axes.plot([], [], "s", ms=3, color="grey", label="inputs")
    axes.plot([], [], "s", ms=3, color="black", label="outputs")
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", title=title, xlabel="um")
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False, fontsize="small")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.savefig(out.with_name(out.name + ".png"), dpi=120, bbox_inches="tight")
    plt.close(figure)


def _colours(count: int) -> list:
    if count > 10:
        return [plt.get_cmap("turbo")(0.08 + 0.84 * place / (count - 1)) for place in range(count)]
    palette = plt.get_cmap("Set3").colors
    return [palette[place] for place in (3, 0, 5, 4, 2, 6, 7, 9, 10, 8)[:count]]


def _cells(axes: plt.Axes, layout: Layout, parts: dict[str, str], colours: dict) -> None:
    x0, y0 = route.origin(layout.technology)
    boxes, faces = [], []
    for name, site in layout.placement.cells.items():
        macro = layout.technology.macros[layout.netlist.cells[name].kind]
        x, y = site.x + x0, site.y + y0
        boxes.append([(x, y), (x + macro.width, y), (x + macro.width, y + macro.height), (x, y + macro.height)])
        faces.append(colours[parts[name]])
    axes.add_collection(shapes.PolyCollection(boxes, facecolors=faces, edgecolors="white", linewidths=0.4))


def _wires(axes: plt.Axes, layout: Layout, width: float) -> None:
    by_layer: dict[str, list] = {}
    for pieces in layout.routing.wires.values():
        for wire in pieces:
            by_layer.setdefault(wire.layer, []).append([(wire.x0, wire.y0), (wire.x1, wire.y1)])
    for layer, lines in sorted(by_layer.items()):
        axes.add_collection(shapes.LineCollection(lines, colors=METALS.get(layer, "#808080"),
                                                  linewidths=width, alpha=0.45))


def _path(axes: plt.Axes, layout: Layout, path: list[dict], width: float) -> None:
    """The nets of the path as they are routed, and its cells outlined."""
    x0, y0 = route.origin(layout.technology)
    nets, boxes = [], []
    for step in path:
        cell, _, pin = step["pin"].partition("/")
        if cell in layout.netlist.cells:
            nets.append(layout.netlist.cells[cell].pins[pin])
            site = layout.placement.cells[cell]
            macro = layout.technology.macros[layout.netlist.cells[cell].kind]
            x, y = site.x + x0, site.y + y0
            boxes.append([(x, y), (x + macro.width, y), (x + macro.width, y + macro.height),
                          (x, y + macro.height)])
    lines = [[(wire.x0, wire.y0), (wire.x1, wire.y1)] for net in dict.fromkeys(nets)
             for wire in layout.routing.wires.get(net, [])]
    axes.add_collection(shapes.PolyCollection(boxes, facecolors="none", edgecolors="black", linewidths=width / 2,
                                              zorder=4))
    axes.add_collection(shapes.LineCollection(lines, colors="crimson", linewidths=width, zorder=5))
    axes.plot([], [], color="crimson", linewidth=2, label="the slowest path")
