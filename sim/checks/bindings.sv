// Binds checks to modules of hw/ in every Verilated model (sim/verilate.cmake). Modules that a model lacks are skipped.
// Widths are taken from ports, because netlists have no parameters.

// Some outputs of checks are only for proofs.
// verilator lint_off PINCONNECTEMPTY

bind fifo fifo_checks #(
  .Depth(Depth),
  .Reserve(Reserve),
  .Late(Memory)
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
// Last is 0: RLAST is not checked, because the memory in this module's own test also sets RLAST in wrong beats.
bind axi_read_manager axi_read_checks #(
  .IdWidth($bits(axi_arid_o)),
  .DataWidth($bits(axi_rdata_i)),
  .Last(1'b0)
) u_read_checks (
  .clk_i,
  .rst_ni,
  .arvalid(axi_arvalid_o),
  .arready(axi_arready_i),
  .arid(axi_arid_o),
  .araddr(axi_araddr_o),
  .arlen(axi_arlen_o),
  .arsize(axi_arsize_o),
  .arburst(axi_arburst_o),
  .rvalid(axi_rvalid_i),
  .rready(axi_rready_o),
  .rid(axi_rid_i),
  .r({axi_rresp_i, axi_rdata_i}),
  .rlast(axi_rlast_i),
  .open_q(),
  .left_q()
);
bind ray_core_axi axi_read_checks #(
  .IdWidth($bits(m_axi_arid)),
  .DataWidth($bits(m_axi_rdata))
) u_read_checks (
  .clk_i,
  .rst_ni,
  .arvalid(m_axi_arvalid),
  .arready(m_axi_arready),
  .arid(m_axi_arid),
  .araddr(m_axi_araddr),
  .arlen(m_axi_arlen),
  .arsize(m_axi_arsize),
  .arburst(m_axi_arburst),
  .rvalid(m_axi_rvalid),
  .rready(m_axi_rready),
  .rid(m_axi_rid),
  .r({m_axi_rresp, m_axi_rdata}),
  .rlast(m_axi_rlast),
  .open_q(),
  .left_q()
);
bind axi_write_manager axi_write_checks #(
  .DataWidth($bits(axi_wdata_o))
) u_write_checks (
  .clk_i,
  .rst_ni,
  .awvalid(axi_awvalid_o),
  .awready(axi_awready_i),
  .awaddr(axi_awaddr_o),
  .awlen(axi_awlen_o),
  .awsize(axi_awsize_o),
  .awburst(axi_awburst_o),
  .wvalid(axi_wvalid_o),
  .wready(axi_wready_i),
  .w({axi_wstrb_o, axi_wdata_o}),
  .wlast(axi_wlast_o),
  .bvalid(axi_bvalid_i),
  .bready(axi_bready_o),
  .bresp(axi_bresp_i),
  .addresses_q(),
  .bursts_q(),
  .beat_q()
);
bind ray_core_axi stream_checks #(
  .Width($bits({m_axis_tdata, m_axis_tlast}))
) u_stream_checks (
  .clk_i,
  .rst_ni,
  .valid(m_axis_tvalid),
  .ready(m_axis_tready),
  .data ({m_axis_tdata, m_axis_tlast})
);
bind csr axi_lite_checks #(
  .AddressWidth($bits(axi_awaddr_i))
) u_port_checks (
  .clk_i,
  .rst_ni,
  .awvalid(axi_awvalid_i),
  .awready(axi_awready_o),
  .awaddr(axi_awaddr_i),
  .wvalid(axi_wvalid_i),
  .wready(axi_wready_o),
  .w({axi_wdata_i, axi_wstrb_i}),
  .bvalid(axi_bvalid_o),
  .bready(axi_bready_i),
  .bresp(axi_bresp_o),
  .arvalid(axi_arvalid_i),
  .arready(axi_arready_o),
  .araddr(axi_araddr_i),
  .rvalid(axi_rvalid_o),
  .rready(axi_rready_i),
  .r({axi_rdata_o, axi_rresp_o}),
  .addresses_q(),
  .words_q(),
  .reads_q()
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
`ifndef RAYGATE_NETLIST  // netlists lack these registers
bind exact_unit exact_checks #(
  .AddressWidth($bits(x_address))
) u_program_checks (
  .clk_i,
  .rst_ni,
  .reads(valid & (issue.step.kind >= exact_pkg::KindCross) & ~issue.step.empty),
  .x_address,
  .y_address,
  .writes(valid_q & {stage_q[4].step.closes & ~stage_q[4].step.down,
                     stage_q[3].step.closes & ~stage_q[3].step.down,
                     stage_q[2].step.closes & ~stage_q[2].step.down,
                     stage_q[1].step.closes & ~stage_q[1].step.down}),
  .addresses({stage_q[4].result, stage_q[3].result, stage_q[2].result, stage_q[1].result})
);
`endif
