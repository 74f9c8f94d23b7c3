"""Tests frames of ray_core_axi with an AXI memory, an AXI4-Lite driver of registers and an AXI4-Stream sink, all from cocotbext-axi.

The memory has two nodes and three triangles across the x axis. The expected hit of each pixel is computed in this file.
"""

import itertools
import logging
import pathlib
import random
import re
import struct

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import RisingEdge
from cocotbext import axi

PAGE = pathlib.Path(__file__).resolve().parent.parent.parent / "hw" / "ray_core" / "registers.md"
REGISTERS = {name: int(address, 16) for address, name in re.findall(r"^\| (0x\w+) \| \d+ \| `(\w+)`", PAGE.read_text(), re.M)}
START, CLEAR = 1, 4
DONE, BUS_ERROR, RAY_ERROR, WRITE_ERROR = 2, 4, 8, 32

SIZE = 12  # pixels per side
STEP = 0.15
EYE = (-1.0, 1.0, 1.0)
BASE, RESULTS, ROOM = 0x1000, 0x8000, 400  # addresses of lines and of the buffer; size of the buffer in results
TRIANGLES = {10: (3.0, 0.0, 4.0), 11: (2.0, 0.0, 4.0), 12: (5.0, 4.0, 7.0)}  # x; y = z of the right angle; y and z of the legs' ends


def node(base, kinds, *boxes):
    """Returns a node's 64 bytes: its grid starts at the origin, with step 1/32. `boxes`: six bytes of grid coordinates per child."""
    bits = 0x7A7A7A << 96 | base << 120 | kinds << 148
    return (bits | sum(box << (176 + 48 * n) for n, box in enumerate(boxes))).to_bytes(64, "little")


def triangle(name):
    """Returns the 64 bytes of triangle `name`, a key of TRIANGLES."""
    x, low, high = TRIANGLES[name]
    return struct.pack("<9fI", x, low, low, x, high, low, x, low, high, name).ljust(64, b"\0")


IMAGE = b"".join((node(1, 0x18, 0xFFFFFF000000, 0x808060000060), node(3, 0x02, 0xE0E0A0000040),
                  triangle(10), triangle(11), triangle(12)))


def expected(x, y):
    """Returns (triangle, t) of a pixel's nearest hit, or None; and whether the ray keeps a distance from all edges."""
    a, b = -0.8 + STEP * x, -0.8 + STEP * y
    sure = True
    for name, (plane, low, high) in sorted(TRIANGLES.items(), key=lambda item: item[1][0]):
        t = plane - EYE[0]
        p, q = EYE[1] + a * t - low, EYE[2] + b * t - low
        inside = min(p, q, high - low - p - q)
        sure &= abs(inside) > 1e-3
        if inside > 0:
            return (name, t), sure
    return None, sure


def check(records):
    """Checks that each pixel has one final result, with the expected hit."""
    ends = {}
    for words in records:
        kind, error, found = words[0] & 1, words[0] >> 2 & 7, words[0] >> 1 & 1
        assert error == 0
        if kind == 1:
            assert words[0] == 1 and not any(words[3:])
            continue
        assert words[1] not in ends
        ends[words[1]] = (words[2], struct.unpack("<f", struct.pack("<I", words[3]))[0]) if found else None
        assert found or not any(words[2:7])
    assert sorted(ends) == [y << 16 | x for y in range(SIZE) for x in range(SIZE)]
    hits = 0
    for tag, end in ends.items():
        want, sure = expected(tag & 0xFFFF, tag >> 16)
        if sure:
            assert (end is None) == (want is None), (tag, end, want)
            assert end is None or (end[0] == want[0] and abs(end[1] - want[1]) < 1e-5), (tag, end, want)
            hits += end is not None
    assert hits > 40


class Memory(axi.MemoryRegion):
    """Memory in which the address range `broken` responds with SLVERR."""

    broken = range(0)

    async def _read(self, address, length, **kwargs):
        if address in self.broken:
            raise RuntimeError("broken")
        return await super()._read(address, length, **kwargs)

    async def _write(self, address, data, **kwargs):
        if address in self.broken:
            raise RuntimeError("broken")
        await super()._write(address, data, **kwargs)


def pauses(seed):
    """Returns an endless iterator of Booleans, one per clock: whether to pause in this clock."""
    chance = random.Random(seed)
    return (chance.random() < 0.4 for _ in itertools.count())


