"""The report's text, tables and plots."""

import pathlib

from host.lab.matrix import derive, plots, runs, statistics
from host.lab.matrix.derive import times
from host.lab.matrix.document import Block, Figure, Heading, Table, Text

# The axes of the Pareto plots: key of a frame, label.
COSTS = [("clocks", "clocks a frame"), ("frame_ms", "ms a frame at the achievable clock"),
         ("area", "area, OSU 0.35 um units"), ("area_time", "area x ms a frame")]
ERRORS = [("point", "error of P, 99th percentile, ulp of binary32"),
          ("wrong", "wrong hit decisions, per million"), ("rmse", "RMSE of the picture, linear")]


def number(value: float | None, form: str = ".3g") -> str:
    """A figure, or a dash where there is none."""
    return "-" if value is None else format(value, form)


def seconds(row: dict) -> str:
    """A median and its spread."""
    values = times(row)
    middle = f"{statistics.median(values):.4g}"
    return middle if len(values) < 2 else f"{middle} ± {100 * statistics.spread(values):.1f} %"


def error_of(frame: dict, which: str) -> float | None:
    """One of ERRORS."""
    match which:
        case "point":
            return frame["point_ulp"]["p99"]
        case "wrong":
            return derive.wrong_per_million(frame)
        case _:
            return frame["image"]["rmse"] if frame["image"] else None


def variants_table(frames: list[dict]) -> Table:
    """Every variant's errors and costs on one scene."""
    rows = []
    for frame in frames:
        variant, image = frame["variant"], frame["image"]
        point = frame["point_ulp"]
        rows.append([
            variant["name"], f"1+{variant['exponent_bits']}+{variant['digits'] - 1}",
            "resolved" if variant["doubts"] else "ignored",
            f"{derive.wrong_per_million(frame):.0f}",
            f"{1e6 * frame['doubts'] / max(frame['tests'], 1):.0f}",
            f"{frame['wrong_rays']:,}",
            " / ".join(number(point[key]) for key in ("p50", "p99", "max")),
            number(frame["t_ulp"]["p99"]),
            *([number(image["rmse"]), number(image["psnr"], ".1f"), number(image["ssim"], ".4f"),
               number(image["flip"], ".4f")] if image and image["differing"] else ["-"] * 4),
            number(frame["clocks"], ",.0f") + (" *" if frame["clocks_modelled"] else ""),
            number(frame.get("area"), ",.0f"), number(frame.get("period_ns"), ".2f"),
            number(frame.get("frame_ms"), ".3f"), number(frame.get("area_time"), ".3g")])
    return Table(["variant", "bits", "doubts", "wrong tests per million", "doubts per million",
                  "wrong rays", "P, ulp: median / p99 / max", "t, ulp: p99", "RMSE", "PSNR, dB",
                  "SSIM", "FLIP", "clocks", "area", "period, ns", "ms a frame", "area x ms"], rows)


def variants_section(results: dict, folder: pathlib.Path) -> list[Block]:
    """Tables, Pareto plots and difference pictures of the arithmetic."""
    frames = derive.frames(results["rows"], results["variants"], results["synthesis"])
    scenes = list(dict.fromkeys(frame["scene"] for frame in frames))
    size = frames[0]["row"]
    light = "; ".join(f"{frame['scene']}: {frame['row']['integrator']}, {frame['row']['samples']} "
                      "samples a pixel" for frame in frames if frame["variant"]["name"] == "binary32")
    blocks: list[Block] = [Heading(2, "Arithmetic"), Text(
        f"Pictures of {size['width']} x {size['height']} ({light}). **Wrong tests**: a camera ray "
        "against a polygon, decided otherwise than exact arithmetic does. **Wrong rays**: their first polygon is "
        "another. **P** and **t** in units of binary32's last place, over the rays that are not "
        "wrong. RMSE and PSNR (peak 1) are of scene-linear colour, SSIM and FLIP (its mean) of "
        "what a display shows; a dash: no difference at all. **Clocks**: the frame's tests times the clocks a test of the variant's "
        "own simulation; with a star: no hardware takes its parameters, binary32's rate is "
        "used. **Area, period**: what `make synth` measured, OSU 0.35 um, cells alone.")]
    for scene in scenes:
        mine = [frame for frame in frames if frame["scene"] == scene]
        blocks += [Heading(3, f"Scene {scene}"), variants_table(mine)]
    blocks += pareto_plots([frame for frame in frames if frame["scene"] == scenes[0]], folder)
    blocks += difference_pictures(frames, folder)
    return blocks


def pareto_plots(frames: list[dict], folder: pathlib.Path) -> list[Block]:
    """A plot for each cost and error of which two points or more are known."""
    blocks: list[Block] = [Heading(3, "What accuracy costs")]
    for cost, cost_label in COSTS:
        for error, error_label in ERRORS:
            points = [{"name": frame["variant"]["name"], "unit": frame["variant"]["unit"],
                       "doubts": frame["variant"]["doubts"], "x": frame[cost],
                       "y": error_of(frame, error)} for frame in frames
                      if frame.get(cost) and error_of(frame, error) is not None]
            if len(points) < 2:
                continue
            title = f"{frames[0]['scene']}: {error_label}"
            file = plots.pareto(points, cost_label, error_label, title,
                                folder / f"pareto-{error}-{cost}.svg")
            blocks.append(Figure(file, f"{error_label} against {cost_label}; scene "
                                       f"{frames[0]['scene']}, section `variants` of the raw data."))
    return blocks


