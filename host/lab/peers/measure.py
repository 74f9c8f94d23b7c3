"""Renders, times and compares images of raygate and Mitsuba, and returns rows for the report."""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import numpy

from host.lab.peers import convert
from host.lab.report import plots
from host.lab.rows import ROOT, processors
from host.lab.steps import render

# The materials of these scenes exist in both renderers. The last four have models from Debian's packages.
SCENES = ("cornell", "cornell_spheres", "columns", "landscape", "lanterns", "cornell_embree", "bunny", "mug", "wuson")
SIDE = 128  # pixels
VARIANT = "llvm_ad_rgb"  # Mitsuba's fastest variant for every scene
CURVES = ("multijitter", "orthogonal")  # Mitsuba's samplers that are also timed with all threads and with other numbers of samples
NO_LIGHT_PATHS = "--caustics off"  # Mitsuba's `path` has no light paths
SEEDS = 10  # per image
COUNT = 32  # samples per pixel in the tables; samplers may round it up
REFERENCE_SEED = 1000


def scene_file(name: str) -> pathlib.Path:
    """Returns a scene file from this folder or from the gallery."""
    mine = pathlib.Path(__file__).parent / "scenes" / f"{name}.json"
    return mine if mine.exists() else ROOT / "scenes" / f"{name}.json"


def light_of(picture: pathlib.Path) -> numpy.ndarray:
    """Returns the red, green and blue channels of an EXR file."""
    import mitsuba  # imported here, as the tests do not need it

    mitsuba.set_variant("scalar_rgb")
    bitmap = mitsuba.Bitmap(str(picture))
    names = [field.name for field in bitmap.struct_()]
    return numpy.array(bitmap)[..., [names.index(channel) for channel in "RGB"]]


class Raygate:
    """The program ./render with the cpu engine."""

    name = "raygate"

    def __init__(self, scene: pathlib.Path, side: int, threads: int) -> None:
        self._command = [ROOT / "render", scene, "--integrator", "path", "--filter", "box", "--depth", str(convert.DEPTH),
                         "--size", f"{side}x{side}", "--threads", str(threads)]

    def render(self, sampler: str, samples: int, seed: int) -> tuple[dict, numpy.ndarray]:
        """Returns the timing and the image. ./render has only one sampler, so `sampler` may hold options instead."""
        options = sampler.split() if sampler.startswith("--") else []
        with tempfile.TemporaryDirectory() as name:
            picture = pathlib.Path(name) / "picture.exr"
            found = render(self._command, *options, "--spp", str(samples), "--seed", str(seed), picture=picture)
            pixels = light_of(picture)
        seconds = found["seconds"]
        return {"seconds": seconds["render"], "processor_seconds": seconds.get("processor", seconds["render"]), "samples": samples}, pixels

    def close(self) -> None:
        """Does nothing, as no process is left running."""


