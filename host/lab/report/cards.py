"""The card of a variant: its figures, from gates to pixels, beside binary32's."""

from host.lab.report.document import inlined, number
from host.lab.rows import ROOT

# Lines: name, value of a frame (targets/bench.py), format.
FIGURES = (("area, um2 in OSU 0.35 um", "area", ",.0f"), ("period, ns", "period_ns", ".2f"),
           ("period with estimated wires, ns", "wired_ns", ".2f"),
           ("clocks a frame", "clocks", ",.0f"), ("ms a frame", "frame_ms", ".3f"), ("uJ a frame, cores", "energy_uj", ".3g"),
           ("wrong tests a million", "wrong", ".1f"), ("doubts a million", "doubtful", ".1f"),
           ("wrong rays", "decisions.wrong_rays", ",d"), ("P, ulp: median", "decisions.point_ulp.p50", ".3g"),
           ("P, ulp: 99 %", "decisions.point_ulp.p99", ".3g"), ("P, ulp: largest", "decisions.point_ulp.max", ".3g"),
           ("t, ulp: 99 %", "decisions.t_ulp.p99", ".3g"), ("RMSE", "rmse", ".3g"), ("SSIM", "ssim", ".4f"),
           ("FLIP", "flip", ".5f"))


def _value(frame: dict, path: str) -> float | None:
    for key in path.split("."):
        frame = frame.get(key) if isinstance(frame, dict) else None
    return frame


def lines(frame: dict) -> dict[str, str]:
    """What is known of a variant's frame: figure, value."""
    return {name: number(_value(frame, path), form) for name, path, form in FIGURES if _value(frame, path) is not None}


def figures(usual: dict, mine: dict, made: dict[str, str] = {}) -> list[dict]:
    """Lines of a card: both values as text, a dash where there is none, their ratio, and the file in `made` that the variant's
    is from."""
    found = []
    for name, path, form in FIGURES:
        numbers = [_value(usual, path), _value(mine, path)]
        if numbers[1] is not None:
            found.append({"figure": name, "ratio": numbers[1] / numbers[0] if numbers[0] else None,
                          "from": made.get(path, made.get("", "")),
                          **dict(zip(("usual", "mine"), (number(each, form) for each in numbers), strict=True))})
    return found


def of_scenes(scenes: dict[str, list[dict]]) -> dict:
    """What the page shows of the frames by scene: figures, picture and map of each variant; equal pictures are there once."""
    pictures: dict[str, int] = {}

    def place(name: str) -> int:
        return pictures.setdefault(inlined(ROOT / name), len(pictures))

    shown = {scene: {frame["variant"]: {"picture": place(f"{frame['picture']}.png"), "map": place(frame["map"]), "figures": lines(frame)}
                     for frame in frames} for scene, frames in scenes.items()}
    return {"scenes": shown, "pictures": list(pictures)}
