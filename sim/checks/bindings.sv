// Which checks watch which module of hw/, in every Verilated model (sim/verilate.cmake). A module that a
// model lacks is passed over.

bind fifo fifo_checks #(
  .Depth(Depth),
  .Reserve(Reserve)
) u_fifo_checks (
  .clk_i,
  .rst_ni,
  .push_i,
  .space_o,
  .pop_i,
  .valid_o
);
bind hit_test_pipeline stream_checks #(
  .Width($bits({first_i, last_i, tag_i, direction_i, record_i}))
) u_input_checks (
  .clk_i,
  .rst_ni,
  .valid(valid_i & rst_ni),
  .ready(ready_o),
  .data ({first_i, last_i, tag_i, direction_i, record_i})
);
bind hit_test_pipeline stream_checks #(
  .Width($bits({report_o, report_tag_o, closed_o, found_o, tag_o, t_o, t_error_o, point_valid_o, point_o}))
) u_output_checks (
  .clk_i,
  .rst_ni,
  .valid(valid_o),
  .ready(ready_i),
  .data ({report_o, report_tag_o, closed_o, found_o, tag_o, t_o, t_error_o, point_valid_o, point_o})
);
bind hit_test_pipeline burst_checks #(
  .DirectionWidth(3 * Width)
) u_burst_checks (
  .clk_i,
  .rst_ni,
  .taken (valid_i & ready_o),
  .first_i,
  .last_i,
  .direction_i,
  .given (valid_o & ready_i),
  .report(report_o),
  .closed_o,
  .found_o,
  .point_valid_o
);
