"""`make speed`: rays per second, exact decisions, skips; profile and phases of rendering; rates of ./trace."""

import argparse
import collections
import pathlib
import re
import subprocess
import sysconfig
import tempfile

import numpy

from host.lab.rows import ROOT, grouped, of
from host.lab.steps import Step, difference, render

SMALL = ("scenes/cornell.obj", "scenes/teapot.obj")
LARGE = ("build/scenes/sphere.obj", "build/scenes/sphereflake.obj", "build/scenes/landscape.obj")
PHASES = ("load", "tree", "render", "write", "total")
# Options of ./trace, by their names in the report.
HITS = {"nearest": (), "any": (), "all": (),
        "nearest, with u, v, the unit's P and its error": ("--columns", "ray,triangle,t,uv,unit-point,unit-error")}
# Values of `--no-skip`, except divisions, which the pipelined unit does not have.
SKIPS = ("culling", "records", "light-behind", "weightless", "empty-tiles", "first-occluder")
# Without culling every ray is tested against every polygon. Images with more tests than this take too long.
MOST_TESTS = 3e8

# Functions in which each part begins, as named by callgrind. All else is shading: generating rays, materials, lights,
# sampling, the film.
WHOLE = r"raygate::TileRenderer::trace\("
PARTS_OF_A_PICTURE = {"hit_tests": r"raygate::CpuIntersector::intersect\(", "doubts": r"raygate::resolve_doubt\(",
         "departures": r"raygate::RaySpawner::"}


def calls(profile: str) -> collections.Counter:
    """Returns (caller, callee) -> instructions in the callee and its callees, from a callgrind file."""
    names: dict[str, str] = {}
    found: collections.Counter = collections.Counter()
    caller = callee = ""
    is_call = False
    for line in profile.splitlines():
        if is_call:
            found[caller, callee] += int(line.split()[1])
            is_call = False
        elif match := re.match(r"(c?)fn=(\(\d+\))(?: (.*))?", line):
            name = names.setdefault(match[2], match[3] or "")
            caller, callee = (caller, name) if match[1] else (name, callee)
        is_call = is_call or line.startswith("calls=")
    return found


def inside(found: collections.Counter, part: str) -> int:
    """Returns the instructions of a part: those of its functions called from other parts."""
    return sum(count for (caller, callee), count in found.items()
               if re.match(part, callee) and not re.match(part, caller))



def skips(program: pathlib.Path, scene: str, repeats: int) -> list[dict]:
    """Returns rows for the image with all skips, with the simulated unit, and without each skip. All images must be
    equal."""
    ways = {"all skips": (), "the simulated unit": ("--engine", "rtl"),
            **{f"without {skip}": ("--no-skip", skip) for skip in SKIPS}}
    found: list[dict] = []
    with tempfile.TemporaryDirectory() as name:
        for what, words in ways.items():
            if what == "without culling" and found[0]["every_test"] > MOST_TESTS:
                continue
            picture = pathlib.Path(name) / f"{what}.exr"
            runs = [render([program, scene], "--threads", "1", "--integrator", "whitted", "--spp", "1", "--size", "320x200",
                           *words, picture=picture) for _ in range(repeats)]
            stats, seconds = runs[0], min(run["seconds"]["processor"] for run in runs)
            same = difference(picture, pathlib.Path(name) / "all skips.exr")["differing"] == 0
            found.append({"table": "skips", "scene": pathlib.Path(scene).stem, "polygons": stats["triangles"], "what": what,
                          "rays": stats["rays"], "tests": stats["tests"], "records": stats["records"] + stats["common_records"],
                          "milliseconds": 1000 * seconds, "picture": "same" if same else "ANOTHER"})
            # As in the paper: every ray against every polygon.
            found[-1]["every_test"] = found[0]["rays"] * stats["triangles"]
            found[-1]["times_fewer_tests"] = found[-1]["every_test"] / stats["tests"]
            found[-1]["time_over_all_skips"] = found[-1]["milliseconds"] / found[0]["milliseconds"]
    return found


