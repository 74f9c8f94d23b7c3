"""The denoised copy of a picture: nearer to what the noise hides, the picture untouched, bad input one line."""

import contextlib
import io
import pathlib
import tempfile
import unittest

import numpy
import OpenEXR
import PIL.Image

from host.film import denoise

SIZE = 64


class Denoise(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "noisy.exr"
        # Two walls that meet in the middle, lit from one side.
        x = numpy.linspace(0.0, 1.0, SIZE, dtype=numpy.float32)
        self.clean = numpy.repeat((0.2 + 0.6 * x)[None, :, None], SIZE, axis=0).repeat(3, axis=2)
        self.clean[:, SIZE // 2 :] *= 0.5
        random = numpy.random.default_rng(1)
        noisy = self.clean * random.exponential(size=self.clean.shape).astype(numpy.float32)
        alpha = numpy.ones((SIZE, SIZE, 1), dtype=numpy.float32)
        self.channels = {"RGBA": numpy.concatenate([noisy, alpha], axis=-1)}

    def write(self) -> None:
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, self.channels).write(str(self.path))

    def error_of(self, path: pathlib.Path) -> float:
        with OpenEXR.File(str(path)) as file:
            return float(numpy.mean((file.channels()["RGBA"].pixels[..., :3] - self.clean) ** 2))

    def run_it(self, *arguments: str) -> tuple[int, str]:
        errors = io.StringIO()
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(errors):
            return denoise.main(list(arguments)), errors.getvalue()

    def test_denoised_copy_has_less_noise(self) -> None:
        self.write()
        before = self.path.read_bytes()
        self.assertEqual(self.run_it(str(self.path)), (0, ""))
        self.assertEqual(self.path.read_bytes(), before)
        copy = self.path.with_suffix(".denoised.exr")
        self.assertLess(self.error_of(copy), 0.05 * self.error_of(self.path))
        with OpenEXR.File(str(copy)) as file:
            self.assertIn("Open Image Denoise", file.header()["software"])
            self.assertEqual(file.channels()["RGBA"].pixels[..., 3].min(), 1.0)
        with PIL.Image.open(self.path.with_suffix(".denoised.png")) as png:
            self.assertEqual(png.size, (SIZE, SIZE))

    def test_albedo_keeps_edges_sharp(self) -> None:
        self.write()
        self.run_it(str(self.path))
        plain = self.error_of(self.path.with_suffix(".denoised.exr"))
        albedo = numpy.full((SIZE, SIZE, 3), 0.8, dtype=numpy.float32)
        albedo[:, SIZE // 2 :] = 0.4
        self.channels["Albedo"] = albedo
        self.channels |= {f"N.{axis}": numpy.full((SIZE, SIZE), float(axis == "Z"), dtype=numpy.float32) for axis in "XYZ"}
        self.write()
        self.run_it(str(self.path))
        self.assertLess(self.error_of(self.path.with_suffix(".denoised.exr")), plain)

    def test_bad_pictures_are_one_line(self) -> None:
        text = self.path.with_name("text.exr")
        text.write_text("no picture")
        self.channels = {"Z": numpy.zeros((4, 4), dtype=numpy.float32)}
        self.write()
        for path in (text, self.path, self.path.with_name("none.exr")):
            status, errors = self.run_it(str(path))
            self.assertEqual((status, errors.count("\n")), (2, 1), errors)
            self.assertIn(path.name, errors)


if __name__ == "__main__":
    unittest.main()
