"""Checks that all memories of more than 2,048 bits in the ray core, as elaborated by Yosys, have clocked read ports, like hw/common's
ram."""

import json
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT))
from synth import cores, yosys  # noqa: E402  (the import needs the path above)

LIMIT = 2048


def memories(top: str) -> dict:
    """Returns the memories of more than LIMIT bits in a top, by module and name: their bits, and whether their read ports have a clock."""
    with tempfile.TemporaryDirectory() as folder:
        netlist = pathlib.Path(folder) / "netlist.json"
        yosys.run(f"{yosys.read(cores.used(top, cores.files('ray_core')), top)}\n"
                  f"opt_expr\nopt_clean\nopt_dff\nopt_clean\nmemory -nomap\nwrite_json {netlist}", netlist.with_suffix(".log"))
        modules = json.loads(netlist.read_text())["modules"]
    found = {}
    for module, content in modules.items():
        for name, cell in content["cells"].items():
            parameters = cell["parameters"]
            if not cell["type"].startswith("$mem"):
                continue
            bits = int(parameters["SIZE"], 2) * int(parameters["WIDTH"], 2)
            if bits > LIMIT:
                found[f"{module}.{name}"] = bits, "0" not in parameters["RD_CLK_ENABLE"]
    return found


def main() -> int:
    """Reports the memories. Returns 1 if a memory has no clock or if there are no memories."""
    found = memories("ray_core_axi")
    without = {name: bits for name, (bits, clocked) in found.items() if not clocked}
    for name, bits in without.items():
        print(f"{name}: {bits:,} bits that are read without a clock, expected a ram")
    print(f"{len(found)} memories of more than {LIMIT:,} bits, {len(without)} without a clock")
    return 1 if without or not found else 0


if __name__ == "__main__":
    sys.exit(main())
