// Control and status registers of the ray core, on AXI4-Lite: what to draw, from which memory, counters, flags.
//
// Words of 32 bits; reading elsewhere gives 0, writing elsewhere does nothing. Bytes that wstrb leaves out
// stay. Binary32 vectors are three words, x first.
//
//   0x000  identity   ro   0x52470001
//   0x004  command    wo   bit 0: make the rays of the rectangle; 1: memory has changed; 2: counters to zero
//   0x008  status     ro   bit 0: the generator has rays to make; 1: rays are in the core, or lines
//                          on their way to it
//   0x00c  enable     rw   of interrupts, as in `flags`
//   0x010  flags      w1c  bit 0: a doubt has left; 1: the last ray of a rectangle has ended; 2: memory
//                          has answered with an error
//                          An event that comes as its flag is lowered raises it again
//   0x014  base       rw   two words: address of line 0, low word first; a multiple of 64
//   0x020  corner     rw   the rectangle's first pixel: x in bits 15:0, y in 31:16
//   0x024  size       rw   its width and height, likewise
//   0x030  eye        rw   where generated rays begin; 0x040 first, 0x050 right, 0x060 down: see ray_generator
//   0x100  counters   ro   two words each, low word first: clocks with status bit 1 high, then those of
//                          ray_core_pkg::event_e in their order. Of 48 bits, modulo 2**48
//
// So a picture is drawn by one write of `size` and one of `command`, where the camera stays. Commands and writes
// to what the camera reads are the user's to hold back while status is not 0.
//
// One write and one read at a time: a write is taken when its address and its data are there.
// interrupt_o is high while a flag is that is enabled.
// Source: AMBA AXI protocol specification, issue E, B1 (AXI4-Lite).
module csr #(
  localparam int unsigned AddressWidth = 12
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
  output logic [63:0]             base_o,
  output logic [31:0]             corner_o,
  output logic [31:0]             size_o,
  output logic [4*96-1:0]         camera_o,      // eye lowest, then first, right, down
  input  logic                    camera_busy_i,
  input  logic                    core_busy_i,
  input  logic                    doubt_i,       // this clock's
  input  logic                    bus_error_i,
  input  logic [ray_core_pkg::NumEvents-1:0] events_i,
  output logic                    interrupt_o
);

  localparam logic [31:0] Identity = 32'h5247_0001;
  localparam int unsigned NumCounters = 1 + ray_core_pkg::NumEvents;
  localparam int unsigned CounterWidth = 48;
  localparam int unsigned NumFlags = 3;

  // Word numbers
  localparam logic [9:0] WordIdentity = 10'h000;
  localparam logic [9:0] WordCommand = 10'h001;
  localparam logic [9:0] WordStatus = 10'h002;
  localparam logic [9:0] WordEnable = 10'h003;
  localparam logic [9:0] WordFlags = 10'h004;
  localparam logic [9:0] WordBase = 10'h005;
  localparam logic [9:0] WordEnd = 10'h01b;  // behind the plain registers, whose first is WordBase
  localparam logic [9:0] WordCounters = 10'h040;

  // ---- Writes

  logic write;
  logic [9:0] write_word, read_word;
  logic [31:0] written;  // bits that are

  assign write         = axi_awvalid_i & axi_wvalid_i & (~axi_bvalid_o | axi_bready_i);
  assign axi_awready_o = write;
  assign axi_wready_o  = write;
  assign axi_bresp_o   = 2'b00;
  assign write_word    = axi_awaddr_i[AddressWidth-1:2];
  assign written       = {{8{axi_wstrb_i[3]}}, {8{axi_wstrb_i[2]}}, {8{axi_wstrb_i[1]}},
                          {8{axi_wstrb_i[0]}}};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) axi_bvalid_o <= 1'b0;
    else axi_bvalid_o <= write | (axi_bvalid_o & ~axi_bready_i);
  end

  logic command, clear;
  assign command      = write & (write_word == WordCommand);
  assign start_o      = command & axi_wdata_i[0] & axi_wstrb_i[0];
  assign invalidate_o = command & axi_wdata_i[1] & axi_wstrb_i[0];
  assign clear        = command & axi_wdata_i[2] & axi_wstrb_i[0];

  // ---- Plain registers: base, corner, size and the camera's

  logic [31:0] words[32];  // by word number; those of other registers are not used

  always_ff @(posedge clk_i) begin
    if (write && write_word < 10'd32) begin
      words[write_word[4:0]] <= (axi_wdata_i & written) | (words[write_word[4:0]] & ~written);
    end
  end

  assign base_o   = {words[6], words[5]};
  assign corner_o = words[8];
  assign size_o   = words[9];
  for (genvar v = 0; v < 4; v++) begin : gen_vector
    assign camera_o[96*v+:96] = {words[14+4*v], words[13+4*v], words[12+4*v]};
  end

  // ---- Flags

  logic [NumFlags-1:0] enable_q, flags_q, raised, lowered;
  logic drawing_q, done;  // a rectangle's rays are on their way

  assign done    = drawing_q & ~camera_busy_i & ~core_busy_i;
  assign raised  = {bus_error_i, done, doubt_i};
  assign lowered = (write && write_word == WordFlags) ? axi_wdata_i[2:0] & written[2:0] : '0;
  assign interrupt_o = (enable_q & flags_q) != '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      enable_q  <= '0;
      flags_q   <= '0;
      drawing_q <= 1'b0;
    end else begin
      if (write && write_word == WordEnable) begin
        enable_q <= (axi_wdata_i[2:0] & written[2:0]) | (enable_q & ~written[2:0]);
      end
      flags_q   <= (flags_q & ~lowered) | raised;
      drawing_q <= camera_busy_i | (drawing_q & ~done);
    end
  end

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

  // ---- Reads

  logic read;
  logic [31:0] value;

  assign read          = axi_arvalid_i & (~axi_rvalid_o | axi_rready_i);
  assign axi_arready_o = read;
  assign axi_rresp_o   = 2'b00;
  assign read_word     = axi_araddr_i[AddressWidth-1:2];

  always_comb begin
    value = '0;
    for (int unsigned n = 0; n < NumCounters; n++) begin
      if (read_word == WordCounters + 10'(2 * n)) value = counters[CounterWidth*n+:32];
      if (read_word == WordCounters + 10'(2 * n + 1)) begin
        value = 32'(counters[CounterWidth*n+32+:CounterWidth-32]);
      end
    end
    if (read_word >= WordBase && read_word < WordEnd) value = words[read_word[4:0]];
    if (read_word == WordIdentity) value = Identity;
    if (read_word == WordStatus) value = {30'd0, core_busy_i, camera_busy_i};
    if (read_word == WordEnable) value = 32'(enable_q);
    if (read_word == WordFlags) value = 32'(flags_q);
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) axi_rvalid_o <= 1'b0;
    else axi_rvalid_o <= read | (axi_rvalid_o & ~axi_rready_i);
  end
  always_ff @(posedge clk_i) if (read) axi_rdata_o <= value;

  logic unused;  // words begin at multiples of four
  assign unused = ^{axi_awaddr_i[1:0], axi_araddr_i[1:0]};

endmodule
