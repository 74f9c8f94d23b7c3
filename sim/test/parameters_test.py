"""Modules of hw/ refuse parameters that their headers rule out, when they are elaborated.

Prints the module, the parameter and what Verilator said, and exits 1, where one is taken."""

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
    "ram_fifo": ["Depth=1", "Reserve=64"],
    "rr_arbiter": ["Width=1"],
    "ray_retire": ["Rays=1", "Rays=48"],
    "line_cache": ["Lines=8", "Lines=48", "Targets=1"],
    "axi_write_manager": ["DataWidth=16", "DataWidth=96", "DataWidth=1024"],
    "axi_read_manager": ["DataWidth=16", "DataWidth=96", "DataWidth=1024"],
    "fp_divider_stages": ["QuotientBits=25", "FracWidth=55"],
    "srt_divider_iterative": ["RowsPerClock=5"],
    "shared_triangle_test": ["Clocks=6"],
    "traversal": ["Rays=1", "Depth=0"],
}


def elaborated(top: str, *parameters: str) -> subprocess.CompletedProcess:
    """What Verilator makes of `top`."""
    files = cores.used(top, cores.files("ray_core"))
    return subprocess.run(["verilator_bin", "--lint-only", "-Wno-lint", "--top-module", top, *(f"-G{one}" for one in parameters), *files],
                          capture_output=True, text=True, check=False)


def main() -> int:
    """Each as it is, then with each parameter."""
    wrong = [f"{top}: {said.stderr}" for top in REFUSED if (said := elaborated(top)).returncode]
    for top, parameters in REFUSED.items():
        for parameter in parameters:
            said = elaborated(top, parameter).stderr
            if not re.search(r"USERERROR.*: expected ", said):
                wrong.append(f"{top} {parameter}: found {said.splitlines()[:1]}, expected an error of its own")
    print(*wrong, f"{sum(map(len, REFUSED.values()))} parameters, {len(wrong)} not refused", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
