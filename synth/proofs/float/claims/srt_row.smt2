; srt_row: from |w| <= 2/3 d it goes to w' = 4 w - digit d, and |w'| <= 2/3 d again. The digit is the
; last one of the positive digits less that of the negative ones, of which one is 0 and none is 3.
(define-fun w () Exact (residual sum_i carry_i))
(define-fun next () Exact (residual sum_o carry_o))
(define-fun plus () (_ BitVec 2) ((_ extract 1 0) positives_o))
(define-fun minus () (_ BitVec 2) ((_ extract 1 0) negatives_o))
(define-fun digit () Exact (bvsub (small plus) (small minus)))
(define-fun assumed () Bool (and (is-divisor divisor_i) (is-remainder w divisor_i)))
(define-fun claimed () Bool
  (and (bvule plus #b10) (bvule minus #b10) (or (= plus #b00) (= minus #b00))
       (= next (bvsub (twice (twice w)) (times digit divisor_i)))
       (is-remainder next divisor_i)
       (= divisor_o divisor_i)
       (= ((_ extract 3 2) positives_o) positives_i)
       (= ((_ extract 3 2) negatives_o) negatives_i)))
