// Memory of lines in one SDRAM of 16 bits: reads and writes of 64 bytes by line number, valid/ready.
//
// A line is 32 neighbouring words of a row, and a row has 16 lines. Successive groups of 16 lines are in successive
// banks. Commands leave from registers. The SDRAM's clock is the inverse of clk_i. So the SDRAM takes a command half a
// clock after it left, and the word of a read (CAS latency 2) is sampled two clocks after its command left. Half a
// period of clk_i must cover the SDRAM's access time, 6 ns, and the delays of pads out and back, some 6 ns: at most 40
// MHz. Writes have priority over reads, refreshes over both. A line that was read comes with its request's id and stays
// until it is taken. A line to be written must stay at the port until its last word leaves.
//
// Latency: 36 clocks (at 40 MHz, from the clock that takes a read to line_valid_o). Throughput: a line in 37 clocks.
// Source: data sheets of MT48LC16M16A2 (Micron) and AS4C16M16 (Alliance): 4 banks, 8,192 rows, 512 columns, 256 Mbit.
module sdram_controller
  import ray_core_pkg::*;
#(
  parameter int unsigned ClockMhz = 40,
  parameter int unsigned IdWidth  = 7,
  localparam int unsigned NumberWidth = AddressWidth
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  // lines; only the low 19 bits of a line's number are used
  input  logic                   read_valid_i,
  output logic                   read_ready_o,
  // verilator lint_off UNUSEDSIGNAL
  // The memory has no more than 2**19 lines.
  input  logic [NumberWidth-1:0] read_line_i,
  input  logic [IdWidth-1:0]     read_id_i,
  output logic                   line_valid_o,
  input  logic                   line_ready_i,
  output logic [IdWidth-1:0]     line_id_o,
  output logic [LineWidth-1:0]   line_o,
  input  logic                   write_valid_i,
  output logic                   write_ready_o,
  input  logic [NumberWidth-1:0] write_line_i,
  // verilator lint_on UNUSEDSIGNAL
  input  logic [LineWidth-1:0]   write_data_i,
  // the SDRAM's pins
  output logic                   sdram_ras_no,
  output logic                   sdram_cas_no,
  output logic                   sdram_we_no,
  output logic [1:0]             sdram_bank_o,
  output logic [12:0]            sdram_address_o,
  output logic                   sdram_drive_o,  // sdram_data_o is driven
  output logic [15:0]            sdram_data_o,
  input  logic [15:0]            sdram_data_i
);

  // ---- Times in clocks, rounded up

  localparam int unsigned Start = 200 * ClockMhz;  // wait after power-up: 200 us
  localparam int unsigned Refresh = 6 * ClockMhz;  // 6 us; a line before it: below 7.8 us
  localparam int unsigned CycleClocks = (70 * ClockMhz + 999) / 1000;  // tRFC
  localparam int unsigned RowClocks = (20 * ClockMhz + 999) / 1000;  // tRCD and tRP
  localparam int unsigned Words = 32;
  localparam int unsigned WaitWidth = $clog2(Start + 1);

  // {RAS, CAS, WE}, active low
  localparam logic [2:0] CommandNone = 3'b111;
  localparam logic [2:0] CommandActivate = 3'b011;
  localparam logic [2:0] CommandRead = 3'b101;
  localparam logic [2:0] CommandWrite = 3'b100;
  localparam logic [2:0] CommandPrecharge = 3'b010;
  localparam logic [2:0] CommandRefresh = 3'b001;
  localparam logic [2:0] CommandMode = 3'b000;
  localparam logic [12:0] Mode = 13'h020;  // single words, CAS latency 2
  // Address bit 10: a precharge closes all banks; a read or a write closes its row afterwards (auto-precharge)
  localparam logic [12:0] All = 13'h400;

  typedef enum logic [2:0] {
    StatePrecharge,
    StateRefreshOnce,
    StateRefreshTwice,
    StateMode,
    StateIdle,
    StateWords
  } state_e;

  state_e state_q;
  logic [WaitWidth-1:0] wait_q, refresh_q;
  logic go, word_goes, refresh_due_q, writing_q, last_word, idle, read_fire;
  logic [2:0] command, reading_q;  // reading_q[n]: a read left n clocks ago
  logic [4:0] word_q;
  logic [5:0] left_q;  // words of a line still to come
  logic [3:0] columns_q;  // the line's place in its row
  logic [18:0] number;
  logic [15:0] word_i_q;

  assign go            = wait_q == '0;
  assign word_goes     = go & (state_q == StateWords);  // a read's or a write's command
  assign last_word     = word_q == 5'(Words - 1);
  assign idle          = go & (state_q == StateIdle) & ~refresh_due_q;
  assign write_ready_o = word_goes & writing_q & last_word;
  assign read_ready_o  = idle & ~write_valid_i & ~line_valid_o & (left_q == '0);
  assign read_fire     = read_valid_i & read_ready_o;
  assign number        = write_valid_i ? write_line_i[18:0] : read_line_i[18:0];

  always_comb begin
    command = CommandNone;
    if (go) begin
      case (state_q)
        StatePrecharge: command = CommandPrecharge;
        StateRefreshOnce, StateRefreshTwice: command = CommandRefresh;
        StateMode: command = CommandMode;
        StateIdle: begin
          if (refresh_due_q) command = CommandRefresh;
          else if (write_valid_i | read_fire) command = CommandActivate;
        end
        default: command = writing_q ? CommandWrite : CommandRead;
      endcase
    end
  end

  // ---- Commands

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q       <= StatePrecharge;
      wait_q        <= WaitWidth'(Start);
      refresh_q     <= WaitWidth'(Refresh);
      refresh_due_q <= 1'b0;
      sdram_drive_o <= 1'b0;
      {sdram_ras_no, sdram_cas_no, sdram_we_no} <= CommandNone;
    end else begin
      {sdram_ras_no, sdram_cas_no, sdram_we_no} <= command;
      sdram_drive_o <= word_goes & writing_q;
      refresh_q     <= (refresh_q == '0) ? WaitWidth'(Refresh) : refresh_q - 1'b1;
      refresh_due_q <= (refresh_q == '0) | (refresh_due_q & (command != CommandRefresh));
      case (command)
        CommandPrecharge: wait_q <= WaitWidth'(RowClocks);
        CommandRefresh:   wait_q <= WaitWidth'(CycleClocks);
        CommandMode:      wait_q <= WaitWidth'(2);
        CommandActivate:  wait_q <= WaitWidth'(RowClocks - 1);
        // after the last word: write recovery, then precharge
        CommandRead, CommandWrite: wait_q <= last_word ? WaitWidth'(2 + RowClocks) : '0;
        default: if (!go) wait_q <= wait_q - 1'b1;
      endcase
      if (go) begin
        case (state_q)
          StatePrecharge:    state_q <= StateRefreshOnce;
          StateRefreshOnce:  state_q <= StateRefreshTwice;
          StateRefreshTwice: state_q <= StateMode;
          StateMode:         state_q <= StateIdle;
          StateIdle:         if (idle & (write_valid_i | read_fire)) state_q <= StateWords;
          default:           if (last_word) state_q <= StateIdle;
        endcase
      end
    end
  end

  always_ff @(posedge clk_i) begin
    // It is known late in a clock whether a line is taken, so its number is registered in every clock.
    if (state_q == StateIdle) begin
      word_q       <= '0;
      writing_q    <= write_valid_i;
      columns_q    <= number[3:0];
      sdram_bank_o <= number[5:4];
    end else if (word_goes) begin
      word_q <= word_q + 1'b1;
    end
    sdram_data_o <= write_data_i[16*word_q+:16];
    case (state_q)
      StateIdle:  sdram_address_o <= number[18:6];
      StateWords: sdram_address_o <= (last_word ? All : '0) | 13'({columns_q, word_q});
      StateMode:  {sdram_bank_o, sdram_address_o} <= {2'b00, Mode};
      default:    sdram_address_o <= All;
    endcase
  end

  // ---- Words from the SDRAM

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      reading_q    <= '0;
      left_q       <= '0;
      line_valid_o <= 1'b0;
    end else begin
      reading_q    <= {reading_q[1:0], word_goes & ~writing_q};
      left_q       <= read_fire ? 6'(Words) : left_q - 6'(reading_q[2]);
      line_valid_o <= (reading_q[2] & (left_q == 6'd1)) | (line_valid_o & ~line_ready_i);
    end
  end
  always_ff @(posedge clk_i) begin
    word_i_q <= sdram_data_i;
    if (reading_q[2]) line_o <= {word_i_q, line_o[LineWidth-1:16]};
    if (read_fire) line_id_o <= read_id_i;
  end

endmodule
