"""The model of ranks: its parts where they are known, and its numbers as host/render has them."""

import pathlib
import tempfile
import unittest

from host.lab.report import document
from host.lab.targets import scaling
from host.lab.rows import ROOT

COSTS = scaling.Costs(scene=2.0, scene_bytes=10**9, pixel=0.0, sample=1e-6, gather_byte=1e-9, slice_bytes=136)


def rows() -> list[dict]:
    """As a machine would measure that has these costs."""
    found = []
    for ranks in (*scaling.RANKS, *scaling.MORE_RANKS):
        for samples in scaling.SAMPLES if ranks in scaling.RANKS else scaling.SAMPLES[:1]:
            came = 10**6 if ranks > 1 else 0
            found.append({"table": "scaling", "scene": "a.obj", "ranks": ranks, "samples": samples, "width": 100, "height": 100, "pixels": 10**4,
                          "scene_bytes": 10**9, "gathered_bytes": came, "gathered_tiles": came // 10**5, "bytes": str(samples),
                          "seconds": {"load": 0.5, "tree": 1.5, "processor": 1e-2 * samples, "gather": 1e-9 * came}})
    return found


class Scaling(unittest.TestCase):
    def test_fits_what_it_was_made_of(self) -> None:
        costs = scaling.fit(rows(), "a.obj")
        for name, value in vars(COSTS).items():
            self.assertAlmostEqual(getattr(costs, name) / (value or 1.0), 1.0 if value else 0.0, places=6, msg=name)

    def test_parts_of_one_rank_and_of_many(self) -> None:
        picture = scaling.Picture(COSTS, pixels=4096 * 2560, samples=1000, threads=1)
        one, ten = scaling.predict(picture, 1), scaling.predict(picture, 10)
        self.assertAlmostEqual(one.compute, 4096 * 2560 * 1e-3)
        self.assertAlmostEqual(one.compute / ten.compute, 10.0)
        self.assertEqual((one.scene, one.gather, one.end), (2.0, 0.0, 0.0))
        self.assertAlmostEqual(ten.scene, 2.0 + 9 / 5)
        fixed = scaling.predict(picture, 10**6, small_tiles=False)
        self.assertAlmostEqual(fixed.compute, one.compute / 2560)  # as many as there are tiles

    def test_numbers_are_those_of_the_program(self) -> None:
        workers = (ROOT / "host/render/remote_workers.cpp").read_text()
        tiles = (ROOT / "host/render/tiles.h").read_text()
        self.assertIn(f"kSeconds = {scaling.JOB_SECONDS};", workers)
        self.assertIn(f"kRate = {scaling.RATE / 1e6:.0f}e6;", workers)
        self.assertIn(f": {scaling.EDGE};", tiles)
        self.assertIn(f"edge > {scaling.LEAST_EDGE} ", tiles)

    def test_a_byte_that_differs_is_no_report(self) -> None:
        wrong = rows()
        wrong[-1]["bytes"] = "other"
        with tempfile.TemporaryDirectory() as folder:
            page = document.render("scaling.md.j2", pathlib.Path(folder), rows(), **scaling.values(rows(), pathlib.Path(folder)))
            self.assertIn("one checksum", page)
            with self.assertRaises(ValueError):
                scaling.values(wrong, pathlib.Path(folder))


if __name__ == "__main__":
    unittest.main()
