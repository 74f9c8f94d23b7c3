"""Tests that sim.mutate distinguishes faults that change outputs from faults that do not, also behind registers."""

import pathlib
import re
import tempfile
import unittest

from sim.mutate.__main__ import equivalent, place
from synth import yosys

# Two registers in series, a black box with an input tied to 0, and a named wire that no output depends on.
SOURCE = """
(* blackbox *) module part(input tie_i, input a_i, output y_o); endmodule
module top(input clk_i, input [1:0] a_i, b_i, output reg [1:0] y_o, output z_o, w_o);
  reg [1:0] q;
  always @(posedge clk_i) begin
    q <= a_i ^ b_i;
    y_o <= q;
  end
  wire both = a_i[0] & b_i[0];
  assign w_o = both | a_i[0];
  part u_part(.tie_i(1'b0), .a_i(q[0]), .y_o(z_o));
endmodule
"""


class Equivalent(unittest.TestCase):
    """Tests `equivalent`."""

    def test_tells_faults_from_none(self):
        with tempfile.TemporaryDirectory() as folder:
            netlist = pathlib.Path(folder) / "top"
            netlist.with_suffix(".v").write_text(SOURCE)
            yosys.run(f"read_verilog {netlist}.v\nhierarchy -top top\nproc\nwrite_rtlil {netlist}.il", netlist.with_suffix(".log"))
            gate = re.search(r"cell \$and (\S+)", netlist.with_suffix(".il").read_text())[1]
            faults = {"const0 -module top -cell u_part -port tie_i": True, "const1 -module top -cell u_part -port tie_i": False,
                      "inv -module top -cell u_part -port a_i": False, f"const0 -module top -cell {gate} -port Y": True,
                      f"const1 -module top -cell {gate} -port Y": False}
            for number, (fault, same) in enumerate(faults.items(), 1):
                with self.subTest(fault):
                    self.assertEqual(equivalent(netlist, f"mutate -ctrl mutant 16 {number} -mode {fault} -portbit 0"), same)


class Place(unittest.TestCase):
    """Tests `place`."""

    def test_is_the_expression_and_not_where_its_instance_is(self):
        fault = "mutate -mode inv -cell $1 -port A -portbit 2 -src /r/hw/fp/fp_adder.sv:24.5 -src /r/hw/fp/fp_round.sv:112.23-112.38"
        self.assertEqual(place(fault), "hw/fp/fp_round.sv:112 inv A[2]")
        self.assertEqual(place(fault.replace("-112.38", "")), "hw/fp/fp_adder.sv:24 inv A[2]")


if __name__ == "__main__":
    unittest.main()
