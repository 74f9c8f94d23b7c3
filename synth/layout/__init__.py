"""Layouts: netlists of `make synth`, placed, routed, timed with their wires and drawn. See synth/README.md."""
