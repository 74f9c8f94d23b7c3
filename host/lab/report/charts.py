"""The reports' charts: one Vega-Lite specification each, a PNG for Markdown and an answer to the pointer in HTML."""

import json
import math
import pathlib

import vl_convert

from host.lab.report import cards, plots, statistics

# What a variant is, by its unit and whether doubts are resolved: label, colour, mark.
KINDS = {("pipeline", True): ("pipelined unit, doubts resolved", "#4477aa", "circle"),
         ("pipeline", False): ("pipelined unit, doubts ignored", "#ee6677", "cross"),
         ("serial", True): ("the paper's unit, software decides", "#228833", "square")}
# Where an error of nothing is drawn on a logarithmic axis: this far below the smallest other one.
BELOW = 10.0
SIZE = (400, 300)  # of a panel, pixels
GRAY = "#999999"


def save(spec: dict, file: pathlib.Path) -> pathlib.Path:
    """Writes NAME.png and, for the page, NAME.json."""
    spec = {"$schema": "https://vega.github.io/schema/vega-lite/v6.json", **spec,
            "config": {"axis": {"gridOpacity": 0.4}, "legend": {"symbolOpacity": 1}}}
    file.with_suffix(".json").write_text(json.dumps(spec))
    plots.write_png(vl_convert.vegalite_to_png(spec, scale=1.5), file)
    return file


def axis(field: str, title: str, form: str) -> dict:
    """Logarithmic."""
    return {"field": field, "type": "quantitative", "title": title, "scale": {"type": "log", "nice": False, "padding": 18},
            "axis": {"format": form, "tickCount": 5}}


def named(drawn: list[tuple[float, float]], names: list[str], first: list[int]) -> dict[str, list[int]]:
    """Which points can have their names beside them, left or right ("right", "left": the text's alignment) of them; those of `first`
    go before others, and names do not overlap."""
    sides = [(math.log(min(side)), math.log(max(side))) for side in zip(*drawn, strict=True)]
    chosen: dict[str, list[int]] = {"left": [], "right": []}
    taken: list[tuple[float, float, float]] = []
    for i in dict.fromkeys([*first, *range(len(drawn))]):
        x, y = (size * (math.log(value) - low) / ((high - low) or 1.0) for value, (low, high), size in zip(drawn[i], sides, SIZE, strict=True))
        width = 6 * len(names[i])
        align = "right" if x + width > SIZE[0] else "left"
        left = x - width if align == "right" else x
        if all(abs(y - other_y) > 11 or left > other_right or other_left > left + width for other_left, other_right, other_y in taken):
            chosen[align].append(i)
            taken.append((left, left + width, y))
    return chosen


def pareto(frames: list[dict], costs: dict[str, str], error: str, label: str, title: str, file: pathlib.Path) -> pathlib.Path:
    """A panel for each cost (key of the frames: label) against the key `error` (`label`), the lower the better in both; a line joins the
    variants that none betters. A point says what is on its card."""
    floor = min((frame[error] for frame in frames if frame[error] > 0), default=1.0) / BELOW
    panels = [_panel([frame for frame in frames if frame.get(key)], (key, text), (error, label), floor) for key, text in costs.items()]
    return save({"title": title, "concat": panels, "columns": 2, "spacing": 30}, file)


def _panel(frames: list[dict], cost: tuple[str, str], error: tuple[str, str], floor: float) -> dict:
    drawn = [(frame[cost[0]], max(frame[error[0]], floor)) for frame in frames]
    best = statistics.front(drawn)
    rows = [{"variant": frame["variant"], "x": x, "y": y, "kind": KINDS[frame["unit"], frame["doubts"]][0], **cards.lines(frame)}
            for frame, (x, y) in zip(frames, drawn, strict=True)]
    told = list(dict.fromkeys(name for row in rows for name in row if name not in ("x", "y")))
    place = {"x": axis("x", cost[1], "~s"), "y": axis("y", error[1], "~g")}
    labels, colours, marks = zip(*KINDS.values(), strict=True)
    kind = {"field": "kind", "type": "nominal", "title": None, "legend": {"orient": "bottom", "columns": 1, "labelLimit": 300}}
    layers = [
        {"data": {"values": [rows[i] for i in best]}, "encoding": place,
         "mark": {"type": "line", "interpolate": "step-after", "color": GRAY}},
        {"data": {"values": rows}, "params": [{"name": f"zoom_{cost[0]}", "select": "interval", "bind": "scales"}],
         "mark": {"type": "point", "filled": True, "size": 80, "opacity": 0.9, "cursor": "pointer"},
         "encoding": {**place, "color": {**kind, "scale": {"domain": labels, "range": colours}},
                      "shape": {**kind, "scale": {"domain": labels, "range": marks}},
                      "tooltip": [{"field": name.replace(".", "\\."), "type": "nominal", "title": name} for name in told]}},
        *({"data": {"values": [rows[i] for i in chosen]}, "encoding": {**place, "text": {"field": "variant"}},
           "mark": {"type": "text", "align": align, "baseline": "bottom", "dx": 6 if align == "left" else -6, "dy": -3, "fontSize": 9,
                    "color": GRAY}}
          for align, chosen in named(drawn, [frame["variant"] for frame in frames], best).items())]
    if any(frame[error[0]] <= 0 for frame in frames):
        layers.append({"data": {"values": [{"y": floor}]}, "encoding": {"y": {"field": "y", "type": "quantitative"}, "x": {"value": 3}},
                       "mark": {"type": "text", "align": "left", "baseline": "top", "dy": 6, "text": "no error", "fontSize": 9,
                                "color": GRAY}})
    return {"width": SIZE[0], "height": SIZE[1], "layer": layers}


def scaling(series: dict[str, list[tuple[float, float]]], xlabel: str, ylabel: str, title: str,
            file: pathlib.Path) -> tuple[pathlib.Path, dict[str, statistics.PowerLaw]]:
    """Points (x, y) of each series on logarithmic axes, with its power law; the file and the laws."""
    laws, dots, lines = {}, [], []
    for name, points in series.items():
        law = statistics.power_law(*zip(*points, strict=True)) if points else None
        label = name
        if law:
            laws[name] = law
            label += f": exponent {law.exponent:.2f} ± {law.exponent_error:.2f}"
            lines += [{"series": label, "x": x, "y": law.at(x)} for x, _ in points]
        dots += [{"series": label, "x": x, "y": y} for x, y in points]
    form = "~s" if max((dot["x"] for dot in dots), default=0) >= 1000 else "~g"
    encoding = {"x": axis("x", xlabel, form), "y": axis("y", ylabel, "~g"),
                "color": {"field": "series", "type": "nominal", "title": None, "scale": {"scheme": "tableau10" if len(series) <= 10 else "tableau20"},
                          "legend": {"orient": "bottom", "columns": 1, "labelLimit": 500}}}
    tips = [{"field": "series", "type": "nominal"}, *({"field": field, "type": "quantitative", "title": text, "format": ",.4~g"}
                                                     for field, text in (("x", xlabel), ("y", ylabel)))]
    return save({"title": title, "width": 560, "height": 340, "layer": [
        {"data": {"values": lines}, "mark": {"type": "line", "strokeWidth": 1}, "encoding": encoding},
        {"data": {"values": dots}, "mark": {"type": "point", "filled": True, "size": 60},
         "params": [{"name": "zoom", "select": "interval", "bind": "scales"}], "encoding": {**encoding, "tooltip": tips}}]}, file), laws
