; fp_divider with QuotientBits: the quotient of significands, in [2, 4) or in [1, 2), keeps QuotientBits bits from its
; leading one on. The bits cut off raise no flag. Otherwise like divide.smt2.
(declare-const wide-a WideWord)
(declare-const wide-b WideWord)
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun without-last ((n Quotient)) Quotient (bvshl (bvlshr free_quotient n) n))
(define-fun from-2 () Bool (bvuge free_quotient (bvshl (_ bv$QUOTIENT_ONE $Q) (_ bv1 $Q))))
(define-fun kept () Quotient
  (ite from-2 (without-last (_ bv$CUT_FROM_2 $Q)) (without-last (_ bv$CUT_FROM_1 $Q))))
(define-fun magnitude () Wide (quotient-magnitude wide-a wide-b kept false))
(define-fun right-result () Float (divide-result m a_i b_i magnitude))
(define-fun right-flags () (_ BitVec 5) (divide-flags m tininess_after_i a_i b_i magnitude))
(define-fun assumed () Bool
  (and (is-word-of wide-a a_i) (is-word-of wide-b b_i) (possible-quotient free_quotient)))
(define-fun claimed () Bool
  (and (=> (is-quotient a_i b_i)
           (and (= free_dividend (normalized wide-a)) (= free_divisor (normalized wide-b))))
       (represents result_o right-result) (= flags_o right-flags)))
