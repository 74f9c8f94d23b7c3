"""Renders with Mitsuba on request: `python3 -m host.lab.peers.mitsuba_worker FOLDER VARIANT THREADS`.

Reads a line for each image from standard input, a JSON object of `sampler`, `samples`, `seed` and optionally `picture` (a file for its
pixels, in numpy's format). Prints one object for each: the seconds of mitsuba.render alone, its processor seconds, and the number of
samples that the sampler used instead of `samples`.
"""

import json
import os
import pathlib
import sys
import time

import drjit
import mitsuba
import numpy

# Debian 12 has several versions of libLLVM. Version 14 is too old for Dr.Jit, and 15 fails on some kernels.
LLVM = "libLLVM.so.19*"


def find_llvm() -> None:
    """Sets the path of LLVM for Dr.Jit, unless the user has set it."""
    found = sorted(pathlib.Path("/usr/lib").glob(f"*/{LLVM}"))
    if found:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(found[-1]))


def realised(value: object, folder: pathlib.Path) -> object:
    """Converts JSON values to values for mitsuba.load_dict."""
    if not isinstance(value, dict):
        return value
    made = {key: realised(part, folder) for key, part in value.items()}
    if "look_at" in made:
        made["to_world"] = mitsuba.ScalarTransform4f().look_at(**made.pop("look_at"))
    if made.get("type") == "ply":
        made["filename"] = str(folder / made["filename"])
    return made


def render(scene: object, sampler: str, samples: int, seed: int, picture: str = "") -> dict:
    """Renders one image."""
    names = [sensor.id() for sensor in scene.sensors()]
    sensor = scene.sensors()[names.index(f"camera_{sampler}")]
    wall, busy = time.perf_counter(), time.process_time()
    image = mitsuba.render(scene, sensor=sensor, spp=samples, seed=seed)
    drjit.eval(image)
    drjit.sync_thread()
    answer = {"seconds": time.perf_counter() - wall, "processor_seconds": time.process_time() - busy,
              "samples": sensor.sampler().sample_count()}
    if picture:
        numpy.save(picture, numpy.array(image))
    return answer


def main() -> None:
    """Serves requests until the end of standard input."""
    folder, variant, threads = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
    find_llvm()
    mitsuba.set_variant(variant)
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    drjit.set_thread_count(threads)
    scene = mitsuba.load_dict(realised(json.loads((folder / "mitsuba.json").read_text()), folder))
    for line in sys.stdin:
        print(json.dumps(render(scene, **json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
