// Quotient-digit selection of the radix-4 SRT divider: where each digit begins.
//
// With the divisor d in [1, 2) and the shifted residual y = 4 w, |w| <= 2/3 d, digit k of -2 .. 2 keeps |y - k d| <=
// 2/3 d for y in [(k - 2/3) d, (k + 2/3) d]. Intervals of neighbours overlap by d/3, so the divisor's first bits and an
// estimate of y, too low by less than two of its units, suffice. The digit is k or more if the estimate is at least
// m_k, where
//   m_k >= (k - 2/3) d               for every d with these first bits (k is not chosen too early), and
//   m_k <= (k - 1 + 2/3) d - 1 unit  (k - 1 is not kept too long).
// The functions give the smallest such m_k; sound() and first_sound() check the second condition, and srt_divider
// refuses to elaborate without it.
// Source: Ercegovac and Lang, "Division and Square Root", 1994, chapter 3.
package srt_pkg;

  // The smallest integer that is at least n/d, for d > 0; SystemVerilog cuts off towards zero.
  function automatic int ceiling(int n, int d);
    ceiling = (n > 0) ? (n + d - 1) / d : n / d;
  endfunction

  // The largest (k - 2/3) d for d in interval i, in eighths, rounded up.
  function automatic int threshold(int k, int i);
    threshold = ceiling((3 * k - 2) * ((k > 0) ? i + 9 : i + 8), 3);
  endfunction

  // m_k of all intervals, one byte per interval: in eighths, plus 64, so that they compare as unsigned numbers. Byte i
  // is for a divisor in [1 + i/8, 1 + (i+1)/8).
  function automatic bit [8*8-1:0] thresholds(int k);
    for (int i = 0; i < 8; i++) thresholds[8*i+:8] = 8'(threshold(k, i) + 64);
  endfunction

  function automatic bit sound();
    sound = 1'b1;
    for (int k = -1; k <= 2; k++) begin
      for (int i = 0; i < 8; i++) begin
        if (3 * threshold(k, i) > (3 * k - 1) * ((k > 0) ? i + 8 : i + 9) - 3) sound = 1'b0;
      end
    end
  endfunction

  // The first digit, 1 .. 4, is chosen by y = 2 x in [2, 4), truncated to eighths, and by sixteenths of the divisor. y
  // is not an estimate, so the second condition has no unit; nor need it hold above 4, where there is no y.
  function automatic int first_threshold(int k, int i);
    first_threshold = ceiling((3 * k - 2) * (i + 17), 6);
    if (first_threshold > 32) first_threshold = 32;
  endfunction

  function automatic bit [8*16-1:0] first_thresholds(int k);
    for (int i = 0; i < 16; i++) first_thresholds[8*i+:8] = 8'(first_threshold(k, i));
  endfunction

  function automatic bit first_sound();
    first_sound = 1'b1;
    for (int k = 2; k <= 4; k++) begin
      for (int i = 0; i < 16; i++) begin
        if (6 * first_threshold(k, i) > (3 * k - 1) * (i + 16)) first_sound = 1'b0;
      end
    end
  endfunction

endpackage
