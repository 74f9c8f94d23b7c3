"""The energy of a doubt: exact_unit's cells of `make synth`, clocked, with its memories beside (`make layout TOP=energy`).

A doubt is a ray from before the scene through a point of a triangle's edge, as near as binary32 can say: does it hit, and is
it nearer than the triangle on the other side? Counted as in energy.py, clock pins included, memories not.
"""

import itertools
import pathlib
import re
from fractions import Fraction

import numpy as np

from synth import catalogue, mapping, store, tools
from synth.catalogue import Library
from synth.layout import energy, netlist, tests
from synth.layout.netlist import Netlist

DESIGN = catalogue.design("exact_unit")
FLOW = "blocks"
COUNT = 8  # doubts
PERIOD = 20  # ns
QUESTIONS = {"does it hit": 0, "does it hit, and is it nearer than another": 2}  # exact_pkg::against_e


def doubts(file: pathlib.Path = tests.SCENE, count: int = COUNT) -> list[list[np.ndarray]]:
    """O, I, a triangle's corners and another's; the triangles share an edge, through which the ray goes."""
    scene = tests.triangles(file)
    origin, edges, found = tests.eye(scene), {}, []
    for number, triangle in enumerate(scene):
        for a, b in itertools.combinations(map(tuple, triangle.tolist()), 2):
            edges.setdefault(frozenset((a, b)), []).append(number)
    shared = [(sorted(edge), sides) for edge, sides in edges.items() if len(edge) == 2 and len(sides) == 2]
    for (a, b), (one, other) in shared[::len(shared) // count][:count]:
        point = (np.array(a) * 5 + np.array(b) * 3) / 8
        found.append([origin, tests.towards(origin, point), scene[one], scene[other]])
    return found


def is_hit(doubt: list[np.ndarray]) -> bool | None:
    """Whether the ray hits the first triangle, in fractions; None where it goes exactly through an edge."""
    origin, i, triangle, _ = ([[Fraction(float(x)) for x in row] for row in np.atleast_2d(part)] for part in doubt)
    a, b, c = ([x - o for x, o in zip(corner, origin[0], strict=True)] for corner in triangle)

    def volume(u: list, v: list, w: list) -> Fraction:
        return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]))

    whole, sides = volume(a, b, c), [volume(i[0], b, c), volume(i[0], c, a), volume(i[0], a, b)]
    return None if 0 in (whole, *sides) else all((side > 0) == (whole > 0) for side in sides)


def measure(library: Library) -> tuple[dict, bool]:
    """nJ and clocks of each question, and whether they were kept."""
    folder = store.OUT / "energies" / f"{DESIGN.name}.{library.name}.{FLOW}"
    files = [*energy.files(library), *DESIGN.sources(), *mapping.files(), pathlib.Path(__file__), pathlib.Path(netlist.__file__)]
    wanted = store.key(files, mapping.flow_facts(), *energy.versions(), DESIGN.facts, library)

    def work() -> dict:
        mapping.synthesise(DESIGN, library, FLOW)
        nets = netlist.parse(mapping.top_module(store.OUT / "runs" / folder.name / "netlist.json"), DESIGN.top)
        given = [doubt for doubt in doubts() if is_hit(doubt) is not None]
        return {name: _spent(nets, library, folder, given, against) for name, against in QUESTIONS.items()}

    return store.cached(folder, wanted, tools.measured(work))


def _spent(nets: Netlist, library: Library, folder: pathlib.Path, given: list[list[np.ndarray]], against: int) -> dict:
    energy.simulate(DESIGN, library, nets, bench(nets, library, given, against), folder)
    answers = re.findall(r"^doubt (\d+) clocks, hit (.)$", (folder / "vvp.log").read_text(), re.M)
    if [hit for _, hit in answers] != [f"{is_hit(doubt):d}" for doubt in given]:
        raise tools.ToolFailed(f"exact_unit's cells: found {answers}, expected the fractions' answers")
    with (folder / "toggles.vcd").open() as trace:
        counts, _ = energy.toggles(trace, PERIOD * 1000)
    (folder / "toggles.vcd").unlink()
    picojoules = sum(energy.energies(nets, counts, dict.fromkeys(nets.nets(), 0.0), energy.pins(library), library).values())
    return {"nj": round(picojoules / len(given) / 1000, 3), "clocks": sum(int(clocks) for clocks, _ in answers) / len(given)}


def bench(nets: Netlist, library: Library, given: list[list[np.ndarray]], against: int) -> str:
    """A test bench that asks about each doubt, and is the memories; it notes all toggles from the second doubt on, the first
    being given twice."""
    buses: dict[str, int] = {}
    connections = []
    for short, port in nets.ports.items():
        name, _, index = port.name.partition("[")
        bus, place = re.sub(r"\W", "_", name), int(index.split("]")[0] or 0)
        buses[bus] = max(buses.get(bus, 0), place + 1)
        connections.append(f".{short}({bus}[{place}])")
    outputs = {re.sub(r"\W", "_", port.name.partition("[")[0]) for port in nets.ports.values() if port.output}
    lines = ["`timescale 1ns/1ps", "module bench;",
             *(f"  {'wire' if bus in outputs else 'reg'} [{width - 1}:0] {bus}{'' if bus in outputs else ' = 0'};"
               for bus, width in buses.items()),
             f"  {nets.top} dut ({', '.join(connections)});", f"  always #{PERIOD / 2:g} clk_i = ~clk_i;", "  integer clocks, i;"]
    for memory in sorted({bus.partition("_words_")[0] for bus in buses if "_words_" in bus}):
        at = f"{memory}_words_"
        lines += [f"  reg [{buses[at + 'read_data_o'] - 1}:0] {memory}[0:{2 ** buses[at + 'read_address_i'] - 1}];",
                  f"  initial for (i = 0; i < {2 ** buses[at + 'read_address_i']}; i = i + 1) {memory}[i] = 0;",
                  "  always @(posedge clk_i) begin",
                  f"    if ({at}read_enable_i) {at}read_data_o <= #{library.access_ns} {memory}[{at}read_address_i];",
                  f"    if ({at}write_enable_i_pin) {memory}[{at}write_address_i] <= {at}write_data_i;", "  end"]
    lines += ["  initial begin", '    $sdf_annotate("delays.sdf", dut);', f"    hit_i = 1; ready_i = 1; against_i = {against};",
              f"    #{4 * PERIOD} rst_ni = 1;"]
    for place, (origin, i, triangle, other) in enumerate([given[0], *given]):
        words = np.concatenate([origin, i, triangle.ravel(), other.ravel(), [np.float32(1)]]).astype(np.float32).view(np.uint32)
        value = sum(int(word) << 32 * k for k, word in enumerate(words))
        lines += [f"    @(posedge clk_i) #1 floats_i = 800'h{value:x}; valid_i = 1; clocks = 0;",
                  "    @(posedge clk_i) #1 valid_i = 0;",
                  f"    while (valid_o !== 1 && clocks < 5000) begin @(posedge clk_i) #{PERIOD - 2} clocks = clocks + 1; end"]
        lines.append(f'    $display("doubt %0d clocks, hit %b", clocks, hit_o); #{PERIOD};' if place else
                     f'    #{PERIOD}; $dumpfile("toggles.vcd"); $dumpvars(1, dut);')
    return "\n".join([*lines, "    $finish;", "  end", "endmodule"]) + "\n"