class Mitsuba:
    """A worker process, which loads the scene once and warms up for each new kind of image."""

    name = "Mitsuba"

    def __init__(self, folder: pathlib.Path, threads: int) -> None:
        self._warm: set[tuple] = set()
        self._process = subprocess.Popen(
            [sys.executable, "-B", "-m", "host.lab.peers.mitsuba_worker", folder, VARIANT, str(threads)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT)

    def _ask(self, **asked: object) -> dict:
        self._process.stdin.write(json.dumps(asked) + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        if not answer:
            raise ValueError(f"{self.name} ended, expected a picture")
        return json.loads(answer)

    def render(self, sampler: str, samples: int, seed: int) -> tuple[dict, numpy.ndarray]:
        """Returns the worker's answer (mitsuba_worker.py), which has the times in seconds, and the image."""
        asked = {"sampler": sampler, "samples": samples}
        if (sampler, samples) not in self._warm:  # each kind of image needs its own kernel
            self._ask(**asked, seed=seed + 1)
            self._warm.add((sampler, samples))
        with tempfile.NamedTemporaryFile(suffix=".npy") as picture:
            row = self._ask(**asked, seed=seed, picture=picture.name)
            return row, numpy.load(picture.name)

    def close(self) -> None:
        """Ends the process."""
        self._process.stdin.close()
        self._process.wait()


def mse(picture: numpy.ndarray, reference: numpy.ndarray) -> float:
    """Returns the mean squared error over pixels and colours, scene-linear."""
    return float(numpy.mean((picture.astype(float) - reference) ** 2))


def shown(light: numpy.ndarray) -> numpy.ndarray:
    """Returns displayed values (sRGB), from 0 to 1."""
    light = numpy.clip(light.astype(float), 0.0, 1.0)
    return numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def display_mse(picture: numpy.ndarray, reference: numpy.ndarray) -> float:
    """Returns the mean squared error of displayed images, in squared steps of an 8-bit display."""
    return 255.0 ** 2 * mse(shown(picture), shown(reference))


def standard_error(values: list[float]) -> float:
    """Returns the standard error of the mean over seeds; 0 for one value."""
    return statistics.stdev(values) / len(values) ** 0.5 if len(values) > 1 else 0.0


def at_count(rows: list[dict]) -> list[dict]:
    """Returns the rows with about COUNT samples per pixel, without those that use the time of another row."""
    return [row for row in rows if COUNT / 2 < row["samples"] <= 2 * COUNT and not row.get("equal_time")]


def best(rows: list[dict], error: str) -> dict:
    """Returns the row of Mitsuba's best sampler at COUNT samples: the least product of time and `error`."""
    return min((row for row in at_count(rows) if row["renderer"] == "Mitsuba"), key=lambda row: row["median_seconds"] * row[error])


def equal_time_samples(ours: dict, theirs: dict) -> int:
    """Returns the samples per pixel that raygate renders in the time of Mitsuba's row, if time is proportional to samples."""
    return max(1, round(ours["samples"] * theirs["median_seconds"] / ours["median_seconds"]))


def reference(renderer: object, sampler: str, samples: int) -> tuple[numpy.ndarray, float]:
    """Returns the mean of two long runs, and the mean's remaining MSE, estimated from the difference of both runs."""
    first, second = (renderer.render(sampler, samples, REFERENCE_SEED + i)[1] for i in range(2))
    return (first.astype(float) + second) / 2.0, mse(first, second) / 4.0


class Measurement:
    """The measurements of one scene."""

    def __init__(self, name: str, quick: bool) -> None:
        self.name, self.quick = name, quick
        self.side = SIDE // (2 if quick else 1)
        self.folder = ROOT / "build" / "peers" / name
        self.folder.mkdir(parents=True, exist_ok=True)
        convert.write_mitsuba(convert.read(scene_file(name)), self.side, self.folder)
        self.references: dict[str, numpy.ndarray] = {}

    def references_row(self, samples: int) -> dict:
        """Returns a row that compares raygate's reference image with Mitsuba's."""
        found = {}
        for renderer, sampler in ((Raygate(scene_file(self.name), self.side, processors()), ""),
                                  (Mitsuba(self.folder, processors()), "multijitter")):
            found[renderer.name] = reference(renderer, sampler, samples)
            renderer.close()
        self.references = {name: picture for name, (picture, _) in found.items()}
        (ours, our_noise), (theirs, their_noise) = found.values()
        plots.save_pixels(0.5 + 10.0 * (ours - theirs), self.folder / "difference.png")
        return {"table": "references", "scene": self.name, "samples": 2 * samples,
                "mean_raygate": float(ours.mean()), "mean_mitsuba": float(theirs.mean()),
                "rmse": mse(ours, theirs) ** 0.5, "noise": (our_noise + their_noise) ** 0.5}

    def plan(self, threads: int) -> list[tuple[object, str, int]]:
        """Returns the renderer, sampler and samples per pixel of each measurement."""
        one_thread = threads == 1
        counts = ([8, COUNT] if self.quick else [2, 8, COUNT]) if one_thread else [COUNT]
        raygate = Raygate(scene_file(self.name), self.side, threads)
        found = [(raygate, "Owen-scrambled Sobol", count) for count in counts]
        if one_thread:
            found += [(raygate, NO_LIGHT_PATHS, COUNT)]
        mitsuba = Mitsuba(self.folder, threads)
        return found + [(mitsuba, sampler, count) for count in counts for sampler in convert.SAMPLERS
                        if count == COUNT and one_thread or sampler in CURVES]

    def equal_time_rows(self, rows: list[dict], repeats: int) -> list[dict]:
        """Returns raygate's rows with as many samples as fit into the time of Mitsuba's best samplers, of one thread's `rows`."""
        kinds = {(row["sampler"], equal_time_samples(row, best(rows, error)))
                 for row in at_count(rows) if row["renderer"] == "raygate" for error in ("mse", "display_mse")}
        raygate = Raygate(scene_file(self.name), self.side, 1)
        return [row | {"equal_time": True} for row in self.rows([(raygate, *kind) for kind in sorted(kinds)], 1, repeats)]

    def rows(self, plan: list[tuple[object, str, int]], threads: int, repeats: int) -> list[dict]:
        """Returns a row for each planned measurement. Repeats use other seeds and are interleaved."""
        runs: list[list[dict]] = [[] for _ in plan]
        for seed in range(repeats):
            for (renderer, sampler, count), mine in zip(plan, runs, strict=True):
                row, picture = renderer.render(sampler, count, seed)
                truth = self.references[renderer.name]
                mine.append(row | {"mse": mse(picture, truth), "display_mse": display_mse(picture, truth)})
        for renderer in {id(renderer): renderer for renderer, _, _ in plan}.values():
            renderer.close()
        return [self.row(threads, renderer.name, sampler, mine) for (renderer, sampler, _), mine in zip(plan, runs, strict=True)]

    def row(self, threads: int, renderer: str, sampler: str, runs: list[dict]) -> dict:
        """Returns the row of a measurement. With one thread, time is processor time, which excludes other programs."""
        key = "processor_seconds" if threads == 1 else "seconds"
        errors = {name: [run[name] for run in runs] for name in ("mse", "display_mse")}
        return {"table": "peers", "scene": self.name, "pixels": self.side ** 2, "threads": threads, "renderer": renderer,
                "sampler": sampler, "samples": runs[0]["samples"], "median_seconds": statistics.median(run[key] for run in runs),
                **{name: statistics.fmean(values) for name, values in errors.items()},
                **{f"{name}_error": standard_error(values) for name, values in errors.items()}}


def measure(name: str, quick: bool, threads: set[int]) -> list[dict]:
    """Returns the rows of one scene."""
    mine, repeats = Measurement(name, quick), 2 if quick else SEEDS
    found = [mine.references_row(128 if quick else 512)]
    for count in sorted(threads):
        rows = mine.rows(mine.plan(count), count, repeats)
        found += rows + (mine.equal_time_rows(rows, repeats) if count == 1 else [])
    return found
