"""The matrix: which pictures are rendered, by whom. Each run is an object for build/picture_bench."""

import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCENES = ROOT / "scenes"
MADE = ROOT / "build" / "scenes"

# Section -> what its rows are compared by. The order is the report's.
SECTIONS = {
    "variants": "arithmetic: errors of decisions, of P and of the picture",
    "samples": "samples of a pixel",
    "engines": "the engines and units",
    "lanes": "lanes of the pipelined unit",
    "triangles": "number of triangles",
    "sizes": "picture size",
    "threads": "threads",
}

# Numbers of triangles: 20 * 4**fineness, see scenes/make_sphere.py.
FINENESS = {False: range(1, 9), True: range(1, 7)}


def sphere(fineness: int) -> pathlib.Path:
    """Where the sphere of 20 * 4**fineness triangles is made."""
    return ROOT / "build" / "bench" / "scenes" / f"sphere-{fineness}.obj"


def _path(file: pathlib.Path) -> str:
    return str(file.relative_to(ROOT))


def variants(table: list[dict], quick: bool) -> list[dict]:
    """Every variant on some scenes, by its twin, and by its hardware in small for the clocks."""
    width, height = (160, 120) if quick else (320, 240)
    lights = {"cornell": {"integrator": "path", "samples": 1 if quick else 4},
              "paper": {"integrator": "whitted"}, "teapot": {"integrator": "primary"}}
    rows = []
    for name, light in lights.items():
        scene = SCENES / f"{name}.obj"
        for variant in table:
            picture = f"build/bench/pictures/{name}-{variant['name']}"
            rows.append({"scene": _path(scene), "width": width, "height": height, **light,
                         "variant": variant["name"], "audit": True, "picture": picture,
                         "engine": "twin"})
            if variant["hardware"] and name == "cornell":
                rows.append({"scene": _path(scene), "width": 64 if quick else 160,
                             "height": 48 if quick else 120, "variant": variant["name"],
                             "engine": "unit"})
    return rows


def samples(_: list[dict], quick: bool) -> list[dict]:
    """Path tracing with more and more samples; the last, with other random numbers, is the truth."""
    side = 32 if quick else 128
    run = {"scene": _path(SCENES / "cornell.obj"), "width": side, "height": side,
           "integrator": "path"}
    counts = [1, 2, 4, 8] if quick else [1, 2, 4, 8, 16, 32, 64]
    return [{**run, "samples": count, "picture": f"build/bench/pictures/samples-{count}"}
            for count in counts] + [
                {**run, "samples": 16 * counts[-1], "seed": 1,
                 "picture": "build/bench/pictures/samples-reference"}]


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


def threads(_: list[dict], quick: bool, processors: int) -> list[dict]:
    """One picture, by 1 thread up to twice as many as there are processors."""
    scene = SCENES / "teapot.obj" if quick else MADE / "sphere.obj"
    counts = [count for count in (1, 2, 4, 8, 16, 32, 64) if count <= 2 * processors]
    return [{"scene": _path(scene), "width": 640, "height": 480, "threads": count,
             "repeats": 5 if quick else 9} for count in counts]
