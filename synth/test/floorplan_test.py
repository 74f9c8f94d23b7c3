"""Floor plans: what is read from nextpnr."""

import pathlib
import tempfile
import unittest

from synth import floorplan


class Reading(unittest.TestCase):
    """nextpnr's two JSON files."""

    def test_cells(self):
        """Where a placed cell is; what has no place is left out."""
        written = {"modules": {"top": {"cells": {
            "u_multiplier.x": {"attributes": {"NEXTPNR_BEL": "X78/Y20/SLICEA.LUT0"}},
            "lost": {"attributes": {}}}}, "library": {"cells": {}}}}
        self.assertEqual(floorplan.cells(written), [("u_multiplier.x", 78, 20)])

    def test_parts(self):
        """By the core at the top of a name."""
        self.assertEqual([floorplan.part(name, floorplan.PARTS) for name in ("u_divider.u_x", "u_adder.y", "state_q")],
                         ["divider", "adder", "registers, multiplexers, control"])
        self.assertEqual([floorplan.part(f"u_board.u_core.{name}", floorplan.CORE_PARTS)
                          for name in ("u_memory.u_node_cache.x", "u_traversal.u_closest_hit.y", "u_traversal.u_traversal.z")],
                         ["caches", "closest hit", "traversal"])

    def test_slowest(self):
        """The path between registers, and none from or to a pin."""
        def path(start, end, *places):
            return {"from": start, "to": end, "path": [{"to": {"loc": list(place)}} for place in places]}
        report = {"critical_paths": [path("<async>", "posedge c", (9, 9)),
                                     path("posedge c", "posedge c", (1, 2), (3, 4))]}
        self.assertEqual(floorplan.slowest(report), [(1, 2), (3, 4)])

    def test_drawn(self):
        """A picture comes out."""
        with tempfile.TemporaryDirectory() as name:
            out = pathlib.Path(name) / "plan"
            floorplan.draw([("u_adder.y", 1, 2), ("u_adder.z", 1, 2)], [(1, 2), (3, 4)], floorplan.PARTS, "", out)
            self.assertEqual(out.with_suffix(".png").read_bytes()[:4], b"\x89PNG")


if __name__ == "__main__":
    unittest.main()
