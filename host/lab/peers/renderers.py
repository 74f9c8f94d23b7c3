"""Common interface of the renderers: raygate's program and Mitsuba's worker."""

import json
import pathlib
import subprocess
import sys
import tempfile

import mitsuba
import numpy

from host.lab.peers.convert import DEPTH
from host.lab.rows import ROOT
from host.lab.steps import render

mitsuba.set_variant("scalar_rgb")  # for reading EXR files


def light_of(picture: mitsuba.Bitmap) -> numpy.ndarray:
    """Returns red, green and blue, in any order of channels."""
    names = [field.name for field in picture.struct_()]
    return numpy.array(picture)[..., [names.index(channel) for channel in "RGB"]]


class Raygate:
    """The program ./render with the cpu engine."""

    name = "raygate"
    most_samples = 1024  # per pixel, with --error

    def __init__(self, folder: pathlib.Path, threads: int, program: pathlib.Path) -> None:
        self._command = [program, folder / "scene.json", "--integrator", "path", "--filter", "box", "--depth", str(DEPTH),
                         "--threads", str(threads)]

    def render(self, sampler: str, samples: int, seed: int, width: int, height: int) -> tuple[dict, numpy.ndarray]:
        """Returns the timing and the image. `sampler` may hold options of ./render, which has only one sampler."""
        options = sampler.split() if sampler.startswith("--") else []
        samples = self.most_samples if "--error" in options else samples
        with tempfile.TemporaryDirectory() as name:
            picture = pathlib.Path(name) / "picture.exr"
            found = render(self._command, *options, "--size", f"{width}x{height}", "--spp", str(samples), "--seed", str(seed),
                           picture=picture)
            pixels = light_of(mitsuba.Bitmap(str(picture)))
        seconds = found["seconds"]
        return {"seconds": seconds["render"], "processor_seconds": seconds.get("processor", seconds["render"]),
                "samples": samples}, pixels

    def close(self) -> None:
        """Does nothing, as no process is left running."""


class Mitsuba:
    """A worker process, which loads the scene once and warms up for each new kind of image."""

    def __init__(self, folder: pathlib.Path, threads: int, variant: str) -> None:
        self.name = f"Mitsuba {variant}"
        self._warm: set[tuple] = set()
        self._process = subprocess.Popen(
            [sys.executable, "-B", "-m", "host.lab.peers.mitsuba_worker", folder, variant, str(threads)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT)

    def _ask(self, **asked: object) -> dict:
        self._process.stdin.write(json.dumps(asked) + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        if not answer:
            raise ValueError(f"{self.name} ended, expected a picture")
        return json.loads(answer)

    def render(self, sampler: str, samples: int, seed: int, width: int, height: int) -> tuple[dict, numpy.ndarray]:
        """Returns the timing and the image."""
        asked = {"sampler": sampler, "samples": samples, "width": width, "height": height}
        # With LLVM, each kind needs its own kernel; otherwise one small image is enough for warming up.
        kind = tuple(asked.values()) if "llvm" in self.name else (width, height)
        if kind not in self._warm:
            self._ask(**asked | ({} if "llvm" in self.name else {"samples": 1}), seed=seed + 1)
            self._warm.add(kind)
        with tempfile.NamedTemporaryFile(suffix=".npy") as picture:
            row = self._ask(**asked, seed=seed, picture=picture.name)
            return row, numpy.load(picture.name)

    def close(self) -> None:
        """Ends the process."""
        self._process.stdin.close()
        self._process.wait()
