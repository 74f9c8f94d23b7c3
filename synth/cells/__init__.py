"""Characterises cells of SkyWater's 130 nm process with ngspice, so that the flows can map to them: see README.md."""
