// Claims, from reset on, for any memory that answers in any order, with interleaved beats and any errors: The core's
// memory port obeys AXI4 (sim/checks/axi_read_checks). A read is requested at the address of its line. The read returns
// one line, with the read's id and the beats of its burst in order. The line has an error if a beat had an error, or if
// RLAST was not set exactly in the last beat. There are never more lines than reads. Assumption: memory sends only
// requested beats. opened_axi_read_manager is axi_read_manager for two IDs, two beats per line, registers as outputs.
module reader_gives_lines (
  input logic clk,
  input logic choose  // watch the read taken now
);

  (* anyseq *) logic [63:0] base;
  (* anyseq *) logic read_valid, line_ready, arready, rvalid, rid, rlast;
  (* anyseq *) logic [27:0] read_line;
  (* anyseq *) logic [1:0] read_id, rresp;
  (* anyseq *) logic [255:0] rdata;

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic read_ready, line_valid, line_error, arvalid, arid, rready, bus_error, id, beat_fire, beat_id, last;
  logic [1:0] line_id, arburst, free, errors, counts, count, open;
  logic [511:0] line, parts;
  logic [63:0] araddr;
  logic [7:0] arlen;
  logic [2:0] arsize;
  logic [27:0] error_number;
  logic [3:0] read_ids;
  logic read_q, write_q;
  logic [517:0] queue;
  logic [15:0] left;

  opened_axi_read_manager dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .base_i(base),
    .read_valid_i(read_valid),
    .read_ready_o(read_ready),
    .read_line_i(read_line),
    .read_id_i(read_id),
    .line_valid_o(line_valid),
    .line_ready_i(line_ready),
    .line_id_o(line_id),
    .line_o(line),
    .line_error_o(line_error),
    .axi_arvalid_o(arvalid),
    .axi_arready_i(arready),
    .axi_arid_o(arid),
    .axi_araddr_o(araddr),
    .axi_arlen_o(arlen),
    .axi_arsize_o(arsize),
    .axi_arburst_o(arburst),
    .axi_rvalid_i(rvalid),
    .axi_rready_o(rready),
    .axi_rid_i(rid),
    .axi_rdata_i(rdata),
    .axi_rresp_i(rresp),
    .axi_rlast_i(rlast),
    .bus_error_o(bus_error),
    .error_number_o(error_number),
    .free_q(free),
    .id(id),
    .beat_fire(beat_fire),
    .beat_id(beat_id),
    .last(last),
    .errors_q(errors),
    .\u_beats.count_q (count),
    .\u_beats.read_q (read_q),
    .\u_beats.write_q (write_q),
    .read_ids(read_ids),
    .counts(counts),
    .u_beats_words(queue),
    .\gen_beat[0]_u_part_words (parts)
  );

  axi_read_checks #(
    .IdWidth(1),
    .DataWidth(256),
    .Inputs(1'b0)
  ) u_checks (
    .clk_i(clk),
    .rst_ni(reset_n),
    .arvalid(arvalid),
    .arready(arready),
    .arid(arid),
    .araddr(araddr),
    .arlen(arlen),
    .arsize(arsize),
    .arburst(arburst),
    .rvalid(rvalid),
    .rready(rready),
    .rid(rid),
    .r({rresp, rdata}),
    .rlast(rlast),
    .open_q(open),
    .left_q(left)
  );

  always_comb assume (!rvalid || open[rid]);

  // ---- Numbers of reads and lines

  logic read, given;
  logic [2:0] reads;  // reads whose line has not been taken
  assign read  = read_valid && read_ready;
  assign given = line_valid && line_ready;
  always_ff @(posedge clk) reads <= reset_n ? reads + 3'(read) - 3'(given) : '0;

  // ---- The watched read: its request, its beats, and its line at the output

  logic watching, asked, answering, its_id, first_last, second_last, first_error, second_error, error;
  logic [1:0] its_read_id;
  logic [63:0] its_address;
  logic [255:0] first, second;
  initial {watching, asked, answering} = '0;
  always_ff @(posedge clk) begin
    if (!reset_n) {watching, asked, answering} <= '0;
    else if (!watching) begin
      {asked, answering} <= '0;
      if (read && choose) begin
        watching    <= 1'b1;
        its_id      <= id;
        its_read_id <= read_id;
        its_address <= {base[63:6], 6'd0} + {30'd0, read_line, 6'd0};
      end
    end else begin
      if (arvalid && arready && arid == its_id) asked <= 1'b1;
      if (asked && !answering && rvalid && rready && rid == its_id) begin
        if (left[8*rid+:8] == 1) {first_error, first_last, first} <= {rresp[1], rlast, rdata};
        else {second_error, second_last, second} <= {rresp[1], rlast, rdata};
      end
      if (!answering && beat_fire && last && beat_id == its_id) answering <= 1'b1;
      if (answering && given) watching <= 1'b0;
    end
  end
  assign error = first_error || first_last || second_error || !second_last;

  // ---- Queued beats; the first is at `read_q`

  logic [258:0] head, next;
  logic [1:0] waits[2];  // by ID: number of beats in the queue
  logic [1:0] sent[2];   // by ID: number of beats received
  assign head = queue[259*read_q+:259];
  assign next = queue[259*!read_q+:259];
  for (genvar n = 0; n < 2; n++) begin : gen_id
    assign waits[n] = 2'(count >= 1 && head[256] == n) + 2'(count == 2 && next[256] == n);
    assign sent[n]  = open[n] ? 2'd1 - left[8*n+:2] : 2'd2;
  end

  always_comb begin
    if (reset_n) begin
      assert (reads == 3'(!free[0]) + 3'(!free[1]) + 3'(line_valid));
      if (watching && arvalid && arid == its_id && !asked) assert (araddr == its_address);
      if (watching && answering) begin
        assert (asked);
        assert (line_valid && line_id == its_read_id && line == {second, first});
        assert (line_error == error);
      end

      // Invariants
      assert (count <= 2 && write_q == (read_q ^ count[0]));
      for (int n = 0; n < 2; n++) begin
        if (open[n]) assert (left[8*n+:8] <= 1);
        if (free[n] || (arvalid && arid == n)) begin
          assert (!open[n] && waits[n] == 0);
          if (!free[n]) assert (!counts[n] && !errors[n]);
        end else assert (sent[n] == 2'(counts[n]) + waits[n]);
        if (arvalid) assert (!free[arid]);
      end
      if (watching && !answering) begin
        assert (!free[its_id] && read_ids[2*its_id+:2] == its_read_id);
        assert (asked != (arvalid && arid == its_id));
        if (counts[its_id]) begin
          assert (parts[256*its_id+:256] == first && errors[its_id] == (first_error || first_last));
        end else assert (!errors[its_id]);
        if (count >= 1 && head[256] == its_id) begin
          assert (head == (counts[its_id] ? {second_error, second_last, its_id, second}
                                          : {first_error, first_last, its_id, first}));
        end
        if (count == 2 && next[256] == its_id) begin
          assert (next == (counts[its_id] || head[256] == its_id
                           ? {second_error, second_last, its_id, second} : {first_error, first_last, its_id, first}));
        end
      end

      cover (watching && answering && !error && !free[!its_id]);
      cover (watching && answering && error && !first_error);
      cover (watching && asked && counts[!its_id] && counts[its_id] && !free[!its_id]);
    end
  end

endmodule
