; Like divide.smt2, for a format that the solver does not support.
(declare-const wide-a WideWord)
(declare-const wide-b WideWord)
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun magnitude () Wide (quotient-magnitude wide-a wide-b free_quotient free_left))
(define-fun x () Wide
  (ite (= (is-negative a_i) (is-negative b_i)) magnitude (fp.neg magnitude)))
(define-fun assumed () Bool
  (and (is-word-of wide-a a_i) (is-word-of wide-b b_i) (possible-quotient free_quotient)))
(define-fun claimed () Bool
  (and (=> (is-quotient a_i b_i)
           (and (= free_dividend (normalized wide-a)) (= free_divisor (normalized wide-b))))
       (right result_o flags_o m tininess_after_i (not (is-quotient a_i b_i))
              (divide-result m a_i b_i magnitude) x x x (divide-invalid a_i b_i)
              (by-zero a_i b_i))))
