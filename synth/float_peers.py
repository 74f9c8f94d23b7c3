"""Compares other projects' binary32 cores with ours in the same flows: `make synth TOP=float_peers`.

HardFloat is taken from the Verilog of a Rocket core, cvfpu and T-Head's divider from the sources of CV32E40P. PyPI has wheels of both.
"""

import dataclasses
import pathlib
import re
import subprocess
import sys
import zipfile

import numpy as np

from synth import catalogue, cores, mapping, store, tables, tools

FOLDER = store.OUT / "float_peers"
WRAPPERS = tools.FLOWS / "float_peers.sv"
BENCH = tools.FLOWS / "float_peers.cpp"
OPERATIONS = {"add": np.add, "multiply": np.multiply, "divide": np.divide}
# Origin, operation, wrapper module, value of its parameter Does, description, and number of register stages (None: iterative).
CORES = (
    ("ours", "add", "our_add", None, "", 0),
    ("HardFloat", "add", "hardfloat_multiply_add", 1, "multiply-add, times 1", 2),
    ("cvfpu", "add", "cvfpu_multiply_add", 1, "multiply-add, times 1", 0),
    ("ours", "multiply", "our_multiply", None, "", 0),
    ("HardFloat", "multiply", "hardfloat_multiply_add", 0, "multiply-add, plus 0", 2),
    ("cvfpu", "multiply", "cvfpu_multiply_add", 0, "multiply-add, plus 0", 0),
    ("HardFloat", "multiply-add", "hardfloat_multiply_add", 2, "", 2),
    ("cvfpu", "multiply-add", "cvfpu_multiply_add", 2, "", 0),
    ("ours", "divide", "our_divide", None, "all rows at once", 0),
    ("HardFloat", "divide", "hardfloat_divide", None, "a bit a clock; has square roots", None),
    ("T-Head, in cvfpu", "divide", "cvfpu_divide", None, "two bits a clock; has square roots", None))


@dataclasses.dataclass(frozen=True)
class PeerDesign(catalogue.Design):
    """A wrapper with the files of its core."""

    files: tuple[pathlib.Path, ...] = ()

    def sources(self, structural: bool = False) -> list[pathlib.Path]:
        return list(self.files)


def fetch() -> pathlib.Path:
    """Downloads and unpacks the wheels; returns their folder. Raises ToolFailed if pip fails."""
    wheels = FOLDER / "wheels"
    pins = (tools.ROOT / "synth" / "float_peers.txt").read_text()
    if not (FOLDER / "pins").exists() or (FOLDER / "pins").read_text() != pins:
        wheels.mkdir(parents=True, exist_ok=True)
        tools.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "-d", wheels, "-r", tools.ROOT / "synth" / "float_peers.txt"],
                  FOLDER / "pip.log")
        for wheel in wheels.glob("*.whl"):
            with zipfile.ZipFile(wheel) as archive:
                archive.extractall(wheels)
        (FOLDER / "pins").write_text(pins)
    return wheels


def modules(text: str, tops: list[str]) -> str:
    """Returns the Verilog of the modules `tops` and of all modules that they instantiate, directly or indirectly."""
    bodies = {match[1]: match[0] for match in re.finditer(r"^module (\w+)\(.*?^endmodule$", text, re.M | re.S)}
    wanted: dict[str, None] = {}
    waiting = list(tops)
    while waiting:
        name = waiting.pop()
        if name not in wanted:
            wanted[name] = None
            waiting += [word for word in set(re.findall(r"^  (\w+) \w+ \(", bodies[name], re.M)) if word in bodies]
    return "\n".join(bodies[name] for name in wanted) + "\n"


def sources(wrapper: str) -> list[pathlib.Path]:
    """Returns the files of a wrapper's core, packages first."""
    if wrapper.startswith("our_"):
        return cores.used({"our_add": "fp_adder", "our_multiply": "fp_multiplier", "our_divide": "fp_divider"}[wrapper], cores.files("fp"))
    if wrapper.startswith("hardfloat_"):
        generated = fetch() / "pythondata_cpu_rocket/verilog/generated-src/freechips.rocketchip.system.LitexFullConfig.v"
        kept = FOLDER / "hardfloat.v"
        store.replace(kept, modules(generated.read_text(), ["MulAddRecFNPipe", "DivSqrtRecFN_small"]))
        return [kept]
    vendor = fetch() / "pythondata_cpu_cv32e40p/system_verilog/rtl/vendor"
    fpnew = vendor / "pulp_platform_fpnew"
    listed = [vendor / "pulp_platform_common_cells/include/common_cells/registers.svh", vendor / "pulp_platform_common_cells/src/cf_math_pkg.sv",
              vendor / "pulp_platform_common_cells/src/lzc.sv", *(fpnew / f"src/{name}.sv" for name in (
                  "fpnew_pkg", "fpnew_classifier", "fpnew_rounding", "fpnew_fma", "fpnew_divsqrt_th_32")),
              *sorted((fpnew / "vendor/opene906/E906_RTL_FACTORY/gen_rtl").glob("*/rtl/*.v"))]
    kept = FOLDER / "cvfpu.sv"
    store.replace(kept, "".join(re.sub(r'^`include "common_cells/.*', "", file.read_text(), flags=re.M) + "\n" for file in listed))
    return [kept]


