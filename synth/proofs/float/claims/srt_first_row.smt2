; srt_first_row makes w = 2 x - digit d, with |w| <= 2/3 d and a digit of 1 .. 4, from 2 x and d.
(define-fun w () Exact (residual sum_o carry_o))
(define-fun digit () Exact (ite (= digit_o #b00) (_ bv4 $N4) (small digit_o)))
(define-fun assumed () Bool
  (and (is-divisor divisor_i) (= ((_ extract $N_TOP $N_TOP) dividend_doubled_i) #b1)
       (= ((_ extract 0 0) dividend_doubled_i) #b0)))
(define-fun claimed () Bool
  (and (= w (bvsub (unsigned dividend_doubled_i) (times digit divisor_i))) (is-remainder w divisor_i)))
