; fp_adder in a format that the solver does not support: every pair of words, every mode, both kinds of tininess.
(define-fun assumed () Bool true)
(define-fun claimed () Bool
  (add-right result_o flags_o (mode rounding_mode_i) tininess_after_i a_i b_i subtract_i))
