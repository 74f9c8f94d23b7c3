; Like multiply.smt2, for a format that the solver does not support.
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun x () Wide (exact-product a_i b_i free_product))
(define-fun assumed () Bool (possible-product a_i b_i free_product))
(define-fun claimed () Bool
  (and (= free_a (significand a_i)) (= free_b (significand b_i))
       (right result_o flags_o m tininess_after_i (not (and (is-finite a_i) (is-finite b_i)))
              (multiply-result m a_i b_i free_product) x x x (multiply-invalid a_i b_i) false)))
