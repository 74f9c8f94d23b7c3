"""Area against delay, one picture a section and library, as SVG and PNG."""

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "raygate"  # the same figures give the same file

import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

from synth import store  # noqa: E402
from synth.catalogue import FLOWS, LIBRARIES  # noqa: E402

MARKERS = dict(zip(FLOWS, "sovD^P", strict=True))


def draw(records: list[dict]) -> list[str]:
    """Draws every section that has areas; the file names without their suffix."""
    names = []
    for section in dict.fromkeys(record["section"] for record in records):
        for library in LIBRARIES:
            points = [record for record in records if record["section"] == section
                      and record["target"] == library.name]
            if points:
                name = f"{section} {library.name}".replace(" ", "-")
                _scatter(points, f"{section}, {library.title}", name)
                names.append(name)
    return names


def _scatter(points: list[dict], title: str, name: str) -> None:
    figure, axes = plt.subplots(figsize=(9, 6), layout="constrained")
    designs = list(dict.fromkeys(point["design"] for point in points))
    colours = plt.get_cmap("tab10")
    for point in points:
        axes.scatter(point["delay_ns"], point["area"], marker=MARKERS[point["flow"]],
                     color=colours(designs.index(point["design"]) % 10))
    for place, design in enumerate(designs):
        axes.scatter([], [], color=colours(place % 10), label=design)
    for flow in dict.fromkeys(point["flow"] for point in points):
        axes.scatter([], [], color="grey", marker=MARKERS[flow], label=f"flow: {flow}")
    axes.set(title=title, xlabel="slowest path, ns", ylabel="area, liberty units",
             xscale="log", ylim=(0, None))
    axes.legend(fontsize="small")
    axes.grid(alpha=0.3)
    for suffix, metadata in (("svg", {"Date": None}), ("png", {})):
        figure.savefig(store.OUT / f"{name}.{suffix}", metadata=metadata)
    plt.close(figure)
