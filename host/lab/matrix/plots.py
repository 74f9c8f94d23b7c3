"""The report's plots, as SVG and PNG."""

import pathlib

from matplotlib import ticker

from host.lab.matrix import statistics
from synth.drawing import plt, save

# What a variant is, by its mark: doubts resolved or ignored, pipelined or the paper's unit.
MARKS = {("pipeline", True): ("o", "tab:blue", "pipelined unit, doubts resolved"),
         ("pipeline", False): ("x", "tab:red", "pipelined unit, doubts ignored"),
         ("serial", True): ("s", "tab:green", "the paper's unit, software decides")}

# Where an error of nothing is drawn on a logarithmic axis: this far below the smallest other one.
BELOW = 10.0


def _save(figure: plt.Figure, file: pathlib.Path) -> pathlib.Path:
    save(figure, file.with_suffix(""))
    return file


def pareto(points: list[dict], xlabel: str, ylabel: str, title: str,
           file: pathlib.Path) -> pathlib.Path:
    """Points {name, unit, doubts, x, y}: both the lower the better; the front is a line."""
    figure, axes = plt.subplots(figsize=(9, 5.5), layout="constrained")
    positive = [point["y"] for point in points if point["y"] > 0]
    floor = min(positive, default=1.0) / BELOW
    drawn = [(point["x"], max(point["y"], floor)) for point in points]
    best = statistics.front(drawn)
    axes.plot([drawn[i][0] for i in best], [drawn[i][1] for i in best], color="0.75",
              drawstyle="steps-post", zorder=0, label="none is better in both")
    for (unit, doubts), (mark, colour, label) in MARKS.items():
        mine = [i for i, point in enumerate(points) if (point["unit"], point["doubts"]) == (unit, doubts)]
        if mine:
            axes.scatter([drawn[i][0] for i in mine], [drawn[i][1] for i in mine], marker=mark,
                         color=colour, label=label)
    axes.set(xlabel=xlabel, ylabel=ylabel, title=title, xscale="log", yscale="log")
    if len(positive) < len(points):
        axes.axhspan(floor / 1.6, floor * 1.6, color="0.95", zorder=-1)
        axes.annotate("no error", (0.005, floor), xycoords=("axes fraction", "data"), va="center",
                      fontsize=8, color="0.4")
    axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 1.5, 2, 3, 4, 5, 7)))
    axes.xaxis.set_major_formatter(ticker.StrMethodFormatter("{x:,g}"))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.margins(x=0.12, y=0.1)
    axes.grid(alpha=0.3, which="both", linewidth=0.5)
    axes.legend(fontsize=8)
    _annotate(axes, points, drawn)
    return _save(figure, file)


def _annotate(axes: plt.Axes, points: list[dict], drawn: list[tuple[float, float]]) -> None:
    """Names beside the points; those of points too close for texts of their own share one."""
    axes.figure.draw_without_rendering()  # settles the axes, so that distances are known
    places = axes.transData.transform(drawn)
    groups: list[list[int]] = []
    for i in sorted(range(len(points)), key=lambda i: -places[i][1]):
        for group in groups:
            apart = abs(places[group[-1]] - places[i])
            if apart[0] < 45 and apart[1] < 14:
                group.append(i)
                break
        else:
            groups.append([i])
    middle = axes.bbox.x0 + 0.7 * axes.bbox.width  # beyond it, names stand to the left
    low = axes.bbox.y0 + 0.3 * axes.bbox.height  # below it, they stack upwards
    for group in groups:
        leftwards = max(places[i][0] for i in group) > middle
        end = (min if leftwards else max)(group, key=lambda i: places[i][0])
        axes.annotate("\n".join(points[i]["name"] for i in group), drawn[end], fontsize=7,
                      textcoords="offset points", xytext=(-6 if leftwards else 6, 3),
                      ha="right" if leftwards else "left",
                      va="top" if len(group) > 1 and places[end][1] > low else "bottom")


def scaling(series: dict[str, list[tuple[float, float]]], xlabel: str, ylabel: str, title: str,
            file: pathlib.Path) -> tuple[pathlib.Path, dict[str, statistics.PowerLaw]]:
    """Lines of (x, y) on logarithmic axes, each with its power law; the file and the laws."""
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    laws = {}
    for name, points in series.items():
        xs, ys = [x for x, _ in points], [y for _, y in points]
        law = statistics.power_law(xs, ys)
        label = name
        if law:
            laws[name] = law
            label += f": exponent {law.exponent:.2f} ± {law.exponent_error:.2f}"
        (line,) = axes.plot(xs, ys, marker="o", linestyle="", label=label)
        if law:
            axes.plot(xs, [law.at(x) for x in xs], color=line.get_color(), linewidth=0.8)
    axes.set(xlabel=xlabel, ylabel=ylabel, title=title, xscale="log", yscale="log")
    axes.grid(alpha=0.3, which="both", linewidth=0.5)
    axes.legend(fontsize=8)
    return _save(figure, file), laws


def gallery(pictures: list[tuple[str, pathlib.Path]], file: pathlib.Path,
            columns: int = 4) -> pathlib.Path:
    """Pictures side by side with their titles, as PNG."""
    rows = -(-len(pictures) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(3 * columns, 2.5 * rows), squeeze=False,
                                layout="constrained")
    for axes in grid.flat:
        axes.set_axis_off()
    for axes, (title, picture) in zip(grid.flat, pictures):
        axes.imshow(plt.imread(picture), interpolation="nearest")
        axes.set_title(title, fontsize=8)
    figure.savefig(file, dpi=110, metadata={"Software": None})
    plt.close(figure)
    return file
