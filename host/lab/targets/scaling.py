"""`make scaling`: how a picture's time grows smaller with ranks: measured here, and a model of more ranks than there are.

The model of a picture's seconds on N ranks of T threads each:

    scene      every rank reads the scene and builds its tree: nothing of it is shared
    compute    thread-seconds / (N T), or / tiles where there are fewer tiles than threads
    gather     bytes that come back to rank 0, at the rate of its link or of its processor; it
               goes on during compute, so only what is longer of both counts
    end        the last pass over a tile, while others have nothing left to do

Sizes of tiles and steps are those of host/render (tiles.h, remote_workers.cpp).
"""

import argparse
import dataclasses
import hashlib
import os
import pathlib
import statistics
import tempfile

import numpy

from host.lab.report import plots
from host.lab.rows import ROOT, of
from host.lab.steps import Step, render
from synth.drawing import plt

SAMPLES = (4, 16, 64)
RANKS = (1, 2)
MORE_RANKS = (4, 8)
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

# As in host/render.
JOB_SECONDS, RATE, EDGE, LEAST_EDGE, PASS = 1.0, 250e6, 64, 16, 4
# Not measured: a link of 10 Gbit/s to rank 0, files read at 5 GB/s by all ranks together, 64 threads a node.
LINK, FILES, THREADS = 1.25e9, 5e9, 64


