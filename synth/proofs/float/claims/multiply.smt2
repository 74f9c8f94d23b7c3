; fp_multiplier, with a multiplier of significands that returns any possible product. The multiplier's operands are the
; significands, and the result is right for the returned product. For every pair of words and every mode.
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun right-result () Float (multiply-result m a_i b_i free_product))
(define-fun right-flags () (_ BitVec 5) (multiply-flags m tininess_after_i a_i b_i free_product))
(define-fun assumed () Bool (possible-product a_i b_i free_product))
(define-fun claimed () Bool
  (and (= free_a (significand a_i)) (= free_b (significand b_i))
       (represents result_o right-result) (= flags_o right-flags)))
