"""Checks that every module of hw/ is in a model of sim/: as the model's top, or instantiated below the top.

Prints "FILE: found ..., expected ..." for every other module and exits 1. Also exits 1 if there is no module at all."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT))

from synth import cores  # noqa: E402


def untested(hardware: list[pathlib.Path], tops: set[str]) -> list[pathlib.Path]:
    """Returns the files of modules that no top uses."""
    among = [*hardware, *(ROOT / "sim").glob("test/**/*.sv")]
    seen = {file for top in tops for file in cores.used(top, among)}
    return [file for file in hardware if file not in seen]


def main() -> int:
    """Runs the check, and verifies that the check can fail. Returns 1 if a module has no test or the check is wrong."""
    hardware = sorted(file for file in ROOT.glob("hw/*/*.sv") if not file.stem.endswith("_pkg"))
    lists = [file.read_text() for file in (ROOT / "sim").glob("**/CMakeLists.txt")]
    tops = {word for text in lists for names in re.findall(r"(?:\bTOP|\bforeach\(\w+) ([\w ]+)", text) for word in names.split()} | {
        file.stem for file in (ROOT / "sim/test").glob("*/*_top.sv")}
    missing = untested(hardware, tops)
    for file in missing:
        print(f"{file.relative_to(ROOT)}: found in no model, expected it in one of sim/")
    if not hardware or "ray_core" not in tops or not untested(hardware, {"fifo"}):
        print(f"{len(hardware)} modules, {len(tops)} tops: the check itself is wrong")
        return 1
    print(f"{len(hardware)} modules, {len(missing)} without a test")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
