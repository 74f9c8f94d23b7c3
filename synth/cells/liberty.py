"""Writes Liberty, as Yosys, ABC and OpenSTA read it."""

from synth.cells.catalogue import PREFIX, Cell, Corner
from synth.cells.flops import EDGE_SLEWS

UNITS = """\
  delay_model : table_lookup;
  time_unit : "1ns";
  voltage_unit : "1V";
  current_unit : "1mA";
  pulling_resistance_unit : "1kohm";
  leakage_power_unit : "1nW";
  capacitive_load_unit (1, pf);
  slew_lower_threshold_pct_rise : 20;
  slew_upper_threshold_pct_rise : 80;
  slew_lower_threshold_pct_fall : 20;
  slew_upper_threshold_pct_fall : 80;
  input_threshold_pct_rise : 50;
  input_threshold_pct_fall : 50;
  output_threshold_pct_rise : 50;
  output_threshold_pct_fall : 50;
"""


def library(corner: Corner, cells: list[tuple[Cell, dict]]) -> str:
    """The library of a corner; of each cell what was measured (library.measured)."""
    slews = len(cells[0][1]["arcs"][0]["slews"])
    loads = len(cells[0][1]["arcs"][0]["loads"])
    edges = len(EDGE_SLEWS)
    return "".join([
        f"library (sky130_{corner.name}) {{\n", UNITS,
        f"  nom_process : 1;\n  nom_voltage : {corner.volts};\n  nom_temperature : {corner.celsius};\n",
        f"  operating_conditions ({corner.name}) {{\n    process : 1;\n    voltage : {corner.volts};\n"
        f"    temperature : {corner.celsius};\n  }}\n  default_operating_conditions : {corner.name};\n",
        _template("lu_table_template", "delay", ("input_net_transition", slews), ("total_output_net_capacitance", loads)),
        _template("power_lut_template", "energy", ("input_transition_time", slews), ("total_output_net_capacitance", loads)),
        _template("lu_table_template", "edges", ("related_pin_transition", edges), ("constrained_pin_transition", edges)),
        *(_cell(cell, got) for cell, got in cells), "}\n"])


def _template(kind: str, name: str, *variables: tuple[str, int]) -> str:
    lines = [f"  {kind} ({name}) {{\n"]
    for i, (variable, size) in enumerate(variables, 1):
        numbers = ", ".join(str(j) for j in range(1, size + 1))
        lines.append(f"    variable_{i} : {variable};\n    index_{i} (\"{numbers}\");\n")
    return "".join([*lines, "  }\n"])


def _cell(cell: Cell, got: dict) -> str:
    leaks = got["leakage"]
    mean = sum(leak["nanowatts"] for leak in leaks) / len(leaks)
    text = [f"cell ({PREFIX}{cell.name}) {{\n  area : {cell.area:.4f};\n  cell_leakage_power : {mean:.6f};\n"]
    text += [f"  leakage_power () {{ when : \"{leak['when']}\"; value : {leak['nanowatts']:.6f}; }}\n"
             for leak in leaks if leak["when"]]
    if cell.flop:
        text.append("  ff (IQ, IQN) {\n    clocked_on : \"CLK\";\n    next_state : \"D\";\n"
                    + (f"    clear : \"!{cell.flop.clear}\";\n" if cell.flop.clear else "")
                    + (f"    preset : \"!{cell.flop.preset}\";\n" if cell.flop.preset else "") + "  }\n")
    for pin, farads in got["capacitances"].items():
        clock = "    clock : true;\n" if cell.flop and pin == "CLK" else ""
        edges = "".join(_constraint(kind, got[kind]) for kind in ("setup", "hold")) if cell.flop and pin == "D" else ""
        text.append(f"  pin ({pin}) {{\n    direction : input;\n{clock}    capacitance : {farads:.7f};\n{edges}  }}\n")
    for output, function in cell.functions or (("Q", "IQ"),):
        arcs = [arc for arc in got["arcs"] if arc["output"] == output]
        text.append(f"  pin ({output}) {{\n    direction : output;\n    function : \"{function}\";\n"
                    f"    max_capacitance : {arcs[0]['loads'][-1]:g};\n"
                    + "".join(_timing(arc) + _energy(arc) for arc in arcs) + "  }\n")
    return "".join([*text, "}\n"])


def _timing(arc: dict) -> str:
    sense = {None: "non_unate", True: "negative_unate", False: "positive_unate"}[arc["inverts"]]
    kind = "rising_edge" if arc["inverts"] is None else "combinational"
    names = ("cell_rise", "cell_fall", "rise_transition", "fall_transition")
    return (f"    timing () {{\n      related_pin : \"{arc['input']}\";\n      timing_sense : {sense};\n"
            f"      timing_type : {kind};\n"
            + "".join(_table(name, "delay", arc[name], arc["slews"], arc["loads"]) for name in names) + "    }\n")


def _energy(arc: dict) -> str:
    return (f"    internal_power () {{\n      related_pin : \"{arc['input']}\";\n"
            + _table("rise_power", "energy", arc["rise_energy"], arc["slews"], arc["loads"])
            + _table("fall_power", "energy", arc["fall_energy"], arc["slews"], arc["loads"]) + "    }\n")


def _constraint(kind: str, tables: dict) -> str:
    return (f"    timing () {{\n      related_pin : \"CLK\";\n      timing_type : {kind}_rising;\n"
            + "".join(_table(f"{edge}_constraint", "edges", tables[edge], EDGE_SLEWS, EDGE_SLEWS)
                      for edge in ("rise", "fall")) + "    }\n")


def _table(name: str, template: str, values: list[list[float]], first: list[float], second: list[float]) -> str:
    rows = ", \\\n".join(f"          \"{', '.join(f'{one:.6g}' for one in row)}\"" for row in values)
    return (f"      {name} ({template}) {{\n        index_1 (\"{', '.join(f'{one:g}' for one in first)}\");\n"
            f"        index_2 (\"{', '.join(f'{one:g}' for one in second)}\");\n        values ( \\\n{rows});\n      }}\n")