def picture(program: pathlib.Path, scene: str, ranks: int, samples: int, size: tuple[int, int]) -> list[dict]:
    """One picture by so many ranks of a thread each: its statistics, and what its bytes are."""
    with tempfile.TemporaryDirectory() as name:
        file = pathlib.Path(name) / "a.exr"
        found = render(["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), program, scene],
                       "--integrator", "path", "--threads", "1", "--size", "{}x{}".format(*size), "--spp", str(samples),
                       picture=file, env=ENVIRONMENT)
        return [{"table": "scaling", "scene": scene, "ranks": ranks, "samples": samples, "pixels": size[0] * size[1],
                 **{key: found[key] for key in ("width", "height", "triangles", "seconds", "gathered_tiles", "gathered_bytes")},
                 "scene_bytes": (ROOT / scene).stat().st_size, "bytes": hashlib.sha256(file.read_bytes()).hexdigest()}]


def steps(given: argparse.Namespace) -> list[Step]:
    """A picture each, taking turns."""
    scenes = ("scenes/cornell.obj",) if given.quick else ("scenes/cornell.obj", "build/scenes/landscape.obj")
    runs = [(scene, ranks, samples, repeat) for repeat in range(1 if given.quick else 5) for scene in scenes
            for samples in SAMPLES for ranks in RANKS]
    runs += [(scene, ranks, SAMPLES[0], 0) for scene in scenes for ranks in MORE_RANKS]
    size = (64, 48) if given.quick else (240, 180)
    return [Step("ranks", f"{scene}, {ranks} ranks, {samples} samples, run {repeat + 1}",
                 measure=lambda scene=scene, ranks=ranks, samples=samples: picture(given.render, scene, ranks, samples, size))
            for scene, ranks, samples, repeat in runs]


PARTS = {"ranks": steps}


@dataclasses.dataclass
class Costs:
    """Of a scene, in seconds of a thread, and bytes."""
    scene: float             # reading it, and its tree
    scene_bytes: int
    pixel: float             # whatever the number of samples
    sample: float
    gather_byte: float       # of rank 0's processor, a byte that comes back
    slice_bytes: float       # a pixel's share of a tile that comes back


def seconds(rows: list[dict], stage: str, **values: object) -> float:
    """The least of the repeats: what other programs took is in the others."""
    return min(row["seconds"][stage] for row in of(rows, "scaling", **values))


def fit(rows: list[dict], scene: str) -> Costs:
    """From one rank's processor seconds, and what rank 0 measured of the others."""
    alone = {"scene": scene, "ranks": 1}
    pixels = of(rows, "scaling")[0]["pixels"]
    samples = numpy.array(SAMPLES) * pixels
    sample, rest = numpy.polyfit(samples, [seconds(rows, "processor", samples=n, **alone) for n in SAMPLES], 1)
    shared = [row for row in of(rows, "scaling", scene=scene) if row["gathered_bytes"]]
    one = of(rows, "scaling", **alone)[0]
    # Every channel of a film with sums, see host/film/film.h: colour, depth, normal, triangle, sums.
    slice_bytes = 16 + 4 + 12 + 4 + 4 + 4 * 24
    return Costs(scene=seconds(rows, "load", **alone) + seconds(rows, "tree", **alone),
                 scene_bytes=one["scene_bytes"], pixel=max(rest, 0.0) / pixels, sample=sample,
                 gather_byte=statistics.median(row["seconds"]["gather"] / row["gathered_bytes"] for row in shared),
                 slice_bytes=slice_bytes)


@dataclasses.dataclass
class Picture:
    """What is rendered, and by nodes of how many threads."""
    costs: Costs
    pixels: int
    samples: int
    threads: int = THREADS


@dataclasses.dataclass
class Time:
    """Seconds."""
    scene: float
    compute: float
    gather: float
    end: float

    def total(self) -> float:
        """Of all, gather going on during compute."""
        return self.scene + max(self.compute, self.gather) + self.end


def predict(picture: Picture, ranks: int, small_tiles: bool = True, slower_answers: bool = True,
            link: float = LINK) -> Time:
    """Of so many ranks; without the smaller tiles, or without the longer steps, that many of them get."""
    costs, workers = picture.costs, ranks * picture.threads
    work = picture.pixels * (costs.pixel + picture.samples * costs.sample)
    edge, per_pass = EDGE, min(PASS, picture.samples)
    while small_tiles and ranks > 1 and edge > LEAST_EDGE and picture.pixels / workers < 4 * edge * edge:
        edge, per_pass = edge // 2, min(picture.samples, 4 * per_pass)
    tiles, passes = -(-picture.pixels // edge**2), -(-picture.samples // per_pass)
    slice_bytes = edge * edge * costs.slice_bytes
    step = max(JOB_SECONDS, workers * slice_bytes / RATE if slower_answers else 0.0)
    one_pass = work / (tiles * passes)
    back = tiles * min(passes, max(1.0, work / tiles / max(step, one_pass))) * slice_bytes * (ranks - 1) / ranks
    return Time(scene=costs.scene + (ranks - 1) * costs.scene_bytes / FILES,
                compute=work / min(workers, tiles),
                gather=back * max(costs.gather_byte, 1.0 / link),
                end=one_pass if workers > 1 else 0.0)


def measured(rows: list[dict], **values: object) -> float:
    """Seconds of a picture where each rank has a processor to itself, whatever else runs meanwhile."""
    alone = {"scene": values["scene"], "ranks": 1}
    return (seconds(rows, "load", **alone) + seconds(rows, "tree", **alone)
            + seconds(rows, "processor", **values) / values["ranks"])


def beside_the_model(rows: list[dict], fits: dict[str, Costs]) -> list[dict]:
    """Scene by scene: seconds of one and two ranks of a thread, and what the model says."""
    return [{"scene": scene, "samples": samples, "ranks": ranks,
             "found": measured(rows, scene=scene, samples=samples, ranks=ranks),
             "told": predict(Picture(costs, of(rows, "scaling")[0]["pixels"], samples, threads=1), ranks).total()}
            for scene, costs in fits.items() for samples in SAMPLES for ranks in RANKS]


def same_bytes(rows: list[dict]) -> str:
    """Whether all pictures of a scene and number of samples are one, and of how many ranks."""
    mine, wrong = of(rows, "scaling"), failures(rows)
    if wrong:
        raise ValueError(wrong[0])
    ranks = ", ".join(str(n) for n in sorted({row["ranks"] for row in mine}))
    return f"{len(mine)} pictures by {ranks} ranks: one checksum for each scene and number of samples."


def failures(rows: list[dict]) -> list[str]:
    """Bytes that depend on the number of ranks."""
    found: dict[tuple, set] = {}
    for row in of(rows, "scaling"):
        found.setdefault((row["scene"], row["samples"]), set()).add(row["bytes"])
    return [f"{scene}, {samples} samples: pictures of different numbers of ranks are not the same bytes"
            for (scene, samples), digests in found.items() if len(digests) > 1]


NODES = numpy.unique(numpy.logspace(0, 3, 61).round().astype(int))


def panel(axes: plt.Axes, picture: Picture, title: str) -> None:
    """Seconds by ranks, in parts."""
    times = [predict(picture, int(n)) for n in NODES]
    axes.plot(NODES, [time.total() for time in times], color="black", linewidth=2, label="all")
    for part, colour in (("compute", "tab:blue"), ("scene", "tab:green"), ("gather", "tab:red"), ("end", "tab:orange")):
        axes.plot(NODES, [getattr(time, part) or numpy.nan for time in times], color=colour, linewidth=1, label=part)
    for words, style, label in (({"small_tiles": False}, ":", "all, with tiles of 64 x 64 pixels"),
                                ({"slower_answers": False}, "--", "all, with an answer each second")):
        axes.plot(NODES, [predict(picture, int(n), **words).total() for n in NODES], color="0.5", linestyle=style,
                  linewidth=1, label=label)
    axes.plot(NODES, times[0].total() / NODES, color="0.8", linewidth=1, zorder=0, label="a node's time / N")
    axes.set(xscale="log", yscale="log", ylim=(0.01, None), xlabel=f"ranks of {picture.threads} threads", ylabel="seconds", title=title)


PICTURES = {"1920 x 1080, 1,024 spp": (1920 * 1080, 1024), "7680 x 4320, 4,096 spp": (7680 * 4320, 4096),
            "7680 x 4320, 65,536 spp": (7680 * 4320, 65536)}


def plot(fits: dict[str, Costs], file: pathlib.Path) -> pathlib.Path:
    """A panel for each scene and picture."""
    figure, grid = plt.subplots(len(fits), len(PICTURES), figsize=(5 * len(PICTURES), 4.5 * len(fits)),
                                squeeze=False, layout="constrained")
    for line, (scene, costs) in zip(grid, fits.items(), strict=True):
        for axes, (name, (pixels, samples)) in zip(line, PICTURES.items(), strict=True):
            panel(axes, Picture(costs, pixels, samples), f"{pathlib.Path(scene).stem}, {name}")
    figure.legend(*grid[0][0].get_legend_handles_labels(), fontsize=8, loc="outside lower center", ncols=4)
    return plots.save(figure, file)


def limits(fits: dict[str, Costs]) -> list[dict]:
    """At how many ranks half of them are idle, and why."""
    found = []
    for scene, costs in fits.items():
        for name, (pixels, samples) in PICTURES.items():
            wanted = Picture(costs, pixels, samples)
            one = predict(wanted, 1).total()
            half = next((int(n) for n in NODES if one / (n * predict(wanted, int(n)).total()) < 0.5), None)
            time = predict(wanted, half or 1000)
            found.append({"scene": scene, "picture": name, "one": one, "thousand": predict(wanted, 1000).total(),
                          "half": half, "longest": max(("scene", "gather", "end"), key=lambda part: getattr(time, part))})
    return found


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """What was fitted, what it says, and the plot. ValueError where numbers of ranks differ in a byte."""
    same = same_bytes(rows)
    fits = {scene: fit(rows, scene) for scene in dict.fromkeys(row["scene"] for row in of(rows, "scaling"))}
    return {"same": same, "costs": [{**dataclasses.asdict(costs), "scene": scene, "reading": costs.scene}
                                    for scene, costs in fits.items()],
            "measured": beside_the_model(rows, fits), "limits": limits(fits), "link": LINK, "files": FILES,
            "threads": THREADS, "plot": plot(fits, folder / "scaling.png")}
