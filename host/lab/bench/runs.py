"""The matrix: which pictures are rendered, by whom. Each run is an object for `lab pictures`."""

import pathlib

from host.lab.machine import processors
from host.lab.rows import ROOT

SCENES = ROOT / "scenes"
MADE = ROOT / "build" / "scenes"
PICTURES = "build/bench/pictures"

# Numbers of triangles: 20 * 4**fineness, see scenes/make_sphere.py.
FINENESS = {False: range(1, 9), True: range(1, 7)}


def sphere(fineness: int) -> pathlib.Path:
    """Where the sphere of 20 * 4**fineness triangles is made."""
    return ROOT / "build" / "bench" / "scenes" / f"sphere-{fineness}.obj"


def _path(file: pathlib.Path) -> str:
    return str(file.relative_to(ROOT))


def variants(table: list[dict], quick: bool) -> list[dict]:
    """Every variant on some scenes, by its reference model, and by its hardware in small for the
    clocks."""
    width, height = (160, 120) if quick else (320, 240)
    lights = {"cornell": {"integrator": "path", "samples": 1 if quick else 4},
              "paper": {"integrator": "whitted"}, "teapot": {"integrator": "primary"}}
    rows = []
    for name, light in lights.items():
        scene = _path(SCENES / f"{name}.obj")
        rows += [{"scene": scene, "width": width, "height": height, **light, "audit": True,
                  "variant": variant["variant"], "engine": "model",
                  "picture": f"{PICTURES}/{name}-{variant['variant']}",
                  "against": f"{PICTURES}/{name}-binary32"} for variant in table]
    scene = _path(SCENES / "cornell.obj")
    return rows + [{"scene": scene, "width": 64 if quick else 160, "height": 48 if quick else 120,
                    "variant": variant["variant"], "engine": "unit"}
                   for variant in table if variant["hardware"]]


def points(table: list[dict], quick: bool) -> list[dict]:
    """P of fewer digits in the picture: guarded by --point-error, as the unit has it, and exact."""
    size = {"width": 80 if quick else 320, "height": 60 if quick else 240, "integrator": "whitted",
            "engine": "model"}
    formats = [variant["variant"] for variant in table if variant["doubts"]
               and variant["unit"] == "pipeline" and not variant["fused"]]
    rows = []
    for name in ("cornell", "paper"):
        run = {"scene": _path(SCENES / f"{name}.obj"), **size}
        exact = f"{PICTURES}/points-{name}-exact"
        rows += [{**run, "variant": "binary32", "point_error": 0.0, "picture": exact}]
        rows += [{**run, "variant": variant, **error, "against": exact,
                  "picture": f"{PICTURES}/points-{name}-{variant}-{word}"}
                 for variant in formats
                 for word, error in (("guarded", {}), ("unguarded", {"point_error": -1.0}))]
    return rows


def samples(_: list[dict], quick: bool) -> list[dict]:
    """Path tracing with more and more samples; the last, with other random numbers, is the truth."""
    side = 32 if quick else 128
    run = {"scene": _path(SCENES / "cornell.obj"), "width": side, "height": side,
           "integrator": "path"}
    counts = [1, 2, 4, 8] if quick else [1, 2, 4, 8, 16, 32, 64]
    reference = f"{PICTURES}/samples-reference"
    return [*({**run, "samples": count, "picture": f"{PICTURES}/samples-{count}",
               "against": reference} for count in counts),
            {**run, "samples": 16 * counts[-1], "seed": 1, "picture": reference}]


def engines(_: list[dict], quick: bool) -> list[dict]:
    """The renderer's own engines and units, timed."""
    scenes = [SCENES / "cornell.obj", SCENES / "paper.obj", SCENES / "teapot.obj",
              MADE / "sphere.obj", MADE / "sphereflake.obj"]
    size = {"width": 96, "height": 72} if quick else {"width": 320, "height": 200}
    return [{"scene": _path(scene), **size, "variant": variant, "engine": engine,
             "repeats": 3 if engine == "rtl" else 5 if quick else 9}
            for scene in (scenes[:3] if quick else scenes)
            for variant in ("binary32", "serial") for engine in ("cpu", "rtl")]


def lanes(_: list[dict], quick: bool) -> list[dict]:
    """The paper's frame, with shadows and 4 bounces, by 1 to 8 lanes and by the paper's own unit."""
    frame = {"scene": _path(SCENES / "paper.obj"), "width": 320, "height": 200,
             "integrator": "whitted", "engine": "rtl", "repeats": 1 if quick else 3}
    return [{**frame, "lanes": count} for count in (1, 2, 4, 8)] + [{**frame, "variant": "serial"}]


def triangles(_: list[dict], quick: bool) -> list[dict]:
    """A sphere, finer and finer."""
    size = {"width": 160, "height": 120} if quick else {"width": 320, "height": 240}
    return [{"scene": _path(sphere(fineness)), **size, "repeats": 5 if quick else 9}
            for fineness in FINENESS[quick]]


def sizes(_: list[dict], quick: bool) -> list[dict]:
    """One scene, larger and larger."""
    scene = SCENES / "teapot.obj" if quick else MADE / "sphere.obj"
    return [{"scene": _path(scene), "width": 80 * factor, "height": 60 * factor,
             "repeats": 5 if quick else 9} for factor in ((1, 2, 4, 8) if quick else (1, 2, 4, 8, 16))]


def threads(_: list[dict], quick: bool) -> list[dict]:
    """One picture, by 1 thread up to as many as there are processors."""
    scene = SCENES / "teapot.obj" if quick else MADE / "sphere.obj"
    counts = [count for count in (1, 2, 4, 8, 16, 32, 64) if count <= processors()]
    return [{"scene": _path(scene), "width": 640, "height": 480, "threads": count,
             "repeats": 5 if quick else 9} for count in counts]


# Section -> its runs. The order is the report's.
SECTIONS = {"variants": variants, "points": points, "samples": samples, "engines": engines, "lanes": lanes,
            "triangles": triangles, "sizes": sizes, "threads": threads}
