"""Renders, times and compares images, and returns rows for the report."""

import pathlib
import statistics
import sys

import numpy

from host.lab.peers import convert, scene as scenes
from host.lab.machine import processors
from host.lab.rows import ROOT

# Width of each scene's image, which is square.
SCENES = {"cornell": 128, "cornell_spheres": 128, "paper_room": 128, "still_life": 128, "columns": 128,
          "teapot": 128, "sphereflake": 128, "landscape": 128, "lanterns": 128}
VARIANTS = ("scalar_rgb", "llvm_ad_rgb")
# The best of Mitsuba's samplers, which are also timed with other numbers of samples.
BEST = ("multijitter", "orthogonal")
NO_LIGHT_PATHS = "--caustics off"  # Mitsuba's `path` has no light paths
ERRORS = (16, 8, 4, 2)  # of --error, for adaptive sampling
SEEDS = 10  # per image
COUNT = 32  # samples per pixel in the tables, or the next number that a sampler supports
REFERENCE_SEED = 1000


def scene_file(name: str) -> pathlib.Path:
    """Returns a scene file from this folder or from the gallery."""
    mine = pathlib.Path(__file__).parent / "scenes" / f"{name}.json"
    return mine if mine.exists() else ROOT / "scenes" / f"{name}.json"


def mse(picture: numpy.ndarray, reference: numpy.ndarray) -> float:
    """Returns the mean squared error over pixels and colours, scene-linear."""
    return float(numpy.mean((picture.astype(float) - reference) ** 2))


def shown(light: numpy.ndarray) -> numpy.ndarray:
    """Returns displayed values (sRGB), from 0 to 1."""
    light = numpy.clip(light.astype(float), 0.0, 1.0)
    return numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def display_rmse(picture: numpy.ndarray, reference: numpy.ndarray) -> float:
    """Returns the RMSE of displayed images in steps of an 8-bit display."""
    return 255.0 * mse(shown(picture), shown(reference)) ** 0.5


def standard_error(values: list[float]) -> float:
    """Returns the standard error of the mean over seeds; 0 for one value."""
    return statistics.stdev(values) / len(values) ** 0.5 if len(values) > 1 else 0.0


def reference(renderer: object, sampler: str, samples: int, size: dict) -> tuple[numpy.ndarray, float]:
    """Returns the mean of two long runs, and its remaining MSE, estimated from their difference."""
    first, second = (renderer.render(sampler, samples, REFERENCE_SEED + i, **size)[1] for i in range(2))
    return (first.astype(float) + second) / 2.0, mse(first, second) / 4.0


