"""`python3 -m synth.prove`: proves the adders, the multiplier, the float cores and the units, and compares
netlists with the RTL that they were made of. Each proof is one command on the RTL itself."""

import argparse
import collections
import csv
import functools
import re
import sys

from synth import catalogue, cores, float_cuts, float_proofs, float_specifications, netlists, runner, store, tables, tools, unit_proofs, yosys
from synth.assertions import PROOFS, Prepare, Proof, holds, rtl
from synth.catalogue import LIBRARIES, Design

NETLIST_FLOWS = ("fast", "area")  # flows whose netlists are compared without --long, too


def adds(design: Design) -> tuple[dict, bool]:
    """Proves by SAT that an adder of any kind and grouping adds."""
    return holds("adder_adds", parameters=design.parameters, name=f"adds.{design.name}")


def booth_assembly(**parameters: object) -> Prepare:
    """Returns a Prepare that makes module "assembly", the part of booth_multiplier between the recoded digits and the tree. Its inputs are
    the signs of the digits and the partial products (rows). Its output is the words that the tree adds."""
    return lambda sources: f"""{yosys.read(sources, "booth_multiplier", parameters.items())}
rename -top assembly
expose -input assembly/w:negative assembly/w:gen_row*.row
delete assembly/u_encoder assembly/u_tree assembly/u_adder assembly/gen_row*.u_row
delete -port assembly/w:a_i assembly/w:b_i assembly/w:product_o
expose assembly/w:rows
opt_clean -purge assembly"""


def every_product(width: int) -> tuple[dict, bool]:
    """Checks the product of every pair of `width`-bit operands in the Verilated multiplier. Raises Refuted for a wrong product."""
    folder = store.OUT / "proofs" / f"every_product_{width}"
    harness = PROOFS / "booth_exhaustive.cpp"
    sources = cores.used("booth_multiplier", rtl("arith"))
    wanted = store.key([*sources, harness], tools.version("verilator"), width)

    def work() -> dict:
        tools.run(["verilator", "--cc", "--exe", "--build", "-O3", "--no-timing", "-MAKEFLAGS",
                   "OPT_FAST=-O3", "-CFLAGS", f"-DWIDTH={width}", f"-GWidth={width}",
                   "--top-module", "booth_multiplier", "--Mdir", folder / "obj",
                   *sources, harness, "-o", "exhaustive"], folder / "build.log")
        try:
            tools.run([str(folder / "obj" / "exhaustive")], folder / "run.log")
        except tools.ToolFailed as error:
            found = re.search(r"(\d+) \* (\d+) gave (\d+)", str(error))
            values = dict(zip(("a", "b", "product"), map(int, found.groups()))) if found else {}
            raise tools.Refuted(f"every product of {width} bits", {
                name: f"{value:0{2 * width if name == 'product' else width}b}" for name, value in values.items()}) from error
        return {"holds": True}

    return store.proven(folder, wanted, work)


