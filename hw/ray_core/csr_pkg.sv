// Registers of the ray core by word number, and their bits: made of registers.md by `make synth DATASHEET=1`.
package csr_pkg;

  // verilator lint_off UNUSEDPARAM
  // No module uses everything.

  localparam logic [9:0] WordIdentity = 10'h000;
  localparam logic [9:0] WordCommand = 10'h001;
  localparam logic [9:0] WordStatus = 10'h002;
  localparam logic [9:0] WordEnable = 10'h003;
  localparam logic [9:0] WordFlags = 10'h004;
  localparam logic [9:0] WordBase = 10'h005;
  localparam logic [9:0] WordBaseHigh = 10'h006;
  localparam logic [9:0] WordLines = 10'h007;
  localparam logic [9:0] WordCorner = 10'h008;
  localparam logic [9:0] WordSize = 10'h009;
  localparam logic [9:0] WordErrorLine = 10'h00a;
  localparam logic [9:0] WordCapability = 10'h00b;
  localparam logic [9:0] WordEye = 10'h00c;
  localparam logic [9:0] WordFirst = 10'h010;
  localparam logic [9:0] WordRight = 10'h014;
  localparam logic [9:0] WordDown = 10'h018;
  localparam logic [9:0] WordResults = 10'h01c;
  localparam logic [9:0] WordResultsHigh = 10'h01d;
  localparam logic [9:0] WordLength = 10'h01e;
  localparam logic [9:0] WordWritten = 10'h01f;
  localparam logic [9:0] WordCounters = 10'h040;

  localparam int unsigned NumCommand = 5;
  localparam int unsigned CommandStart = 0;
  localparam int unsigned CommandInvalidate = 1;
  localparam int unsigned CommandClear = 2;
  localparam int unsigned CommandAbort = 3;
  localparam int unsigned CommandRewind = 4;

  localparam int unsigned NumStatus = 4;
  localparam int unsigned StatusGenerating = 0;
  localparam int unsigned StatusTracing = 1;
  localparam int unsigned StatusReading = 2;
  localparam int unsigned StatusWriting = 3;

  localparam int unsigned NumFlags = 6;
  localparam int unsigned FlagsDoubt = 0;
  localparam int unsigned FlagsDone = 1;
  localparam int unsigned FlagsBusError = 2;
  localparam int unsigned FlagsRayError = 3;
  localparam int unsigned FlagsFull = 4;
  localparam int unsigned FlagsWriteError = 5;

  localparam int unsigned NumCapability = 31;
  localparam int unsigned CapabilityGenerator = 28;
  localparam int unsigned CapabilityBuffer = 29;
  localparam int unsigned CapabilityStream = 30;

  localparam int unsigned NumCounters = 12;

  // Bits that can be written of words 31 to 0, while nothing is traced
  localparam logic [31:0][31:0] PlainBits = {
    128'h00000000_ffffffff_ffffffff_ffffffc0,
    128'h00000000_ffffffff_ffffffff_ffffffff,
    128'h00000000_ffffffff_ffffffff_ffffffff,
    128'h00000000_ffffffff_ffffffff_ffffffff,
    128'h00000000_ffffffff_ffffffff_ffffffff,
    128'h00000000_00000000_ffffffff_ffffffff,
    128'h0fffffff_ffffffff_ffffffc0_00000000,
    128'h00000000_00000000_00000000_00000000
  };

  // verilator lint_on UNUSEDPARAM

endpackage
