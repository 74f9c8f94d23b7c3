"""How far measured figures are from SkyWater's own.

A few figures of the Liberty that SkyWater published for these cells (repository skywater-pdk-libs-sky130_fd_sc_hd of google,
cells/*/*.lib.json: tt_025C_1v80, ss_100C_1v60, ff_n40C_1v95), at points of its tables; no part of the library that is written here.
"""

import bisect
import dataclasses

from synth import tables
from synth.cells import library
from synth.cells.catalogue import CELLS


@dataclasses.dataclass(frozen=True)
class Figure:
    """A published figure, ns, or pF of a pin: of a cell at a corner, and the path in what was measured.

    `of`: an arc "A to Y", or a pin; `name`: of the arc's table, "setup rise", "hold fall", or "capacitance".
    """

    cell: str
    corner: str
    of: str
    name: str
    value: float
    slew: float = 0  # ns
    load: float = 0  # pF, or ns of the data's slew


FIGURES = [
    Figure("inv_1", "tt", "A", "capacitance", 0.002302),
    Figure("inv_1", "tt", "A to Y", "cell_rise", 0.0566328, 0.0531329, 0.00356533),
    Figure("inv_1", "tt", "A to Y", "cell_fall", 0.0410519, 0.0531329, 0.00356533),
    Figure("inv_1", "tt", "A to Y", "cell_rise", 0.0903158, 0.0531329, 0.00952062),  # the load of four like it
    Figure("inv_1", "tt", "A to Y", "cell_fall", 0.0615784, 0.0531329, 0.00952062),
    Figure("inv_1", "tt", "A to Y", "cell_rise", 0.1807958, 0.0531329, 0.0254232),
    Figure("inv_1", "tt", "A to Y", "cell_fall", 0.1142486, 0.0531329, 0.0254232),
    Figure("inv_1", "tt", "A to Y", "rise_transition", 0.0404175, 0.0531329, 0.00356533),
    Figure("inv_1", "tt", "A to Y", "fall_transition", 0.0253538, 0.0531329, 0.00356533),
    Figure("nand2_1", "tt", "A", "capacitance", 0.002315),
    Figure("nand2_1", "tt", "A to Y", "cell_rise", 0.0612167, 0.0531329, 0.00346659),
    Figure("nand2_1", "tt", "A to Y", "cell_fall", 0.0504824, 0.0531329, 0.00346659),
    Figure("nor2_1", "tt", "B to Y", "cell_rise", 0.0837553, 0.0531329, 0.0027814),
    Figure("nor2_1", "tt", "B to Y", "cell_fall", 0.0388281, 0.0531329, 0.0027814),
    Figure("fa_1", "tt", "CIN to COUT", "cell_rise", 0.1574593, 0.0531329, 0.0033953),
    Figure("fa_1", "tt", "CIN to COUT", "cell_fall", 0.3613433, 0.0531329, 0.0033953),
    Figure("dfxtp_1", "tt", "CLK", "capacitance", 0.001794),
    Figure("dfxtp_1", "tt", "D", "capacitance", 0.001678),
    Figure("dfxtp_1", "tt", "CLK to Q", "cell_rise", 0.3070411, 0.0531329, 0.00343455),
    Figure("dfxtp_1", "tt", "CLK to Q", "cell_fall", 0.2971512, 0.0531329, 0.00343455),
    Figure("dfxtp_1", "tt", "D", "setup rise", 0.0508281, 0.01, 0.01),
    Figure("dfxtp_1", "tt", "D", "setup fall", 0.1033184, 0.01, 0.01),
    Figure("dfxtp_1", "tt", "D", "hold rise", -0.0285176, 0.01, 0.01),
    Figure("dfxtp_1", "tt", "D", "hold fall", -0.0468281, 0.01, 0.01),
    Figure("inv_1", "ss", "A to Y", "cell_rise", 0.1806423, 0.0793701, 0.0143127),
    Figure("inv_1", "ss", "A to Y", "cell_fall", 0.144757, 0.0793701, 0.0143127),
    Figure("dfxtp_1", "ss", "CLK to Q", "cell_rise", 0.7142901, 0.223607, 0.00442418),
    Figure("dfxtp_1", "ss", "CLK to Q", "cell_fall", 0.6586442, 0.223607, 0.00442418),
    Figure("inv_1", "ff", "A to Y", "cell_rise", 0.0775728, 0.0531329, 0.0108888),
    Figure("inv_1", "ff", "A to Y", "cell_fall", 0.0467605, 0.0531329, 0.0108888),
]


def table(corners: list[str]) -> str:
    """The figures at `corners` beside those measured here: ps and fF; deviations in per cent, of set-up and hold in ps."""
    rows = []
    for figure in FIGURES:
        if figure.corner in corners:
            own = measured(figure)
            edge = figure.name.startswith(("setup", "hold"))
            off = f"{1000 * (own - figure.value):+.0f} ps" if edge else f"{100 * (own / figure.value - 1):+.0f} %"
            unit = "fF" if figure.name == "capacitance" else "ps"
            at = [f"{1000 * figure.slew:.3g}", f"{1000 * figure.load:.3g}"] if figure.load and not edge else ["", ""]
            rows.append([figure.cell, figure.corner, figure.of, *at, figure.name.replace("_", " "),
                         f"{1000 * figure.value:.3g}", f"{1000 * own:.3g}", unit, off])
    return tables.markdown(["cell", "corner", "pin, or path", "slew, ps", "load, fF", "figure", "published", "measured", "unit", "deviation"], rows)


def measured(figure: Figure) -> float:
    """The same figure of what was measured here, read from its tables as a timer does."""
    cell = next(cell for cell in CELLS if cell.name == figure.cell)
    got, _ = library.measured(cell, library.corner(figure.corner))
    if figure.name == "capacitance":
        return got["capacitances"][figure.of]
    kind, _, edge = figure.name.partition(" ")
    if edge:
        return got[kind][edge][0][0]  # both slews the least
    source, _, output = figure.of.partition(" to ")
    arc = next(arc for arc in got["arcs"] if (arc["input"], arc["output"]) == (source, output))
    return between(arc[figure.name], arc["slews"], arc["loads"], figure.slew, figure.load)


def between(values: list[list[float]], rows: list[float], columns: list[float], row: float, column: float) -> float:
    """Bilinear interpolation in a table."""
    def place(points: list[float], at: float) -> tuple[int, float]:
        i = min(max(bisect.bisect(points, at) - 1, 0), len(points) - 2)
        return i, (at - points[i]) / (points[i + 1] - points[i])

    (i, down), (j, across) = place(rows, row), place(columns, column)
    return ((1 - down) * ((1 - across) * values[i][j] + across * values[i][j + 1])
            + down * ((1 - across) * values[i + 1][j] + across * values[i + 1][j + 1]))
