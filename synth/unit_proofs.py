"""What is claimed of the units and what they are made of, around arithmetic of which as little is known as
the claim needs (proofs/contracts)."""

import functools
import pathlib
import re

from synth import catalogue, cores, float_proofs
from synth.assertions import PROOFS, Prepare, Proof, holds, opened


def fifo_keeps_order(depth: int, reserve: int) -> tuple[dict, bool]:
    """A FIFO of this size keeps its promises, by induction."""
    return holds("fifo_keeps_order", "Bitwuzla", [catalogue.HW / "common" / "fifo.sv"],
                 opened("fifo", "*_q", f"words {depth} 2", Width=2, Depth=depth, Reserve=reserve),
                 (("Depth", depth), ("Reserve", reserve)), steps=1, reach=depth + 6, name=f"fifo_{depth}")


def ram_fifo_keeps_order(depth: int, reserve: int) -> tuple[dict, bool]:
    """The same of a FIFO in a memory with a clock."""
    return holds("ram_fifo_keeps_order", "Bitwuzla", [catalogue.HW / "common" / f"{name}.sv" for name in ("ram", "ram_fifo")],
                 opened("ram_fifo", "write_q read_q count_q", f"u_words.words {depth} 2", Width=2, Depth=depth, Reserve=reserve),
                 (("Depth", depth), ("Reserve", reserve)), steps=1, reach=depth + 6, name=f"ram_fifo_{depth}")