def wrapped(wrapper: str) -> pathlib.Path:
    """Writes float_peers.sv without the wrappers of other cores; returns the file."""
    kept = FOLDER / f"{wrapper}.sv"
    store.replace(kept, re.sub(rf"^module (?!{wrapper}\b).*?^endmodule$", "", WRAPPERS.read_text(), flags=re.M | re.S))
    return kept


def vectors(operation: str, count: int) -> pathlib.Path:
    """Writes `count` operations with the results of this processor; returns the file. A third of the operations each have random bits,
    exponents near each other, and results near the smallest normal number."""
    random = np.random.default_rng(1)
    a, b = random.integers(0, 2**32, (2, count), np.uint32)
    exponent, off, third = (a >> 23 & 255).astype(int), random.integers(-3, 4, count), np.arange(count) % 3
    small = {"add": off + 3, "multiply": 127 - exponent + off, "divide": exponent + 127 + off}[operation]
    if operation == "add":
        a[third == 2] &= 0x81ffffff  # exponents up to 3
    wanted = np.choose(third, (b >> 23 & 255, exponent + off, small)).clip(0, 255).astype(np.uint32)
    b = (b & 0x807fffff) | (wanted << 23)
    with np.errstate(all="ignore"):
        result = OPERATIONS[operation](a.view(np.float32), b.view(np.float32)).view(np.uint32)
    file = FOLDER / f"{operation}-{count}.txt"
    store.replace(file, "".join("%x %x %x\n" % row for row in zip(a, b, result)))
    return file


def simulate(design: PeerDesign, operation: str) -> dict:
    """Returns clocks and instructions per operation in simulation, and how many of 20,000 results differ."""
    folder = FOLDER / "models" / design.name
    wanted = store.key([*design.sources(), BENCH], design.facts, tools.version("verilator"))

    def make() -> dict:
        tools.run(["verilator", "--cc", "--exe", "--build", "-O3", "--x-assign", "fast", "--prefix", "Vcore", "--top-module", design.top, "-Wno-fatal", "-Wno-lint",
                   "-Wno-style", "--Mdir", folder, *(f"-G{name}={value}" for name, value in design.parameters), "-o", "bench", *design.sources(), BENCH,
                   "-CFLAGS", "-O2 -std=c++17"], folder / "verilator.log")
        counts = []
        for repeats in (1, 2):
            run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", folder / "bench", vectors(operation, 2000), str(repeats)],
                                 capture_output=True, text=True, check=True)
            counts.append(int(re.search(r"Collected : (\d+)", run.stderr)[1]))
        operations, clocks, differences = map(int, subprocess.run(
            [folder / "bench", vectors(operation, 20000), "1"], capture_output=True, text=True, check=True).stdout.split())
        return {"clocks": clocks / operations, "instructions": (counts[1] - counts[0]) / 2000, "differences": differences}
    return store.cached(folder, wanted, make)[0]


def run(libraries: list[catalogue.Library]) -> int:
    """Measures and prints all cores. Returns 1 if a result differs from the processor's."""
    for tool in ("verilator", "valgrind"):
        tools.find(tool)
    rows, differences = [], 0
    for whose, operation, wrapper, does, what, stages in CORES:
        clock = "" if stages == 0 else "clk_i"
        design = PeerDesign(f"float-peers-{wrapper}" + ("" if does is None else f"-{operation}"), wrapper, "fp",
                            () if does is None else (("Does", str(does)),), clock, (*sources(wrapper), wrapped(wrapper)))
        simulated = simulate(design, operation) if operation in OPERATIONS else {}
        differences += simulated.get("differences", 0)
        for library in libraries:
            for flow in ("small",) if clock else ("small", "fast"):
                mapped, _ = mapping.synthesise(design, library, flow)
                rows.append([whose, operation, what, library.name, flow, f"{mapped['area']:,}", f"{mapped['delay_ns']:.2f}",
                             f"{simulated['clocks']:.1f}" if stages is None else stages + 1,
                             f"{simulated['instructions']:,.0f}" if simulated else "-", simulated.get("differences", "-")])
                print(f"{whose}, {operation}, {library.name}, {flow}: {rows[-1][5]} um2, {rows[-1][6]} ns", file=sys.stderr, flush=True)
    print(tables.markdown(["core", "operation", "as", "library", "flow", "area, um2", "ns, pre-layout", "clocks", "instructions simulated",
                           "of 20,000 differ"], rows))
    print("ns: the longest path, between registers where there are any. clocks: from operands to result; HardFloat's multiply-add begins one in each, the "
          "dividers of others one after the other (mean of random operands).\nSimulated by Verilator, instructions by callgrind; differences from this "
          "processor's results, to nearest even, where any NaN equals any other.")
    return 1 if differences else 0
