; Like multiply.smt2, for a format that the solver does not support.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (let ((product (product-of a b)))
    (let ((x (exact-product a b product)))
      (and (possible-product a b product)
           (right result flags m after (not (and (is-finite a) (is-finite b)))
                  (multiply-result m a b product) x x x (multiply-invalid a b) false)))))
