// Claim: rr_arbiter grants a request if there is any. It grants the first request at or above `from`, wrapping around.
module arbiter_is_fair #(
  parameter int unsigned Width = 64,
  localparam int unsigned IndexWidth = $clog2(Width)
) (
  input logic [Width-1:0]      requests,
  input logic [IndexWidth-1:0] from,
  input logic [IndexWidth-1:0] other  // any index
);

  logic valid;
  logic [IndexWidth-1:0] index;

  rr_arbiter #(
    .Width(Width)
  ) dut (
    .requests_i(requests),
    .start_i(from),
    .valid_o(valid),
    .index_o(index)
  );

  logic [IndexWidth-1:0] distance, other_distance;  // from `from` upwards, wrapping around
  assign distance       = index - from;
  assign other_distance = other - from;

  always_comb begin
    assert (valid == (requests != '0));
    if (valid) assert (requests[index]);
    if (requests[other]) assert (distance <= other_distance);
  end

endmodule
