"""matplotlib, set up so that the same figures give the same files."""

import pathlib
import sys

try:
    import matplotlib
except ModuleNotFoundError:
    print("found no matplotlib in this Python, expected it: `.ci/setup synth` installs it, and "
          "build/venv/bin/python3 has it", file=sys.stderr)
    sys.exit(2)

matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "raygate"

import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)
from matplotlib import ticker  # noqa: E402

__all__ = ["plt", "save", "ticker"]


def save(figure: plt.Figure, out: pathlib.Path) -> None:
    """Writes OUT.svg and OUT.png."""
    for suffix, metadata in ((".svg", {"Date": None}), (".png", {})):
        figure.savefig(out.with_name(out.name + suffix), metadata=metadata, dpi=120)
    plt.close(figure)