def profile(program: pathlib.Path, scene: str, size: str) -> dict:
    """Returns the percentage of instructions by part of a path-traced image; deterministic."""
    with tempfile.TemporaryDirectory() as name:
        file = pathlib.Path(name) / "profile"
        counts = render(["valgrind", "--quiet", "--tool=callgrind", f"--callgrind-out-file={file}", program, scene],
                        "--threads", "1", "--integrator", "path", "--size", size, "--spp", "4")
        found = calls(file.read_text())
    whole = inside(found, WHOLE)
    shares = {part: 100 * inside(found, names) / whole for part, names in PARTS_OF_A_PICTURE.items()}
    return {"table": "profile", "scene": scene, "triangles": counts["triangles"], "rays": counts["rays"],
            "edge_doubts_percent": 100 * counts["edge_doubts"] / max(counts["tests"], 1),
            "instructions_per_ray": whole / max(counts["rays"], 1), **shares,
            "shading": 100 - shares["hit_tests"] - shares["departures"]}


def phases(programs: list[pathlib.Path], scene: str, size: str, repeats: int) -> list[dict]:
    """Returns a row for each program: the least seconds of each phase of an image over interleaved repeats."""
    runs = [[render([program, scene], "--integrator", "whitted", "--spp", "1", "--size", size)
             for program in programs] for _ in range(repeats)]
    return [{"table": "phase_times", "scene": scene, "program": number, "triangles": mine[0]["triangles"],
             "seconds": {phase: min(run["seconds"][phase] for run in mine) for phase in PHASES}}
            for number, mine in enumerate(zip(*runs, strict=True))]


def positions_of(scene: pathlib.Path) -> numpy.ndarray:
    """Returns the vertices of an OBJ file."""
    with open(scene, encoding="utf-8") as file:
        return numpy.array([line.split()[1:4] for line in file if line.startswith("v ")], float)


def rays_around(scene: pathlib.Path, count: int) -> numpy.ndarray:
    """Returns origins on a sphere around the scene and directions to points of its box, seeded."""
    numbers = numpy.random.default_rng(1)
    positions = positions_of(scene)
    low, high = positions.min(axis=0), positions.max(axis=0)
    middle, radius = (low + high) / 2, float(numpy.linalg.norm(high - low))
    towards = numbers.normal(size=(count, 3))
    origins = middle + radius * towards / numpy.linalg.norm(towards, axis=1, keepdims=True)
    targets = numbers.uniform(low, high, size=(count, 3))
    return numpy.hstack([origins, targets - origins]).astype(numpy.float32)


def trace_rates(program: pathlib.Path, scene: str, count: int) -> list[dict]:
    """Returns a row for each kind of query: rates from the summary of ./trace, including reading and writing tables."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        rays, hits = pathlib.Path(folder) / "rays.csv", pathlib.Path(folder) / "hits.csv"
        numpy.savetxt(rays, rays_around(ROOT / scene, count), fmt="%.9g", delimiter=",")
        for kind, columns in HITS.items():
            command = [program, scene, rays, "-o", hits, "--hits", kind.split(",")[0], *columns]
            said = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stderr
            rate = re.search(r"([\d,]+) rays/s", said)
            column = "hit" if kind == "any" else "triangle"
            with hits.open() as file:
                at = file.readline().strip().split(",").index(column)
                number = sum(int(line.split(",")[at]) > (0 if kind == "any" else -1) for line in file)
            found.append({"table": "trace", "scene": scene, "kind": kind, "rays": count, "hits": number,
                          "rays_per_second": int(rate[1].replace(",", "")) if rate else 0})
    return found


def embree4() -> list[pathlib.Path]:
    """Returns the library of Embree 4, from embreex of PyPI, if installed."""
    return sorted(pathlib.Path(sysconfig.get_path("platlib")).glob("embreex.libs/libembree4*"))[:1]


def rays_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that measure rays per second, compared with Embree."""
    scenes = SMALL[:1] if given.quick else (*SMALL, "scenes/paper.obj", *LARGE)
    words = ("--size", 128, "--repeats", 1) if given.quick else ()
    for library in embree4():
        words += ("--embree4", library)
    return [Step("rays", scene, ("rays", scene, *words)) for scene in scenes]


