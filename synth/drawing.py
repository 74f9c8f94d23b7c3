"""matplotlib, set up so that the same figures give the same files."""

import pathlib

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "raygate"

import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

__all__ = ["plt", "save"]


def save(figure: plt.Figure, out: pathlib.Path) -> None:
    """Writes OUT.svg and OUT.png."""
    for suffix, metadata in ((".svg", {"Date": None}), (".png", {})):
        figure.savefig(out.with_name(out.name + suffix), metadata=metadata, dpi=120)
    plt.close(figure)
