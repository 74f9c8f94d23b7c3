"""The paper's three adders under its own delay model, and the search for better groups."""

import concurrent.futures
import sys
from collections.abc import Callable

from synth import catalogue, final_adder, grading, mapping, store, tables, tools, unit_delay
from synth.catalogue import Design, Library
from synth.grading import Grouping
from synth.measure import Targets

WIDTH = 48

# (library, flow, groups by look-ahead): where group widths are searched for.
SEARCHES = [
    ("osu035", "cells", False),
    ("osu035", "kept", True),
    ("osu035", "fast", False),
    ("osu018", "fast", False),
]


def text_of(groups: Grouping) -> str:
    """Widths, least significant first."""
    return ", ".join(map(str, groups))


def graded(groups: Grouping, look_ahead: bool, width: int = WIDTH) -> Design:
    """A carry-select adder of these groups."""
    return catalogue.design("adder", adder="graded", widths=list(groups), look_ahead=look_ahead,
                            Width=width)


def model_table() -> str:
    """The adders' delays under each counting, beside the paper's, and the best there is."""
    optimum = grading.best_by_model(WIDTH, unit_delay.COUNTINGS[1])[1]
    rows = []
    for name, design, paper in [
            ("ripple", catalogue.design("adder", adder="ripple", Width=WIDTH), "48"),
            *((f"uniform, {WIDTH // size} groups of {size}",
               graded((size,) * (WIDTH // size), False), "14")
              for size in (3, 4, 6, 8, 12)),
            ("graded, the core's own groups",
             catalogue.design("adder", adder="graded", look_ahead=False, Width=WIDTH), "10"),
            (f"graded, {text_of(optimum)}", graded(optimum, False), "10")]:
        module = unit_delay.netlist(design)
        hardware = unit_delay.cells(module)
        delays = [unit_delay.count(module, counting)["delay"] for counting in unit_delay.COUNTINGS]
        rows.append([name, paper, *(f"{delay:g}" for delay in delays),
                     hardware["full_adder"], hardware["multiplexer"]])
    best = [grading.best_by_model(WIDTH, counting) for counting in unit_delay.COUNTINGS]
    for (delay, groups), counting in zip(best, unit_delay.COUNTINGS, strict=True):
        counted = unit_delay.count(unit_delay.netlist(graded(groups, False)), counting)["delay"]
        if counted != delay:
            raise AssertionError(f"the search says {delay}, the netlist of {groups} {counted}")
    rows.append(["least of all groupings", "-", *(f"{delay:g}" for delay, _ in best), "-", "-"])
    header = [f"{WIDTH}-bit adder", "paper",
              *(counting.title for counting in unit_delay.COUNTINGS), "full adders", "multiplexers"]
    return tables.markdown(header, rows)


def search(make: Callable[[Grouping], Design], seeds: list[Grouping], library: Library, flow: str,
           budget: int, workers: int) -> dict:
    """The fastest grouping found for one library and flow, and every one that was measured.

    `make`: the design that has these groups; `seeds`: where to begin.
    """
    folder = store.OUT / "search"

    def one(groups: Grouping) -> tuple[float, float]:
        try:
            result, _ = mapping.synthesise(make(groups), library, flow, folder)
        except tools.ToolFailed:
            return float("inf"), float("inf")
        return result["delay_ns"], result["area"]

    def measure(groupings: list[Grouping]) -> list[tuple[float, float]]:
        with concurrent.futures.ThreadPoolExecutor(workers) as pool:
            return list(pool.map(one, groupings))

    best, known = grading.best_by_measurement(seeds, budget, measure)
    return {"groups": list(best), "delay_ns": known[best][0], "area": known[best][1],
            "tried": [[list(groups), *figures] for groups, figures in known.items()]}


def adder_seeds(width: int = WIDTH) -> list[Grouping]:
    """The best groupings under models whose multiplexers cost half to three full-adder delays."""
    seeds = [grading.best_by_model(width, unit_delay.Counting("", "", cost, cost))[1]
             for cost in (0.5, 1, 1.5, 2, 2.5, 3)]
    return seeds + [groups for groups in ((4, 5, 7, 9, 11, 12), (8,) * 6) if sum(groups) == width]


def search_table(targets: Targets, budget: int) -> str:
    """The best groups of the 48-bit adder, alone and behind the multiplier's tree."""
    rows = []

    def add(what: str, library: Library, flow: str, look_ahead: bool, best: dict) -> None:
        rows.append([what, library.title, flow, "look-ahead" if look_ahead else "ripple",
                     text_of(best["groups"]), f"{best['area']:,}", f"{best['delay_ns']:.3f}",
                     len(best["tried"])])
        print("best groups:", *rows[-1], file=sys.stderr, flush=True)

    for name, flow, look_ahead in SEARCHES:
        if name in targets.names:
            library = catalogue.library(name)
            add("adder alone", library, flow, look_ahead, search(
                lambda groups, ahead=look_ahead: graded(groups, ahead), adder_seeds(),
                library, flow, budget, targets.workers))
    if "osu035" in targets.names:
        library = catalogue.library("osu035")
        add("24 x 24 multiplier's last adder", library, "fast", False, search(
            lambda groups: final_adder.multiplier(groups, False), final_adder.seeds(library, "fast"),
            library, "fast", budget, targets.workers))
    return tables.markdown(["adder", "library", "flow", "groups add by", "widths, lowest first", "area",
                            "ns", "tried"], rows)
