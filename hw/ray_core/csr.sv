// Control and status registers of the ray core, on AXI4-Lite: camera, rectangle, memory addresses, counters, flags.
//
// registers.md lists words, bits and what is refused while the core is busy; csr_pkg is generated from it. One write
// and one read at a time; no AXI output depends on an input in the same clock. interrupt_o: an enabled flag is high.
// Source: AMBA AXI protocol specification, issue E, B1 (AXI4-Lite).
module csr
  import ray_core_pkg::*, csr_pkg::*;
#(
  parameter bit [31:0] Capability = '0
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // AXI4-Lite
  input  logic                    axi_awvalid_i,
  output logic                    axi_awready_o,
  input  logic [11:0]             axi_awaddr_i,
  input  logic                    axi_wvalid_i,
  output logic                    axi_wready_o,
  input  logic [31:0]             axi_wdata_i,
  input  logic [3:0]              axi_wstrb_i,
  output logic                    axi_bvalid_o,
  input  logic                    axi_bready_i,
  output logic [1:0]              axi_bresp_o,
  input  logic                    axi_arvalid_i,
  output logic                    axi_arready_o,
  input  logic [11:0]             axi_araddr_i,
  output logic                    axi_rvalid_o,
  input  logic                    axi_rready_i,
  output logic [31:0]             axi_rdata_o,
  output logic [1:0]              axi_rresp_o,
  // the core's side
  output logic                    start_o,  // commands, high for one clock
  output logic                    invalidate_o,
  output logic                    abort_o,  // high until no ray is left
  output logic                    drawing_o,  // a rectangle's rays are being traced
  output logic [63:0]             base_o,
  output logic [AddressWidth-1:0] lines_o,
  output logic [31:0]             corner_o,
  output logic [31:0]             size_o,
  output logic [4*96-1:0]         camera_o,  // eye lowest, then first, right, down
  output logic [63:0]             results_o,
  output logic [31:0]             length_o,
  output logic                    rewind_o,  // command, high for one clock
  input  logic                    camera_busy_i,
  input  logic                    core_busy_i,  // rays are in the core
  input  logic                    outstanding_i,
  input  logic                    writing_i,
  input  logic [31:0]             written_i,
  input  logic                    doubt_i,  // events of this clock
  input  logic                    ray_error_i,
  input  logic                    full_i,
  input  logic                    write_error_i,
  input  logic                    bus_error_i,
  input  logic [AddressWidth-1:0] error_number_i,
  input  logic [NumEvents-1:0]    events_i,
  output logic                    interrupt_o
);

  localparam logic [31:0] Identity = 32'h5247_0001;
  localparam int unsigned CounterWidth = 48;

  if (NumCounters != 1 + NumEvents) begin : gen_check
    $error("csr: expected a counter of each event, and one of clocks");
  end

  // ---- Writes: address and data are taken, each into a register; then the word is written

  logic write, refused, address_q, data_q;  // address_q, data_q: taken, not written yet
  logic [9:0] write_word_q, read_word;
  logic [3:0] strobes_q;
  logic [31:0] write_data_q, mask;  // mask: the bits to write

  assign write         = address_q & data_q & ~axi_bvalid_o;
  assign axi_awready_o = ~address_q;
  assign axi_wready_o  = ~data_q;
  assign mask = {{8{strobes_q[3]}}, {8{strobes_q[2]}}, {8{strobes_q[1]}}, {8{strobes_q[0]}}};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      address_q    <= 1'b0;
      data_q       <= 1'b0;
      axi_bvalid_o <= 1'b0;
    end else begin
      address_q    <= address_q ? ~write : axi_awvalid_i;
      data_q       <= data_q ? ~write : axi_wvalid_i;
      axi_bvalid_o <= write | (axi_bvalid_o & ~axi_bready_i);
    end
  end
  always_ff @(posedge clk_i) begin
    if (!address_q) write_word_q <= axi_awaddr_i[11:2];
    if (!data_q) {strobes_q, write_data_q} <= {axi_wstrb_i, axi_wdata_i};
    if (write) axi_bresp_o <= {refused, 1'b0};
  end

  logic command, plain, rebase, empty, clear;
  logic [NumCommand-1:0] commands;
  assign commands     = (write && write_word_q == WordCommand)
                      ? write_data_q[NumCommand-1:0] & mask[NumCommand-1:0] : '0;
  assign plain        = (write_word_q < 10'd32)
                      && (PlainBits[write_word_q[4:0]] != '0);
  assign rebase       = (write_word_q == WordBase)
                      | (write_word_q == WordBaseHigh);
  assign refused      = ((camera_busy_i | core_busy_i)
                         & (plain | commands[CommandStart] | empty))
                      | (outstanding_i & (rebase | empty))
                      | (writing_i & commands[CommandRewind]);
  assign empty        = commands[CommandInvalidate];
  assign command      = write & ~refused;
  assign start_o      = command & commands[CommandStart];
  assign invalidate_o = command & (empty | rebase);
  assign rewind_o     = command & commands[CommandRewind];
  assign clear        = command & commands[CommandClear];

  // ---- Plain registers: hold what was written, in the bits of PlainBits

  logic [31:0][31:0] words;  // by word number

  for (genvar n = 0; n < 32; n++) begin : gen_word
    localparam logic [31:0] Bits = PlainBits[n];
    if (Bits != '0) begin : gen_plain
      logic [31:0] word_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) word_q <= '0;
        else if (command && write_word_q == 10'(n)) begin
          word_q <= (write_data_q & mask & Bits) | (word_q & ~mask);
        end
      end
      assign words[n] = word_q;
    end else begin : gen_none
      assign words[n] = '0;
    end
  end

  assign base_o    = words[5'(WordBase)+:2];
  assign lines_o   = words[5'(WordLines)][AddressWidth-1:0];
  assign corner_o  = words[5'(WordCorner)];
  assign size_o    = words[5'(WordSize)];
  assign results_o = words[5'(WordResults)+:2];
  assign length_o  = words[5'(WordLength)];
  for (genvar v = 0; v < 4; v++) begin : gen_vector
    assign camera_o[96*v+:96] = words[32'(WordEye)+4*v+:3];
  end

  // ---- Flags

  logic [NumFlags-1:0] enable_q, flags_q, raised, lowered;
  logic done;
  logic [AddressWidth-1:0] error_line_q;

  assign done    = drawing_o & ~camera_busy_i & ~core_busy_i;
  assign raised[FlagsDoubt]    = doubt_i;
  assign raised[FlagsDone]     = done;
  assign raised[FlagsBusError] = bus_error_i;
  assign raised[FlagsRayError] = ray_error_i;
  assign raised[FlagsFull]       = full_i;
  assign raised[FlagsWriteError] = write_error_i;
  assign lowered = (write && write_word_q == WordFlags)
                 ? write_data_q[NumFlags-1:0] & mask[NumFlags-1:0] : '0;
  assign interrupt_o = (enable_q & flags_q) != '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      enable_q  <= '0;
      flags_q   <= '0;
      drawing_o <= 1'b0;
      abort_o   <= 1'b0;
      error_line_q <= '0;
    end else begin
      if (write && write_word_q == WordEnable) begin
        enable_q <= (write_data_q[NumFlags-1:0] & mask[NumFlags-1:0])
                  | (enable_q & ~mask[NumFlags-1:0]);
      end
      flags_q   <= (flags_q & ~lowered) | raised;
      drawing_o <= start_o | camera_busy_i | (drawing_o & ~done);
      if (bus_error_i && !flags_q[FlagsBusError]) error_line_q <= error_number_i;
      abort_o <= (command & commands[CommandAbort]) | (abort_o & (camera_busy_i | core_busy_i));
    end
  end

  // ---- Counters

  logic [NumCounters-1:0][CounterWidth-1:0] counters;
  logic [NumCounters-1:0] counted;

  assign counted = {events_i, core_busy_i};
  for (genvar n = 0; n < NumCounters; n++) begin : gen_counter
    logic [CounterWidth-1:0] count_q;
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) count_q <= '0;
      else count_q <= clear ? '0 : count_q + CounterWidth'(counted[n]);
    end
    assign counters[n] = count_q;
  end

  // ---- Reads: a read of a counter's low word keeps its high word for the next read

  logic read;
  logic [31:0] value;
  logic [CounterWidth-33:0] high, high_q;
  logic [NumStatus-1:0] status;

  assign read          = axi_arvalid_i & axi_arready_o;
  assign axi_arready_o = ~axi_rvalid_o;
  assign axi_rresp_o   = 2'b00;
  assign read_word     = axi_araddr_i[11:2];
  assign status[StatusGenerating] = camera_busy_i;
  assign status[StatusTracing]    = core_busy_i;
  assign status[StatusReading]    = outstanding_i;
  assign status[StatusWriting]    = writing_i;

  always_comb begin
    value = (read_word < 10'd32) ? words[read_word[4:0]] : '0;
    high  = high_q;
    for (int unsigned n = 0; n < NumCounters; n++) begin
      if (read_word == WordCounters + 10'(2 * n)) {high, value} = counters[n];
      if (read_word == WordCounters + 10'(2 * n + 1)) value = 32'(high_q);
    end
    if (read_word == WordIdentity) value = Identity;
    if (read_word == WordCapability) value = Capability;
    if (read_word == WordStatus) value = 32'(status);
    if (read_word == WordWritten) value = written_i;
    if (read_word == WordErrorLine) value = 32'(error_line_q);
    if (read_word == WordEnable) value = 32'(enable_q);
    if (read_word == WordFlags) value = 32'(flags_q);
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) axi_rvalid_o <= 1'b0;
    else axi_rvalid_o <= read | (axi_rvalid_o & ~axi_rready_i);
  end
  always_ff @(posedge clk_i) if (read) {high_q, axi_rdata_o} <= {high, value};

  logic unused;  // words begin at multiples of four
  assign unused = ^{axi_awaddr_i[1:0], axi_araddr_i[1:0]};

endmodule