def difference_pictures(frames: list[dict], folder: pathlib.Path) -> list[Block]:
    """FLIP maps of what differs at all."""
    blocks: list[Block] = []
    for scene in dict.fromkeys(frame["scene"] for frame in frames):
        shown = [(f"{frame['variant']['name']}: FLIP {frame['image']['flip']:.4f}",
                  runs.ROOT / frame["image"]["map"])
                 for frame in frames if frame["scene"] == scene and frame["image"]
                 and frame["image"]["differing"]]
        if shown:
            blocks.append(Figure(plots.gallery(shown, folder / f"differences-{scene}.png"),
                                 f"Where the pictures of {scene} differ from binary32's (FLIP; black: "
                                 "not at all)."))
    return [Heading(3, "Where the pictures differ"), *blocks] if blocks else []


def samples_section(rows: list[dict], folder: pathlib.Path) -> list[Block]:
    """Error of path tracing by samples."""
    mine = [row for row in rows if row["section"] == "samples" and row.get("image")]
    if not mine:
        return []
    reference = max((row for row in rows if row["section"] == "samples"),
                    key=lambda row: row["samples"])
    series = {"RMSE": [(row["samples"], row["image"]["rmse"]) for row in mine],
              "FLIP": [(row["samples"], row["image"]["flip"]) for row in mine]}
    file, laws = plots.scaling(series, "samples a pixel", "error", "Path tracing, Cornell box",
                               folder / "samples.svg")
    shown = [(f"{row['samples']} samples: RMSE {row['image']['rmse']:.3f}",
              runs.ROOT / f"{row['picture']}.png") for row in mine[::2]]
    return [Heading(2, "Samples"), Text(
        f"`{reference['scene']}`, {reference['width']} x {reference['height']}, path traced, against "
        f"{reference['samples']} samples of another seed."),
        Table(["samples", "seconds", "rays", "RMSE", "PSNR, dB", "SSIM", "FLIP"],
              [[str(row["samples"]), seconds(row), f"{row['rays']:,}", number(row["image"]["rmse"]),
                number(row["image"]["psnr"], ".1f"), number(row["image"]["ssim"], ".4f"),
                number(row["image"]["flip"], ".4f")] for row in mine]),
        Figure(file, "; ".join(f"{name} goes as samples to the power {law.exponent:.2f} ± "
                               f"{law.exponent_error:.2f}" for name, law in laws.items())
               + " (RMSE of independent samples: -1/2)."),
        Figure(plots.gallery(shown, folder / "samples-gallery.png"), "What they look like.")]


def checks_section(checks: list[dict]) -> list[Block]:
    """The twins against the hardware."""
    rows = [[check["variant"], f"{check['tests']:,}",
             *(f"{check[key]:,}" for key in ("misses", "hits", "doubts", "near_ties")),
             check["difference"] or "none"] for check in checks]
    return [Heading(2, "Is the C++ twin the hardware?"), Text(
        "Each variant that the hardware has parameters for is Verilated with them and run beside "
        "its twin: random and adversarial tests, every bit of every result and the counts of "
        f"events (`build/picture_bench --check {checks[0]['tests'] if checks else 0}`). The serial "
        "unit gives P alone and counts nothing."),
        Table(["variant", "tests", "misses", "hits", "doubts", "near ties", "differences"], rows)]


def engines_section(rows: list[dict]) -> list[Block]:
    """Times of the renderer's engines."""
    mine = [row for row in rows if row["section"] == "engines"]
    table = [[derive.scene_name(row), f"{row['triangles']:,}", row["variant"], row["engine"],
              seconds(row), f"{row['rays'] / statistics.median(times(row)):,.0f}",
              f"{row['tests'] / row['rays']:.2f}",
              f"{row['unit_tests'] / row['thread_seconds']['hit_tests']:,.0f}",
              f"{row['clocks'] / row['unit_tests']:.2f}" if row["clocks"] else "-"] for row in mine]
    return [Heading(2, "Engines"), Text(
        f"One thread, {mine[0]['width']} x {mine[0]['height']}, processor seconds: the median of the "
        "repeats ± the median distance from it; all rows' repeats were interleaved."),
        Table(["scene", "triangles", "unit", "engine", "seconds", "rays/s", "tests a ray",
               "unit's tests/s", "clocks a test"], table)]


