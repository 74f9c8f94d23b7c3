"""Area against delay, one picture a section and library, as SVG and PNG."""

from synth import drawing, store
from synth.catalogue import FLOWS, LIBRARIES
from synth.drawing import plt, ticker

MARKERS = dict(zip(FLOWS, "soXvD^<P*d", strict=True))


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


def _colours(count: int) -> list:
    """As many colours that differ; grey is left to the flows."""
    palette = plt.get_cmap("tab10" if count < 10 else "tab20").colors
    return [colour for colour in palette if max(colour) - min(colour) > 0.01]


def _scatter(points: list[dict], title: str, name: str) -> None:
    figure, axes = plt.subplots(figsize=(9, 6), layout="constrained")
    designs = list(dict.fromkeys(point["design"] for point in points))
    colours = _colours(len(designs))
    for point in points:
        axes.scatter(point["delay_ns"], point["area"], marker=MARKERS[point["flow"]],
                     color=colours[designs.index(point["design"])])
    for place, design in enumerate(designs):
        axes.scatter([], [], color=colours[place], label=design)
    for flow in dict.fromkeys(point["flow"] for point in points):
        axes.scatter([], [], color="grey", marker=MARKERS[flow], label=f"flow: {flow}")
    axes.set(title=title, xlabel="slowest path, ns", ylabel="area of the cells, square micrometres",
             xscale="log", ylim=(0, None))
    axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 1.5, 2, 3, 4, 5, 6, 8)))
    axes.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.yaxis.set_major_formatter(ticker.StrMethodFormatter("{x:,.0f}"))
    axes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    axes.grid(alpha=0.3)
    drawing.save(figure, store.OUT / name)