def predicates_steps(_: argparse.Namespace) -> list[Step]:
    """Returns the step that measures the cost of an exact decision."""
    return [Step("predicates", "exact decisions", ("predicates",))]


def skips_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that measure the savings of each skip."""
    scenes = ("scenes/cornell.obj",) if given.quick else \
        ("scenes/paper.obj", "build/scenes/teapot_coarse.obj", "scenes/teapot.obj", *LARGE[:2])
    return [Step("skips", scene, measure=lambda scene=scene: skips(given.render, scene, 1 if given.quick else 3))
            for scene in scenes]


def profile_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that profile rendering."""
    gallery = sorted(str(file.relative_to(ROOT)) for file in (ROOT / "scenes").glob("*_*.json"))
    scenes = SMALL[:1] if given.quick else (*SMALL, *gallery, "scenes/columns.json", "scenes/sphereflake.json", LARGE[2])
    size = "32x24" if given.quick else "128x96"
    return [Step("profile", scene, measure=lambda scene=scene: [profile(given.render, scene, size)]) for scene in scenes]


def phases_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that time each phase of rendering."""
    programs = [given.render] + ([given.before.resolve()] if given.before else [])
    size, repeats = ("64x48", 2) if given.quick else ("640x480", 9)
    return [Step("phases", scene, measure=lambda scene=scene: phases(programs, scene, size, repeats))
            for scene in (SMALL[:1] if given.quick else (*SMALL, *LARGE[1:]))]


def trace_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that measure the rays per second of ./trace."""
    count = 10_000 if given.quick else 1_000_000
    return [Step("trace", scene, measure=lambda scene=scene: trace_rates(ROOT / "trace", scene, count))
            for scene in (SMALL[:1] if given.quick else (*SMALL, *LARGE))]


PARTS = {"rays": rays_steps, "predicates": predicates_steps, "skips": skips_steps, "profile": profile_steps,
         "phases": phases_steps, "trace": trace_steps}


def over_best(row: dict) -> dict:
    """Returns raygate's rays per second relative to Embree's fastest mode and fastest robust mode, over all versions."""
    ours = row["at"]["raygate"]
    found = {**row, "mrays": ours["mrays_per_second"]}
    for kind, is_robust in (("fast", False), ("robust", True)):
        modes = [peer for name, peer in row["at"].items() if name != "raygate" and name.endswith(" robust") == is_robust]
        best = max(modes, key=lambda peer: peer["mrays_per_second"], default=None)
        ratio = ours["mrays_per_second"] / best["mrays_per_second"] if best else None
        spread = ratio * (ours["spread_percent"] + best["spread_percent"]) / 100 if best else None
        found |= {kind: f"{ratio:.2f} ± {spread:.2f}" if best else None, f"{kind}_mode": best and best["by"].removesuffix(" robust")}
    return found


def values(rows: list[dict], _: pathlib.Path) -> dict:
    """Returns rays compared with Embree's best modes, the skips by scene, and the phase times of two programs."""
    rays, skips = of(rows, "rays"), of(rows, "skips")
    return {"over_best": [over_best(row) for row in grouped(rays, ("scene", "rays"), "by")],
            "skips_of_two": [row for row in skips if row["scene"] in (skips[0]["scene"], skips[-1]["scene"])],
            "phases": PHASES, "phase_times": grouped(of(rows, "phase_times"), ("scene",), "program")}


def failures(rows: list[dict]) -> list[str]:
    """Returns methods whose exact decisions are wrong, and skips that change the image."""
    return [f"{row['suite']}: exact decisions are {row['raygate']}" for row in of(rows, "predicates")
            if row["raygate"] != "right"] + \
        [f"{row['scene']}: {row['what']}: {row['picture']} picture" for row in of(rows, "skips")
         if row["picture"] != "same"]
