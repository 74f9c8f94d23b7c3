"""`python3 -m synth.prove`: proves the adders, the multiplier and the unit's timetable, and compares
netlists with the RTL that they were made of. Each proof is one command on the RTL itself."""

import argparse
import collections
import dataclasses
import functools
import pathlib
import re
import sys
from collections.abc import Callable

from synth import catalogue, cores, float_cuts, float_proofs, induction, mapping, netlists, runner, store, tables, tools
from synth.catalogue import LIBRARIES, Design

PROOFS = pathlib.Path(__file__).resolve().parent / "proofs"


NETLIST_FLOWS = ("fast", "area")  # whose netlists are compared without LONG


@dataclasses.dataclass(frozen=True)
class Proof:
    """Something that is shown; `quick`: in well under half a minute, so `make test` shows it too;
    `long`: only where it is asked for."""

    name: str
    claim: str
    how: str
    work: Callable[[], tuple[dict, bool]]
    quick: bool = True
    long: bool = False


def _files(folder: str) -> list[pathlib.Path]:
    return catalogue.Design("", "", folder).sources()


def _used(top: str) -> list[pathlib.Path]:
    return cores.used(top, _files("arith"))


def holds(top: str, method: str = "SAT", sources: list[pathlib.Path] | None = None,
          prepare: str = "", parameters: tuple[tuple[str, object], ...] = (), steps: int = 0,
          reach: int = 0, prepared: str = "", beside: tuple[str, ...] = (), name: str = "") -> tuple[dict, bool]:
    """Proves the assertions of proofs/<top>.sv; raises ToolFailed where one does not hold, where there
    is none, and where what is assumed leaves a `cover` out of reach.

    `method`: "SAT" (Yosys's) or "Bitwuzla". `sources`: the RTL, what is named of hw/arith unless said.
    `prepare`, `prepared`: a Tcl file that makes a module of it first, and what of. `beside`: files of
    `sources`, by name, whose modules the proof itself has beside that one.
    `steps`: 0 for combinational ones; else proven for that many clocks from reset and, where they
    held for so many, for the next one. `reach`: clocks to reach covers in, `steps` unless said.
    """
    folder = store.OUT / "proofs" / (name or top)
    own = PROOFS / f"{top}.sv"
    rtl = cores.used(top, [*_files("arith"), own])[:-1] if sources is None else sources
    read = [*(file for file in rtl if not prepare or file.stem in beside), own]
    scripts = [PROOFS / "prove.tcl", pathlib.Path(induction.__file__), *([PROOFS / prepare] if prepare else [])]
    wanted = store.key([*rtl, *read, *scripts], tools.version("yosys"), method, parameters, steps,
                       reach, prepared)

    def work() -> dict:
        smt2 = folder / "model.smt2"
        tools.run(["yosys", "-c", PROOFS / "prove.tcl"], folder / "yosys.log", {
            "SOURCES": " ".join(map(str, read)), "TOP": top,
            "PARAMETERS": " ".join(f"{key} {value}" for key, value in parameters),
            "PREPARE": str(PROOFS / prepare) if prepare else "",
            "RTL": " ".join(map(str, rtl)), "PREPARED": prepared,
            "SMT2": str(smt2) if method == "Bitwuzla" else ""})
        if method == "Bitwuzla":
            induction.holds(top, smt2, steps, reach or steps)
        return {"holds": True}

    return store.cached(folder, wanted, tools.measured(work))


def adds(design: Design) -> tuple[dict, bool]:
    """An adder of any kind and grouping adds, by SAT."""
    return holds("adder_adds", parameters=design.parameters, name=f"adds.{design.name}")


def fifo_keeps_order(depth: int, reserve: int) -> tuple[dict, bool]:
    """A FIFO of this size keeps its promises, by induction."""
    parameters = f"-chparam Width 2 -chparam Depth {depth} -chparam Reserve {reserve}"
    return holds("fifo_keeps_order", "Bitwuzla", [catalogue.HW / "common" / "fifo.sv"], "open.tcl",
                 (("Depth", depth), ("Reserve", reserve)), steps=1, reach=depth + 6,
                 prepared=f"fifo {{{parameters}}} *_q {{words {depth} 2}}", name=f"fifo_{depth}")


