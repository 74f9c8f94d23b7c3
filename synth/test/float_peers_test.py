"""Tests the comparison with other projects' float cores: modules taken from their files, and reference results."""

import unittest

import numpy as np

from synth import float_peers

GENERATED = """\
module Unused(
  input clock
);
endmodule
module Inner(
  input clock
);
endmodule
module Outer(
  input clock
);
  wire  inner_clock; // @[Outer.scala 1:15]
  Inner inner ( // @[Outer.scala 1:15]
    .clock(inner_clock)
  );
endmodule
"""


class FloatPeers(unittest.TestCase):
    def test_modules_with_what_is_in_them(self) -> None:
        kept = float_peers.modules(GENERATED, ["Outer"])
        self.assertIn("module Outer(", kept)
        self.assertIn("module Inner(", kept)
        self.assertNotIn("Unused", kept)

    def test_wrappers_alone(self) -> None:
        text = float_peers.wrapped("hardfloat_divide").read_text()
        self.assertEqual([line.split()[1] for line in text.splitlines() if line.startswith("module")], ["hardfloat_divide"])
        self.assertIn("endpackage", text)

    def test_vectors(self) -> None:
        for operation, function in float_peers.OPERATIONS.items():
            rows = [[int(word, 16) for word in line.split()] for line in float_peers.vectors(operation, 500).read_text().splitlines()]
            a, b, result = np.array(rows, np.uint32).T
            with np.errstate(all="ignore"):
                right = function(a.view(np.float32), b.view(np.float32))
            np.testing.assert_array_equal(right, result.view(np.float32))
            self.assertGreater((result & 0x7f800000 == 0).sum(), 5)  # subnormal results, and zeros


if __name__ == "__main__":
    unittest.main()
