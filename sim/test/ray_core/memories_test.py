"""The memories of the ray core, as Yosys elaborates them, have a clock: whatever has more than 2,048 bits is a ram of
hw/common, or a part of one, whose read port is a register."""

import json
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT))
from synth import cores, yosys  # noqa: E402  (the import needs the path above)

LIMIT = 2048


def memories(top: str) -> dict:
    """Each memory above LIMIT of a top and of what is in it: by module and name its bits, and whether its read port has a
    clock."""
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
    """Says which memories there are; the exit status is 1 where one has no clock or there is none."""
    found = memories("ray_core_axi")
    without = {name: bits for name, (bits, clocked) in found.items() if not clocked}
    for name, bits in without.items():
        print(f"{name}: {bits:,} bits that are read without a clock, expected a ram")
    print(f"{len(found)} memories of more than {LIMIT:,} bits, {len(without)} without a clock")
    return 1 if without or not found else 0


if __name__ == "__main__":
    sys.exit(main())
