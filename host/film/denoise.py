"""A denoised copy of a picture, to look at: PICTURE.exr becomes PICTURE.denoised.exr and PICTURE.denoised.png. The picture
itself, and all that is measured, stay as they are. By Open Image Denoise (Afra 2019 ff.), which PyPI's pyoidn brings along;
normals, and albedo where the picture has it (--channels Albedo), keep edges and textures sharp."""

import argparse
import pathlib
import sys

try:
    import numpy
    import OpenEXR
    import PIL.Image
    import pyoidn
except ModuleNotFoundError as missing:
    print(f"found no {missing.name} in this Python, expected it: `.ci/setup denoise` installs it into build/venv", file=sys.stderr)
    sys.exit(2)


class PictureError(Exception):
    """The picture cannot be used: one line."""


def read(path: pathlib.Path) -> tuple[dict, dict[str, numpy.ndarray]]:
    """The header and the channels: RGBA, and N and Albedo where they are."""
    try:
        with path.open("rb") as file:
            found = file.read(4)
        if found != b"v/1\1":
            raise PictureError(f"{path}: expected an OpenEXR file, found {found!r} at its beginning")
        with OpenEXR.File(str(path)) as file:
            header, channels = file.header(), {name: channel.pixels for name, channel in file.channels().items()}
    except OSError as error:
        raise PictureError(f"{path}: {error.strerror}") from error
    except RuntimeError as error:
        raise PictureError(f"{path}: expected a whole OpenEXR file, found: {error}".replace("\n", " ")) from error
    if "RGBA" not in channels:
        raise PictureError(f"{path}: expected the channels R, G, B and A, found {', '.join(channels)}")
    if all(f"N.{axis}" in channels for axis in "XYZ"):
        channels["N"] = numpy.stack([channels[f"N.{axis}"] for axis in "XYZ"], axis=-1)
    return header, {name: channels[name].astype(numpy.float32) for name in ("RGBA", "N", "Albedo") if name in channels}


def denoised(channels: dict[str, numpy.ndarray]) -> numpy.ndarray:
    """RGBA without noise; alpha stays."""
    guides = {"albedo": channels.get("Albedo"), "normal": channels.get("N")}
    if guides["albedo"] is None:  # the filter takes normals beside albedo alone
        guides = {}
    color = pyoidn.denoise(numpy.ascontiguousarray(channels["RGBA"][..., :3]), hdr=True, **guides)
    return numpy.concatenate([color, channels["RGBA"][..., 3:]], axis=-1)


def srgb(linear: numpy.ndarray) -> numpy.ndarray:
    """8-bit codes (IEC 61966-2-1)."""
    x = numpy.clip(linear, 0.0, 1.0)
    encoded = numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return numpy.rint(255.0 * encoded).astype(numpy.uint8)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="denoise", description=__doc__)
    parser.add_argument("picture", type=pathlib.Path, help="an EXR of ./render; with --channels Albedo textures stay sharp")
    parser.add_argument("--exposure", type=float, default=0.0, metavar="STOPS", help="of the PNG: +1 is twice as bright")
    options = parser.parse_args(arguments)
    try:
        header, channels = read(options.picture)
    except PictureError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    picture = denoised(channels)
    kept = {name: header[name] for name in ("dataWindow", "displayWindow", "compression", "type") if name in header}
    kept["software"] = f"{header.get('software', '')}, Open Image Denoise".lstrip(", ")
    target = options.picture.with_suffix(".denoised")
    OpenEXR.File(kept, {"RGBA": picture}).write(f"{target}.exr")
    PIL.Image.fromarray(srgb(picture[..., :3] * 2.0**options.exposure)).save(f"{target}.png")
    print(f"{target}.exr, {target}.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
