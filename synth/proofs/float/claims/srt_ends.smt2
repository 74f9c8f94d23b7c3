; srt_divider, with rows of which only |w| <= 2/3 d is known (w: residual, x: dividend, d: divisor). The first row's
; inputs are 2 x and d. The inputs of every other row are the outputs of the row before, and d. The quotient is the
; positive digits minus the negative digits, minus one if the last residual is negative.
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
