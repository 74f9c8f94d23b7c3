"""The multiplier's last adder: when the bits of its operands come, and the groups that suit them."""

import dataclasses

from synth import catalogue, grading, mapping, tables, unit_delay
from synth.catalogue import Design, Library
from synth.grading import Grouping
from synth.unit_delay import Counting

WIDTH = 24  # of the factors; the adder has twice as many bits
CORES_OWN = (3, 5, 6, 7, 8, 9, 10)  # arith_pkg's groups of 48 bits


def multiplier(groups: Grouping | None, look_ahead: bool) -> Design:
    """The Booth multiplier with these groups in its last adder (none: the core's own)."""
    return catalogue.design("booth_multiplier", adder="graded", widths=list(groups or ()),
                            look_ahead=look_ahead, Width=WIDTH)


def tree() -> Design:
    """The Booth multiplier without its last adder, whose operands become outputs."""
    whole = catalogue.design("booth_multiplier", "booth-tree", "graded", Width=WIDTH)
    return dataclasses.replace(whole, cut="u_adder")


def _later(one: list[float], other: list[float]) -> list[float]:
    return [max(pair) for pair in zip(one, other, strict=True)]


def counted_arrivals() -> list[float]:
    """When bit i of both operands is there, in full-adder delays, on the elaborated netlist."""
    module = unit_delay.netlist(tree())
    counting = Counting("", "", 1, 1)  # the tree has no multiplexers
    return _later(*(unit_delay.count(module, counting, f"u_adder.{port}_i")["arrivals"]
                    for port in "ab"))


def measured_arrivals(library: Library, flow: str) -> list[float]:
    """The same in ns, as OpenSTA times the mapped tree."""
    got, _ = mapping.synthesise(tree(), library, flow)
    return _later(*([got["ends"].get(f"u_adder.{port}_i[{bit}]", 0.0)
                     for bit in range(2 * WIDTH)] for port in "ab"))


def seeds(library: Library, flow: str) -> list[Grouping]:
    """The best groupings for the tree's measured arrivals, under models of several full-adder and
    multiplexer delays (nobody knows what ABC makes of either)."""
    arrivals = measured_arrivals(library, flow)
    found = [grading.best_by_model(2 * WIDTH, Counting("", "", cost, cost),
                                   [time / full_adder for time in arrivals])[1]
             for full_adder in (0.15, 0.25, 0.35) for cost in (1, 2)]
    return list(dict.fromkeys([CORES_OWN, *found]))


def table(targets: tuple[str, ...]) -> str:
    """When the operands' bits come, and what grading for that is worth under the delay model."""
    counted = counted_arrivals()
    header, columns = ["full-adder delays"], [counted]
    if "osu035" in targets:
        header.append("OSU 0.35 um, fast, ns")
        columns.append(measured_arrivals(catalogue.library("osu035"), "fast"))
    bits = [*range(0, 12), *range(12, 2 * WIDTH, 5)]
    profile = tables.markdown(["bit", *header], [[bit, *(f"{column[bit]:.4g}" for column in columns)]
                                                 for bit in bits])
    rows = []
    for counting in unit_delay.COUNTINGS[:2]:
        for name, arrivals in (("all bits at once", None), ("as the tree's bits come", counted)):
            _, groups = grading.best_by_model(2 * WIDTH, counting, arrivals)
            whole = unit_delay.count(unit_delay.netlist(multiplier(groups, False)), counting,
                                     "product_o")["delay"]
            rows.append([counting.title, name, ", ".join(map(str, groups)), f"{whole:g}"])
    best = tables.markdown(["counting", "graded for", "best groups", "multiplier's delays"], rows)
    return f"When the later of the two operands' bits is there:\n\n{profile}\n{best}"
