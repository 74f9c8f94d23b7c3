// Quotient-digit selection of the radix-4 SRT divider: the thresholds at which digits begin.
//
// d in [1, 2) is the divisor, w the residual, |w| <= 2/3 d, and y = 4 w. Digit k of -2 .. 2 is valid if the next
// residual, y - k d, is again at most 2/3 d in magnitude: if y is in [(k - 2/3) d, (k + 2/3) d]. The intervals of k - 1
// and k overlap by d/3. So the first bits of d and an estimate of y in eighths suffice to choose k. The estimate is too
// low by less than 2/8. The digit is k or more if the estimate is at least a threshold m_k. For every d with these
// first bits,
//   1. m_k >= (k - 2/3) d, so that y is not below the interval of k if k is chosen;
//   2. m_k <= (k - 1 + 2/3) d - 1/8: an estimate below m_k is at most m_k - 1/8, so y is less than m_k + 1/8.
// The functions return the smallest m_k of condition 1. sound() and first_sound() check condition 2 for srt_divider.
// Source: Ercegovac and Lang, "Division and Square Root", 1994, chapter 3.
package srt_pkg;

  // Returns n / d rounded up, for d > 0. (The language's / rounds towards zero.)
  function automatic int ceiling(int n, int d);
    ceiling = (n > 0) ? (n + d - 1) / d : n / d;
  endfunction

  // Returns m_k, in eighths, for d in [1 + i/8, 1 + (i+1)/8): the largest (k - 2/3) d, rounded up.
  function automatic int threshold(int k, int i);
    threshold = ceiling((3 * k - 2) * ((k > 0) ? i + 9 : i + 8), 3);
  endfunction

  // Returns m_k of all intervals i of d, one byte per interval, interval 0 lowest. A byte is m_k in eighths plus 64, so
  // that bytes compare as unsigned numbers.
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

  // Returns m_k of the first digit, k = 2 .. 4, in eighths, for d in [1 + i/16, 1 + (i+1)/16) and y = 2 x in [2, 4). As
  // y is known exactly, condition 2 is m_k <= (k - 1 + 2/3) d. m_k is limited to 32 eighths, as y is below 4.
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
