; srt_divider around rows that may do anything that keeps |w| <= 2/3 d: the first row gets 2 x and d, every other row
; the outputs of the row before it, and d; the quotient is the positive digits minus the negative digits, minus one if w
; is negative in the end.
(define-fun divisor () Residual (concat #b0 divisor_i))
(define-fun last () Exact (residual free_sum_o_$ROWS free_carry_o_$ROWS))
(define-fun negative () Bool (bvslt last (_ bv0 $N4)))
(define-fun assumed () Bool
  (and (is-divisor divisor) (is-divisor (concat #b0 dividend_i)) (is-remainder last divisor)))
(define-fun claimed () Bool
  (and (= free_dividend_doubled_i_0 (concat dividend_i #b0))
       (= free_divisor_i_0 divisor)
       $CHAIN
       (= quotient_o
          (bvsub (bvsub $POSITIVES $NEGATIVES) ((_ zero_extend $Q1) (ite negative #b1 #b0))))
       (= remainder_o (not (= last (_ bv0 $N4))))))
