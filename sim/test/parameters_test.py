"""Checks that modules of hw/ refuse, at elaboration, parameters that their headers exclude.

If a parameter is accepted, prints the module, the parameter and Verilator's message, and exits 1."""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT))

from synth import cores  # noqa: E402

REFUSED = {
    "fifo": ["Depth=1", "Reserve=2"],
    "ram": ["Depth=1"],
    "rr_arbiter": ["Width=1"],
    "line_cache": ["Lines=8", "Lines=48", "Targets=1"],
    "axi_write_manager": ["DataWidth=16", "DataWidth=96", "DataWidth=1024"],
    "axi_read_manager": ["DataWidth=16", "DataWidth=96", "DataWidth=1024", "IdWidth=0"],
    "fp_divider": ["QuotientBits=25", "FracWidth=55"],
    "fp_adder": ["ExpWidth=2 FracWidth=2", "FracWidth=1", "ExpWidth=5 FracWidth=17", "Arith=5"],
    "fp_vector": ["Clocks=4"],
    "hit_decision": ["FracWidth=6", "FracWidth=27"],
    "hit_test_control": ["NumSteps=7"],
    "adder": ["Arith=5"],
    "carry_select_adder": ["GroupWidths=44", "GroupWidths=128'h2c0004", "GroupWidths=128'h040030"],
    "leading_zero_counter": ["Width=1"],
    "multiplier": ["Width=1", "Arith=5"],
    "exact_unit": ["DigitWidth=47", "DigitWidth=22"],
    "exact_product": ["DigitWidth=47", "Width=95"],
    "box_unit": ["Clocks=6"],
    "ray_alloc": ["Rays=48", "Clocks=2"],
    "uart_receiver": ["ClocksPerBit=3"],
    "uart_transmitter": ["ClocksPerBit=1"],
    "triangle_test": ["Clocks=6"],
    "traversal": ["Rays=1", "Depth=0"],
}


def elaborated(top: str, *parameters: str) -> subprocess.CompletedProcess:
    """Returns Verilator's result for `top` with these parameters."""
    files = cores.used(top, cores.files("board"))
    return subprocess.run(["verilator_bin", "--lint-only", "-Wno-lint", "--top-module", top, *(f"-G{one}" for one in parameters), *files],
                          capture_output=True, text=True, check=False)


def main() -> int:
    """Elaborates each module with its defaults, then with each parameter. Returns 1 if a result is wrong."""
    wrong = [f"{top}: {said.stderr}" for top in REFUSED if (said := elaborated(top)).returncode]
    for top, parameters in REFUSED.items():
        for parameter in parameters:
            said = elaborated(top, *parameter.split()).stderr
            if not re.search(r"USERERROR.*: expected ", said):
                wrong.append(f"{top} {parameter}: found {said.splitlines()[:1]}, expected an error of its own")
    print(*wrong, f"{sum(map(len, REFUSED.values()))} parameters, {len(wrong)} not refused", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
