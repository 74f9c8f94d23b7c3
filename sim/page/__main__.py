"""`python3 -m sim.page OUT.html`: the paper's hit-test unit as a page that needs nothing installed.

Verilates hit_test_unit with an adder whose gates the page can break (fp_adder.sv here), compiles that to WebAssembly (Emscripten, which is
looked for as em++), and writes one file for any web server, or to be opened."""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys

from sim.mutate import netlist
from synth import cores, tools

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
FAULTS = 400
VERILATOR = pathlib.Path(os.environ.get("VERILATOR_ROOT", "/usr/share/verilator")) / "include"
MODES = {"inv": "inverted", "const0": "held at 0", "const1": "held at 1"}


def described(line: str) -> str:
    """Describes a fault in words. `line`: its line in the .list file of sim.mutate.netlist."""
    mode = MODES[re.search(r"-mode (\w+)", line)[1]]
    wire = re.search(r"-wire (\S+) -wirebit (\d+)", line)
    where = netlist.source(line)
    name = re.sub(r"genblk\d+\.", "", wire[1]) + f", bit {wire[2]}" if wire else "a wire without a name"
    return f"{name}: {mode}" + (f" ({where})" if where else "")


def example() -> list[float]:
    """Returns I, N and d of the worked example, read from sim/worked_example.cpp."""
    text = (ROOT / "sim" / "worked_example.cpp").read_text()
    return [float(word.rstrip("f")) for word in re.search(r"kWords = \{([^}]*)\}", text)[1].replace("\n", " ").split(", ")]


def verilate(folder: pathlib.Path) -> list[str]:
    """Writes the Verilated unit as C++ into `folder`. Returns the lines of fp_adder.list, one per fault of the adder."""
    netlist.write(folder / "fp_adder", "fp_adder", [], FAULTS, 1, [])
    gates = (folder / "fp_adder.v").read_text().replace("module fp_adder(", "module fp_adder_gates(", 1)
    (folder / "fp_adder_gates.v").write_text(gates)
    files = list(dict.fromkeys(file for core in cores.names() for file in cores.files(core)))
    packages = [str(file) for file in files if file.stem.endswith("_pkg")]
    folders = dict.fromkeys(f"-I{file.parent}" for file in files)
    subprocess.run(
        ["verilator", "--cc", "-O3", "--no-timing", "-Wno-fatal", "-Wno-lint", "-Wno-style", "-Wno-UNOPTFLAT",
         "-fno-const-bit-op-tree", "--x-assign", "unique", "--x-initial", "unique", str(ROOT / "sim" / "visible.vlt"),
         "-y", str(HERE), "-y", str(folder), *folders, "--prefix", "Vhit_test_unit_page", "--Mdir", str(folder / "unit"),
         "--top-module", "hit_test_unit", *packages, str(ROOT / "hw" / "hit_test" / "hit_test_unit.sv")], check=True)
    return (folder / "fp_adder.list").read_text().splitlines()


def compile_unit(folder: pathlib.Path) -> str:
    """Returns the unit as JavaScript that contains its WebAssembly."""
    sources = [VERILATOR / "verilated.cpp", VERILATOR / "verilated_threads.cpp", *sorted((folder / "unit").glob("*.cpp")),
               HERE / "unit_page.cpp"]
    # Debian's Emscripten finds its Node.js modules only with Debian's Node.js or with NODE_PATH.
    environment = {"NODE_PATH": "/usr/share/nodejs", **os.environ}
    subprocess.run(
        ["em++", "-O2", "-std=c++20", "-w", "-include", "cstdint", "-DVL_IGNORE_UNKNOWN_ARCH", "-DVM_TRACE=0", "-iquote", str(ROOT),
         f"-I{folder / 'unit'}", f"-I{VERILATOR}", f"-I{VERILATOR / 'vltstd'}", *map(str, sources), "-sSINGLE_FILE=1",
         "-sMODULARIZE=1", "-sEXPORT_NAME=loadUnit", "-sEXPORTED_FUNCTIONS=_run_unit",
         "-sEXPORTED_RUNTIME_METHODS=ccall,HEAPU32", "-sALLOW_MEMORY_GROWTH=1", "-sFILESYSTEM=0", "-sENVIRONMENT=web",
         "-o", str(folder / "unit.js")], check=True, env=environment)
    return (folder / "unit.js").read_text()


def main() -> int:
    """Runs the command line. Returns 2 if a tool is missing or fails."""
    parser = argparse.ArgumentParser(prog="sim.page", description=__doc__)
    parser.add_argument("out", type=pathlib.Path, metavar="OUT.html")
    out = parser.parse_args().out
    folder = out.parent / "parts"
    folder.mkdir(parents=True, exist_ok=True)
    try:
        print("Breaking the adder's gates ...", flush=True)
        faults = [described(line) for line in verilate(folder)]
        print("Compiling the unit to WebAssembly, about a minute ...", flush=True)
        unit = compile_unit(folder)
    except FileNotFoundError as error:
        print(f"sim.page: {error.filename} is missing; `make page` installs it", file=sys.stderr)
        return 2
    except subprocess.CalledProcessError as error:
        print(f"sim.page: {error.cmd[0]} failed with status {error.returncode}", file=sys.stderr)
        return 2
    except (tools.MissingTool, tools.ToolFailed) as error:
        print(f"sim.page: {error}", file=sys.stderr)
        return 2
    page = (HERE / "page.html").read_text()
    for name, content in (("@FAULTS@", json.dumps(faults)), ("@EXAMPLE@", json.dumps(example())), ("@UNIT@", unit)):
        page = page.replace(name, content.replace("</script", "<\\/script"), 1)
    out.write_text(page)
    print(f"{out}: {out.stat().st_size / 1e6:.1f} MB, for a browser")
    return 0


if __name__ == "__main__":
    sys.exit(main())
