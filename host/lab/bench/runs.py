"""The benchmark's images and engines. Each run is an object for `lab pictures`."""

import pathlib

from host.lab.rows import ROOT

SCENES = ROOT / "scenes"
MADE = ROOT / "build" / "scenes"
PICTURES = "build/bench/pictures"

def _path(file: pathlib.Path) -> str:
    return str(file.relative_to(ROOT))


def variants(table: list[dict], quick: bool) -> list[dict]:
    """Returns runs of every variant on some scenes: by the reference model, and in small by the hardware for clocks."""
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


def engines(_: list[dict], quick: bool) -> list[dict]:
    """Returns timed runs of the renderer's own engines and units."""
    scenes = [SCENES / "cornell.obj", SCENES / "paper.obj", SCENES / "teapot.obj",
              MADE / "sphere.obj", MADE / "sphereflake.obj"]
    size = {"width": 96, "height": 72} if quick else {"width": 320, "height": 200}
    return [{"scene": _path(scene), **size, "variant": variant, "engine": engine,
             "repeats": 3 if engine == "rtl" else 5 if quick else 9}
            for scene in (scenes[:3] if quick else scenes)
            for variant in ("binary32", "serial") for engine in ("cpu", "rtl")]


def lanes(_: list[dict], quick: bool) -> list[dict]:
    """Returns runs of the paper's frame, with shadows and 4 bounces, on 1 to 8 lanes and on the paper's unit."""
    frame = {"scene": _path(SCENES / "paper.obj"), "width": 320, "height": 200,
             "integrator": "whitted", "engine": "rtl", "repeats": 1 if quick else 3}
    return [{**frame, "lanes": count} for count in (1, 2, 4, 8)] + [{**frame, "variant": "serial"}]


# The runs of each section, in the order of the report.
SECTIONS = {"variants": variants, "engines": engines, "lanes": lanes}
