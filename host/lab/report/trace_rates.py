"""Rays per second of ./trace: nearest, any and all hits of rays from all around a scene, tables in and out included."""

import pathlib
import re
import subprocess
import tempfile

import numpy

from host.lab.report.rows import ROOT

HITS = ("nearest", "any", "all")


def positions_of(scene: pathlib.Path) -> numpy.ndarray:
    """The vertices of an OBJ file."""
    with open(scene, encoding="utf-8") as file:
        return numpy.array([line.split()[1:4] for line in file if line.startswith("v ")], float)


def rays_around(scene: pathlib.Path, count: int) -> numpy.ndarray:
    """From a sphere around the scene to points of its box: origins and directions, seeded."""
    numbers = numpy.random.default_rng(1)
    positions = positions_of(scene)
    low, high = positions.min(axis=0), positions.max(axis=0)
    middle, radius = (low + high) / 2, float(numpy.linalg.norm(high - low))
    towards = numbers.normal(size=(count, 3))
    origins = middle + radius * towards / numpy.linalg.norm(towards, axis=1, keepdims=True)
    targets = numbers.uniform(low, high, size=(count, 3))
    return numpy.hstack([origins, targets - origins]).astype(numpy.float32)


def rows(program: pathlib.Path, scene: str, count: int) -> list[dict]:
    """A row for each kind of question; the summary of ./trace says how long it took."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        rays, hits = pathlib.Path(folder) / "rays.npy", pathlib.Path(folder) / "hits.npy"
        numpy.save(rays, rays_around(ROOT / scene, count))
        for kind in HITS:
            said = subprocess.run([program, scene, rays, "-o", hits, "--hits", kind], cwd=ROOT, check=True,
                                  capture_output=True, text=True).stderr
            rate = re.search(r"([\d,]+) rays/s", said)
            answers = numpy.load(hits, mmap_mode="r")
            number = numpy.count_nonzero(answers["hit"]) if kind != "all" else len(answers)
            found.append({"table": "trace", "scene": scene, "kind": kind, "rays": count, "hits": int(number),
                          "rays_per_second": int(rate[1].replace(",", "")) if rate else 0})
    return found
