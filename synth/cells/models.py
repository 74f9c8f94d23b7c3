"""The two transistors of the cells as models that ngspice reads quickly.

SkyWater's files hold 60 models a transistor, one for each range of widths and lengths, inside a subcircuit that every
instance copies. Here they stand once, in the open, those of the cells' one length alone, and without the random
differences between transistors.
"""

import re

from synth.cells import package

DEVICES = {"nfet_01v8": "n", "pfet_01v8_hvt": "p"}  # by what the cells' netlists and this program call them
LENGTH = 0.15  # um, of every transistor of these cells

# A model, to the next one or the end of the subcircuit.
MODEL = re.compile(r"^\.model (\S+)\.(\d+) (nmos|pmos)\n(.*?)(?=^\.model|^\.ends)", re.M | re.S)


def at_corner(corner: str) -> str:
    """The models "n" and "p" at the corner tt, ss or ff, as SPICE."""
    return "".join(_flat(package.device(name, corner).read_text(), short) for name, short in DEVICES.items())


def _flat(text: str, short: str) -> str:
    """The models in `text` of transistors LENGTH long, as `short`.0, `short`.1, ..., which ngspice picks by width."""
    models = []
    for _, _, kind, body in MODEL.findall(text):
        low, high = (float(re.search(rf"{name} = (\S+)", body)[1]) * 1e6 for name in ("lmin", "lmax"))
        if not low - 1e-6 <= LENGTH < high:
            continue
        # {nominal+MC_MM_SWITCH*AGAUSS(...)...}: the nominal value.
        body = re.sub(r"\{([-+.\de]+)\+MC_MM_SWITCH[^}]*\}", r"\1", body)
        if "{" in body:
            raise ValueError(f"a model of {short} has an expression: {re.search(r'.*{.*', body)[0]}")
        body = re.sub(r"^\*.*\n", "", body, flags=re.M)
        models.append(f".model {short}.{len(models)} {kind}\n{body}")
    return "".join(models)
