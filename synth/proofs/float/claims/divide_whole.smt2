; The whole fp_divider. Useful only to find counterexamples: no solver completes the proof.
(declare-const wide-a WideWord)
(declare-const wide-b WideWord)
(define-fun m () RoundingMode (mode rounding_mode_i))
(define-fun x () (_ BitVec $QX)
  (bvshl (concat (_ bv0 $QUOTIENT_SHIFT) (normalized wide-a)) (_ bv$QUOTIENT_SHIFT $QX)))
(define-fun d () (_ BitVec $QX) (concat (_ bv0 $QUOTIENT_SHIFT) (normalized wide-b)))
(define-fun magnitude () Wide
  (quotient-magnitude wide-a wide-b ((_ extract $Q1 0) (bvudiv x d))
                      (not (= (bvurem x d) (_ bv0 $QX)))))
(define-fun right-result () Float (divide-result m a_i b_i magnitude))
(define-fun right-flags () (_ BitVec 5) (divide-flags m tininess_after_i a_i b_i magnitude))
(define-fun assumed () Bool (and (is-word-of wide-a a_i) (is-word-of wide-b b_i)))
(define-fun claimed () Bool (and (represents result_o right-result) (= flags_o right-flags)))
