; The whole fp_multiplier. Useful only to find counterexamples: no solver completes the proof.
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun right-result () Float (multiply-result m a_i b_i (product-of a_i b_i)))
(define-fun right-flags () (_ BitVec 5)
  (multiply-flags m tininess_after_i a_i b_i (product-of a_i b_i)))
(define-fun assumed () Bool true)
(define-fun claimed () Bool (and (represents result_o right-result) (= flags_o right-flags)))