class Measurement:
    """The measurements of one scene."""

    def __init__(self, name: str, quick: bool, program: pathlib.Path) -> None:
        self.name, self.quick, self.program = name, quick, program
        side = SCENES[name] // (2 if quick else 1)
        self.size = {"width": side, "height": side}
        self.folder = ROOT / "build" / "peers" / name
        found = scenes.read(scene_file(name))
        convert.write(found, self.folder)
        self.left_out = found.left_out
        self.references: dict[str, numpy.ndarray] = {}

    def progress(self, text: str) -> None:
        """Prints progress to standard error."""
        print(f"{self.name}: {text}", file=sys.stderr)

    def references_row(self, samples: int) -> dict:
        """Returns a row that compares the references of both renderers."""
        from host.lab.peers.renderers import Mitsuba, Raygate  # need Mitsuba, which the tests do not use
        found = {}
        for renderer, sampler in ((Raygate(self.folder, processors(), self.program), ""),
                                  (Mitsuba(self.folder, processors(), "llvm_ad_rgb"), "multijitter")):
            self.progress(f"{2 * samples} samples by {renderer.name}")
            found[renderer.name.split()[0]] = reference(renderer, sampler, samples, self.size)
            renderer.close()
        self.references = {name: picture for name, (picture, _) in found.items()}
        (ours, our_noise), (theirs, their_noise) = found.values()
        self.write_side_by_side(ours, theirs)
        return {"table": "references", "scene": self.name, "samples": 2 * samples, "left_out": self.left_out,
                "mean_raygate": float(ours.mean()), "mean_mitsuba": float(theirs.mean()),
                "rmse": mse(ours, theirs) ** 0.5, "noise": (our_noise + their_noise) ** 0.5}

    def write_side_by_side(self, ours: numpy.ndarray, theirs: numpy.ndarray) -> None:
        """Writes references.png: raygate, Mitsuba, and ten times their difference."""
        import mitsuba
        strip = numpy.concatenate([ours, theirs, 10.0 * abs(ours - theirs)], axis=1)
        mitsuba.util.write_bitmap(str(self.folder / "references.png"), strip.astype(numpy.float32))

    def plan(self, threads: int) -> list[tuple[object, str, int]]:
        """Returns the renderer, sampler and samples per pixel of each measurement."""
        from host.lab.peers.renderers import Mitsuba, Raygate
        one_thread = threads == 1
        counts = ([8, COUNT] if self.quick else [2, 8, COUNT]) if one_thread else [COUNT]
        raygate = Raygate(self.folder, threads, self.program)
        found = [(raygate, "Owen-scrambled Sobol", count) for count in counts]
        if one_thread:
            found += [(raygate, f"--error {error}", COUNT) for error in ERRORS] + [(raygate, NO_LIGHT_PATHS, COUNT)]
        for variant in VARIANTS:
            mitsuba = Mitsuba(self.folder, threads, variant)
            found += [(mitsuba, sampler, count) for count in counts for sampler in convert.SAMPLERS
                      if count == COUNT and one_thread or sampler in BEST]
        return found

    def rows(self, threads: int, repeats: int) -> list[dict]:
        """Returns a row for each planned measurement. Repeats use other seeds and are interleaved."""
        plan = self.plan(threads)
        runs: list[list[dict]] = [[] for _ in plan]
        for seed in range(repeats):
            for (renderer, sampler, count), mine in zip(plan, runs, strict=True):
                self.progress(f"{renderer.name} {sampler}, {count} samples, {threads} threads")
                row, picture = renderer.render(sampler, count, seed, **self.size)
                truth = self.references[renderer.name.split()[0]]
                mine.append(row | {"mse": mse(picture, truth), "display_rmse": display_rmse(picture, truth)})
        for renderer in {id(renderer): renderer for renderer, _, _ in plan}.values():
            renderer.close()
        return [self.row(threads, renderer.name, sampler, mine)
                for (renderer, sampler, _), mine in zip(plan, runs, strict=True)]

    def row(self, threads: int, renderer: str, sampler: str, runs: list[dict]) -> dict:
        """Returns the row of a measurement. With one thread, time is processor time, which excludes other programs."""
        key = "processor_seconds" if threads == 1 else "seconds"
        seconds = statistics.median(run[key] for run in runs)
        error = statistics.fmean(run["mse"] for run in runs)
        shown = statistics.fmean(run["display_rmse"] ** 2 for run in runs)
        return {"table": "peers", "scene": self.name, **self.size, "threads": threads, "renderer": renderer,
                "sampler": sampler, "samples": runs[0]["samples"], "seconds": [run["seconds"] for run in runs],
                "processor_seconds": [run["processor_seconds"] for run in runs], "median_seconds": seconds,
                "mse": error, "mse_error": standard_error([run["mse"] for run in runs]), "display_rmse": shown ** 0.5,
                "display_mse": shown, "display_mse_error": standard_error([run["display_rmse"] ** 2 for run in runs]),
                "time_mse": seconds * error}


def measure(name: str, quick: bool, program: pathlib.Path, threads: set[int]) -> list[dict]:
    """Returns the rows of one scene."""
    mine = Measurement(name, quick, program)
    return [mine.references_row(128 if quick else 512),
            *(row for count in sorted(threads) for row in mine.rows(count, 2 if quick else SEEDS))]
