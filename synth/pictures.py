"""The pictures beside the report: plots, the unit's block diagram, the worked example's timing."""

import subprocess

from synth import diagram, plots, store, tools, waveform

SAVE_FILE = tools.ROOT / "sim" / "worked_example.gtkw"


def draw(records: list[dict]) -> str:
    """Draws what can be drawn; Markdown that shows it, and says what is missing."""
    lines = [f"![{name}]({name}.svg)\n" for name in plots.draw(records)]
    if tools.installed("dot"):
        diagram.draw("hit_test_unit", store.OUT / "hit_test_unit")
        lines.append("The paper's unit, drawn from the design:\n\n![unit](hit_test_unit.svg)\n")
    else:
        lines.append(f"No block diagram: dot is missing ({tools.TOOLS['dot'][0]}).\n")
    program = tools.ROOT / "build" / "sim" / "worked_example"
    if program.exists():
        trace = store.OUT / "worked_example.vcd"
        subprocess.run([program, "--trace", trace], check=True, stdout=subprocess.DEVNULL)
        waveform.draw(trace, SAVE_FILE, store.OUT / "worked_example")
        lines.append("The worked example, from a simulation trace:\n\n![timing](worked_example.svg)\n")
    else:
        lines.append("No timing diagram: `make example` builds build/sim/worked_example first.\n")
    return "\n".join(lines)
