// Control and status registers of the ray core, on AXI4-Lite: what to draw, from which memory, counters, flags.
//
// Words of 32 bits; reading elsewhere gives 0, writing elsewhere does nothing. Bytes that wstrb leaves out
// stay. Binary32 vectors are three words, x first.
//
//   0x000  identity   ro   0x52470001
//   0x004  command    wo   bit 0: make the rays of the rectangle; 1: memory has changed; 2: counters to zero;
//                          3: give up all rays, generated and others: they end at once, with an error
//   0x008  status     ro   bit 0: the generator has rays to make; 1: rays are in the core; 2: lines are on
//                          their way to it
//   0x00c  enable     rw   of interrupts, as in `flags`
//   0x010  flags      w1c  bit 0: a doubt has left; 1: the last ray of a rectangle has ended; 2: memory
//                          has answered with an error; 3: a ray has ended with an error
//                          An event that comes as its flag is lowered raises it again
//   0x014  base       rw   two words: address of line 0, low word first; a multiple of 64
//   0x01c  lines      rw   of memory, 28 bits; 0: 2**28. A ray that enters more nodes ends with an error
//   0x020  corner     rw   the rectangle's first pixel: x in bits 15:0, y in 31:16
//   0x024  size       rw   its width and height, likewise
//   0x028  error line ro   the number of the line that raised flag 2
//   0x030  eye        rw   where generated rays begin; 0x040 first, 0x050 right, 0x060 down: see ray_generator
//   0x100  counters   ro   two words each, low word first: clocks with status bit 1 high, then those of
//                          ray_core_pkg::event_e in their order. Of 48 bits, modulo 2**48; a high word is
//                          that of the moment when a low word was read last
//
// So a picture is drawn by one write of `size` and one of `command`, where the camera stays. While status bits 1:0
// are not 0, command 0 and writes to 0x014 to 0x068 do nothing and are answered by SLVERR; while bits 2:0 are not,
// command 1 and writes to `base`, which are a command 1, too. A rectangle without pixels is done at once.
//
// One write and one read at a time; no output of AXI depends on an input in the same clock.
// interrupt_o is high while a flag is that is enabled.
// Source: AMBA AXI protocol specification, issue E, B1 (AXI4-Lite).
module csr #(
  localparam int unsigned AddressWidth = 12,
  localparam int unsigned LineNumberWidth = ray_core_pkg::AddressWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // AXI4-Lite
  input  logic                    axi_awvalid_i,
  output logic                    axi_awready_o,
  input  logic [AddressWidth-1:0] axi_awaddr_i,
  input  logic                    axi_wvalid_i,
  output logic                    axi_wready_o,
  input  logic [31:0]             axi_wdata_i,
  input  logic [3:0]              axi_wstrb_i,
  output logic                    axi_bvalid_o,
  input  logic                    axi_bready_i,
  output logic [1:0]              axi_bresp_o,
  input  logic                    axi_arvalid_i,
  output logic                    axi_arready_o,
  input  logic [AddressWidth-1:0] axi_araddr_i,
  output logic                    axi_rvalid_o,
  input  logic                    axi_rready_i,
  output logic [31:0]             axi_rdata_o,
  output logic [1:0]              axi_rresp_o,
  // the core's side
  output logic                    start_o,       // this clock's commands
  output logic                    invalidate_o,
  output logic                    abort_o,       // until no ray is left
  output logic                    drawing_o,     // a rectangle's rays are on their way
  output logic [63:0]             base_o,
  output logic [LineNumberWidth-1:0] lines_o,
  output logic [31:0]             corner_o,
  output logic [31:0]             size_o,
  output logic [4*96-1:0]         camera_o,      // eye lowest, then first, right, down
  input  logic                    camera_busy_i,
  input  logic                    core_busy_i,   // has rays
  input  logic                    outstanding_i,
  input  logic                    doubt_i,       // this clock's
  input  logic                    ray_error_i,
  input  logic                    bus_error_i,
  input  logic [LineNumberWidth-1:0] error_number_i,
  input  logic [ray_core_pkg::NumEvents-1:0] events_i,
  output logic                    interrupt_o
);

  localparam logic [31:0] Identity = 32'h5247_0001;
  localparam int unsigned NumCounters = 1 + ray_core_pkg::NumEvents;
  localparam int unsigned CounterWidth = 48;
  localparam int unsigned NumFlags = 4;

  // Word numbers
  localparam logic [9:0] WordIdentity = 10'h000;
  localparam logic [9:0] WordCommand = 10'h001;
  localparam logic [9:0] WordStatus = 10'h002;
  localparam logic [9:0] WordEnable = 10'h003;
  localparam logic [9:0] WordFlags = 10'h004;
  localparam logic [9:0] WordBase = 10'h005;
  localparam logic [9:0] WordLines = 10'h007;
  localparam logic [9:0] WordErrorLine = 10'h00a;
  localparam logic [31:0] PlainWords = 32'h0777_73e0;  // by number, those of plain registers
  localparam logic [9:0] WordCounters = 10'h040;

  // ---- Writes: address and data are taken, each into a register; then the word is written

  logic write, refused, address_q, data_q;  // here
  logic [9:0] write_word_q, read_word;
  logic [3:0] strobes_q;
  logic [31:0] write_data_q, mask;  // the bits to write

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
    if (!address_q) write_word_q <= axi_awaddr_i[AddressWidth-1:2];
    if (!data_q) {strobes_q, write_data_q} <= {axi_wstrb_i, axi_wdata_i};
    if (write) axi_bresp_o <= {refused, 1'b0};
  end

  logic command, plain, rebase, clear;
  logic [3:0] commands;
  assign commands     = (write && write_word_q == WordCommand) ? write_data_q[3:0] & mask[3:0] : '0;
  assign plain        = (write_word_q < 10'd32) && PlainWords[write_word_q[4:0]];
  assign rebase       = (write_word_q == WordBase) | (write_word_q == WordBase + 10'd1);
  assign refused      = ((camera_busy_i | core_busy_i) & (plain | (commands[1:0] != '0)))
                      | (outstanding_i & (rebase | commands[1]));
  assign command      = write & ~refused;
  assign start_o      = command & commands[0];
  assign invalidate_o = command & (commands[1] | rebase);
  assign clear        = command & commands[2];

  // ---- Plain registers: base, corner, size and the camera's

  logic [32*32-1:0] words;  // by word number

  for (genvar n = 0; n < 32; n++) begin : gen_word
    // That can be written. Yosys 0.23 reads '1 in a conditional as 32'd1.
    localparam logic [31:0] Bits = (n == 32'(WordBase)) ? 32'hFFFF_FFC0
                                 : (n == 32'(WordLines)) ? 32'h0FFF_FFFF : 32'hFFFF_FFFF;
    if (PlainWords[n]) begin : gen_plain
      logic [31:0] word_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) word_q <= '0;
        else if (command && write_word_q == 10'(n)) begin
          word_q <= (write_data_q & mask & Bits) | (word_q & ~mask);
        end
      end
      assign words[32*n+:32] = word_q;
    end else begin : gen_none
      assign words[32*n+:32] = '0;
    end
  end

  assign base_o   = words[32*5+:64];
  assign lines_o  = words[32*7+:LineNumberWidth];
  assign corner_o = words[32*8+:32];
  assign size_o   = words[32*9+:32];
  for (genvar v = 0; v < 4; v++) begin : gen_vector
    assign camera_o[96*v+:96] = words[32*(12+4*v)+:96];
  end

  // ---- Flags

  logic [NumFlags-1:0] enable_q, flags_q, raised, lowered;
  logic drawing_q, done, abort_q;
  logic [LineNumberWidth-1:0] error_line_q;

  assign done    = drawing_q & ~camera_busy_i & ~core_busy_i;
  assign raised  = {ray_error_i, bus_error_i, done, doubt_i};
  assign lowered = (write && write_word_q == WordFlags) ? write_data_q[3:0] & mask[3:0] : '0;
  assign interrupt_o = (enable_q & flags_q) != '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      enable_q  <= '0;
      flags_q   <= '0;
      drawing_q <= 1'b0;
      abort_q   <= 1'b0;
      error_line_q <= '0;
    end else begin
      if (write && write_word_q == WordEnable) begin
        enable_q <= (write_data_q[3:0] & mask[3:0]) | (enable_q & ~mask[3:0]);
      end
      flags_q   <= (flags_q & ~lowered) | raised;
      drawing_q <= start_o | camera_busy_i | (drawing_q & ~done);
      if (bus_error_i && !flags_q[2]) error_line_q <= error_number_i;
      abort_q <= (command & commands[3]) | (abort_q & (camera_busy_i | core_busy_i));
    end
  end

  assign drawing_o = drawing_q;
  assign abort_o   = abort_q;

  // ---- Counters

  logic [NumCounters*CounterWidth-1:0] counters;
  logic [NumCounters-1:0] counted;

  assign counted = {events_i, core_busy_i};
  for (genvar n = 0; n < NumCounters; n++) begin : gen_counter
    logic [CounterWidth-1:0] count_q;
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) count_q <= '0;
      else count_q <= clear ? '0 : count_q + CounterWidth'(counted[n]);
    end
    assign counters[CounterWidth*n+:CounterWidth] = count_q;
  end

  // ---- Reads: with a counter's low word its high one is held for the next read

  logic read;
  logic [31:0] value;
  logic [CounterWidth-33:0] high, high_q;

  assign read          = axi_arvalid_i & axi_arready_o;
  assign axi_arready_o = ~axi_rvalid_o;
  assign axi_rresp_o   = 2'b00;
  assign read_word     = axi_araddr_i[AddressWidth-1:2];

  always_comb begin
    value = (read_word < 10'd32) ? words[32*read_word[4:0]+:32] : '0;
    high  = high_q;
    for (int unsigned n = 0; n < NumCounters; n++) begin
      if (read_word == WordCounters + 10'(2 * n)) begin
        {high, value} = counters[CounterWidth*n+:CounterWidth];
      end
      if (read_word == WordCounters + 10'(2 * n + 1)) value = 32'(high_q);
    end
    if (read_word == WordIdentity) value = Identity;
    if (read_word == WordStatus) value = {29'd0, outstanding_i, core_busy_i, camera_busy_i};
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
