// Link to a host: words become lines and rays, results become words.
//
// Bits 31:28 of a message's first word are its kind, bits 27:0 a number:
//   1     writes the line of that number; its 16 words follow
//   2     memory has changed: it now has that number of lines, and the caches are emptied
//   4-7   a ray: any_hit in bit 28; its tag, source_id, skip_id, t_max, and x, y, z of direction and origin follow
// Other messages are ignored. A result is 8 words: result_t in the lowest bits, zeros above it.
//
// The host must send kinds 1 and 2 while no ray is in the core; they take effect when the core has no read in flight.
// Words use valid/ready handshakes.
//
// A break (break_i, for a clock) ends the host's session: the next word is a message's first, and the rays in the core
// are aborted. A result being sent is completed, others are dropped. Words are accepted again when no ray is left.
module core_link
  import ray_core_pkg::*;
(
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // words from the host
  input  logic                    word_valid_i,
  output logic                    word_ready_o,
  input  logic [31:0]             word_i,
  input  logic                    break_i,
  // words to the host
  output logic                    word_valid_o,
  input  logic                    word_ready_i,
  output logic [31:0]             word_o,
  // lines to memory
  output logic                    write_valid_o,
  input  logic                    write_ready_i,
  output logic [AddressWidth-1:0] write_line_o,
  output logic [LineWidth-1:0]    write_data_o,
  // the core
  output logic                    invalidate_o,
  output logic                    abort_o,
  input  logic                    outstanding_i,
  output logic [AddressWidth-1:0] lines_o,
  output logic                    ray_valid_o,
  input  logic                    ray_ready_i,
  output ray_t                    ray_o,
  input  logic                    result_valid_i,
  output logic                    result_ready_o,
  input  result_t                 result_i
);

  localparam int unsigned LineWords = LineWidth / 32;
  localparam int unsigned RayWords = 10;
  localparam int unsigned ResultWords = 8;
  localparam logic [3:0] KindLine = 4'd1;
  localparam logic [3:0] KindLines = 4'd2;

  // ---- Messages: the first word, then the others from the top of a shift register

  logic outstanding_q;  // a clock late; while no ray is in the core, outstanding_i cannot rise
  logic first_q, full_q, done, is_ray;  // first_q: a message's first word is next; full_q: all came
  logic [3:0] kind_q;
  logic [4:0] left_q;  // words of the message still to come
  logic [AddressWidth-1:0] number_q;
  logic [LineWords*32-1:0] words_q;
  logic [15:0] rays_q;  // number of rays in the core
  logic ray_fire, ended, result_load;

  assign word_ready_o = ~full_q & ~abort_o;
  assign is_ray       = kind_q[3:2] == 2'b01;

  always_comb begin
    done = 1'b1;  // an unknown message is done at once
    if (kind_q == KindLine) done = write_ready_i & ~outstanding_q;
    if (kind_q == KindLines) done = ~outstanding_q;
    if (is_ray) done = ray_ready_i;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      first_q <= 1'b1;
      full_q  <= 1'b0;
      left_q  <= '0;
      lines_o <= '0;
      rays_q  <= '0;
      abort_o <= 1'b0;
    end else begin
      rays_q  <= rays_q + 16'(ray_fire) - 16'(ended);
      abort_o <= break_i | (abort_o & (full_q | (rays_q != '0)));
      if (word_valid_i && word_ready_o) begin
        if (first_q) begin
          left_q  <= (word_i[31:28] == KindLine) ? 5'(LineWords)
                   : (word_i[31:30] == 2'b01) ? 5'(RayWords) : '0;
          first_q <= (word_i[31:28] != KindLine) & (word_i[31:30] != 2'b01);
          full_q  <= (word_i[31:28] != KindLine) & (word_i[31:30] != 2'b01);
        end else begin
          left_q  <= left_q - 1'b1;
          first_q <= left_q == 5'd1;
          full_q  <= left_q == 5'd1;
        end
      end
      if (full_q && done) full_q <= 1'b0;
      if (invalidate_o) lines_o <= number_q;
      if (break_i) first_q <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    outstanding_q <= outstanding_i;
    if (word_valid_i && word_ready_o) begin
      if (first_q) {kind_q, number_q} <= word_i;
      else words_q <= {word_i, words_q[LineWords*32-1:32]};
    end
  end

  assign write_valid_o = full_q & (kind_q == KindLine) & ~outstanding_q;
  assign write_line_o  = number_q;
  assign write_data_o  = words_q;
  assign invalidate_o  = full_q & (kind_q == KindLines) & ~outstanding_q;

  localparam int unsigned Ray = (LineWords - RayWords) * 32;  // first bit of the ray's words
  assign ray_valid_o     = full_q & is_ray;
  assign ray_fire        = ray_valid_o & ray_ready_i;
  assign ray_o.tag       = words_q[Ray+:32];
  assign ray_o.source_id = words_q[Ray+32+:32];
  assign ray_o.skip_id   = words_q[Ray+64+:32];
  assign ray_o.t_max     = words_q[Ray+96+:31];
  assign ray_o.direction = words_q[Ray+128+:96];
  assign ray_o.origin    = words_q[Ray+224+:96];
  assign ray_o.any_hit   = kind_q[0];

  // ---- Results

  logic [ResultWords*32-1:0] result_q;
  logic [ResultWords-1:0] result_left_q;  // a 1 for each word still to go

  assign word_valid_o   = result_left_q[0];
  assign word_o         = result_q[31:0];
  assign result_load    = result_valid_i & ~result_left_q[0] & ~abort_o;
  assign result_ready_o = ~result_left_q[0] | abort_o;
  assign ended = result_valid_i & result_ready_o & (result_i.kind == ResultEnd);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) result_left_q <= '0;
    else if (result_load) result_left_q <= '1;
    else if (word_ready_i) result_left_q <= result_left_q >> 1;
  end
  always_ff @(posedge clk_i) begin
    if (result_load) result_q <= (ResultWords * 32)'(result_i);
    else if (word_ready_i) result_q <= result_q >> 32;
  end

endmodule
