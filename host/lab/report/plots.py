"""Images for reports: galleries, heat maps and plots."""

import io
import math
import pathlib

import numpy
from PIL import Image

from synth.drawing import plt

# Label, colour and marker of a variant, by its unit and whether doubts are resolved.
KINDS = {("pipeline", True): ("pipelined unit, doubts resolved", "#4477aa", "o"),
         ("pipeline", False): ("pipelined unit, doubts ignored", "#ee6677", "x"),
         ("serial", True): ("the paper's unit, software decides", "#228833", "s")}
# On logarithmic axes, an error of 0 is drawn as the smallest other error divided by this.
BELOW = 10.0


def write_png(drawn: bytes, file: pathlib.Path) -> None:
    """Writes a PNG with at most 256 colours, 1/5 of the original size."""
    picture = Image.open(io.BytesIO(drawn)).convert("RGB")
    picture.quantize(256, dither=Image.Dither.NONE).save(file, optimize=True)


def save(figure: plt.Figure, file: pathlib.Path) -> pathlib.Path:
    """Writes and closes a figure. Equal figures give equal files."""
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=110)
    plt.close(figure)
    write_png(drawn.getvalue(), file)
    return file


def flip(reference: pathlib.Path, picture: pathlib.Path) -> tuple[numpy.ndarray, float]:
    """Returns the FLIP difference map of two PNGs, and its mean."""
    import flip_evaluator  # not needed by the tests of tables

    shown = [numpy.asarray(plt.imread(file), dtype=numpy.float32)[..., :3] for file in (reference, picture)]
    error_map, mean, _ = flip_evaluator.evaluate(*shown, "LDR")
    return error_map, float(mean)


def save_pixels(pixels: numpy.ndarray, file: pathlib.Path) -> None:
    """Writes pixels with values from 0 to 1."""
    plt.imsave(file, numpy.clip(pixels, 0, 1))


def panels(count: int, columns: int, size: tuple[float, float], **words: object) -> tuple[plt.Figure, list[plt.Axes]]:
    """Returns a figure with `count` panels, in rows of `columns`, each of this size in inches."""
    columns = min(count, columns)
    lines = -(-count // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(size[0] * columns, size[1] * lines), squeeze=False,
                                layout="constrained", **words)
    for axes in grid.flat[count:]:
        axes.set_axis_off()
    return figure, list(grid.flat[:count])


def gallery(pictures: list[tuple[str, pathlib.Path]], file: pathlib.Path, columns: int = 4) -> pathlib.Path:
    """Draws images side by side with titles. With one column, they are strips of three times the width."""
    figure, grid = panels(len(pictures), columns, (9, 2.5) if columns == 1 else (3, 2.5))
    for axes, (title, picture) in zip(grid, pictures, strict=True):
        axes.imshow(plt.imread(picture), interpolation="nearest")
        axes.set_title(title, fontsize=8)
        axes.set_axis_off()
    return save(figure, file)


def front(points: list[tuple[float, float]]) -> list[int]:
    """Returns the Pareto-optimal points: no other point is at most as large in both coordinates and smaller in one.

    Returns indices, sorted by the first coordinate.
    """
    best, kept = math.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            kept.append(i)
            best = points[i][1]
    return kept


def pareto(frames: list[dict], costs: dict[str, str], error: str, label: str, title: str, file: pathlib.Path) -> pathlib.Path:
    """Plots each cost (key of the frames: label) against the key `error` in a panel. A line connects the
    Pareto-optimal variants, which are labelled."""
    floor = min((frame[error] for frame in frames if frame[error] > 0), default=1.0) / BELOW
    figure, grid = panels(len(costs), 2, (5.5, 4))
    for axes, (cost, text) in zip(grid, costs.items(), strict=True):
        known = [frame for frame in frames if frame.get(cost)]
        drawn = [(frame[cost], max(frame[error], floor)) for frame in known]
        best = front(drawn)
        axes.step(*zip(*(drawn[i] for i in best), strict=True), where="post", color="0.6", linewidth=1, zorder=0)
        for kind, (name, colour, marker) in KINDS.items():
            mine = [point for frame, point in zip(known, drawn, strict=True) if (frame["unit"], frame["doubts"]) == kind]
            if mine:
                axes.scatter(*zip(*mine, strict=True), color=colour, marker=marker, s=25, label=name)
        for i in best:
            axes.annotate(known[i]["variant"], drawn[i], xytext=(4, 3), textcoords="offset points", fontsize=7)
        axes.set(xscale="log", yscale="log", xlabel=text, ylabel=label)
        axes.grid(True, alpha=0.3)
        if any(frame[error] <= 0 for frame in known):
            axes.axhline(floor, color="0.8", linewidth=0.8, zorder=0)
            axes.text(0.01, floor, "no error", transform=axes.get_yaxis_transform(), fontsize=7, color="0.5", va="bottom")
    figure.legend(*grid[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    figure.suptitle(title)
    return save(figure, file)


def lines(series: dict[str, list[tuple[float, float]]], xlabel: str, ylabel: str, title: str, file: pathlib.Path) -> pathlib.Path:
    """Plots the points (x, y) of each series on logarithmic axes, connected by lines."""
    figure, axes = plt.subplots(figsize=(7.5, 5), layout="constrained")
    axes.set_prop_cycle(color=plt.get_cmap("tab20" if len(series) > 10 else "tab10").colors)
    for name, points in series.items():
        axes.loglog(*zip(*sorted(points), strict=True), marker=".", linewidth=1, label=name)
    axes.set(xlabel=xlabel, ylabel=ylabel, title=title)
    axes.grid(True, which="both", alpha=0.3)
    figure.legend(loc="outside right upper", fontsize="small")
    return save(figure, file)
