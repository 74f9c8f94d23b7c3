; srt_divider_stages around rows that may do anything that keeps |w| <= 2/3 d: its first digit, of 1 .. 4,
; leaves w = 2 x - digit d and |w| <= 2/3 d; each row gets what the row before it gave; the quotient is the
; positive digits less the negative ones, less one if w is negative in the end.
(define-fun divisor () Residual (concat #b0 divisor_i))
(define-fun first () Exact (ite (= free_positives_i_1 #b00) (_ bv4 $N4) (small free_positives_i_1)))
(define-fun w () Exact (residual free_sum_i_1 free_carry_i_1))
(define-fun last () Exact (residual free_sum_o_$ROWS free_carry_o_$ROWS))
(define-fun negative () Bool (bvslt last (_ bv0 $N4)))
(define-fun assumed () Bool
  (and (is-divisor divisor) (is-divisor (concat #b0 dividend_i)) (is-remainder last divisor)))
(define-fun claimed () Bool
  (and (= w (bvsub (unsigned (concat dividend_i #b0)) (times first divisor)))
       (is-remainder w divisor)
       (= free_negatives_i_1 #b00)
       (= free_divisor_i_1 divisor)
       $CHAIN
       (= quotient_o
          (bvsub (bvsub free_positives_o_$ROWS free_negatives_o_$ROWS)
                 ((_ zero_extend $Q1) (ite negative #b1 #b0))))
       (= remainder_o (not (= last (_ bv0 $N4))))))
