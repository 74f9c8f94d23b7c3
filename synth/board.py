"""Makes the bitstream of a board: `make fpga TOP=small_core BOARD=ulx3s`; synth/boards/README.md says how to load it.

fpga.py maps, places and routes; ecppack packs. A board that misses its clock has no bitstream.
"""

import argparse
import dataclasses
import pathlib
import sys

from synth import catalogue, cores, fpga, store, tools


@dataclasses.dataclass(frozen=True)
class Board(catalogue.Design):
    """A board. Its top module is in boards/NAME.sv."""

    holds: str = ""  # the catalogue's design on the board
    mhz: int = 40  # the clock that the top derives from the oscillator
    device: catalogue.Fpga = catalogue.ECP5_LUT4S

    def sources(self, structural: bool = False) -> list[pathlib.Path]:
        """Returns the RTL files, the top last."""
        return cores.used(self.top, [*cores.files(self.folder), tools.ROOT / "synth" / "boards" / f"{self.name}.sv"])


BOARDS = [Board("ulx3s", "ulx3s", "board", clock="clk_25mhz", holds="small_core", device=dataclasses.replace(
    catalogue.ECP5_LUT4S, clock="clk", arguments=(
        "--85k", "--package", "CABGA381", "--speed", "6", "--lpf", "synth/boards/ulx3s.lpf", "--router", "router2")))]


def bitstream(board: Board, seed: int) -> pathlib.Path:
    """Makes the bitstream and returns its path from the repository's root. Raises ToolFailed if the board misses its clock."""
    device = dataclasses.replace(board.device, seeds=(seed,))
    got, _ = fpga.place(board, device)
    print(f"{got['mhz']} MHz, {got['luts']} LUTs, from {got['from']} to {got['to']}")
    if got["mhz"] < board.mhz:
        raise tools.ToolFailed(f"{board.name}: found {got['mhz']} MHz, expected {board.mhz}: another SEEDS= may do")
    config = store.OUT / "runs" / f"{board.name}.{device.name}" / f"seed-{seed}" / "board.config"
    out = store.OUT / "boards" / board.name / f"{board.holds}.bit"
    out.parent.mkdir(parents=True, exist_ok=True)
    tools.run(["yowasp-ecppack", "--compress", "--freq", "62.0", *(file.relative_to(tools.ROOT) for file in (config, out))],
              config.with_name("ecppack.log"))
    return out.relative_to(tools.ROOT)


@tools.command("fpga")
def main() -> int:
    """Runs the command line. Returns 1 if a clock is missed or a tool fails, 2 for errors that the user can correct."""
    parser = argparse.ArgumentParser(prog="synth.board", description="Makes a board's bitstream.")
    parser.add_argument("top", help="the design on the board")
    parser.add_argument("board")
    parser.add_argument("--seed", type=int, default=2, help="of the placement (%(default)s, which is faster than 1)")
    given = parser.parse_args()
    board = next((board for board in BOARDS if (board.name, board.holds) == (given.board, given.top)), None)
    if board is None:
        raise ValueError(f"TOP={given.top} BOARD={given.board}: expected one of "
                         + ", ".join(f"TOP={board.holds} BOARD={board.name}" for board in BOARDS))
    tools.find("yowasp-ecppack")
    print(f"bitstream: {bitstream(board, given.seed)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
