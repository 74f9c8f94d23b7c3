"""Memories that synthesis keeps."""

import collections
import pathlib
import re
import tempfile
import unittest

from synth import catalogue, mapping


class Memories(unittest.TestCase):
    """Flow `blocks`."""

    def check(self, design: catalogue.Design, depth: int, width: int, address: int, enables: int) -> None:
        """A memory's ports are the design's: each bit of data and address, and an enable for each part of a word."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            found, _ = mapping.synthesise(design, catalogue.library("osu035"), "blocks", root)
            (netlist,) = root.glob("*/netlist.json")
            ports = mapping.top_module(netlist)["ports"]
        bits = collections.Counter(re.sub(r"[.[].*", "", name.rpartition("words.")[2]) for name in ports if "words." in name)
        self.assertEqual(found["blocks"]["the rest"]["bits"], width * depth)
        self.assertEqual([bits[port] for port in ("read_data_o", "write_data_i", "read_address_i", "write_enable_i")],
                         [width, width, address, enables])

    def test_every_bit_of_a_kept_memory_is_timed(self):
        """A queue around a ram."""
        self.check(catalogue.design("ram_fifo", Width=48, Depth=64), 64, 48, 6, 1)

    def test_parts_of_a_word_have_an_enable_each(self):
        """As the tags of a cache's ways."""
        self.check(catalogue.design("ram", Width=48, Depth=64, Parts=4), 64, 48, 6, 4)


if __name__ == "__main__":
    unittest.main()
