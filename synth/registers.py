"""Generates the RTL's package csr_pkg.sv and the drivers' header registers.h from the tables of hw/ray_core/registers.md.

`made` returns the texts of both files. `make synth DATASHEET=1` writes the files, `synth.datasheet --check` compares them.
"""

import dataclasses
import pathlib
import re

from synth import cores

PAGE = cores.HW / "ray_core" / "registers.md"
PLAIN = 32  # words from address 0 that may be plain registers, those with access `idle`
ACCESSES = ("ro", "rw", "wo", "w1c", "idle")


@dataclasses.dataclass(frozen=True)
class Register:
    """A register of one or more consecutive words. `mask`: the writable bits of each word if it is plain (access `idle`), else 0."""

    name: str
    address: int
    words: int
    access: str
    mask: int
    bits: dict[str, int]


def _cells(text: str, first: str) -> list[list[str]]:
    """Returns the cells of table rows whose first cell matches `first`, without spaces and backticks."""
    return [[cell.strip(" `") for cell in line.split("|")[1:-1]]
            for line in text.splitlines() if re.match(rf"\| {first} \|", line)]


def registers(text: str) -> list[Register]:
    """Returns the page's registers by address, with their bits. Raises ValueError if they overlap or a row is malformed."""
    listed: dict[str, Register] = {}
    end = 0
    for address, words, name, access, mask, _ in _cells(text, "0x[0-9a-f]+"):
        register = Register(name, int(address, 16), int(words), access, int(mask or "0", 16), {})
        if register.address < end or register.address % 4 or name in listed or access not in ACCESSES \
                or (access == "idle") != bool(mask):
            raise ValueError(f"{PAGE}: {address} {name}: found {access} {mask} at or before 0x{end:03x}, expected a word of its own")
        end = register.address + 4 * register.words
        listed[name] = register
    for name, bit, meaning, _ in _cells(text, r"`\w+`"):
        if name not in listed or meaning in listed[name].bits or int(bit) in listed[name].bits.values():
            raise ValueError(f"{PAGE}: {name} {bit} {meaning}: expected a bit of its own of a register")
        listed[name].bits[meaning] = int(bit)
    return list(listed.values())


def _camel(*names: str) -> str:
    return "".join(part.capitalize() for name in names for part in name.split("_"))


def package(listed: list[Register]) -> str:
    """Returns the text of csr_pkg.sv: the numbers of words and bits by name, and the writable bits of plain registers."""
    masks = [0] * PLAIN
    for register in listed:
        for word in range(register.address // 4, register.address // 4 + register.words):
            if register.access == "idle":
                masks[word] = register.mask
    lines = ["// Registers of the ray core by word number, and their bits: made of registers.md by `make synth DATASHEET=1`.",
             "package csr_pkg;", "", "  // verilator lint_off UNUSEDPARAM", "  // No module uses everything.", ""]
    for register in listed:
        lines.append(f"  localparam logic [9:0] {_camel('word', register.name)} = 10'h{register.address // 4:03x};")
    for register in listed:
        if register.bits:
            lines += ["", f"  localparam int unsigned {_camel('num', register.name)} = {max(register.bits.values()) + 1};"]
        if register.name != "counters":  # ray_core_pkg::event_e
            lines += [f"  localparam int unsigned {_camel(register.name, name)} = {bit};" for name, bit in register.bits.items()]
    lines += ["", f"  // Bits that can be written of words {PLAIN - 1} to 0, while nothing is traced",
              f"  localparam logic [{PLAIN - 1}:0][31:0] PlainBits = {{"]
    for last in range(PLAIN - 1, 0, -4):
        lines.append("    128'h" + "_".join(f"{masks[word]:08x}" for word in range(last, last - 4, -1)) + ("," if last > 3 else ""))
    return "\n".join([*lines, "  };", "", "  // verilator lint_on UNUSEDPARAM", "", "endpackage"]) + "\n"


def header(listed: list[Register]) -> str:
    """Returns the text of registers.h: addresses of registers, masks of bits, and addresses of counters."""
    lines = ["/* Registers of the ray core: addresses, and bits as masks. Made of registers.md by `make synth DATASHEET=1`. */",
             "#ifndef RAYGATE_REGISTERS_H", "#define RAYGATE_REGISTERS_H", "", "enum {"]
    for register in listed:
        lines.append(f"  RAYGATE_{register.name.upper()} = 0x{register.address:03x},")
    for register in listed:
        for name, bit in register.bits.items():
            value = f"0x{register.address + 8 * bit:03x}" if register.name == "counters" else f"1 << {bit}"
            lines.append(f"  RAYGATE_{register.name.upper()}_{name.upper()} = {value},")
    return "\n".join([*lines, "};", "", "#endif"]) + "\n"


def made(text: str) -> dict[pathlib.Path, str]:
    """Returns the paths and contents of the files that are generated from the text of registers.md."""
    listed = registers(text)
    return {PAGE.with_name("csr_pkg.sv"): package(listed), PAGE.with_name("registers.h"): header(listed)}
