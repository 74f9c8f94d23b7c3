"""Draws where nextpnr put a unit on an FPGA, by part, and its slowest path.

`python3 -m synth.floorplan [UNIT | BOARD]` draws a unit of `make fpga` (the paper's on ECP5 if none) or what is on a board
from the first seed's placement, which it makes where that is not kept: build/synth/floorplan-NAME.png.
"""

import collections
import json
import pathlib
import re
import sys

from synth import board, catalogue, fpga, store, tools
from synth.drawing import plt

# What a cell's name in the hierarchy says, the first that matches.
# A core's last gates are named after the unit's wires that they drive.
PARTS = [(r"^(u_multiplier|product_)", "multiplier"), (r"^(u_adder|sum_)", "adder"),
         (r"^(u_divider|quotient_)", "divider"), (r"", "registers, multiplexers, control")]
CORE_PARTS = [(r"u_(node|triangle)_cache\.", "caches"), (r"u_memory\.", "queues of the memory's ports"),
              (r"u_intersection\.u_contexts\.", "rays"), (r"u_boxes\.", "boxes"), (r"u_tests\.", "triangles"),
              (r"u_closest_hit\.", "closest hit"), (r"u_traversal\.", "traversal"),
              (r"u_sdram\.", "SDRAM controller"), (r"", "results, link to the host, the rest")]
UNIT = "hit_test_unit-binary32-behavioural"


def cells(written: dict) -> list[tuple[str, int, int]]:
    """Name and place (column, row) of each cell that nextpnr placed, of the JSON that it writes; no pins."""
    (module,) = [body for body in written["modules"].values() if body["cells"]]
    found = []
    for name, cell in module["cells"].items():
        place = re.match(r"X(\d+)/Y(\d+)", cell["attributes"].get("NEXTPNR_BEL", ""))
        if place and cell.get("type") != "TRELLIS_IO":
            found.append((name, int(place.group(1)), int(place.group(2))))
    return found


def part(name: str, parts: list[tuple[str, str]]) -> str:
    """The part of the unit that a cell belongs to."""
    return next(label for pattern, label in parts if re.search(pattern, name))


def slowest(report: dict) -> list[tuple[int, int]]:
    """The places along the slowest path between registers, in the JSON that nextpnr reports."""
    path = next(path["path"] for path in report["critical_paths"]
                if path["from"] == path["to"] and "<async>" not in path["from"])
    return [tuple(step["to"]["loc"]) for step in path]


def draw(placed: list[tuple[str, int, int]], path: list[tuple[int, int]], parts: list[tuple[str, str]], title: str,
         out: pathlib.Path) -> None:
    """Writes OUT.png: a tile is as dark as it is full."""
    figure, axes = plt.subplots(figsize=(10, 8), layout="constrained")
    columns, rows = ([spot[axis] for spot in [entry[1:] for entry in placed] + path] for axis in (0, 1))
    side = 560 / max(max(columns) - min(columns) + 2, 1.25 * (max(rows) - min(rows) + 2))  # points
    for place, (_, label) in enumerate(parts):
        mine = [(x, y) for name, x, y in placed if part(name, parts) == label]
        counts = collections.Counter(mine)
        if not mine:
            continue
        color = plt.get_cmap("tab10").colors[place]
        axes.scatter([x for x, _ in counts], [y for _, y in counts], s=side ** 2, marker="s", linewidths=0, color=color,
                     alpha=[min(1.0, 0.25 + count / 10) for count in counts.values()])
        axes.scatter([], [], marker="s", color=color, label=f"{label}: {len(mine):,} cells")
    axes.plot(*zip(*path), color="black", linewidth=1, label=f"the slowest path, {len(path):,} steps")
    axes.invert_yaxis()
    axes.set(title=title, xlabel="column of tiles", ylabel="row of tiles", aspect="equal")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.07), ncols=2, frameon=False, fontsize="small")
    figure.savefig(out.with_name(out.name + ".png"), dpi=120)
    plt.close(figure)


def main() -> int:
    """2 for what the user can mend."""
    name = (sys.argv[1:] or [UNIT])[0]
    units = {design.name: (design, device) for design, _, _, device in catalogue.fpga_units()}
    boards = {entry.name: entry for entry in board.BOARDS}
    try:
        if name not in [*units, *boards]:
            raise ValueError(f"no unit {name}, expected one of {', '.join([*units, *boards])}")
        if name in boards:
            folder, what, clock = board.placement(boards[name]), f"{boards[name].holds} on {name}", boards[name].clock
        else:
            design, device = units[name]
            tools.find(device.tool)
            folder, what, clock = fpga.placement(design, device), f"{name} on {device.title}", ""
    except (tools.MissingTool, tools.ToolFailed, ValueError) as error:
        print(f"floorplan: {error}", file=sys.stderr)
        return 2
    report = json.loads((folder / "placed.json").read_text())
    mhz = max(found["achieved"] for said, found in report["fmax"].items() if clock in said)
    parts = PARTS if name.startswith("hit_test_unit") else CORE_PARTS
    out = store.OUT / f"floorplan-{name}"
    draw(cells(json.loads((folder / "written.json").read_text())), slowest(report), parts,
         f"{what}, {mhz:.1f} MHz", out)
    print(out.with_name(out.name + ".png").relative_to(tools.ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
