; For residuals w with |w| <= 2/3 d, srt_row computes w' = 4 w - digit d, and |w'| <= 2/3 d. The digit is positive_o -
; negative_o. At least one of positive_o and negative_o is 0, and neither is 3.
(define-fun w () Exact (residual sum_i carry_i))
(define-fun next () Exact (residual sum_o carry_o))
(define-fun digit () Exact (bvsub (small positive_o) (small negative_o)))
(define-fun assumed () Bool (and (is-divisor divisor_i) (is-remainder w divisor_i)))
(define-fun claimed () Bool
  (and (bvule positive_o #b10) (bvule negative_o #b10) (or (= positive_o #b00) (= negative_o #b00))
       (= next (bvsub (twice (twice w)) (times digit divisor_i)))
       (is-remainder next divisor_i)))
