"""What follows from the measured rows: clocks, time and area of a frame for each variant."""

import pathlib

from host.lab.matrix import costs

def scene_name(row: dict) -> str:
    """`cornell` for scenes/cornell.obj."""
    return pathlib.Path(row["scene"]).stem


def times(row: dict) -> list[float]:
    """Of one thread's work the processor's seconds, which other programs don't stretch; else wall."""
    return row["processor_seconds"] if row["threads"] == 1 else row["seconds"]


def frames(rows: list[dict], variants: list[dict], records: list[dict]) -> list[dict]:
    """An object for each (scene, variant) of the section `variants`: its figures of error, and

    clocks      of the frame: its tests through the unit, times the clocks a test of the variant's
                simulation (of binary32's where it has no hardware: then `clocks_modelled`)
    area, period_ns, cost_origin, frame_ms, area_time    where synthesis knows the unit
    """
    rate = {row["variant"]: row["clocks"] / row["unit_tests"] for row in rows
            if row["section"] == "variants" and row["engine"] == "unit" and row["unit_tests"]}
    by_name = {variant["name"]: variant for variant in variants}
    found = []
    for row in rows:
        if row["section"] != "variants" or row["engine"] == "unit":
            continue
        variant = by_name[row["variant"]]
        usual = rate.get("serial" if variant["unit"] == "serial" else "binary32")
        clocks_a_test = rate.get(row["variant"], usual)
        frame = {"scene": scene_name(row), "variant": variant, "row": row, **row["decisions"],
                 "image": row.get("image"), "exact": row["exact_inside"] + row["exact_depth"],
                 "clocks": row["unit_tests"] * clocks_a_test if clocks_a_test else None,
                 "clocks_modelled": row["variant"] not in rate}
        cost = costs.cost(records, variant)
        if cost and frame["clocks"]:
            frame |= {"area": cost.area, "period_ns": cost.period_ns, "cost_origin": cost.origin,
                      "frame_ms": frame["clocks"] * cost.period_ns * 1e-6}
            frame["area_time"] = cost.area * frame["frame_ms"]
        found.append(frame)
    return found


def wrong_per_million(frame: dict) -> float:
    """Hit tests decided wrongly, for each million of them."""
    return 1e6 * (frame["wrong_hits"] + frame["wrong_misses"]) / max(frame["tests"], 1)
