; srt_first_row computes the residual w = 2 x - digit d from 2 x and d, with |w| <= 2/3 d and a digit from 1 to 4.
(define-fun w () Exact (residual sum_o carry_o))
(define-fun digit () Exact (ite (= digit_o #b00) (_ bv4 $N4) (small digit_o)))
(define-fun assumed () Bool
  (and (is-divisor divisor_i) (= ((_ extract $N_TOP $N_TOP) dividend_doubled_i) #b1)
       (= ((_ extract 0 0) dividend_doubled_i) #b0)))
(define-fun claimed () Bool
  (and (= w (bvsub (unsigned dividend_doubled_i) (times digit divisor_i))) (is-remainder w divisor_i)))
