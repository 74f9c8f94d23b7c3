"""The tables and plots of `make bench`, for bench.md.j2."""

import pathlib
import statistics

from host.lab.peers.peers_report import error_against_time
from host.lab.report import plots, rows as kept
from host.lab.report.bench import frames, median_seconds
from host.lab.report.document import render, table
from host.lab.report.rows import ROOT, scene_name
from host.lab.report.statistics import spread, times

# The axes of the Pareto plots: key of a frame, label.
COSTS = {"clocks": "clocks per frame", "frame_ms": "ms per frame at the clock of synthesis",
         "area": "area, OSU 0.35 um units", "area_time": "area x ms per frame",
         "energy_uj": "uJ per frame in the cores, OSU 0.35 um"}
ERRORS = {"point": "error of P, 99th percentile, ulp of binary32",
          "wrong": "wrong hit decisions per million tests",
          "rmse": "RMSE of the picture, scene-linear"}
# Pictures that differ by less are not shown: their maps are black.
LEAST_FLIP = 0.00005


def decisions_table(mine: list[dict]) -> str:
    """Every variant's decisions, t and P on one scene."""
    return table({"variant": "", "bits": "", "doubts": "", "wrong tests per million": ".0f",
                  "doubts per million": ".0f", "wrong rays": ",", "P, ulp: median": ".3g",
                  "99 %": ".3g", "largest": ".3g", "t, ulp: 99 %": ".3g"},
                 [[f["variant"], f"1+{f['exponent_bits']}+{f['digits'] - 1}",
                   "resolved" if f["doubts"] else "ignored", f["wrong"], f["doubtful"],
                   f["decisions"]["wrong_rays"], *(f["decisions"]["point_ulp"][key] for key in
                                                   ("p50", "p99", "max")),
                   f["decisions"]["t_ulp"]["p99"]] for f in mine])


def costs_table(mine: list[dict]) -> str:
    """Every variant's picture and costs on one scene."""
    return table({"variant": "", "RMSE": ".3g", "PSNR, dB": ".1f", "SSIM": ".4f", "FLIP": ".4f",
                  "clocks": "", "area": ",.0f", "period, ns": ".2f", "ms per frame": ".3f",
                  "area x ms": ".3g", "uJ in the cores": ".3g"},
                 [[f["variant"], *([f["rmse"], f["psnr_db"], f["ssim"], f["flip"]]
                                   if f["differing_pixels"] else [None] * 4),
                   f"{f['clocks']:,.0f}{' *' if f['clocks_modelled'] else ''}", f.get("area"),
                   f.get("period_ns"), f.get("frame_ms"), f.get("area_time"),
                   f.get("energy_uj")] for f in mine])


def variants(rows: list[dict], folder: pathlib.Path) -> dict:
    """Tables by scene, Pareto plots of the first one, and where pictures differ."""
    found = frames(rows)
    scenes = {}
    for frame in found:
        scenes.setdefault(frame["scene"], []).append(frame)
    first = found[0]["scene"]
    pareto = []
    for error, label in ERRORS.items():
        points = [{**frame, "name": frame["variant"], "error": frame[error]}
                  for frame in scenes[first]]
        known = {cost: text for cost, text in COSTS.items()
                 if sum(bool(point.get(cost)) for point in points) > 1}
        pareto.append((plots.pareto(points, known, label, f"{first}: {label}",
                                    folder / f"pareto-{error}.png"), label))
    differences = []
    for scene, mine in scenes.items():
        shown = [(f"{frame['variant']}: FLIP {frame['flip']:.4f}", ROOT / frame["map"])
                 for frame in mine if frame["flip"] >= LEAST_FLIP]
        if shown:
            differences.append((plots.gallery(shown, folder / f"differences-{scene}.png"), scene))
    return {"size": found[0], "first": first, "pareto": pareto, "differences": differences,
            "scenes": [{"name": scene, "light": mine[0], "decisions": decisions_table(mine),
                        "costs": costs_table(mine)} for scene, mine in scenes.items()]}


def points(rows: list[dict]) -> str:
    """The picture as P of fewer digits makes it, guarded and as it comes."""
    digits = {row["variant"]: row["digits"] for row in kept.of(rows, "variants")}
    mine = [row for row in kept.of(rows, "pictures", section="points") if row.get("against")]
    cells = []
    for unguarded in (row for row in mine if row["point_error"] < 0):
        (guarded,) = (row for row in mine if row["point_error"] >= 0 and all(
            row[key] == unguarded[key] for key in ("scene", "variant")))
        cells.append([scene_name(unguarded), unguarded["variant"], digits[unguarded["variant"]],
                      guarded["point_doubts"], unguarded["point_doubts"], guarded["rmse"],
                      unguarded["rmse"], guarded["flip"], unguarded["flip"]])
    return table({"scene": "", "variant": "", "digits of P": "d", "P by the host, guarded": ",",
                  "P by the host, inf": ",", "RMSE, guarded": ".3g", "RMSE, inf": ".3g",
                  "FLIP, guarded": ".5f", "FLIP, inf": ".5f"}, cells)