def nearest_is_kept(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """nearest_hit keeps the nearest hit, by induction."""
    return holds("nearest_hit_keeps_nearest", "Bitwuzla", cores.files("hit_test"), steps=1, reach=5,
                 parameters=(("ExpWidth", exp), ("FracWidth", frac)), name=f"nearest.{name}")


def around(top: str, *names: str) -> list[pathlib.Path]:
    """A unit, with the modules of these files of contracts/ in place of its own."""
    contracts = [PROOFS / "contracts" / f"{name}.sv" for name in names]
    stands_for = re.findall(r"^module (\w+)", "".join(file.read_text() for file in contracts), re.M)
    rtl = [file for file in cores.files("hit_test") if file.stem not in stands_for]
    needed = [file for name in (top, *names) for file in cores.used(name, [*rtl, *contracts])]
    return [file for file in [*rtl, *contracts] if file in {*needed, *contracts}]


def computes(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """The pipelined unit's words go through the cores that they should, by unrolling."""
    inner = " ".join(f"u_nearest.{port}_i" for port in ("valid", "hit", "doubt", "t", "t_error", "payload"))
    inner += " u_point.valid_i u_point.dividends_i u_point.v_i u_point.valid_o u_point.point_o"
    latency = frac // 2 + 16
    return holds("pipeline_computes", "Bitwuzla", around("hit_test_pipeline", "functions"), _opened(exp, frac, 1, inner),
                 (("ExpWidth", exp), ("FracWidth", frac)), steps=latency + 1, reach=latency + 3,
                 beside=("functions", "hit_decision", "delay_line"),
                 name=f"computes.{name}")


def keeps_credits(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """The pipelined unit never overfills its queue, and holds what it offers, by induction."""
    inner = ("test_q decided_q dividing_q report closed u_point.valid_q u_results.push_i "
             "u_results.count_q u_results.read_q u_results.write_q")
    return holds("pipeline_keeps_credits", "Bitwuzla", around("hit_test_pipeline", "hit_test_arithmetic"),
                 _opened(exp, frac, 1, inner), (("ExpWidth", exp), ("FracWidth", frac)), steps=1, name=f"credits.{name}")


def keeps_tags(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """Tests come to their distances in order, with their tags, by induction."""
    inner = "u_nearest.valid_i u_nearest.first_i u_nearest.last_i u_nearest.tag_i"
    latency = frac // 2 + 16
    return holds("pipeline_keeps_tags", "Bitwuzla", around("hit_test_pipeline", "hit_test_arithmetic"),
                 _opened(exp, frac, 2, inner), (("ExpWidth", exp), ("FracWidth", frac)), steps=latency + 1, reach=latency + 3,
                 name=f"tags.{name}")


def queues_results(name: str, exp: int, frac: int) -> tuple[dict, bool]:
    """The pipelined unit's ports are what its queue was given, from any state."""
    inner = " ".join(f"u_nearest.{port}_o" for port in ("report", "report_tag", "closed", "found", "tag", "t",
                                                "t_error"))
    return holds("pipeline_queues_results", "Bitwuzla",
                 around("hit_test_pipeline", "hit_test_arithmetic", "queue_as_wire"),
                 _opened(exp, frac, 2, inner + " u_point.valid_o u_point.point_o"), (("ExpWidth", exp), ("FracWidth", frac)), name=f"queues.{name}")


def array() -> tuple[dict, bool]:
    """An array of four lanes is its lanes, by induction."""
    return holds("array_is_its_lanes", "Bitwuzla", around("hit_test_array", "lane"),
                 opened("hit_test_array", "gen_lane*.given gen_lane*.said gen_lane*.counted counters events_q",
                        Lanes=4, ExpWidth=5, FracWidth=10, TagWidth=2, CounterWidth=6), steps=1, reach=8)


def contexts_answer_once() -> tuple[dict, bool]:
    """A ray that comes into a ray core has a slot of its own and leaves it once, by induction."""
    slots = PROOFS / "contracts" / "ray_contexts.sv"  # and a divider and a queue in place of hw/'s
    rtl = [file for file in cores.files("ray_core") if file.stem not in ("fp_divider", "ram_fifo")]
    return holds("contexts_answer_once", "Bitwuzla", cores.used("ray_contexts", [*rtl, slots]), steps=1, reach=50,
                 prepare=opened("ray_contexts", "*.bits_q u_alloc.free_q u_retire.active_q *dividing_q u_retire.known_q *.count_q "
                 "*u_rays.valid_o *u_rays.space_o *u_inverses.valid_o *u_ends.valid_o *u_ends.space_o"))


def stack_keeps_nodes() -> tuple[dict, bool]:
    """What a ray's stack holds is asked for once, or beyond, by induction: of two rays, with two levels each and two
    shared."""
    wires = ("busy_q waiting_q ready_q picked_q ray_q choosing_q choosing_ray_q level_q t_max_q "
             "ended_q asked_q asking_ray_q asked_level_q mask_q remaining_q next_valid_q next_started_q next_ray_q "
             "next_level_q next_remaining_q next_enter_q base_q offset_q group *.next_q push left "
             "shared_q shared_ray_q refused_q shared_mask_q")
    memories = "levels 2 3 shared_masks 2 7 u_groups.words 6 224 " + " ".join(f"gen_level[{d}].nexts 2 26" for d in range(2))
    return holds("stack_keeps_nodes", "Bitwuzla", cores.used("traversal", cores.files("ray_core")),
                 steps=1, reach=26, prepare=opened("traversal", wires, memories, Rays=2, Depth=2, Levels=4))


def hits_keep_nearest() -> tuple[dict, bool]:
    """closest_hit keeps a ray's nearest hit and tells what may be nearer, by induction: of two rays."""
    wires = ("found_q any_hit_q traversal_ray_q leaf_ray_q box_ray_q is_over_q is_sure_q is_vague_q ray_q tag_q triangle_q t_q t_error_q low_q high_q "
             "old_found_q old_t_max_q old_low_q old_triangle_q replace test_q test_ray_q u_doubts.push_i u_doubts.data_i *.count_q "
             "point_q here_q")
    memories = ("t_max 2 31 nearest_t 2 32 nearest_low 2 32 nearest_error 2 5 nearest_triangle 2 32 u_kept.words 2 96 tests 2 28 "
                "counts 2 5")
    return holds("hits_keep_nearest", "Bitwuzla", cores.used("closest_hit", cores.files("ray_core")),
                 steps=1, reach=8,
                 prepare=opened("closest_hit", wires, memories, Rays=2, Queue=18))


def leaves_are_asked_for() -> tuple[dict, bool]:
    """primitive_fetch asks for the triangles of each group in order, or they are beyond, by induction: of two rays."""
    wires = "valid_q ray_q group_q mask_q number_q u_groups.count_q u_groups.valid_o u_groups.data_o u_groups.read_q u_groups.write_q"
    return holds("leaves_are_asked_for", "Bitwuzla", cores.used("primitive_fetch", cores.files("ray_core")),
                 steps=1, reach=10,
                 prepare=opened("primitive_fetch", wires, "u_groups.u_words.words 2 232", Rays=2))


def cache_answers_once() -> tuple[dict, bool]:
    """line_cache answers each request once, by its line, by induction: of two sets, and two that may wait."""
    wires = ("valid_q pending_q free_q mores_q draining_q current_q target current somebody leaves entry room "
             "u_hits.count_q u_hits.valid_o u_hits.data_o u_hits.read_q u_hits.write_q request_q demand_q ray_q set tag set_tags done "
             "compare_q compare_demand_q compare_ray_q compare_tag_q compare_set_q changed_q changed_way_q changed_tag_q same_q "
             "valid_ways_q pending_ways_q "
             "hit_q hit_ray_q hit_line")
    memories = "u_lines.words 16 2 u_tags.words 2 216 heads 16 2 nexts 2 2 rays 2 1 u_hits.u_words.words 16 3"
    return holds("cache_answers_once", "Bitwuzla", cores.used("line_cache", cores.files("ray_core")),
                 steps=1, reach=10, prepare=opened("line_cache", wires, memories, Lines=16, Targets=2, RayWidth=1, Width=2))


def _watched(cell: str, *checks: str) -> dict:
    """The sources of a proof of a port of hw/ray_core, with modules of sim/checks."""
    watching = [cores.HW.parent / "sim" / "checks" / f"{name}.sv" for name in (*checks, "stream_checks")]
    return {"sources": [*cores.used(cell, cores.files("ray_core")), *watching],
            "beside": tuple(file.stem for file in watching)}


def csr_keeps_protocol() -> tuple[dict, bool]:
    """The registers' port keeps AXI4-Lite, and its plain registers are read as written, by induction."""
    return holds("csr_keeps_protocol", "Bitwuzla", steps=2, reach=8, **_watched("csr", "axi_lite_checks"),
                 prepare=opened("csr", "words address_q data_q write_word_q strobes_q write_data_q"))


def reader_gives_lines() -> tuple[dict, bool]:
    """axi_read_manager keeps AXI4 and gives each read its line, by induction: of two IDs, two beats a line."""
    wires = "free_q id beat_fire beat_id last errors_q u_beats.count_q u_beats.read_q u_beats.write_q"
    memories = "read_ids 2 2 counts 2 1 u_beats.words 2 259 gen_beat[0].u_part.words 2 256"
    return holds("reader_gives_lines", "Bitwuzla", steps=2, reach=12, **_watched("axi_read_manager", "axi_read_checks"),
                 prepare=opened("axi_read_manager", wires, memories, DataWidth=256, IdWidth=1, ReadIdWidth=2))


def writer_puts_records(width: int) -> tuple[dict, bool]:
    """axi_write_manager keeps AXI4 and puts each record in its place, by induction, at this width."""
    return holds("writer_puts_records", "Bitwuzla", parameters=(("DataWidth", width),), steps=2, reach=12,
                 **_watched("axi_write_manager", "axi_write_checks"), name=f"writer_{width}",
                 prepare=opened("axi_write_manager", "next_q left_q record_q", DataWidth=width))


def of_exact(top: str, cell: str, name: str = "", steps: int = 0, reach: int = 0, wires: str = "",
             **parameters: int) -> tuple[dict, bool]:
    """What is claimed of a cell of hw/exact, with these parameters; `wires`: those that are shown."""
    return holds(top, "Bitwuzla", cores.used(cell, cores.files("exact")), opened(cell, wires, **parameters) if wires else None,
                 tuple(parameters.items()), steps, reach, name=name or top)


def of_ray_core(top: str, cell: str, steps: int = 0) -> tuple[dict, bool]:
    """What is claimed of a cell of hw/ray_core."""
    return holds(top, "Bitwuzla", cores.used(cell, cores.files("ray_core")), steps=steps)


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


def _opened(exp: int, frac: int, tag: int, inner: str) -> Prepare:
    return opened("hit_test_pipeline", inner, ExpWidth=exp, FracWidth=frac, TagWidth=tag)


def timetable() -> tuple[dict, bool]:
    """The paper's unit keeps its timetable, by induction."""
    sources = [*(file for file in cores.files("hit_test") if file.stem in ("arith_pkg", "fp_pkg")),
               PROOFS / "contracts" / "fp_cores.sv",
               *(catalogue.HW / "hit_test" / f"{name}.sv" for name in ("hit_test_control", "hit_test_unit"))]
    return holds("timetable", "Bitwuzla", sources, steps=20,
                 prepare=opened("hit_test_unit", "word step clear accumulate load_d divide"))


def serial_computes() -> tuple[dict, bool]:
    """The paper's unit makes its components of a test's words, by unrolling."""
    return holds("unit_computes", "Bitwuzla", around("hit_test_unit", "functions"), steps=12)


def general_computes() -> tuple[dict, bool]:
    """The general unit likewise."""
    return holds("general_unit_computes", "Bitwuzla", around("general_hit_test_unit", "functions"), steps=17)


ALL = [
    *(Proof(f"unit.fifo_{depth}", f"a FIFO of {depth} words, {reserve} kept back: order, counts, stability",
            "Bitwuzla", functools.partial(fifo_keeps_order, depth, reserve))
      for depth, reserve in ((2, 0), (4, 0), (5, 2), (20, 0), (24, 0), (36, 33), (48, 45))),
    *(Proof(f"unit.ram_fifo_{depth}", f"a FIFO of {depth} words in a memory with a clock: order, counts, stability",
            "Bitwuzla", functools.partial(ram_fifo_keeps_order, depth, reserve))
      for depth, reserve in ((2, 0), (5, 2), (16, 1), (25, 0))),
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
    *(Proof(f"unit.queues.{name}", "the pipelined unit's ports are what its queue was given", "Bitwuzla",
            functools.partial(queues_results, name, exp, frac))
      for name, (exp, frac, *_) in float_proofs.FORMATS.items()),
    *(Proof(f"unit.decision.{name}", "no verdict denies exact edge products, if bounds hold", "Bitwuzla",
            functools.partial(decision, name, exp, frac))
      for name, (exp, frac, *_) in float_proofs.FORMATS.items()),
    *(Proof(f"unit.edge_sign.{frac}", f"{frac} bits of fraction: beyond its bound an edge product has "
            "the exact one's sign", "Bitwuzla", functools.partial(edge_sign, frac), False, frac > 4)
      for frac in (3, 4, 5, 6, 7)),
    Proof("unit.timetable", "the unit keeps its timetable, from reset and always", "Bitwuzla", timetable),
    Proof("unit.computes.serial", "the paper's unit makes P of its words, whatever it did before", "Bitwuzla",
          serial_computes, False),
    Proof("unit.computes.general", "the general unit, likewise", "Bitwuzla", general_computes, False),
    Proof("unit.contexts", "a ray in a ray core has a slot of its own, and is answered once, by its tag", "Bitwuzla",
          contexts_answer_once),
    Proof("unit.stack", "a node on a ray's stack is asked for once, unless it is beyond the limit", "Bitwuzla",
          stack_keeps_nodes, False),
    Proof("unit.hits", "a ray's nearest hit is kept, what may be nearer is a doubt, once; tests are counted",
          "Bitwuzla", hits_keep_nearest),
    Proof("unit.leaves", "a leaf's triangles are asked for in order, each once, unless they are beyond the limit",
          "Bitwuzla", leaves_are_asked_for),
    Proof("unit.cache", "a request for a line is answered once, by that line, in whichever order memory answers",
          "Bitwuzla", cache_answers_once, False),
    Proof("unit.csr", "the registers' port keeps AXI4-Lite; a register is read as it was written", "Bitwuzla", csr_keeps_protocol),
    Proof("unit.reader", "the memory port keeps AXI4; each read is given its line, once, in any order of beats", "Bitwuzla",
          reader_gives_lines, False),
    *(Proof(f"unit.writer_{width}", "results: the port keeps AXI4, each record is written in its place, once", "Bitwuzla",
            functools.partial(writer_puts_records, width)) for width in (128, 512)),
    Proof("unit.sort", "seven words come out in order, each as often as it went in", "Bitwuzla",
          functools.partial(of_ray_core, "sort7_sorts", "sort7", 3)),
    Proof("unit.arbiter", "the first request from a place on is picked", "Bitwuzla",
          functools.partial(of_ray_core, "arbiter_is_fair", "rr_arbiter")),
    *(Proof(f"unit.exact_accumulator_{width}", f"sums of {products} products of {width} bits a column, without rounding, and sure only where it may be",
            "Bitwuzla", functools.partial(of_exact, "exact_accumulator_sums", "exact_accumulator", f"exact_accumulator_{width}", 1, 6,
                                          "sum_q", DigitWidth=width, Products=products), width < 48)
      for width, products in ((24, 72), (48, 36))),
    *(Proof(f"unit.exact_product_{width}", f"the product of any two digits of {width} bits, or its negative", "Bitwuzla",
            functools.partial(of_exact, "exact_product_multiplies", "exact_product", f"exact_product_{width}", DigitWidth=width))
      for width in (6, 8)),
    Proof("unit.exact_product_rows", "at 48 bits the words that are added up are the digits' multiples", "Bitwuzla",
          functools.partial(of_exact, "exact_product_rows", "exact_product", wires="gen_booth.rows gen_booth.turned", DigitWidth=48, Width=103)),
    Proof("unit.exact_slice", "digits of shifted significands, of any binary32 number", "Bitwuzla",
          functools.partial(of_exact, "exact_slice_cuts", "exact_slice")),
    Proof("unit.exact_sequencer", "each product of an instruction goes out once, in its column, columns in order", "Bitwuzla",
          functools.partial(of_exact, "exact_sequencer_steps", "exact_sequencer", steps=1, reach=40,
                            wires="*_q terms_last closes ends fire advance", Digits=6)),
    *(Proof(f"unit.exact_exponents_{exp}", f"units and digits of {width} bits hold every number of any request in a format of {exp} bits of "
            f"exponent and {frac} of fraction, and none is needless", "Bitwuzla",
            functools.partial(of_exact, "exact_exponents_fit", "exact_exponents", f"exact_exponents_{exp}", 6, 7,
                              ExpWidth=exp, FracWidth=frac, DigitWidth=width))
      for exp, frac, width in ((3, 2, 6),)),
    Proof("unit.beyond", "words of t are ordered as the numbers that they stand for", "Bitwuzla",
          functools.partial(of_ray_core, "beyond_orders_numbers", "ray_core_pkg")),
    Proof("unit.plane_offset", "ways on a node's grid are products, cut off", "Bitwuzla",
          functools.partial(of_ray_core, "plane_offset_multiplies", "plane_offset", 2)),
    Proof("unit.array", "an array is its lanes, and its counters are their sums", "Bitwuzla", array),
]
