"""Plots of a stress run."""

import math
import pathlib

import matplotlib

matplotlib.use("Agg")
from matplotlib import colors  # noqa: E402  (after the choice of its back end)
from matplotlib import pyplot as plt  # noqa: E402

# Curves that would lie on one another: the engines have one another's bits.
ENGINE = "cpu"


def wrong_decisions(run: dict, file: pathlib.Path) -> None:
    """How wrong each variant is in each suite; white where it never was."""
    suites = run["suites"]
    others = [(i, v["name"]) for i, v in enumerate(run["variants"]) if not v["exact"]]
    if not others:
        return
    shares = [[s["variants"][i]["wrong"] / max(s["variants"][i]["tests"], 1) for s in suites]
              for i, _ in others]
    figure, axes = plt.subplots(figsize=(11, 6.5), layout="constrained")
    palette = plt.get_cmap("YlOrRd").with_extremes(bad="white")
    image = axes.imshow([[share or math.nan for share in row] for row in shares], aspect="auto",
                        cmap=palette, norm=colors.LogNorm(1e-6, 1))
    for y, row in enumerate(shares):
        for x, share in enumerate(row):
            axes.text(x, y, f"{100 * share:.2g}" if share else "0", ha="center", va="center",
                      fontsize=7, color="white" if share > 0.1 else "black")
    axes.set_xticks(range(len(suites)), [s["name"] for s in suites], rotation=60, ha="right")
    axes.set_yticks(range(len(others)), [name for _, name in others])
    axes.set_title("Wrong decisions, % of tests (the exact engines: 0 everywhere)")
    figure.colorbar(image, label="share of tests")
    figure.savefig(file, dpi=110)
    plt.close(figure)


def error_by_angle(run: dict, file: pathlib.Path) -> None:
    """The 99th percentile of each variant's t, and the largest of the unit's under its bound."""
    figure, axes = plt.subplots(figsize=(10, 5.5), layout="constrained")
    axes.set_prop_cycle(color=plt.get_cmap("tab20").colors)

    def curve(decades: list[dict], key: str) -> tuple[list[float], list[float]]:
        points = [(10 ** -(d + 0.5), e[key]) for d, e in enumerate(decades)
                  if e["count"] > 100 and e[key]]
        return [x for x, _ in points], [y for _, y in points]

    for variant in run["variants"]:
        if variant["exact"] and variant["name"] != ENGINE:
            continue
        decades = variant["total"]["t_ulp_by_angle"]
        name = variant["name"]
        if name == ENGINE:
            axes.loglog(*curve(decades, "max"), "k^", label="the unit, largest")
            name = "the unit"
        axes.loglog(*curve(decades, "p99"), marker=".", label=name,
                    color="black" if variant["exact"] else None,
                    linewidth=2 if variant["exact"] else 1)
    bounds = [b for b in run["bounds"] if b["t_ulp"] is not None]
    axes.loglog([b["sine"] for b in bounds], [b["t_ulp"] for b in bounds], "k--",
                label="the unit, proven bound")
    delivered = next((v["total"]["delivered_t_ulp"]["max"] for v in run["variants"]
                      if v["name"] == ENGINE), None)
    if delivered:
        axes.axhline(delivered, color="black", linestyle=":", label="delivered, largest")
    axes.set_xlabel("sine of the angle between ray and plane (a decade each)")
    axes.set_ylabel("error of t, ulp: 99th percentile")
    figure.legend(loc="outside right upper", fontsize="small")
    axes.grid(True, alpha=0.3)
    figure.savefig(file, dpi=110)
    plt.close(figure)