class Bench:
    """The core, connected to a memory, a driver of its registers and a sink of its stream."""

    def __init__(self, dut, seed):
        self.dut = dut
        logging.getLogger("cocotb.ray_core_axi").setLevel(logging.ERROR)
        dut.ray_valid_i.value = 0
        dut.ray_i.value = 0
        dut.rst_ni.value = 0
        reset = {"reset": dut.rst_ni, "reset_active_level": False}
        self.memory = Memory(0x10000)
        self.slave = axi.AxiSlave(axi.AxiBus.from_prefix(dut, "m_axi"), dut.clk_i, target=self.memory, **reset)
        self.registers = axi.AxiLiteMaster(axi.AxiLiteBus.from_prefix(dut, "s_axil"), dut.clk_i, **reset)
        self.sink = axi.AxiStreamSink(axi.AxiStreamBus.from_prefix(dut, "m_axis"), dut.clk_i, **reset)
        read, write = self.slave.read_if, self.slave.write_if
        control, status = self.registers.write_if, self.registers.read_if
        channels = (read.ar_channel, read.r_channel, write.aw_channel, write.w_channel, write.b_channel, control.aw_channel,
                    control.w_channel, control.b_channel, status.ar_channel, status.r_channel, self.sink)
        for number, channel in enumerate(channels):
            channel.set_pause_generator(pauses(seed + number))
        self.memory.mem[BASE:BASE + len(IMAGE)] = IMAGE

    async def write(self, name, *values):
        """Writes words to a register. Each response must be OKAY."""
        for number, value in enumerate(values):
            word = struct.pack("<f", value) if isinstance(value, float) else value.to_bytes(4, "little")
            assert (await self.registers.write(REGISTERS[name] + 4 * number, word)).resp == axi.AxiResp.OKAY

    async def read(self, name):
        """Reads a register's word."""
        return int.from_bytes((await self.registers.read(REGISTERS[name], 4)).data, "little")

    async def draw(self, length):
        """Draws a frame, to the buffer or, if `length` is 0, to the stream. Returns the register `flags`."""
        await self.write("size", SIZE << 16 | SIZE)
        await self.write("length", length)
        await self.write("flags", 63)
        await self.write("enable", DONE)
        await self.write("command", START | CLEAR)
        await RisingEdge(self.dut.interrupt_o)
        return await self.read("flags")


async def begin(dut, seed):
    """Returns a bench out of reset, with its camera set."""
    cocotb.start_soon(Clock(dut.clk_i, 10, unit="ns").start())
    bench = Bench(dut, seed)
    for _ in range(3):
        await RisingEdge(dut.clk_i)
    dut.rst_ni.value = 1
    assert await bench.read("identity") == 0x52470001
    assert await bench.read("capability") == 0x70130201
    await bench.write("base", BASE)
    await bench.write("lines", len(IMAGE) // 64)
    await bench.write("eye", *EYE)
    await bench.write("first", 1.0, -0.8, -0.8)
    await bench.write("right", 0.0, STEP, 0.0)
    await bench.write("down", 0.0, 0.0, STEP)
    await bench.write("results", RESULTS)
    return bench


def in_buffer(bench, count):
    """Returns the first `count` results in the buffer."""
    return [struct.unpack_from("<8I", bench.memory.mem, RESULTS + 32 * n) for n in range(count)]


@cocotb.test()
async def results_go_to_memory(dut):
    """Results arrive in the buffer, even with random pauses on all channels."""
    bench = await begin(dut, 1)
    assert await bench.draw(ROOM) & ~1 == DONE
    check(in_buffer(bench, await bench.read("written")))


@cocotb.test()
async def results_go_by_the_stream(dut):
    """The same results come by AXI4-Stream. TLAST is set for each final result."""
    bench = await begin(dut, 2)
    assert await bench.draw(0) & ~1 == DONE
    records = []
    while not bench.sink.empty():
        frame = bench.sink.recv_nowait().tdata
        some = [struct.unpack_from("<8I", frame, at) for at in range(0, len(frame), 32)]
        assert [words[0] & 1 for words in some] == [1] * (len(some) - 1) + [0]
        records += some
    check(records)


@cocotb.test()
async def errors_of_memory_are_told(dut):
    """SLVERR for a line sets error_line, and rays that need the line end with an error. When memory works again, a frame is complete."""
    bench = await begin(dut, 3)
    bench.memory.broken = range(BASE + 3 * 64, BASE + 4 * 64)
    assert await bench.draw(ROOM) & ~1 == DONE | BUS_ERROR | RAY_ERROR
    assert await bench.read("error_line") == 3
    errors = {words[0] >> 2 & 7 for words in in_buffer(bench, await bench.read("written")) if words[0] & 1 == 0}
    assert errors == {0, 1}
    bench.memory.broken = range(RESULTS + 64, RESULTS + 128)
    await bench.write("command", 16)
    assert await bench.draw(ROOM) & ~1 == DONE | WRITE_ERROR
    bench.memory.broken = range(0)
    await bench.write("command", 16)
    assert await bench.draw(ROOM) & ~1 == DONE
    check(in_buffer(bench, await bench.read("written")))
