"""Simulates ray_core_axi, as written by `make synth VERILOG=1`, in Icarus Verilog with cocotb and cocotbext-axi: `make test LONG=cocotb`.

The exit status is 1 if a test of axi_frames.py fails."""

import pathlib
import sys

from cocotb_tools import runner

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT))

from synth import catalogue, verilog  # noqa: E402

PARAMETERS = {"Arith": "1", "Rays": "4", "Depth": "2", "NodeLines": "16", "TriangleLines": "16", "DataWidth": "64", "IdWidth": "4"}


def main() -> int:
    """Writes the netlist and runs the tests."""
    out = ROOT / "build" / "cocotb" / "sim"
    netlist = out / "ray_core_axi.v"
    verilog.write(catalogue.design("ray_core_axi", **PARAMETERS), netlist)
    icarus = runner.get_runner("icarus")
    icarus.build(sources=[netlist], hdl_toplevel="ray_core_axi", build_dir=out, timescale=("1ns", "1ps"))
    results = icarus.test(test_module="axi_frames", hdl_toplevel="ray_core_axi", build_dir=out, test_dir=out,
                          extra_env={"PYTHONPATH": str(pathlib.Path(__file__).parent), "PYTHONWARNINGS": "ignore"}, timescale=("1ns", "1ps"))
    ran, failed = runner.get_results(results)
    print(f"{ran} tests, {failed} failed")
    return 1 if failed or not ran else 0


if __name__ == "__main__":
    sys.exit(main())