def lanes_section(rows: list[dict], folder: pathlib.Path) -> list[Block]:
    """Clocks by lanes; 16 is modelled."""
    mine = sorted((row for row in rows if row["section"] == "lanes"
                   and row["variant"] == "binary32"), key=lambda row: row["lanes"])
    table = [[str(row["lanes"]), f"{row['clocks']:,}", "simulated",
              f"{row['clocks'] * row['lanes'] / row['unit_tests']:.3f}", seconds(row)]
             for row in mine]
    points = [(row["lanes"], row["clocks"]) for row in mine]
    file, laws = plots.scaling({"clocks a frame": points}, "lanes", "clocks",
                               "Clocks by lanes, paper's scene", folder / "lanes.svg")
    law = laws["clocks a frame"]
    table.append(["16", f"{law.at(16):,.0f}", "modelled: the power law of the others", "-", "-"])
    return [Heading(2, "Lanes"), Text(
        f"`{mine[0]['scene']}`, {mine[0]['width']} x {mine[0]['height']}, with shadows and "
        "reflections: the paper's frame. Lane clocks a test: clocks x lanes / tests."),
        Table(["lanes", "clocks a frame", "", "lane clocks a test", "simulation, s"], table),
        Figure(file, f"Clocks fall with lanes to the power {law.exponent:.3f} (ideal: -1).")]


def scaling_section(rows: list[dict], folder: pathlib.Path) -> list[Block]:
    """Time by triangles, pixels and threads, with exponents."""
    blocks: list[Block] = [Heading(2, "Scaling of the renderer, engine cpu")]
    for section, axis, x_of in [
            ("triangles", "triangles", lambda row: row["triangles"]),
            ("sizes", "pixels", lambda row: row["width"] * row["height"]),
            ("threads", "threads", lambda row: row["threads"])]:
        mine = [row for row in rows if row["section"] == section]
        series = {"seconds": [(x_of(row), statistics.median(times(row))) for row in mine]}
        if section == "triangles":
            series["hit tests a ray"] = [(x_of(row), row["tests"] / row["rays"]) for row in mine]
        file, laws = plots.scaling(series, axis, ", ".join(series), f"By {axis}",
                                   folder / f"scaling-{section}.svg")
        said = "; ".join(f"{name} go as {axis} to the power {law.exponent:.2f} ± "
                         f"{law.exponent_error:.2f} (worst point off by x {law.largest_miss:.2f})"
                         for name, law in laws.items())
        blocks += [Heading(3, f"By {axis}"),
                   Table([axis, "seconds", "hit tests a ray", "records"],
                         [[f"{x_of(row):,}", seconds(row), f"{row['tests'] / row['rays']:.2f}",
                           f"{row['records']:,}"] for row in mine]),
                   Figure(file, said + ".")]
    return blocks


def machine_section(results: dict) -> list[Block]:
    """What it was made on and with, and how to make a row again."""
    facts = [[key.replace("_", " "), str(value)] for key, value in results["machine"].items()]
    example = results["rows"][0]["command"]
    return [Heading(2, "Machine and raw data"), Table(["what", "which"], facts), Text(
        "Every figure is in `results.json` (and its scalars in `results.csv`): the row of its "
        f"section, scene, variant, engine, lanes and threads. Each row has the command that makes it "
        f"again, for example `{example}`.")]


def heading(results: dict) -> list[Block]:
    """Title, and what made it."""
    machine, kind = results["machine"], "quick run" if results["quick"] else "full run"
    return [Heading(1, "Run time against error, from the adder to the picture"),
            Text(f"Made by `{results['command']}` ({kind}, {results['seconds']:.0f} s) on "
                 f"{machine['processor']}, {machine['processors']} processors, load "
                 f"{machine['load_before']} before it began; Verilator {machine['verilator']}, "
                 f"{machine['compiler']}.")]


def claims_section(results: dict) -> list[Block]:
    """The paper's claims."""
    return [Heading(2, "The paper's claims"),
            Table(["claim", "the paper", "measured", "command"], results["claims"])]


def build(results: dict, folder: pathlib.Path) -> list[Block]:
    """All blocks; draws the plots into `folder`."""
    rows = results["rows"]
    return [
        *heading(results),
        *variants_section(results, folder),
        *samples_section(rows, folder),
        *checks_section(results["checks"]),
        *claims_section(results),
        *engines_section(rows),
        *simulation_section(results),
        *lanes_section(rows, folder),
        *scaling_section(rows, folder),
        *machine_section(results)]


def excerpt(results: dict, folder: pathlib.Path) -> list[Block]:
    """What the repository's documentation shows."""
    return [*heading(results), *variants_section(results, folder),
            *samples_section(results["rows"], folder), *claims_section(results)]


def simulation_section(results: dict) -> list[Block]:
    """Speed and instructions of the simulation; a quick run leaves them to build/sim/unit_bench."""
    if not results["simulation"]:
        return []
    rows = [[row["unit"], row["arithmetic"], row["lanes"], f"{row['hits_percent']:.1f}",
             f"{row['tests_per_second']:,.0f}", number(row["instructions"], ",.0f")]
            for row in results["simulation"]]
    return [Heading(2, "The simulation of the hardware"), Text(
        "`build/sim/unit_bench`, one thread. Instructions a test are callgrind's: the same on every "
        "machine of one instruction set and compiler."),
        Table(["unit", "arithmetic", "lanes", "hits, %", "tests/s", "instructions a test"], rows)]
