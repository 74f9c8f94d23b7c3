"""Tests that proofs refute faulty modules. Examples of faults: a wrong wire in an array's lane, a counter that misses events, two exchanged
results, a lost hit."""

import pathlib
import tempfile
import unittest
import unittest.mock

from synth import catalogue, cores, prove, store, tools, unit_proofs

# Faults by the proof that refutes them: the faulty module, and pairs of source text and its replacement.
FAULTS = {
    "array": ("hit_test_array", [
        (".tag_i(tag_i[TagWidth*n +: TagWidth])", ".tag_i(tag_i[0 +: TagWidth])"),
        (".ready_i(ready_i[n])", ".ready_i(ready_i[Lanes-1-n])"),
        ("n < Lanes; n++) begin\n        increment", "n < Lanes-1; n++) begin\n        increment"),
        ("count_q + increment", "count_q | increment")]),
    "queues.binary16": ("hit_test_pipeline", [
        ("assign {report_o, closed_o, found_o", "assign {report_o, found_o, closed_o"),
        ("push   = report != ReportNone | closed", "push   = closed")]),
    "hits": ("closest_hit", [
        ("(low_q <= {1'b0, old_t_max_q})", "(low_q < {1'b0, old_t_max_q})"),
        ("(old_low_q <= high_q)", "(old_low_q < high_q)"),
        ("old_open ? old_triangle_q : triangle_q", "open ? triangle_q : old_triangle_q"),
        ("forward ? low_q : nearest_low", "is_over_q ? low_q : nearest_low"),
        ("(high_q < {1'b0, old_t_max_q})", "(high_q <= {1'b0, old_t_max_q})"),  # of two equally near hits, keeps the later hit
        ("if (test_q && !same) counts", "if (test_q) counts"), ("here_q < CountWidth'(Queue)", "here_q <= CountWidth'(Queue)")]),
    "leaves": ("primitive_fetch", [
        ("<= last ? '0 : number_q + 1'b1", "<= number_q + 1'b1"),
        ("fire & last & (remaining == '0)", "fire & (remaining == '0)"),
        ("triangle_o.valid & triangle_ready_i;", "triangle_o.valid;"),
        ("if (push) leaf_pending_o[box_ray_i] <= 1'b1;", "if (push && !done) leaf_pending_o[box_ray_i] <= 1'b1;")]),
    "cache": ("line_cache", [
        ("some_free & ~(arrive & fill_set == set & follows[fill_way])", "some_free"),
        ("changed_q     <= allocate & (asked_set == set)", "changed_q     <= 1'b0"),
        ("is_changed & (way == WayWidth'(w))", "1'b0"),
        ("if (arrives) begin", "if (arrives && go) begin"),
        ("<= follow & head[TargetWidth]", "<= follow"),
        ("valid_q[fill_entry_i]   <= ~fill_error_i;", "valid_q[fill_entry_i]   <= 1'b1;"),
        (".requests_i(~pending_ways_q)", ".requests_i({Ways{1'b1}})")]),
    "stack": ("traversal", [
        ("& (~full | free);", ";"),
        (" | (level_q == LevelWidth'(Levels))", ""), ("if (free && !full) refused_q <= '0;", "")]),
    "writer_128": ("axi_write_manager", [("(axi_wready_i & axi_wlast_o)", "axi_wready_i"), ("next_q[0], 5'd0}", "1'b0, 5'd0}"),
        ("some_room & address_free", "address_free")]),
    "contexts": ("ray_retire", [
        (".Reserve(1)", ".Reserve(0)"),
        ("known_q <= ending_o;", "known_q <= some;"), ("active_q & ~busy_i", "active_q")]),
    "exact_accumulator_24": ("exact_accumulator", [
        ("& sum_q[DigitWidth-1];", "& sum_q[DigitWidth];"),
        ("$signed(sum_q) >>> DigitWidth", "sum_q >> DigitWidth"),
        ("DigitWidth - 1 + $clog2", "DigitWidth - 3 + $clog2")]),
    "exact_product_6": ("exact_product", [
        ("~row[DigitWidth], row", "row[DigitWidth], row"), ("{DigitWidth{negate_i}}) & Ones", "{DigitWidth{1'b0}}) & Ones"),
        ("Signs | Width'(turned)", "Signs")]),
    "exact_sequencer": ("exact_sequencer", [
        ("(i_q == x_last_q || j_q == '0)", "(i_q == x_last_q)"),
        ("else if (from_i_q != x_last_q) begin", "else if (from_i_q == '0) begin"),
        ("if (start_i | advance) begin\n      term_q", "if (start_i) begin\n      term_q")]),
    "exact_slice": ("exact_slice", [
        ("DigitWidth * k <= MaxShift", "DigitWidth * k < MaxShift - DigitWidth"), ("quotient + 1'b1) ?", "quotient) ?")]),
    "exact_exponents_3": ("exact_exponents", [
        ("lows[2*n] < lows[2*n+1]", "lows[2*n] > lows[2*n+1]"),
        ("v < Other || with_other_i", "v < Other"),
        ("one_shift_o   <= less_q ?", "one_shift_o   <= ~less_q ?"),
        ("bits + 3 > DigitWidth", "bits + 2 > DigitWidth")])}


class ProofsRefuseFaults(unittest.TestCase):
    def refuse(self, module, faults, proof):
        sound = next(catalogue.HW.glob(f"*/{module}.sv"))
        files = cores.files
        work = next(one.work for one in unit_proofs.ALL if one.name == f"unit.{proof}")
        for before, after in faults:
            self.assertEqual(sound.read_text().count(before), 1, before)
            with self.subTest(after), tempfile.TemporaryDirectory() as folder:
                broken = pathlib.Path(folder) / sound.name
                broken.write_text(sound.read_text().replace(before, after))

                def with_fault(core, broken=broken):
                    return [broken if file == sound else file for file in files(core)]

                with (unittest.mock.patch.object(store, "OUT", pathlib.Path(folder)),
                      unittest.mock.patch.object(cores, "files", with_fault),
                      self.assertRaisesRegex(tools.Refuted, r"synth/proofs/\w+\.sv:\d+")):
                    work()


for _proof, (_module, _faults) in FAULTS.items():
    setattr(ProofsRefuseFaults, f"test_{_proof}", lambda self, module=_module, faults=_faults, proof=_proof: self.refuse(module, faults, proof))


class Netlists(unittest.TestCase):
    """Tests which netlists are compared with their RTL."""

    def test_none_that_can_only_fail(self):
        """ABC compares netlists without registers, simulation compares units. Netlists with memories as ports are not compared."""
        names = {proof.name: proof.how for proof in prove.all_proofs() if proof.name.startswith("netlist.")}
        self.assertEqual([name for name in names if name.endswith(".blocks")], [])
        clocked = {f"netlist.{row.design.name}." for row in catalogue.report_rows() if row.design.clock}
        self.assertEqual({how for name, how in names.items() if name.startswith(tuple(clocked))}, {"simulation"})
