"""Memories that synthesis keeps."""

import collections
import pathlib
import tempfile
import unittest

from synth import catalogue, mapping


class Memories(unittest.TestCase):
    """Flow `blocks`."""

    def test_every_bit_of_a_kept_memory_is_timed(self):
        """A ram of 64 words, and the queue around it: its ports are the design's, bit by bit."""
        design = catalogue.design("ram_fifo", Width=48, Depth=64)
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            found, _ = mapping.synthesise(design, catalogue.library("osu035"), "blocks", root)
            (netlist,) = root.glob("*/netlist.json")
            ports = mapping.top_module(netlist)["ports"]
        bits = collections.Counter(name.partition(".words.")[2].partition("[")[0] for name in ports)
        self.assertEqual(found["blocks"]["the rest"]["bits"], 48 * 64)
        self.assertEqual((bits["read_data_o"], bits["write_data_i"], bits["read_address_i"], bits["write_enable_i"]), (48, 48, 6, 1))


if __name__ == "__main__":
    unittest.main()
