"""The reports' plots, as PNG."""

import math
import pathlib

import numpy
from matplotlib import colors, ticker

from host.lab.report import statistics
from synth.drawing import plt

# What a variant is, by its mark: doubts resolved or ignored, pipelined or the paper's unit.
MARKS = {("pipeline", True): ("o", "tab:blue", "pipelined unit, doubts resolved"),
         ("pipeline", False): ("x", "tab:red", "pipelined unit, doubts ignored"),
         ("serial", True): ("s", "tab:green", "the paper's unit, software decides")}

# Where an error of nothing is drawn on a logarithmic axis: this far below the smallest other one.
BELOW = 10.0


def save(figure: plt.Figure, file: pathlib.Path) -> pathlib.Path:
    """Writes and closes it; the same figure gives the same file."""
    figure.savefig(file, dpi=110, metadata={"Software": None})
    plt.close(figure)
    return file


def flip(reference: pathlib.Path, picture: pathlib.Path) -> tuple[numpy.ndarray, float]:
    """The map of FLIP differences of two PNGs, and their mean."""
    import flip_evaluator  # which tests of the tables do without

    shown = [numpy.asarray(plt.imread(file), dtype=numpy.float32)[..., :3] for file in (reference, picture)]
    error_map, mean, _ = flip_evaluator.evaluate(*shown, "LDR")
    return error_map, float(mean)


def save_pixels(pixels: numpy.ndarray, file: pathlib.Path) -> None:
    """As they are, from 0 to 1."""
    plt.imsave(file, numpy.clip(pixels, 0, 1))


def panels(count: int, columns: int, size: tuple[float, float], **words: object) -> tuple[plt.Figure, list[plt.Axes]]:
    """A figure of so many panels, in rows of `columns`, each of that size in inches."""
    columns = min(count, columns)
    lines = -(-count // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(size[0] * columns, size[1] * lines), squeeze=False,
                                layout="constrained", **words)
    for axes in grid.flat[count:]:
        axes.set_axis_off()
    return figure, list(grid.flat[:count])


def pareto(points: list[dict], costs: dict[str, str], error: str, title: str,
           file: pathlib.Path) -> pathlib.Path:
    """A panel for each cost (key: label) of points {name, unit, doubts, error, key ...}; the lower
    the better in both; the front is a line."""
    figure, grid = panels(len(costs), 2, (6.5, 5))
    for axes, (key, label) in zip(grid, costs.items(), strict=True):
        _pareto_panel(axes, [point for point in points if point.get(key)], key)
        axes.set(xlabel=label, ylabel=error)
    grid[0].legend(fontsize=8)
    figure.suptitle(title)
    return save(figure, file)


def _pareto_panel(axes: plt.Axes, points: list[dict], key: str) -> None:
    positive = [point["error"] for point in points if point["error"] > 0]
    floor = min(positive, default=1.0) / BELOW
    drawn = [(point[key], max(point["error"], floor)) for point in points]
    best = statistics.front(drawn)
    axes.plot([drawn[i][0] for i in best], [drawn[i][1] for i in best], color="0.75",
              drawstyle="steps-post", zorder=0, label="none is better in both")
    for (unit, doubts), (mark, colour, label) in MARKS.items():
        mine = [drawn[i] for i, point in enumerate(points)
                if (point["unit"], point["doubts"]) == (unit, doubts)]
        axes.scatter([x for x, _ in mine], [y for _, y in mine], marker=mark, color=colour,
                     label=label)
    axes.set(xscale="log", yscale="log")
    if len(positive) < len(points):
        axes.axhspan(floor / 1.6, floor * 1.6, color="0.95", zorder=-1)
        axes.annotate("no error", (0.005, floor), xycoords=("axes fraction", "data"), va="center",
                      fontsize=8, color="0.4")
    axes.xaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(ticker.StrMethodFormatter("{x:,g}"))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.margins(x=0.15, y=0.12)
    axes.grid(alpha=0.3, which="both", linewidth=0.5)
    _annotate(axes, [point["name"] for point in points], drawn)


