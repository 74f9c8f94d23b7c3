// Composition of the multiplier's proof, step 3. Claim: the words that enter the carry-save tree add up to
//   the sum over k of (row[k] + n[k] - n[k] * 2**25) * 4**k, modulo 2**48,
// with row[k] partial product k, and n[k] 1 if digit k is negative. SAT solvers cannot prove this sum at once; it is
// proven in two parts. First: word k is its value for rows of 0, plus row[k] * 4**k. Second: the words for rows of 0
// add up to the terms in n. With Words = 14, a word of constants precedes word 0. booth_assembly in synth/prove.py
// makes module "assembly" from the multiplier.
module booth_assembly_sums #(
  parameter int unsigned Words = 13
) (
  input logic [13*25-1:0] row_values,
  input logic [11:0]      n           // bit k: digit k is negative; digit 12 is not negative (step 1)
);

  logic [48*Words-1:0] words, bare;

  assembly_words #(.Words(Words)) u_words (.row_values, .n, .words);
  assembly_words #(.Words(Words)) u_bare (.row_values(325'd0), .n, .words(bare));

  for (genvar k = 0; k < Words; k++) begin : gen_word
    logic [47:0] row;
    localparam int Digit = k - (Words - 13);
    if (Digit >= 0) begin : gen_row
      assign row = 48'(row_values[25*Digit +: 25]) << 2 * Digit;
    end else begin : gen_none
      assign row = '0;
    end
    always_comb assert (words[48*k +: 48] == bare[48*k +: 48] + row);
  end

  logic [47:0] total, signs;
  always_comb begin
    total = '0;
    for (int unsigned k = 0; k < Words; k++) total = total + bare[48*k +: 48];
    signs = '0;
    for (int unsigned k = 0; k < 12; k++) begin
      signs = signs + (48'(n[k]) << 2 * k) - (48'(n[k]) << (25 + 2 * k));
    end
  end

  always_comb assert (total == signs);

endmodule

// The assembly with its ports as vectors.
module assembly_words #(
  parameter int unsigned Words = 13
) (
  input  logic [13*25-1:0]    row_values,
  input  logic [11:0]         n,
  output logic [48*Words-1:0] words
);

  logic [25:0] negative;
  always_comb begin
    negative = '0;
    for (int unsigned k = 0; k < 12; k++) negative[2*k] = n[k];
  end

  assembly u_assembly (
    .rows(words),
    .negative(negative),
    .\gen_row[0].row (row_values[25*0 +: 25]),
    .\gen_row[1].row (row_values[25*1 +: 25]),
    .\gen_row[2].row (row_values[25*2 +: 25]),
    .\gen_row[3].row (row_values[25*3 +: 25]),
    .\gen_row[4].row (row_values[25*4 +: 25]),
    .\gen_row[5].row (row_values[25*5 +: 25]),
    .\gen_row[6].row (row_values[25*6 +: 25]),
    .\gen_row[7].row (row_values[25*7 +: 25]),
    .\gen_row[8].row (row_values[25*8 +: 25]),
    .\gen_row[9].row (row_values[25*9 +: 25]),
    .\gen_row[10].row (row_values[25*10 +: 25]),
    .\gen_row[11].row (row_values[25*11 +: 25]),
    .\gen_row[12].row (row_values[25*12 +: 25])
  );

endmodule