def nearest_is_kept(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """nearest_hit keeps the nearest hit, by induction."""
    return holds("nearest_hit_keeps_nearest", "Bitwuzla", cores.files("hit_test"), steps=1, reach=5,
                 parameters=(("ExpWidth", exp), ("FracWidth", frac)), name=f"nearest.{name}")


def _around(top: str, name: str) -> list[pathlib.Path]:
    """A unit, with the modules of contracts/NAME.sv in place of its own."""
    contracts = PROOFS / "contracts" / f"{name}.sv"
    stands_for = re.findall(r"^module (\w+)", contracts.read_text(), re.M)
    rtl = [file for file in cores.files("hit_test") if file.stem not in stands_for]
    return [*dict.fromkeys([*cores.used(top, rtl), *cores.used(name, [*rtl, contracts])])]


def computes(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """The pipelined unit's words go through the cores that they should, by unrolling."""
    inner = " ".join(f"u_nearest.{port}_i" for port in ("valid", "hit", "doubt", "t", "t_error", "payload"))
    inner += " u_point.valid_i u_point.dividends_i u_point.v_i u_point.valid_o u_point.point_o"
    latency = frac // 2 + 16
    return holds("pipeline_computes", "Bitwuzla", _around("hit_test_pipeline", "functions"), "open.tcl",
                 (("ExpWidth", exp), ("FracWidth", frac)), steps=latency + 1, reach=latency + 3,
                 prepared=_opened(exp, frac, 1, inner), beside=("functions", "hit_decision", "delay_line"),
                 name=f"computes.{name}")


def keeps_credits(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """The pipelined unit never overfills its queue, and holds what it offers, by induction."""
    inner = ("test_q decided_q dividing_q report closed u_point.valid_q u_results.push_i "
             "u_results.count_q u_results.read_q u_results.write_q")
    return holds("pipeline_keeps_credits", "Bitwuzla", _around("hit_test_pipeline", "hit_test_arithmetic"), "open.tcl",
                 (("ExpWidth", exp), ("FracWidth", frac)), steps=1,
                 prepared=_opened(exp, frac, 1, inner), name=f"credits.{name}")


def keeps_tags(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """Tests come to their distances in order, with their tags, by induction."""
    inner = "u_nearest.valid_i u_nearest.first_i u_nearest.last_i u_nearest.tag_i"
    latency = frac // 2 + 16
    return holds("pipeline_keeps_tags", "Bitwuzla", _around("hit_test_pipeline", "hit_test_arithmetic"), "open.tcl",
                 (("ExpWidth", exp), ("FracWidth", frac)), steps=latency + 1, reach=latency + 3,
                 prepared=_opened(exp, frac, 2, inner), name=f"tags.{name}")


def array() -> tuple[dict, bool]:
    """An array of four lanes is its lanes, by induction."""
    return holds("array_is_its_lanes", "Bitwuzla", _around("hit_test_array", "lane"), "open.tcl", steps=1,
                 reach=8, prepared="hit_test_array {-chparam Lanes 4 -chparam ExpWidth 5 -chparam FracWidth 10 "
                 "-chparam TagWidth 2 -chparam CounterWidth 6} "
                 "{gen_lane*.given gen_lane*.said gen_lane*.counted counters events_q}")


def decision(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """hit_decision denies no exact edge product."""
    return holds("decision_follows_edges", "Bitwuzla", cores.files("hit_test"),
                 parameters=(("ExpWidth", exp), ("FracWidth", frac)), name=f"decision.{name}")


def edge_sign(frac: int) -> tuple[dict, bool]:
    """An edge product beyond its bound has the exact one's sign, in a format of this fraction width."""
    u = 2.0 ** -(frac + 1)
    most = int(1024 * (2 + 6 / (1 - 3 * u)))
    return holds("edge_sign_is_exact", "Bitwuzla", cores.files("fp"), name=f"edge_sign.{frac}",
                 parameters=(("ExpWidth", 4), ("FracWidth", frac), ("C1024", most)))


def _opened(exp: int, frac: int, tag: int, inner: str) -> str:
    return (f"hit_test_pipeline {{-chparam ExpWidth {exp} -chparam FracWidth {frac} "
            f"-chparam TagWidth {tag}}} {{{inner}}}")


def every_product(width: int) -> tuple[dict, bool]:
    """Every product of the Verilated multiplier."""
    folder = store.OUT / "proofs" / f"every_product_{width}"
    harness = PROOFS / "booth_exhaustive.cpp"
    rtl = _used("booth_multiplier")
    wanted = store.key([*rtl, harness], tools.version("verilator"), width)

    def work() -> dict:
        tools.run(["verilator", "--cc", "--exe", "--build", "-O3", "--no-timing", "-MAKEFLAGS",
                   "OPT_FAST=-O3", "-CFLAGS", f"-DWIDTH={width}", f"-GWidth={width}",
                   "--top-module", "booth_multiplier", "--Mdir", folder / "obj",
                   *rtl, harness, "-o", "exhaustive"], folder / "build.log")
        tools.run([str(folder / "obj" / "exhaustive")], folder / "run.log")
        return {"holds": True}

    return store.cached(folder, wanted, tools.measured(work))


def all_proofs() -> list[Proof]:
    """Every proof there is, in the order of the report."""
    proofs = [
        Proof(f"adder.{name}", "carry, sum = a + b + carry at 48 bits", "SAT",
              functools.partial(adds, catalogue.design("adder", f"adder-{name}", kind, widths,
                                                       look_ahead, Width=48)))
        for name, kind, widths, look_ahead in catalogue.ADDERS if kind != catalogue.BEHAVIOURAL]
    contracts = PROOFS / "contracts"
    package = [file for file in _files("arith") if file.stem == "arith_pkg"]
    unit = [*(file for file in _files("hit_test") if file.stem in ("arith_pkg", "fp_pkg")),
            contracts / "fp_cores.sv", catalogue.HW / "hit_test" / "hit_test_control.sv",
            catalogue.HW / "hit_test" / "hit_test_unit.sv"]
    tree = [*package, contracts / "carry_save_adder.sv", catalogue.HW / "arith" / "carry_save_tree.sv"]
    proofs += [
        Proof("booth.digits", "24 bits, step 1: the digits add up to b", "SAT",
              lambda: holds("booth_digits")),
        Proof("booth.row", "step 2: a row is its digit times a", "SAT",
              lambda: holds("booth_row_multiple")),
        Proof("booth.assembly", "step 3: the tree's 13 words are the rows, constants cancel", "SAT",
              lambda: holds("booth_assembly_sums", sources=_used("booth_multiplier"), prepare="booth_assembly.tcl",
                            prepared="-chparam Width 24")),
        Proof("booth.assembly_14", "step 3, with the paper's 14th row", "SAT",
              lambda: holds("booth_assembly_sums", sources=_used("booth_multiplier"), prepare="booth_assembly.tcl",
                            parameters=(("Words", 14),), name="booth_assembly_14",
                            prepared="-chparam Width 24 -chparam ConstantRow 1'b1")),
        Proof("booth.carry_save", "step 4: a carry-save adder preserves the sum, 48 bits", "SAT",
              lambda: holds("carry_save_preserves")),
        Proof("booth.tree", "step 5: a tree of such adders adds up its 13 rows", "Bitwuzla",
              lambda: holds("carry_save_tree_adds", "Bitwuzla", tree)),
        Proof("booth.tree_14", "step 5, with the paper's 14 rows", "Bitwuzla",
              lambda: holds("carry_save_tree_adds", "Bitwuzla", tree, parameters=(("Rows", 14),),
                            name="carry_save_tree_14")),
        Proof("booth.all_of_6_bits", "6 x 6 bits: the product, in one piece", "SAT",
              lambda: holds("booth_multiplies", parameters=(("Width", 6),), name="booth_6")),
        Proof("booth.all_of_8_bits", "8 x 8 bits: the product, in one piece", "SAT",
              lambda: holds("booth_multiplies", parameters=(("Width", 8),), name="booth_8"), False),
        *(Proof(f"booth.every_product_{width}", f"{width} x {width} bits: every product",
                "simulation", functools.partial(every_product, width), width <= 10)
          for width in (9, 10, 11, 12, 13, 14)),
        *(Proof(f"unit.fifo_{depth}", f"a FIFO of {depth} words, {reserve} kept back: order, counts, stability",
                "Bitwuzla", functools.partial(fifo_keeps_order, depth, reserve))
          for depth, reserve in ((2, 0), (5, 2), (36, 33), (48, 45))),
        *(Proof(f"unit.nearest.{name}", "a burst's nearest hit is kept, and near ties reported",
                "Bitwuzla", functools.partial(nearest_is_kept, name, exp, frac))
          for name, (exp, frac, *_) in float_proofs.FORMATS.items()),
        *(Proof(f"unit.credits.{name}", "the pipelined unit's queue has room for all that comes; what it "
                "offers stays until taken", "Bitwuzla",
                functools.partial(keeps_credits, name, exp, frac), False)
          for name, (exp, frac, *_) in float_proofs.FORMATS.items()),
        *(Proof(f"unit.tags.{name}", "the pipelined unit keeps the order, tags and bursts of its tests",
                "Bitwuzla", functools.partial(keeps_tags, name, exp, frac), False)
          for name, (exp, frac, *_) in float_proofs.FORMATS.items()),
        *(Proof(f"unit.computes.{name}", "the pipelined unit's words go through the operations that they should",
                "Bitwuzla", functools.partial(computes, name, exp, frac), False)
          for name, (exp, frac, *_) in float_proofs.FORMATS.items()),
        *(Proof(f"unit.decision.{name}", "no verdict denies exact edge products, if bounds hold", "Bitwuzla",
                functools.partial(decision, name, exp, frac))
          for name, (exp, frac, *_) in float_proofs.FORMATS.items()),
        *(Proof(f"unit.edge_sign.{frac}", f"{frac} bits of fraction: beyond its bound an edge product has "
                "the exact one's sign", "Bitwuzla", functools.partial(edge_sign, frac), False, frac > 4)
          for frac in (3, 4, 5, 6, 7)),
        Proof("unit.timetable", "the unit keeps its timetable, from reset and always", "Bitwuzla",
              lambda: holds("timetable", "Bitwuzla", unit, "open.tcl", steps=20,
                            prepared="hit_test_unit {} {word step clear accumulate load_d divide}")),
        Proof("unit.computes.serial", "the paper's unit makes P of its words, whatever it did before", "Bitwuzla",
              lambda: holds("unit_computes", "Bitwuzla", _around("hit_test_unit", "functions"), steps=12), False),
        Proof("unit.computes.general", "the general unit, likewise", "Bitwuzla",
              lambda: holds("general_unit_computes", "Bitwuzla",
                            _around("general_hit_test_unit", "functions"), steps=17), False),
        Proof("unit.array", "an array is its lanes, and its counters are their sums", "Bitwuzla",
              array),
    ]
    proofs += [Proof(f"float.{one.name}", one.says, "Bitwuzla",
                     functools.partial(float_proofs.proven, one), False, one.long)
               for one in float_proofs.PROOFS]
    proofs += [Proof(f"float.cuts.{cut.name}.{name}.{kind}", "with all its registers the same, only later",
                     "Bitwuzla", functools.partial(float_cuts.agree, cut, name, kind), False,
                     (cut.name, name) == ("divide", "binary32"))
               for cut in float_cuts.CUTS for name in cut.latency for kind in ("graded", "behavioural")]
    proofs += [Proof(f"float.lemma.{name}", says, "z3",
                     functools.partial(float_proofs.lemma, name), False)
               for name, says in float_proofs.LEMMAS.items()]
    proofs += [Proof(f"float.specification.{one.name}", f"as MPFR, {float_proofs.VECTORS:,} times",
                     "evaluation", functools.partial(float_proofs.agrees_with_mpfr, one), False)
               for one in float_proofs.SPECIFICATIONS]
    # The pipelined unit in binary16: Verilator would take an hour for binary32's hundred thousand
    # cells.
    narrow = catalogue.design("hit_test_pipeline", ExpWidth=5, FracWidth=10)
    rows = [row for row in catalogue.report_rows() if row.design.top != narrow.top]
    for row in [*rows, catalogue.Row("units", narrow, {"osu035": ("parts",)})]:
        for library in LIBRARIES:
            for flow in row.flows.get(library.name, ()):
                name = f"netlist.{row.design.name}.{library.name}.{flow}"
                quick = name in ("netlist.adder-graded.osu035.fast", "netlist.booth-graded.osu035.fast")
                proofs.append(
                    Proof(name, "the netlist and its RTL agree", "simulation", functools.partial(
                        netlists.agree, row.design, library, flow, 20000), False, True)
                    if row.section == "units" else
                    Proof(name, "the netlist computes what its RTL does", "ABC", functools.partial(
                        netlists.equal, row.design, library, flow), quick,
                          not quick and (library.name != "osu035" or flow not in NETLIST_FLOWS)))
    return proofs


def outcome(proof: Proof, result: dict | None) -> str:
    """proven; simulated, which is none; or failed."""
    if result is None:
        return "FAILED"
    return "simulated" if proof.how in ("simulation", "evaluation") else "proven"


PAGE = PROOFS / "README.md"
TIMES = re.compile(r"(?<=<!-- times: make prove RECORD=1 -->\n\n).*?(?=\n\n<!-- end of times -->)", re.S)


def group(name: str) -> str:
    """A proof's name without what its siblings differ in: adders, sizes, the netlist's design."""
    if name.startswith("netlist."):
        return "netlist.*"
    return re.sub(r"^(adder)\..*|(?:\.(?:ripple|uniform|graded|prefix|structural|behavioural|distance_\d+_to_\d+))(?=\.|$)",
                  lambda match: f"{match[1]}.*" if match[1] else "", name)


def record(proofs: list[Proof], results: list[dict | None]) -> None:
    """Writes into the page what these proofs took; rows of others stay as they are."""
    page = PAGE.read_text()
    old = re.findall(r"^\| `(\S+)` *\| (.*) \|$", TIMES.search(page)[0], re.M)
    rows = {name: [cell.strip() for cell in cells.split("|")] for name, cells in old}
    groups: dict[str, list[tuple[Proof, dict]]] = {}
    for proof, result in zip(proofs, results, strict=True):
        if result and "seconds" in result:
            groups.setdefault(group(proof.name), []).append((proof, result))
    for name, members in groups.items():
        rows[name] = [members[0][0].how, str(len(members)),
                      str(max(result["seconds"] for _, result in members)),
                      str(max(result["megabytes"] for _, result in members))]
    order = list(dict.fromkeys(group(proof.name) for proof in all_proofs()))
    table = tables.markdown(["proofs", "by", "number", "most s", "most MB"], [
        [f"`{name}`", *rows[name]] for name in order if name in rows])
    PAGE.write_text(TIMES.sub(lambda _: table.strip(), page))


def is_kept(proof: Proof) -> bool:
    """Whether an earlier run has left its result, of the RTL and the claims as they are."""
    try:
        return proof.work()[1]
    except store.NotKept:
        return False


def main() -> int:
    """Runs the proofs asked for; 1 where one fails, 2 for what the user can mend."""
    parser = argparse.ArgumentParser(prog="synth.prove", description=__doc__)
    parser.add_argument("names", nargs="*", help="beginnings of proofs' names; all if none")
    parser.add_argument("--quick", action="store_true", help="those alone that `make test` runs")
    parser.add_argument("--long", action="store_true", help="those too that take hours")
    parser.add_argument("--jobs", type=int, default=2, help="at once (%(default)s)")
    parser.add_argument("--record", action="store_true",
                        help="write into the page of proofs what they took")
    parser.add_argument("--kept", action="store_true",
                        help="runs nothing: those alone that an earlier run has left")
    given = parser.parse_args()
    store.only_kept = given.kept
    try:
        chosen = [proof for proof in all_proofs()
                  if (proof.quick or not given.quick) and (given.long or not proof.long)
                  and (not given.names or proof.name.startswith(tuple(given.names)))]
        if given.kept:
            chosen = [proof for proof in chosen if is_kept(proof)]
        if not chosen:
            raise ValueError(f"no proof's name begins with {' or '.join(given.names)}")
        results, failures = runner.run_all(
            [runner.Job(proof.name, proof.work, lambda _: "holds") for proof in chosen], given.jobs)
    except (tools.MissingTool, ValueError) as error:
        print(f"synth: {error}", file=sys.stderr)
        return 2
    print(tables.markdown(["what", "claim", "by", "outcome", "s", "MB"], [
        [proof.name, proof.claim, proof.how, outcome(proof, result),
         (result or {}).get("seconds", ""), (result or {}).get("megabytes", "")]
        for proof, result in zip(chosen, results, strict=True)]))
    for failure in failures:
        print("failed:", failure, file=sys.stderr)
    if given.record:
        record(chosen, results)
    counts = collections.Counter(map(outcome, chosen, results))
    seconds = sum((result or {}).get("seconds", 0) for result in results)
    print(f"\n{counts['proven']} proven, {counts['simulated']} simulated, {counts['FAILED']} failed; "
          f"{seconds:.0f} processor seconds")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