def samples(rows: list[dict], folder: pathlib.Path) -> dict:
    """Error of path tracing by samples."""
    every = kept.of(rows, "pictures", section="samples")
    mine = [row for row in every if row.get("against")]
    file, laws = plots.scaling(
        {name: [(row["samples"], row[key]) for row in mine]
         for name, key in (("RMSE", "rmse"), ("FLIP", "flip"))},
        "samples per pixel", "error", "Path tracing, Cornell box", folder / "samples.png")
    shown = [(f"{row['samples']} samples: RMSE {row['rmse']:.3f}",
              ROOT / f"{row['picture']}.png") for row in mine[::2]]
    scenes = [row["scene"] for row in kept.of(rows, "references")]
    return {"reference": max(every, key=lambda row: row["samples"]), "plot": file, "laws": laws,
            "races": [(error_against_time(rows, scene, folder / f"race-{scene}.png"), scene) for scene in scenes],
            "table": table({"samples": ",", "seconds": ".3g", "rays": ",", "RMSE": ".3g",
                            "PSNR, dB": ".1f", "SSIM": ".4f", "FLIP": ".4f"},
                           [[row["samples"], median_seconds(row), row["rays"], row["rmse"],
                             row["psnr_db"], row["ssim"], row["flip"]] for row in mine]),
            "gallery": plots.gallery(shown, folder / "samples-gallery.png")}


def checks(rows: list[dict]) -> str:
    """The reference models against the hardware."""
    keys = ("tests", "misses", "hits", "doubts", "near_ties")
    return table({"variant": "", **{key.replace("_", " "): "," for key in keys}, "differences": ""},
                 [[row["variant"], *(row[key] for key in keys), row["difference"]]
                  for row in kept.of(rows, "checks")])


def engines(rows: list[dict]) -> str:
    """Times of the renderer's engines."""
    return table({"scene": "", "triangles": ",", "unit": "", "engine": "", "seconds": ".4g",
                  "spread, %": ".1f", "rays/s": ",.0f", "tests per ray": ".2f",
                  "unit's tests/s": ",.0f", "clocks per test": ".2f"},
                 [[scene_name(row), row["triangles"], row["variant"], row["engine"],
                   median_seconds(row), 100 * spread(times(row)), row["rays"] / median_seconds(row),
                   row["tests"] / row["rays"],
                   row["unit_tests"] / row["thread_seconds"]["hit_tests"]
                   if row["unit_tests"] else None,
                   row["clocks"] / row["unit_tests"] if row["clocks"] else None]
                  for row in kept.of(rows, "pictures", section="engines")])


def lanes(rows: list[dict], folder: pathlib.Path) -> dict:
    """Clocks by lanes; 16 is modelled by the power law of the others."""
    mine = kept.of(rows, "pictures", section="lanes", variant="binary32")
    file, laws = plots.scaling({"clocks per frame": [(row["lanes"], row["clocks"]) for row in mine]},
                               "lanes", "clocks", "Clocks by lanes, paper's scene",
                               folder / "lanes.png")
    (law,) = laws.values()
    cells = [[row["lanes"], row["clocks"], "simulated",
              row["clocks"] * row["lanes"] / row["unit_tests"], median_seconds(row)]
             for row in mine]
    return {"row": mine[0], "plot": file, "law": law, "table": table(
        {"lanes": "d", "clocks per frame": ",.0f", "known by": "", "lane clocks per test": ".3f",
         "simulation, s": ".3g"}, [*cells, [16, law.at(16), "power law", None, None]])}


def scaling(rows: list[dict], folder: pathlib.Path) -> list[dict]:
    """Time by triangles, pixels and threads, with exponents."""
    found = []
    for section, axis, x_of in [
            ("triangles", "triangles", lambda row: row["triangles"]),
            ("sizes", "pixels", lambda row: row["width"] * row["height"]),
            ("threads", "threads", lambda row: row["threads"])]:
        mine = kept.of(rows, "pictures", section=section)
        series = {"seconds": [(x_of(row), median_seconds(row)) for row in mine]}
        if section == "triangles":
            series["hit tests per ray"] = [(x_of(row), row["tests"] / row["rays"]) for row in mine]
        file, laws = plots.scaling(series, axis, ", ".join(series), f"By {axis}",
                                   folder / f"scaling-{section}.png")
        found.append({"axis": axis, "plot": file, "laws": laws, "table": table(
            {axis: ",", "seconds": ".4g", "spread, %": ".1f", "hit tests per ray": ".2f"},
            [[x_of(row), statistics.median(times(row)), 100 * spread(times(row)),
              row["tests"] / row["rays"]] for row in mine])})
    return found


def simulation(rows: list[dict]) -> str:
    """Speed and instructions of the simulation."""
    return table({"unit": "", "arithmetic": "", "lanes": "", "hits, %": ".1f", "tests/s": ",.0f",
                  "instructions per test": ",.0f"},
                 [[row["unit"], row["arithmetic"], row["lanes"], float(row["hits_percent"]),
                   int(row["tests_per_second"]),
                   int(row["instructions"]) if row["instructions"] else None]
                  for row in kept.of(rows, "simulation")])


def claims(rows: list[dict]) -> str:
    """The paper's."""
    return table({"claim": "", "the paper": "", "measured": "", "command": ""},
                 [[row["claim"], row["paper"], row["measured"], f"`{row['command']}`"]
                  for row in kept.of(rows, "claims")])


def build(rows: list[dict], folder: pathlib.Path) -> str:
    """The report in Markdown; draws the plots into `folder`."""
    (machine,) = kept.of(rows, "machine")
    return render("bench.md.j2", folder, machine=machine, variants=variants(rows, folder),
                  points=points(rows), samples=samples(rows, folder), checks=checks(rows), claims=claims(rows),
                  engines=engines(rows), simulation=simulation(rows), lanes=lanes(rows, folder),
                  scaling=scaling(rows, folder), columns=kept.COLUMNS,
                  example=kept.of(rows, "pictures")[0]["command"],
                  facts=table({"what": "", "which": ""}, [
                      [key.replace("_", " "), str(value)] for key, value in machine.items()
                      if key != "table"]))
