"""Images for reports: galleries, heat maps and plots."""

import io
import pathlib

import numpy
from matplotlib import pyplot as plt, ticker
from PIL import Image


def write_png(drawn: bytes, file: pathlib.Path) -> None:
    """Writes a PNG with at most 256 colours, a fifth of the bytes of the original."""
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
    import flip_evaluator  # imported here, as the tests of tables do not need it

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
    figure, grid = plt.subplots(lines, columns, figsize=(size[0] * columns, size[1] * lines), squeeze=False, layout="constrained", **words)
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


def lines(series: dict[str, list[tuple]], xlabel: str, ylabel: str, title: str, file: pathlib.Path) -> pathlib.Path:
    """Plots the points (x, y) or (x, y, label) of each series on logarithmic axes, connected by lines."""
    figure, axes = plt.subplots(figsize=(7.5, 5), layout="constrained")
    axes.set_prop_cycle(color=plt.get_cmap("tab20" if len(series) > 10 else "tab10").colors)
    for number, (name, points) in enumerate((name, sorted(points)) for name, points in series.items()):
        side = 1 if number else -1  # labels of the first series are on the left
        axes.loglog([point[0] for point in points], [point[1] for point in points], marker=".", linewidth=1, label=name)
        for place, (x, y, *label) in enumerate(points):
            axes.annotate("".join(label), (x, y), xytext=(5 * side, (2, -8)[place % 2]), textcoords="offset points", fontsize=7,
                          horizontalalignment="left" if number else "right")
    axes.set(xlabel=xlabel, ylabel=ylabel, title=title, xmargin=0.15)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set(major_locator=ticker.LogLocator(subs=(1, 2, 5)), major_formatter="{x:,g}", minor_formatter="")
    axes.grid(True, which="both", alpha=0.3)
    figure.legend(loc="outside right upper", fontsize="small")
    return save(figure, file)