def _annotate(axes: plt.Axes, names: list[str], drawn: list[tuple[float, float]]) -> None:
    """Names beside the points; those of points too close for texts of their own share one."""
    axes.figure.draw_without_rendering()  # settles the axes, so that distances are known
    places = axes.transData.transform(drawn) if drawn else []
    groups: list[list[int]] = []
    for i in sorted(range(len(drawn)), key=lambda i: -places[i][1]):
        for group in groups:
            apart = abs(places[group[0]] - places[i])
            if apart[0] < 80 and apart[1] < 14 * (len(group) + 1):
                group.append(i)
                break
        else:
            groups.append([i])
    middle = axes.bbox.x0 + 0.7 * axes.bbox.width  # beyond it, names stand to the left
    low = axes.bbox.y0 + 0.3 * axes.bbox.height  # below it, they stack upwards
    for group in groups:
        leftwards = max(places[i][0] for i in group) > middle
        end = (min if leftwards else max)(group, key=lambda i: places[i][0])
        axes.annotate("\n".join(names[i] for i in group), drawn[end], fontsize=7,
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
    return save(figure, file), laws


def gallery(pictures: list[tuple[str, pathlib.Path]], file: pathlib.Path, columns: int = 4) -> pathlib.Path:
    """Pictures side by side with their titles; in one column they are strips, three times as wide."""
    figure, grid = panels(len(pictures), columns, (9, 2.5) if columns == 1 else (3, 2.5))
    for axes, (title, picture) in zip(grid, pictures, strict=True):
        axes.imshow(plt.imread(picture), interpolation="nearest")
        axes.set_title(title, fontsize=8)
        axes.set_axis_off()
    return save(figure, file)


def heat_map(values: list[list[float]], rows: list[str], columns: list[str], title: str,
           file: pathlib.Path) -> pathlib.Path:
    """A map of shares from 1e-6 to 1, white where there are none."""
    figure, axes = plt.subplots(figsize=(12, 0.4 * len(rows) + 2.5), layout="constrained")
    palette = plt.get_cmap("YlOrRd").with_extremes(bad="white")
    image = axes.imshow([[share or math.nan for share in row] for row in values], aspect="auto",
                        cmap=palette, norm=colors.LogNorm(1e-6, 1))
    for y, row in enumerate(values):
        for x, share in enumerate(row):
            axes.text(x, y, f"{100 * share:.2g}" if share else "0", ha="center", va="center",
                      fontsize=7, color="white" if share > 0.1 else "black")
    axes.set_xticks(range(len(columns)), columns, rotation=60, ha="right")
    axes.set_yticks(range(len(rows)), rows)
    axes.set_title(title)
    figure.colorbar(image, label="share of tests")
    return save(figure, file)


def error_by_angle(curves: dict[str, list[tuple[float, float]]], unit: list[tuple[float, float]],
                   largest: list[tuple[float, float]], bound: list[tuple[float, float]],
                   file: pathlib.Path) -> pathlib.Path:
    """The 99th percentile of each subject's t, and the largest of the unit's under its bound."""
    figure, axes = plt.subplots(figsize=(10, 5.5), layout="constrained")
    axes.set_prop_cycle(color=plt.get_cmap("tab20").colors)
    for name, points in curves.items():
        axes.loglog(*zip(*points, strict=True), marker=".", linewidth=1, label=name)
    axes.loglog(*zip(*unit, strict=True), "k.-", linewidth=2, label="the unit")
    axes.loglog(*zip(*largest, strict=True), "k^", label="the unit, largest")
    axes.loglog(*zip(*bound, strict=True), "k--", label="the unit, proven bound")
    axes.set_xlabel("sine of the angle between ray and plane (a decade each)")
    axes.set_ylabel("error of t, ulp: 99th percentile")
    axes.set_ylim(top=1e9)  # above it are overflows of the narrow formats alone
    figure.legend(loc="outside right upper", fontsize="small")
    axes.grid(True, alpha=0.3)
    return save(figure, file)
