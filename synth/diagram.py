"""Draws a block diagram of a module from its elaborated netlist: registers, cores and multiplexers, or,
of one made of units, those and the memories between them.

`python3 -m synth.diagram TOP OUT [--units]`: OUT.svg and OUT.png, by graphviz.
"""

import argparse
import collections
import pathlib
import re
import sys

from synth import catalogue, mapping, scripts, store, tools, yosys

SHAPES = {"register": "box", "multiplexer": "invtrapezium", "core": "box3d", "port": "oval", "memory": "cylinder"}
# Inputs of cells that say when or which, not what.
CONTROLS = {"S", "EN", "CLK", "ARST", "SRST", "RD_EN", "WR_EN", "RD_CLK", "WR_CLK", "RD_ADDR", "WR_ADDR"}


def blocks(module: dict, width: int) -> tuple[dict[str, tuple[str, str]], set[tuple[str, str]]]:
    """Nodes (name -> kind, label) and arrows of the paths that are at least `width` bits wide.

    Registers are named after what they drive; other logic is left out.
    """
    netnames = {tuple(net["bits"]): name for name, net in module["netnames"].items()
                if not net.get("hide_name")}
    nodes, outputs, inputs = {}, {}, {}
    for name, port in module["ports"].items():
        if len(port["bits"]) >= width:
            nodes[name] = ("port", name)
            side = outputs if port["direction"] == "input" else inputs
            side.setdefault(name, []).append(port["bits"])
    for name, cell in module["cells"].items():
        kind = {"$mux": "multiplexer", "$pmux": "multiplexer"}.get(cell["type"], "")
        if "dff" in cell["type"]:
            kind = "register"
        elif not cell["type"].startswith("$"):
            kind = "core"
        if not kind:
            continue
        directions = cell["port_directions"]
        wide = {port: bits for port, bits in cell["connections"].items() if len(bits) >= width}
        out = [bits for port, bits in wide.items() if directions[port] == "output"]
        if not out and kind != "core":
            continue
        label = re.sub(r"\bu_|\bgen_", "", name) if kind == "core" else netnames.get(tuple(out[0]), "")
        nodes[name] = (kind, label.removesuffix("_q"))
        outputs[name] = out
        inputs[name] = [bits for port, bits in wide.items() if directions[port] == "input"]
    drives = {bit: name for name, words in outputs.items() for word in words for bit in word
              if isinstance(bit, int)}
    bits = collections.Counter((drives[bit], name) for name, words in inputs.items() for word in words
                               for bit in word if bit in drives)
    arrows = {arrow for arrow, count in bits.items() if count >= width}
    met = {name for arrow in arrows for name in arrow}
    return {name: node for name, node in nodes.items() if name in met}, arrows


def units(module: dict, width: int) -> tuple[dict[str, tuple[str, str]], set[tuple[str, str]]]:
    """Units, memories and the module's ports, and arrows of the words of at least `width` bits that get from one
    to another, whatever registers and gates are on the way."""
    nodes, starts, ends, passes = {}, {}, {}, []
    for name, port in module["ports"].items():
        if len(port["bits"]) >= width:
            nodes[name] = ("port", name)
            side = starts if port["direction"] == "input" else ends
            side.setdefault(name, []).append(port["bits"])
    for name, cell in module["cells"].items():
        is_unit = not cell["type"].startswith("$")
        is_memory = cell["type"].startswith("$mem")
        words = [(bits, cell["port_directions"][port]) for port, bits in cell["connections"].items()
                 if port not in CONTROLS]
        if not is_unit and not is_memory:
            passes.append(words)
            continue
        label = re.sub(r"\bu_|\bgen_", "", name) if is_unit else cell["parameters"]["MEMID"].lstrip("\\")
        if is_unit and "delay_line" in cell["type"]:  # no more than registers
            passes.append(words)
            continue
        nodes[name] = ("core" if is_unit else "memory", label)
        for bits, direction in words:
            (starts if direction == "output" else ends).setdefault(name, []).append(bits)
    follow = collections.defaultdict(set)  # bit -> bits that it gets to
    for words in passes:
        into = [bits for bits, direction in words if direction == "input"]
        for out in (bits for bits, direction in words if direction == "output"):
            for bits in into:  # bit by bit: nearly all that is between units is as wide as its words
                for place, bit in enumerate(out):
                    if bits:
                        follow[bits[place % len(bits)]].add(bit)
    arrows = set()
    for name, words in starts.items():
        reached = {bit for word in words if len(word) >= width for bit in word}
        edge = list(reached)
        while edge:
            fresh = follow[edge.pop()] - reached
            reached |= fresh
            edge += fresh
        arrows |= {(name, other) for other, words in ends.items() if other != name and any(
            sum(bit in reached for bit in word) >= width for word in words)}
    met = {name for arrow in arrows for name in arrow}
    return {name: node for name, node in nodes.items() if name in met}, arrows


def draw(top: str, out: pathlib.Path, width: int = 32, seen: object = blocks) -> None:
    """Writes OUT.dot, OUT.svg and OUT.png; `seen`: blocks, or units."""
    design = catalogue.design(top)
    file = out.with_suffix(".json")
    yosys.run(scripts.modules_json(design, file), out.with_suffix(".log"))
    nodes, arrows = seen(mapping.top_module(file), width)
    names = {name: f"n{place}" for place, name in enumerate(sorted(nodes))}
    lines = [f"digraph {top} {{", "  rankdir=LR; node [fontname=sans]; edge [arrowsize=0.7];"]
    lines += [f'  {names[name]} [shape={SHAPES[kind]}, label="{label}"];'
              for name, (kind, label) in sorted(nodes.items())]
    lines += [f"  {names[a]} -> {names[b]};" for a, b in sorted(arrows)]
    out.with_suffix(".dot").write_text("\n".join([*lines, "}"]) + "\n")
    for kind in ("svg", "png"):
        tools.run(["dot", f"-T{kind}", "-o", out.with_suffix(f".{kind}"), out.with_suffix(".dot")],
                  out.with_suffix(".log"))


def main() -> int:
    """The command line; 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="synth.diagram", description="Draws a module as blocks.")
    parser.add_argument("top", metavar="TOP", help="module of hw/")
    parser.add_argument("out", metavar="OUT", nargs="?", type=pathlib.Path, help="OUT.svg and OUT.png (build/synth/TOP)")
    parser.add_argument("--units", action="store_true", help="units and the memories between them")
    given = parser.parse_args()
    try:
        draw(given.top, given.out or store.OUT / given.top, *((28, units) if given.units else ()))
    except (tools.MissingTool, OSError) as error:
        print(f"synth.diagram: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
