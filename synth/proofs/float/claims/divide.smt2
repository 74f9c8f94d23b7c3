; fp_divider, with a divider of significands that returns any possible quotient. The divider's operands are the
; normalised significands, and the result is right for the returned quotient. For every pair of words and every mode.
(declare-const wide-a WideWord)
(declare-const wide-b WideWord)
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun magnitude () Wide (quotient-magnitude wide-a wide-b free_quotient free_left))
(define-fun right-result () Float (divide-result m a_i b_i magnitude))
(define-fun right-flags () (_ BitVec 5) (divide-flags m tininess_after_i a_i b_i magnitude))
(define-fun assumed () Bool
  (and (is-word-of wide-a a_i) (is-word-of wide-b b_i) (possible-quotient free_quotient)))
(define-fun claimed () Bool
  (and (=> (is-quotient a_i b_i)
           (and (= free_dividend (normalized wide-a)) (= free_divisor (normalized wide-b))))
       (represents result_o right-result) (= flags_o right-flags)))
