"""Two runs side by side: what got slower or less accurate, beyond the noise."""

from host.lab.matrix import statistics
from host.lab.matrix.derive import times

# Rows of two runs are one when all of these are equal.
KEY = ("section", "scene", "width", "height", "variant", "engine", "lanes", "threads",
       "integrator", "samples", "seed")

# Counted, the same whenever nothing has changed: any growth is worth a line.
COUNTS = ("tests", "clocks", "records", "exact_inside", "exact_depth")
ERRORS = ("wrong_hits", "wrong_misses", "wrong_rays")

# Times must differ by more than this, however small their spread seems.
LEAST_CHANGE = 0.05
SPREADS = 5.0


def key(row: dict) -> tuple:
    """What names a row in every run."""
    return tuple(row[name] for name in KEY)


def name(row: dict) -> str:
    """The same in words."""
    scene = row["scene"].rpartition("/")[2].removesuffix(".obj")
    words = [row["section"], scene, f"{row['width']}x{row['height']}", row["variant"], row["engine"]]
    if row["integrator"] != "primary":
        words.append(f"{row['integrator']} of {row['samples']}")
    if row["lanes"] > 1:
        words.append(f"{row['lanes']} lanes")
    if row["threads"] > 1:
        words.append(f"{row['threads']} threads")
    return " ".join(words)


def machine_ratio(pairs: list[tuple[dict, dict]]) -> float:
    """How much slower the machine was: the median of the new yardstick times over the old ones."""
    ratios = [statistics.median(new["yardstick_seconds"]) / statistics.median(old["yardstick_seconds"])
              for old, new in pairs if old.get("yardstick_seconds") and new.get("yardstick_seconds")]
    return statistics.median(ratios) if ratios else 1.0


def noise(old: dict, new: dict) -> float:
    """What part of a time may change without meaning anything, from the spreads of both."""
    return max(LEAST_CHANGE, SPREADS * (statistics.spread(times(old))
                                        + statistics.spread(times(new))))


def compare(old: dict, new: dict) -> list[str]:
    """Lines about two runs' results; the first says what was compared."""
    before = {key(row): row for row in old["rows"]}
    pairs = [(before[key(row)], row) for row in new["rows"] if key(row) in before]
    machine = machine_ratio(pairs)
    worse, better = [], []
    for was, now in pairs:
        if len(was["seconds"]) > 1 and len(now["seconds"]) > 1:
            ratio = (statistics.median(times(now)) / statistics.median(times(was))) / machine
            limit = noise(was, now)
            before_after = " -> ".join(f"{statistics.median(times(row)):.4g} s" for row in (was, now))
            line = (f"{name(now)}: {before_after}, x {ratio:.2f} beside the machine's own "
                    f"x {machine:.2f} (noise {100 * limit:.0f} %)")
            if ratio > 1 + limit:
                worse.append("slower: " + line)
            elif ratio < 1 / (1 + limit):
                better.append("faster: " + line)
        for count in COUNTS:
            _changed(f"{name(now)}: {count}", was[count], now[count], worse, better, "more work")
        for error in ERRORS:
            if "decisions" in was and "decisions" in now:
                _changed(f"{name(now)}: {error}", was["decisions"][error],
                         now["decisions"][error], worse, better, "less accurate")
        if "image" in was and "image" in now:
            _changed(f"{name(now)}: RMSE", was["image"]["rmse"], now["image"]["rmse"], worse,
                     better, "less accurate")
    missing = len(old["rows"]) - len(pairs)
    head = (f"{len(pairs)} rows compared with the older run; {missing} of its rows are not here. "
            f"{len(worse)} worse, {len(better)} better beyond the noise.")
    return [head, *worse, *better]


def _changed(what: str, was: float, now: float, worse: list[str], better: list[str],
             word: str) -> None:
    if now > was:
        worse.append(f"{word}: {what} {was:.6g} -> {now:.6g}")
    elif now < was:
        better.append(f"better: {what} {was:.6g} -> {now:.6g}")
