"""`make verilog` writes what Icarus Verilog compiles and runs, with the right words.

usage: icarus_test.py TOP CASES [Name=value ...]   beside it: TOP_bench.v, whose last line counts CASES
"""

import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent


def main():
    """Writes, compiles, runs; the exit status is 1 where a word is wrong or a case is missing."""
    top, cases, *parameters = sys.argv[1:]
    subprocess.run(["python3", "-m", "synth.verilog", top, *parameters], check=True, cwd=ROOT)
    built = ROOT / "build" / "verilog" / f"{top}.vvp"
    subprocess.run(["iverilog", "-g2001", "-Wall", "-s", "bench", "-o", built, HERE / f"{top}_bench.v",
                    built.with_suffix(".v")], check=True)
    said = subprocess.run(["vvp", "-n", built], check=True, capture_output=True, text=True).stdout
    print(said, end="")
    return said.splitlines()[-1:] != [f"{cases} cases, 0 failures"]


if __name__ == "__main__":
    sys.exit(main())
