"""Renders with Mitsuba on request: `python3 -m host.lab.peers.mitsuba_worker FOLDER VARIANT THREADS`.

Reads a line for each image from standard input, a JSON object of `sampler`, `samples`, `seed`, `width`, `height` and
optionally `picture` (a file for its pixels, in numpy's format). Answers with one: the seconds of mitsuba.render alone,
its processor seconds, and the number of samples that the sampler used for `samples`.
"""

import json
import os
import pathlib
import sys
import time

import drjit
import mitsuba
import numpy

# This version of Debian 12's libLLVM works; 14 is too old for Dr.Jit, and 15 fails on some kernels.
LLVM = "libLLVM.so.19*"


def find_llvm() -> None:
    """Sets the path of LLVM for Dr.Jit, unless the user has set it."""
    found = sorted(pathlib.Path("/usr/lib").glob(f"*/{LLVM}"))
    if found:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(found[-1]))


def realised(value: object, folder: pathlib.Path) -> object:
    """Converts JSON values to those of mitsuba.load_dict."""
    if not isinstance(value, dict):
        return value
    made = {key: realised(part, folder) for key, part in value.items()}
    if "look_at" in made:
        made["to_world"] = mitsuba.ScalarTransform4f().look_at(**made.pop("look_at"))
    if made.get("type") == "ply":
        made["filename"] = str(folder / made["filename"])
    if made.get("type") == "bitmap":
        picture = mitsuba.Bitmap(str(folder / made.pop("filename"))).convert(
            mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, srgb_gamma=False)
        made |= {"bitmap": mitsuba.Bitmap(numpy.array(picture) * numpy.float32(made.pop("times"))), "raw": True}
    return made


class Worker:
    """A loaded scene."""

    def __init__(self, folder: pathlib.Path, threads: int) -> None:
        drjit.set_thread_count(threads)
        self._text = (folder / "mitsuba.json").read_text()
        self._folder = folder
        self._scenes: dict = {}

    def _scene(self, width: int, height: int) -> object:
        if (width, height) not in self._scenes:
            asked = json.loads(self._text)
            for part in asked.values():
                if isinstance(part, dict) and "film" in part:
                    part["film"] |= {"width": width, "height": height}
            self._scenes = {(width, height): mitsuba.load_dict(realised(asked, self._folder))}
        return self._scenes[width, height]

    def render(self, sampler: str, samples: int, seed: int, width: int, height: int, picture: str = "") -> dict:
        """Renders one image."""
        scene = self._scene(width, height)
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
    worker = Worker(folder, threads)
    for line in sys.stdin:
        print(json.dumps(worker.render(**json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
