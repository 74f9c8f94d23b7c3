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
bind ram_fifo fifo_checks #(
  .Depth(Depth),
  .Reserve(Reserve),
  .Late(1'b1)
) u_fifo_checks (
  .clk_i,
  .rst_ni,
  .push_i,
  .space_o,
  .pop_i,
  .valid_o
);
bind stream_arbiter stream_checks #(
  .Width($bits({data_o, source_o}))
) u_output_checks (
  .clk_i,
  .rst_ni,
  .valid(valid_o & rst_ni),
  .ready(ready_i),
  .data ({data_o, source_o})
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
  .in_fire(valid_i & ready_o),
  .first_i,
  .last_i,
  .direction_i,
  .out_fire(valid_o & ready_i),
  .report(report_o),
  .closed_o,
  .found_o,
  .point_valid_o
);
bind ray_generator stream_checks #(
  .Width($bits({direction_o, pixel_o}))
) u_output_checks (
  .clk_i,
  .rst_ni,
  .valid(valid_o),
  .ready(ready_i),
  .data ({direction_o, pixel_o})
);
bind axi_read_manager stream_checks #(
  .Width($bits({axi_arid_o, axi_araddr_o, axi_arlen_o, axi_arsize_o, axi_arburst_o, axi_arprot_o}))
) u_request_checks (
  .clk_i,
  .rst_ni,
  .valid(axi_arvalid_o),
  .ready(axi_arready_i),
  .data ({axi_arid_o, axi_araddr_o, axi_arlen_o, axi_arsize_o, axi_arburst_o, axi_arprot_o})
);
bind csr stream_checks #(
  .Width($bits(axi_bresp_o))
) u_write_checks (
  .clk_i,
  .rst_ni,
  .valid(axi_bvalid_o),
  .ready(axi_bready_i),
  .data (axi_bresp_o)
);
bind csr stream_checks #(
  .Width($bits({axi_rdata_o, axi_rresp_o}))
) u_read_checks (
  .clk_i,
  .rst_ni,
  .valid(axi_rvalid_o),
  .ready(axi_rready_i),
  .data ({axi_rdata_o, axi_rresp_o})
);
bind ray_core_axi stream_checks u_ray_checks (
  .clk_i,
  .rst_ni,
  .valid(core_valid),
  .ready(core_ready),
  .data (camera_valid)
);
bind ray_core stream_checks #(
  .Width($bits({read_line_o, read_id_o}))
) u_read_checks (
  .clk_i,
  .rst_ni,
  .valid(read_valid_o),
  .ready(read_ready_i),
  .data ({read_line_o, read_id_o})
);
bind ray_core stream_checks #(
  .Width($bits(result_o))
) u_result_checks (
  .clk_i,
  .rst_ni,
  .valid(result_valid_o),
  .ready(result_ready_i),
  .data (result_o)
);
