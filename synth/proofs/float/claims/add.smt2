; fp_adder: every pair of words, every mode, both kinds of tininess.
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun right-result () Float (add-result m a_i b_i subtract_i))
(define-fun right-flags () (_ BitVec 5) (add-flags m tininess_after_i a_i b_i subtract_i))
(define-fun assumed () Bool true)
(define-fun claimed () Bool (and (represents result_o right-result) (= flags_o right-flags)))
