; Like divide.smt2, for a format that the solver does not support.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (let ((n (bvshl (concat (_ bv0 $QUOTIENT_SHIFT) (normalized wide-a)) (_ bv$QUOTIENT_SHIFT $QX)))
        (d (concat (_ bv0 $QUOTIENT_SHIFT) (normalized wide-b))))
    (let ((quotient ((_ extract $Q1 0) (bvudiv n d))))
      (let ((magnitude (quotient-magnitude wide-a wide-b quotient
                                           (not (= (bvurem n d) (_ bv0 $QX))))))
        (let ((x (ite (= (is-negative a) (is-negative b)) magnitude (fp.neg magnitude))))
          (and (is-word-of wide-a a) (is-word-of wide-b b)
               (=> (is-quotient a b) (possible-quotient quotient))
               (right result flags m after (not (is-quotient a b)) (divide-result m a b magnitude)
                      x x x (divide-invalid a b) (by-zero a b))))))))
