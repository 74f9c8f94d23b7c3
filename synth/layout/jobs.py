"""What `make layout` lays out: the one table to edit."""

import dataclasses

from synth import catalogue
from synth.catalogue import Design, Library
from synth.layout.flow import Job

SPARSE = 0.45, 1.3  # density and aspect with which a multiplier's nets all find their way,
SPARSER = 0.42, 1.3  # and binary32's


@dataclasses.dataclass(frozen=True)
class Row:
    """A design of the table: laid out once for each seed, of which the median counts."""

    section: str
    design: Design
    flow: str
    density: float
    aspect: float
    seeds: int = 1
    routed: bool = True
    library: Library = catalogue.library("osu035")

    def jobs(self) -> list[Job]:
        """One for each seed."""
        return [Job(self.design, self.library, self.flow, self.density, self.aspect, seed, self.routed)
                for seed in range(1, self.seeds + 1)]


SECTIONS = ("adders", "multipliers", "cores", "unit")


def rows(section: str, seeds: int = 3) -> list[Row]:
    """The rows of one of SECTIONS. `seeds`: of each adder; the others are large."""
    if section == "adders":
        return [Row(section, row.design, flow, 1.0, 0.75, seeds) for row in catalogue.report_rows()
                if row.section == "48-bit adders"
                for flow in ("cells", "fast") if flow in row.flows["osu035"]]
    if section == "multipliers":
        graded = catalogue.design("booth_multiplier", "booth-graded-ripple-groups", "graded",
                                  look_ahead=False, Width=24)
        kinds = [catalogue.design("booth_multiplier", f"booth-{kind}", kind, Width=24)
                 for kind in ("ripple", "uniform", "prefix")]
        plain = catalogue.design("multiplier", "multiplier-behavioural", catalogue.BEHAVIOURAL, Width=24)
        return [Row(section, graded, "cells", *SPARSE),
                *(Row(section, design, "fast", *SPARSE) for design in (graded, *kinds, plain))]
    if section == "cores":
        small = catalogue.FORMATS["binary16"]
        tops = {"fp_adder": SPARSE, "fp_multiplier": SPARSER, "fp_divider": SPARSE}
        return [*(Row(section, catalogue.design(top, f"{top.replace('_', '-')}-binary16", "graded",
                                                ExpWidth=small[0], FracWidth=small[1]), "modules", *SPARSE)
                  for top in tops),
                *(Row(section, catalogue.design(top, top.replace("_", "-"), "graded"), "modules", *sparse)
                  for top, sparse in tops.items())]
    if section == "unit":  # whether qrouter routes 18,000 nets has not been tried
        return [Row(section, catalogue.design("hit_test_unit"), flow, *SPARSE, routed=False)
                for flow in ("parts", "small")]
    raise ValueError(f"no section {section}; there are {', '.join(SECTIONS)}")
