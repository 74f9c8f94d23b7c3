; Whether the specification of quotients, and SMT-LIB's fp.div, agree with a test vector.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (let ((x (bvshl (concat (_ bv0 $QUOTIENT_SHIFT) (normalized wide-a)) (_ bv$QUOTIENT_SHIFT $QX)))
        (d (concat (_ bv0 $QUOTIENT_SHIFT) (normalized wide-b))))
    (let ((quotient ((_ extract $Q1 0) (bvudiv x d))))
      (let ((magnitude (quotient-magnitude wide-a wide-b quotient
                                           (not (= (bvurem x d) (_ bv0 $QX))))))
        (and (is-word-of wide-a a) (is-word-of wide-b b)
             (possible-quotient quotient)
             (represents result (divide-result m a b magnitude))
             (represents result (fp.div m (number a) (number b)))
             (= flags (divide-flags m after a b magnitude)))))))
