"""Samples by error (`--error`) beside the same number everywhere: time at equal RMSE, and at equal FLIP."""

import math
import pathlib
import statistics
import tempfile

import numpy

from host.lab.report import plots
from host.lab.rows import ROOT
from host.lab.steps import difference, render

MEASURES = ("rmse", "flip")
# most: --spp with --error; counts: of uniform samples; reference: samples of the picture that is the truth.
USUAL = {"size": "96x72", "error": 2.0, "most": 256, "counts": [16, 32, 64, 128, 256], "reference": 2048, "seeds": 2}
QUICK = USUAL | {"size": "48x36", "most": 64, "counts": [8, 32], "reference": 128, "seeds": 1}


def interpolated(errors: list[float], values: list[float], error: float) -> float:
    """The value at `error` on a line through logarithms; errors fall. Beyond the ends, as 1 / error²."""
    if error > errors[0] or error < errors[-1]:
        end = 0 if error > errors[0] else -1
        return values[end] * (errors[end] / error) ** 2
    found = numpy.interp(-math.log(error), [-math.log(e) for e in errors], [math.log(v) for v in values])
    return math.exp(float(found))


class Pictures:
    """Of one scene, by one program, in a folder that is removed."""

    def __init__(self, program: pathlib.Path, scene: pathlib.Path, size: str, folder: pathlib.Path) -> None:
        self.command = [program, scene, "--integrator", "path", "--size", size, "--threads", "1"]
        self.folder = folder

    def render(self, name: str, *words: str) -> dict:
        """Statistics of a run that writes NAME.exr and NAME.png."""
        return render(self.command, *words, picture=self.folder / name)

    def errors(self, name: str) -> dict:
        """RMSE, FLIP and bias against the reference."""
        files = [self.folder / f"{which}.exr" for which in (name, "reference")]
        measures = difference(*files)
        error = plots.flip(*(file.with_suffix(".png") for file in reversed(files)))[1]
        return {"rmse": measures["rmse"], "flip": error, "bias": measures["bias"]}

    def measured(self, seeds: int, *words: str) -> dict:
        """Processor seconds of rendering, samples a pixel and errors, over seeds: the root mean square of RMSE,
        the mean of the others."""
        found = []
        for seed in range(1, seeds + 1):
            stats = self.render("picture", "--seed", str(seed), *words)
            pixels = stats["width"] * stats["height"]
            found.append({"seconds": stats["seconds"]["processor"],
                          "samples": stats["spp"] - stats["skipped"]["spare_samples"] / pixels,
                          **self.errors("picture")})
        mean = {key: statistics.fmean(row[key] for row in found) for key in found[0]}
        return mean | {"rmse": math.sqrt(statistics.fmean(row["rmse"] ** 2 for row in found))}


def row(program: pathlib.Path, scene: pathlib.Path, given: dict) -> dict:
    """`given`: as USUAL."""
    with tempfile.TemporaryDirectory() as name:
        pictures = Pictures(program, scene, given["size"], pathlib.Path(name))
        pictures.render("reference", "--seed", "99", "--spp", str(given["reference"]))
        adaptive = pictures.measured(given["seeds"], "--spp", str(given["most"]), "--error", str(given["error"]))
        uniform = [pictures.measured(given["seeds"], "--spp", str(count)) for count in given["counts"]]
    found = {"table": "adaptive", "scene": str(scene.relative_to(ROOT)), **given, "uniform": uniform, "adaptive": adaptive}
    for measure in MEASURES:
        errors = [each[measure] for each in uniform]
        found[f"{measure}_samples"] = interpolated(errors, [each["samples"] for each in uniform], adaptive[measure])
        found[f"{measure}_ratio"] = adaptive["seconds"] / interpolated(
            errors, [each["seconds"] for each in uniform], adaptive[measure])
    return found
