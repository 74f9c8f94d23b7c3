"""What `make core` found, as a report: clocks of the ray core by scene, kind of ray and memory."""

import pathlib

from matplotlib import ticker

from host.lab.report import document, plots
from host.lab.report.rows import of
from synth.drawing import plt

TITLE = """# The ray core in simulation

Clocks of `hw/ray_core`, 128x128 pixels, a line of 64 bytes a clock at the port to memory. Latency: clocks from a request to its line; lines,
bytes and busy shares are those at the middle one. Busy: clocks in which `box_unit` takes a node, or `set_up_unit` a triangle; last, those of
the busier one in each 256 clocks, as they are busy in turns. Each answer was compared with the cpu engine's.
"""


def clocks_table(rows: list[dict]) -> str:
    """A row for each scene and kind of rays; clocks a ray at each latency, the rest at the middle one."""
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
                      row["busier_percent"], row["doubts_per_1000"]])
    return document.table(
        {"scene": "", "rays": "", **{f"clocks/ray, latency {latency}": ".2f" for latency in latencies},
         "lines/ray": ".2f", "bytes/ray": ".0f", "boxes busy, %": ".1f", "triangles busy, %": ".1f",
         "busier of 256 clocks, %": ".1f", "doubts/1000 rays": ".2f"}, cells)


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
    sweep = [row for row in rows if row["run"] == "in flight"]
    file = draw(sweep, folder / "core.png")
    caption = "Clocks a ray against rays in flight."
    return (f"{TITLE}\n## 64 rays in flight\n\n{clocks_table([row for row in rows if row['run'] == 'scenes'])}\n"
            f"## Rays in flight and latency\n\nOne ray in eight.\n\n![{caption}]({file.relative_to(folder)})\n\n"
            "## Several cores behind one port\n\nMemory 50 clocks away. Waits: clocks in which a core asks for a line "
            "and another core's request, or none, is taken.\n\n"
            f"{cores_table([row for row in rows if row['run'] == 'cores'])}")
