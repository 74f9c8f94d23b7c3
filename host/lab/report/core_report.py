"""What `make core` found, as a report: clocks of the ray core by scene, kind of ray and memory."""

import pathlib

from matplotlib import ticker

from host.lab.report import document, plots
from host.lab.report.rows import of
from synth.drawing import plt

TITLE = """# The ray core in simulation

Clocks of `hw/ray_core`, 128x128 pixels, a line of 64 bytes a clock at the port to memory. Latency: clocks from a request to its line; lines,
bytes and shares of boxes and triangles are those at the middle one. Busy: clocks in which `box_unit` takes a node, or `set_up_unit` a triangle.
Each answer was compared with the cpu engine's.
"""


def clocks_table(rows: list[dict]) -> str:
    """A row for each scene and kind of rays; clocks a ray at each latency, the others at the middle one."""
    latencies = sorted({row["latency"] for row in rows})
    middle = latencies[len(latencies) // 2]
    cells = []
    for row in rows:
        if row["latency"] != middle:
            continue
        same = {other["latency"]: other for other in rows
                if (other["scene"], other["rays"]) == (row["scene"], row["rays"])}
        cells.append([row["scene"], row["rays"], *(same[latency]["clocks_per_ray"] for latency in latencies),
                      row["lines_per_ray"], row["bytes_per_ray"], row["nodes_percent"], row["triangles_percent"],
                      row["doubts_per_1000"]])
    return document.table(
        {"scene": "", "rays": "", **{f"clocks/ray, latency {latency}": ".2f" for latency in latencies},
         "lines/ray": ".2f", "bytes/ray": ".0f", "boxes busy, %": ".1f", "triangles busy, %": ".1f",
         "doubts/1000 rays": ".2f"}, cells)


def busy_table(rows: list[dict], wide: list[dict]) -> str:
    """How busy the busier unit is at each latency; last, of `wide`: with more rays, memory farthest away."""
    latencies = sorted({row["latency"] for row in rows})
    cells = []
    for row in wide:
        same = {other["latency"]: other for other in rows
                if (other["scene"], other["rays"]) == (row["scene"], row["rays"])}
        cells.append([row["scene"], row["rays"], *(same[latency]["busier_percent"] for latency in latencies),
                      row["busier_percent"], row["clocks_per_ray"]])
    head = [f"%, latency {latency}, 64 rays" for latency in latencies]
    more = f"latency {wide[0]['latency']}, {wide[0]['in_flight']} rays"
    return document.table({"scene": "", "rays": "", **dict.fromkeys(head, ".1f"), f"%, {more}": ".1f",
                           f"clocks/ray, {more}": ".2f"}, cells)


def records_table(rows: list[dict]) -> str:
    """How many tests would find their record in a cache of them."""
    sizes = [16, 64, 256]
    return document.table(
        {"scene": "", "rays": "", "tests/ray": ".2f", **{f"found of {size}, %": ".1f" for size in sizes}},
        [[row["scene"], row["rays"], row["tests_per_ray"], *(row[f"of_{size}_percent"] for size in sizes)]
         for row in rows])


def cores_table(rows: list[dict]) -> str:
    """Clocks a ray by the number of cores, and how often memory makes one of them wait."""
    numbers = sorted({row["cores"] for row in rows})
    cells = []
    for row in rows:
        if row["cores"] != numbers[0]:
            continue
        same = {other["cores"]: other for other in rows
                if (other["scene"], other["rays"]) == (row["scene"], row["rays"])}
        cells.append([row["scene"], row["rays"], *(same[number]["clocks_per_ray"] for number in numbers),
                      *(same[number]["waits_percent"] for number in numbers)])
    return document.table(
        {"scene": "", "rays": "", **{f"clocks/ray, {number} core{'s' * (number > 1)}": ".2f" for number in numbers},
         **{f"waits for the port, %, {number}": ".1f" for number in numbers}}, cells)


def draw(rows: list[dict], file: pathlib.Path) -> pathlib.Path:
    """Clocks a ray against rays in flight: a panel for each scene and kind, a line for each latency."""
    panels = list(dict.fromkeys((row["scene"], row["rays"]) for row in rows))
    columns = min(len(panels), 3)
    lines = -(-len(panels) // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(4.2 * columns, 3.6 * lines), squeeze=False,
                                sharex=True, layout="constrained")
    for axes in grid.flat[len(panels):]:
        axes.set_axis_off()
    for axes, (scene, kind) in zip(grid.flat, panels, strict=False):
        for latency in sorted({row["latency"] for row in rows}):
            points = of(rows, "core", scene=scene, rays=kind, latency=latency)
            axes.plot([row["in_flight"] for row in points], [row["clocks_per_ray"] for row in points], marker="o",
                      markersize=4, label=f"memory {latency} clock{'s' * (latency > 1)} away")
        axes.set(title=f"{scene}, {kind} rays", xscale="log", yscale="log")
        axes.xaxis.set_major_locator(ticker.LogLocator(base=2, numticks=10))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
        axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_minor_locator(ticker.NullLocator())
        axes.yaxis.set_minor_locator(ticker.NullLocator())
        axes.grid(alpha=0.3)
    grid.flat[0].legend(fontsize=8)
    figure.supxlabel("rays in flight")
    figure.supylabel("clocks a ray")
    return plots.save(figure, file)


def build(rows: list[dict], folder: pathlib.Path) -> str:
    """The report in Markdown; draws the plot into `folder`. `rows`: of all runs of `make core`."""
    run = {name: [row for row in rows if row["run"] == name]
           for name in ("scenes", "wide", "in flight", "cores", "records")}
    file = draw(run["in flight"], folder / "core.png")
    caption = "Clocks a ray against rays in flight."
    return (f"{TITLE}\n## 64 rays in flight\n\n{clocks_table(run['scenes'])}\n"
            "## How busy the units are\n\nOf each 256 clocks those of the busier unit, as boxes and triangles are busy in turns; "
            f"last, with a table of 256 rays.\n\n{busy_table(run['scenes'], run['wide'])}\n"
            "## Rays in flight and latency\n\nOne ray in four; beyond 64 with a table of 256.\n\n"
            f"![{caption}]({file.relative_to(folder)})\n\n"
            "## Several cores behind one port\n\nMemory 50 clocks away. Waits: clocks in which a core asks for a line "
            f"and another core's request, or none, is taken.\n\n{cores_table(run['cores'])}\n"
            "## Records used again\n\nTests whose record (of a triangle, seen from an origin) is among the last 16, 64 or 256 that "
            "were used, in the order of a core that has one ray at a time. No such cache is built.\n\n"
            f"{records_table(run['records'])}")
