"""matplotlib, set up so that the same figures give the same files."""

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

__all__ = ["plt"]
