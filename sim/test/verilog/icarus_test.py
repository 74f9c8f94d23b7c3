"""Checks that Icarus Verilog compiles and runs the output of `make synth VERILOG=1`, with the right results.

usage: icarus_test.py TOP CASES [ecp5] [bench.Name=value ...] [Name=value ...]

The test bench is TOP_bench.v in this folder; bench.Name=value sets its parameters. The last line that it prints must count CASES cases.
With ecp5, runs the netlist that `make fpga` places instead, with Yosys's models of the ECP5's cells.
"""

import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent
sys.path.insert(0, str(ROOT))

from synth import catalogue, scripts, tools, yosys  # noqa: E402


def mapped(top: str, words: list[str], out: pathlib.Path) -> list[str | pathlib.Path]:
    """Writes the ECP5 netlist of `top` to `out`; returns the files that Icarus reads."""
    design = catalogue.design(top, **dict(word.split("=") for word in words))
    netlist = out.with_suffix(".json")
    yosys.run(scripts.fpga(design, "ecp5", "", netlist), out.with_suffix(".map.log"))
    empty = " ".join(f"-unset INITVAL_{row:02X}" for row in range(64))
    # Icarus Verilog rejects $error in Yosys's cell models, so Yosys reads the models and writes them without it.
    yosys.run(f"read_json {netlist}\nchtype -set block_ram t:DP16KD\nsetparam {empty} t:block_ram\n"
              f"delete =$paramod*\nread_verilog -overwrite +/ecp5/cells_sim.v\nhierarchy -top {top}\nproc\n"
              f"setattr -mod -unset lib_whitebox *\nwrite_verilog -noattr {out}", out.with_suffix(".log"))
    return [out, tools.FLOWS / "ecp5_cells.v"]


def main():
    """Writes, compiles and runs the test. Returns the exit status: True (1) if a word is wrong or a case is missing."""
    top, cases, *parameters = sys.argv[1:]
    bench = [word for word in parameters if word.startswith("bench.")]
    parameters = [word for word in parameters if word not in bench]
    out = ROOT / "build" / "verilog" / f"{top}.v"
    if parameters[:1] == ["ecp5"]:
        out = out.with_suffix(".ecp5.v")
        out.parent.mkdir(parents=True, exist_ok=True)
        files = mapped(top, parameters[1:], out)
    else:
        subprocess.run(["python3", "-m", "synth.verilog", top, *parameters], check=True, cwd=ROOT)
        files = [out]
    built = out.with_suffix(".vvp")
    lint = [] if "ecp5" in parameters else ["-Wall"]
    subprocess.run(["iverilog", "-g2001", *lint, "-s", "bench", *(f"-P{word}" for word in bench), "-o", built,
                    HERE / f"{top}_bench.v", *files], check=True)
    said = subprocess.run(["vvp", "-n", built], check=True, capture_output=True, text=True).stdout
    print(said, end="")
    return said.splitlines()[-1:] != [f"{cases} cases, 0 failures"]


if __name__ == "__main__":
    sys.exit(main())
