"""How far a picture is from its reference: what `compare` measures, and FLIP, whose maps show where.

FLIP: Andersson et al., "FLIP: a difference evaluator for alternating images", 2020, its authors'
own implementation (PyPI flip-evaluator), at its default of 67 pixels a degree.
"""

import json
import pathlib
import subprocess

import flip_evaluator
import numpy as np
from matplotlib import image


def _shown(stem: pathlib.Path) -> np.ndarray:
    """The 8-bit picture, from 0 to 1."""
    return np.asarray(image.imread(f"{stem}.png"), dtype=np.float32)[..., :3]


def errors(program: pathlib.Path, reference: pathlib.Path, test: pathlib.Path,
           flip_map: pathlib.Path) -> dict:
    """The errors of TEST.exr and TEST.png against REFERENCE's; writes FLIP's map to `flip_map`.

    rmse, psnr, ssim, differing, ...: as `compare` (build/compare, here `program`) measures
    scene-linear R, G and B; psnr is None for equal pictures. flip: mean over the pixels, 0 to 1.
    """
    done = subprocess.run([program, f"{test}.exr", f"{reference}.exr", "--json"],
                          stdout=subprocess.PIPE, text=True, check=True)
    error_map, flip, _ = flip_evaluator.evaluate(_shown(reference), _shown(test), "LDR")
    image.imsave(flip_map, np.clip(error_map, 0, 1))
    return {**json.loads(done.stdout), "flip": float(flip)}