def all_proofs() -> list[Proof]:
    """Returns all proofs, in the order of the report."""
    proofs = [
        Proof(f"adder.{name}", "carry, sum = a + b + carry at 48 bits", "SAT",
              functools.partial(adds, catalogue.design("adder", f"adder-{name}", kind, widths,
                                                       look_ahead, Width=48)))
        for name, kind, widths, look_ahead in catalogue.ADDERS if kind != catalogue.BEHAVIOURAL]
    contracts = PROOFS / "contracts"
    booth = cores.used("booth_multiplier", rtl("arith"))
    package = [file for file in rtl("arith") if file.stem == "arith_pkg"]
    tree = [*package, contracts / "carry_save_adder.sv", catalogue.HW / "arith" / "carry_save_tree.sv"]
    proofs += [
        Proof("booth.digits", "24 bits, step 1: the digits add up to b", "SAT",
              lambda: holds("booth_digits")),
        Proof("booth.row", "step 2: a row is its digit times a", "SAT",
              lambda: holds("booth_row_multiple")),
        Proof("booth.assembly", "step 3: the tree's 13 words are the rows, constants cancel", "SAT",
              lambda: holds("booth_assembly_sums", sources=booth, prepare=booth_assembly(Width=24))),
        Proof("booth.assembly_14", "step 3, with the paper's 14th row", "SAT",
              lambda: holds("booth_assembly_sums", sources=booth, name="booth_assembly_14",
                            prepare=booth_assembly(Width=24, ConstantRow="1'b1"), parameters=(("Words", 14),))),
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
    ]
    proofs += unit_proofs.ALL
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
    proofs += [Proof(f"float.specification.{one.name}", f"as MPFR, {float_specifications.VECTORS:,} times",
                     "evaluation", functools.partial(float_specifications.agrees_with_mpfr, one), False)
               for one in float_specifications.SPECIFICATIONS]
    # The netlist of the pipelined unit is compared in binary16: in binary32 it has a hundred thousand cells, and Verilator takes an hour.
    narrow = catalogue.design("hit_test_pipeline", ExpWidth=5, FracWidth=10)
    # Flow `blocks` turns memories into ports, so netlists of this flow cannot be compared with the RTL.
    rows = [row for row in catalogue.report_rows() if row.design.top != narrow.top and "blocks" not in row.flows["osu035"]]
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
    """Returns "proven", "simulated" (no proof) or "FAILED"."""
    if result is None:
        return "FAILED"
    return "simulated" if proof.how in ("simulation", "evaluation") else "proven"


TABLE = PROOFS / "proofs.csv"
COLUMNS = ["proofs", "claim", "by", "number", "most s", "most MB"]


def group(name: str) -> str:
    """Returns the name of a proof's group: the proof's name without the kind of adder or arithmetic, or "netlist.*"."""
    if name.startswith("netlist."):
        return "netlist.*"
    return re.sub(r"^(adder)\..*|(?:\.(?:ripple|uniform|graded|prefix|structural|behavioural))(?=\.|$)",
                  lambda match: f"{match[1]}.*" if match[1] else "", name)


def record(proofs: list[Proof], results: list[dict | None]) -> None:
    """Writes claims and costs of `proofs` into TABLE, one row per group. Rows of other groups remain unchanged."""
    rows = {row["proofs"]: row for row in csv.DictReader(TABLE.read_text().splitlines())}
    groups: dict[str, list[tuple[Proof, dict]]] = {}
    for proof, result in zip(proofs, results, strict=True):
        if result and "seconds" in result:
            groups.setdefault(group(proof.name), []).append((proof, result))
    for name, members in groups.items():
        rows[name] = dict(zip(COLUMNS, [name, members[0][0].claim, members[0][0].how, len(members), max(result["seconds"] for _, result in members),
                                        max(result["megabytes"] for _, result in members)], strict=True))
    order = list(dict.fromkeys(group(proof.name) for proof in all_proofs()))
    TABLE.write_text(tables.comma_separated([rows[name] for name in order if name in rows], COLUMNS))


def is_kept(proof: Proof) -> bool:
    """Returns whether an earlier run has kept the result for the present RTL and claim."""
    try:
        return proof.work()[1]
    except store.NotKept:
        return False


def main() -> int:
    """Runs the selected proofs. Returns 1 if a proof fails, 2 for errors that the user can correct."""
    parser = argparse.ArgumentParser(prog="synth.prove", description=__doc__)
    parser.add_argument("names", nargs="*", help="beginnings of proofs' names; all if none")
    parser.add_argument("--quick", action="store_true", help="those alone that `make test` runs")
    parser.add_argument("--long", action="store_true", help="those too that take hours")
    parser.add_argument("--jobs", type=int, default=2, help="at once (%(default)s)")
    parser.add_argument("--publish", action="store_true",
                        help="write what they took into proofs/proofs.csv")
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
    if given.publish:
        record(chosen, results)
    counts = collections.Counter(map(outcome, chosen, results))
    seconds = sum((result or {}).get("seconds", 0) for result in results)
    print(f"\n{counts['proven']} proven, {counts['simulated']} simulated, {counts['FAILED']} failed; "
          f"{seconds:.0f} processor seconds")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
