"""The paper's three adders under its own delay model, and the best groups under it."""

from synth import catalogue, grading, tables, unit_delay
from synth.catalogue import Design
from synth.grading import Grouping

WIDTH = 48


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
